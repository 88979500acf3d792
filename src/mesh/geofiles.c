/* Follows the files of a .geo, see geofiles.h. */
#include "geofiles.h"
#include "base/hash.h"
#include "geoscript.h"
#include "geostrings.h"
#include "gmshfile.h"
#include <ctype.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* The files are followed so many times at most until their variables are known. Each pass finds what one more level of
   names in variables leads to. */
#define PASSES 8

/* How gmsh treats a file that a .geo names. */
typedef enum {
  READS_SCRIPT,  /* as commands: Include */
  READS_BY_NAME, /* by its ending: Merge */
  READS_DATA,    /* as numbers or shapes */
} Reading;

/* The words after which the name of a file stands. */
static const struct {
  const char *word;
  Reading     reading;
  char        before; /* the sign in front of the name, or 0 */
} Readers[] = {
  {"Include", READS_SCRIPT, 0},       {"Merge", READS_BY_NAME, 0},       {"MergeWithBoundingBox", READS_BY_NAME, 0},
  {"ShapeFromFile", READS_DATA, '('}, {"ListFromFile", READS_DATA, '('}, {"FileExists", READS_DATA, '('},
  {"FileName", READS_DATA, '='},
};

/* Endings of files that gmsh reads as shapes, meshes or pictures. Any other file it reads as commands, unless it begins
   as one of Headers. gmsh knows the endings in small and in capital letters. */
static const char *const DataEndings[] = {
  "stl",     "nii", "brep", "rle", "brp", "xao",  "iges", "igs", "step", "stp", "sat",  "x_t",  "xmt_txt", "x_b",
  "xmt_bin", "unv", "vtk",  "wrl", "iv",  "vrml", "mesh", "off", "diff", "med", "mmed", "rmed", "bdf",     "nas",
  "neu",     "p3d", "pnm",  "pbm", "pgm", "ppm",  "bmp",  "jpg", "jpeg", "png", "ply2", "ply",  "geom",    "cgns"};
static const char *const Headers[] = {"$PTS",        "$NO",       "$PARA",       "$ELM",
                                      "$MeshFormat", "$Comments", "$PostFormat", "$View"};
/* Endings of files that gmsh hands to another program. */
static const char *const ProgramEndings[] = {"gz", "py", "m", "exe", "ol", "pro"};

typedef struct {
  Scene      scene;
  PetscBool  trust;
  GeoFiles  *files;
  GeoStrings known, found; /* variables: of the pass before, and of this one */
  int        n_seen, room;
  char     **seen; /* full paths of the files that were followed in this pass */
  Complaint *complaint;
} Walk;

static PetscErrorCode WalkFile(Walk *, const char *path, Reading);

static PetscBool HasEnding(const char *file, const char *const *endings, size_t n)
{
  const char *dot = strrchr(file, '.');

  for (size_t i = 0; dot && i < n; i++) {
    const size_t length = strlen(endings[i]);
    size_t       small = 0, capital = 0;

    if (strlen(dot + 1) != length) continue;
    for (size_t k = 0; k < length; k++) {
      small += dot[1 + k] == endings[i][k];
      capital += dot[1 + k] == toupper(endings[i][k]);
    }
    if (small == length || capital == length) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Tells whether a file that was seen already is met again, and notes it. */
static PetscErrorCode Seen(Walk *walk, const char *path, PetscBool *seen)
{
  PetscFunctionBeginUser;
  *seen = PETSC_FALSE;
  for (int i = 0; i < walk->n_seen; i++)
    if (!strcmp(walk->seen[i], path)) *seen = PETSC_TRUE;
  if (*seen) PetscFunctionReturn(PETSC_SUCCESS);
  if (walk->n_seen == walk->room) {
    walk->room = 2 * walk->room + 16;
    PetscCall(PetscRealloc((size_t)walk->room * sizeof(char *), &walk->seen));
  }
  PetscCall(PetscStrallocpy(path, &walk->seen[walk->n_seen++]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ForgetSeen(Walk *walk)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < walk->n_seen; i++) PetscCall(PetscFree(walk->seen[i]));
  walk->n_seen = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses what a script does besides geometry, unless the user trusts it. */
static void Judge(Walk *walk, const char *path, int line, const char *what)
{
  if (walk->trust)
    walk->files->open = PETSC_TRUE;
  else
    Complain(walk->complaint,
             "%s:%d: %s; allowed: commands that make geometry and mesh (-trust on the command line allows the others, "
             "for a scene that you trust)",
             path, line, what);
}

/* Follows the file that the expression behind token `at` names. */
static PetscErrorCode FollowName(Walk *walk, const char *path, const GeoTokens *tokens, int at, Reading reading)
{
  const char *slash = strrchr(path, '/');
  char        directory[PATH_MAX + 1], file[PATH_MAX + 1], what[128], *name;
  const int   line = tokens->token[at].line;

  PetscFunctionBeginUser;
  snprintf(directory, sizeof(directory), "%.*s", slash ? (int)(slash - path) + 1 : 0, path);
  PetscCall(GeoStringsEvaluate(&walk->known, tokens, &at, directory, &name));
  if (!name && reading == READS_DATA) {
    walk->files->open = PETSC_TRUE;
  } else if (!name) {
    Judge(walk, path, line,
          "the name of a file is made while gmsh runs, so that nobody can tell which commands it has");
  } else if (reading == READS_BY_NAME && HasEnding(name, ProgramEndings, PETSC_STATIC_ARRAY_LENGTH(ProgramEndings))) {
    snprintf(what, sizeof(what), "gmsh hands '%.60s' to another program", name);
    Judge(walk, path, line, what);
  } else {
    snprintf(file, sizeof(file), "%s%s", *name == '/' ? "" : directory, name);
    if (reading == READS_BY_NAME && HasEnding(name, DataEndings, PETSC_STATIC_ARRAY_LENGTH(DataEndings)))
      reading = READS_DATA;
    PetscCall(WalkFile(walk, file, reading));
  }
  PetscCall(PetscFree(name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follows all files that a script names. */
static PetscErrorCode FollowNames(Walk *walk, const char *path, const GeoTokens *tokens)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < tokens->n - 2; i++) {
    const GeoToken *token = tokens->token + i;

    for (size_t k = 0; token->kind == GEO_WORD && k < PETSC_STATIC_ARRAY_LENGTH(Readers); k++) {
      const char      before     = Readers[k].before;
      const PetscBool at_bracket = GeoTokenIs(token + 1, "(") || GeoTokenIs(token + 1, "[") ? PETSC_TRUE : PETSC_FALSE;

      if (!GeoTokenIs(token, Readers[k].word)) continue;
      if (before == '(' ? !at_bracket : before == '=' ? !GeoTokenIs(token + 1, "=") : token[1].kind == GEO_SIGN)
        continue;
      PetscCall(FollowName(walk, path, tokens, i + (before ? 2 : 1), Readers[k].reading));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Looks through a file of commands and follows the files that it names. */
static PetscErrorCode WalkScript(Walk *walk, const char *path, const char *text, size_t size)
{
  GeoTokens   tokens;
  const char *what;
  char        says[256];
  int         at;

  PetscFunctionBeginUser;
  PetscCall(GeoTokensCreate(text, size, &tokens));
  what = GeoScriptForbidden(&tokens, &at);
  if (what) {
    const GeoToken *token = &tokens.token[at];

    const GeoToken *last = at + 2 < tokens.n && GeoTokenIs(token + 1, ".") ? token + 2 : token; /* of an option */

    snprintf(says, sizeof(says), "'%.*s' %s", (int)PetscMin(last->at + last->length - token->at, 60), token->at, what);
    Judge(walk, path, token->line, says);
  } else if (tokens.wrong) {
    Judge(walk, path, tokens.token[tokens.n - 1].line, tokens.wrong);
  }
  PetscCall(GeoParametersAdd(text, &walk->files->declared));
  PetscCall(GeoStringsAdd(&walk->found, &tokens));
  if (!walk->complaint->text[0]) PetscCall(FollowNames(walk, path, &tokens));
  PetscCall(GeoTokensDestroy(&tokens));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hashes a file, and follows it if gmsh reads it as commands. gmsh complains of a file that is missing, if it matters;
   here the place counts as empty, so that a file which appears there later makes a new mesh. */
static PetscErrorCode WalkFile(Walk *walk, const char *name, Reading reading)
{
  char      path[PATH_MAX + 1], *text;
  size_t    size;
  PetscBool seen, script;

  PetscFunctionBeginUser;
  if (walk->complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  if (!realpath(name, path)) PetscCall(PetscStrncpy(path, name, sizeof(path)));
  PetscCall(Seen(walk, path, &seen));
  if (seen) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GmshFileLoad(path, &text, &size));
  walk->files->content = HashBytes(walk->files->content, text ? text : "", text ? size + 1 : 0);
  script               = text && reading != READS_DATA ? PETSC_TRUE : PETSC_FALSE;
  for (size_t i = 0; script && reading == READS_BY_NAME && i < PETSC_STATIC_ARRAY_LENGTH(Headers); i++)
    if (!strncmp(text, Headers[i], strlen(Headers[i]))) script = PETSC_FALSE;
  if (script) PetscCall(WalkScript(walk, path, text, size));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follows the .geo once, with what is known of the variables from the pass before. gmsh also reads the options beside
   it, if there are any. */
static PetscErrorCode WalkOnce(Walk *walk)
{
  char options[PETSC_MAX_PATH_LEN + 8];

  PetscFunctionBeginUser;
  PetscCall(ForgetSeen(walk));
  PetscCall(GeoFilesReset(walk->files));
  walk->files->content = HASH_START;
  snprintf(options, sizeof(options), "%s.opt", walk->scene->mesh_file);
  PetscCall(WalkFile(walk, walk->scene->mesh_file, READS_SCRIPT));
  PetscCall(WalkFile(walk, options, READS_SCRIPT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follows the .geo until all its variables are known. A file that comes later may set a variable again, and a macro may
   then read another file with it. */
static PetscErrorCode CollectStrings(Walk *walk)
{
  const PetscBool trust  = walk->trust;
  uint64_t        before = 0, now = 1;

  PetscFunctionBeginUser;
  walk->trust = PETSC_TRUE;
  for (int pass = 0; now != before && pass < PASSES; pass++) {
    before = GeoStringsHash(&walk->known);
    PetscCall(WalkOnce(walk));
    now = GeoStringsHash(&walk->found);
    PetscCall(GeoStringsDestroy(&walk->known));
    walk->known = walk->found;
    walk->found = (GeoStrings){.scene = walk->scene};
  }
  walk->trust = trust;
  if (now != before) Judge(walk, walk->scene->mesh_file, 1, "the names of its files cannot be followed");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoFilesRead - follows all files that a scene's .geo reads.

  Not collective

  Input Parameters:
+ scene - its mesh file and parameters are read
- trust - PETSC_TRUE: commands that run programs or write files are not refused

  Output Parameters:
+ files     - what was found, to be freed with GeoFilesReset()
- complaint - the first command that is refused, with its file and line

  Note:
  For one rank. gmsh complains of files that are missing.
@*/
PetscErrorCode GeoFilesRead(Scene scene, PetscBool trust, GeoFiles *files, Complaint *complaint)
{
  Walk walk = {.scene     = scene,
               .trust     = trust,
               .files     = files,
               .known     = {.scene = scene},
               .found     = {.scene = scene},
               .complaint = complaint};

  PetscFunctionBeginUser;
  *files = (GeoFiles){0};
  PetscCall(CollectStrings(&walk));
  PetscCall(WalkOnce(&walk));
  PetscCall(ForgetSeen(&walk));
  PetscCall(PetscFree(walk.seen));
  PetscCall(GeoStringsDestroy(&walk.known));
  PetscCall(GeoStringsDestroy(&walk.found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoFilesReset - frees the lists.

  Not collective

  Input Parameter:
. files - zero afterwards
@*/
PetscErrorCode GeoFilesReset(GeoFiles *files)
{
  PetscFunctionBeginUser;
  PetscCall(GeoParametersReset(&files->declared));
  *files = (GeoFiles){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
