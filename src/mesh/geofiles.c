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
/* Files may include each other so deeply. Each level takes some kilobytes of the stack. */
#define DEPTH 32

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

/* Endings of files that gmsh reads as shapes, meshes or pictures, in small or in capital letters; then those that it
   knows in small letters only. Any other file it reads as commands, unless it begins as one of Headers. */
static const char *const SmallEndings[] = {"brep", "rle", "x_t", "x_b", "xmt_txt", "xmt_bin"};
static const char *const DataEndings[]  = {"stl",  "nii",  "brp", "xao",  "iges", "igs",  "step", "stp",  "sat",
                                           "unv",  "vtk",  "wrl", "iv",   "vrml", "mesh", "off",  "diff", "med",
                                           "mmed", "rmed", "bdf", "nas",  "neu",  "p3d",  "pnm",  "pbm",  "pgm",
                                           "ppm",  "bmp",  "jpg", "jpeg", "png",  "ply2", "ply",  "geom", "cgns"};
static const char *const Headers[]      = {"$PTS",        "$NO",       "$PARA",       "$ELM",
                                           "$MeshFormat", "$Comments", "$PostFormat", "$View"};
/* Endings of files that gmsh hands to another program. */
static const char *const ProgramEndings[] = {"gz", "py", "m", "exe", "ol", "pro"};

/* A file that was met, by its full path */
typedef struct {
  char     *path;
  PetscBool followed; /* as commands; a file may be read as data first */
} Met;

typedef struct {
  Scene      scene;
  PetscBool  trust;
  GeoFiles  *files;
  GeoStrings known, found; /* variables: of the pass before, and of this one */
  PetscBool  open;         /* the variables could not be settled */
  int        depth;        /* files that are being followed, one in the other */
  int        n_met, room;
  Met       *met; /* in this pass */
  Complaint *complaint;
} Walk;

static PetscErrorCode WalkFile(Walk *, const char *path, Reading);

/* Tells whether the ending of a file is in a list, in small letters or, unless `small`, all in capitals. */
static PetscBool HasEnding(const char *file, const char *const *endings, size_t n, PetscBool small)
{
  const char *dot = strrchr(file, '.');

  for (size_t i = 0; dot && i < n; i++) {
    const size_t length = strlen(endings[i]);
    size_t       same = 0, capital = 0;

    if (strlen(dot + 1) != length) continue;
    for (size_t k = 0; k < length; k++) {
      same += dot[1 + k] == endings[i][k];
      capital += dot[1 + k] == toupper(endings[i][k]);
    }
    if (same == length || (!small && capital == length)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscBool IsData(const char *file)
{
  return HasEnding(file, DataEndings, PETSC_STATIC_ARRAY_LENGTH(DataEndings), PETSC_FALSE) ||
             HasEnding(file, SmallEndings, PETSC_STATIC_ARRAY_LENGTH(SmallEndings), PETSC_TRUE)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Finds a file among those that were met, or adds it. *known: it was there. */
static PetscErrorCode Meet(Walk *walk, const char *path, Met **met, PetscBool *known)
{
  PetscFunctionBeginUser;
  *met   = NULL;
  *known = PETSC_TRUE;
  for (int i = 0; i < walk->n_met; i++) {
    *met = &walk->met[i];
    if (!strcmp((*met)->path, path)) PetscFunctionReturn(PETSC_SUCCESS);
  }
  *known = PETSC_FALSE;
  if (walk->n_met == walk->room) {
    walk->room = 2 * walk->room + 16;
    PetscCall(PetscRealloc((size_t)walk->room * sizeof(Met), &walk->met));
  }
  *met  = &walk->met[walk->n_met++];
  **met = (Met){0};
  PetscCall(PetscStrallocpy(path, &(*met)->path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ForgetMet(Walk *walk)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < walk->n_met; i++) PetscCall(PetscFree(walk->met[i].path));
  walk->n_met = 0;
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
  char        directory[PATH_MAX + 1], full[PATH_MAX + 1], file[PATH_MAX + 1], what[128], *name;
  const int   line = tokens->token[at].line;

  PetscFunctionBeginUser;
  /* gmsh's CurrentDirectory is that of the file itself; names start at the folder as it was written, through links. */
  if (!realpath(path, full)) PetscCall(PetscStrncpy(full, path, sizeof(full)));
  if (strrchr(full, '/')) strrchr(full, '/')[1] = '\0';
  snprintf(directory, sizeof(directory), "%.*s", slash ? (int)(slash - path) + 1 : 0, path);
  PetscCall(GeoStringsEvaluate(&walk->known, tokens, &at, full, &name));
  if (!name && reading == READS_DATA) {
    walk->files->open = PETSC_TRUE;
  } else if (!name) {
    Judge(walk, path, line,
          "the name of a file is made while gmsh runs, so that nobody can tell which commands it has");
  } else if (*name == '\\' || (*name && name[1] == ':')) {
    Judge(walk, path, line, "the name of a file is one of another system");
  } else if (reading == READS_BY_NAME &&
             HasEnding(name, ProgramEndings, PETSC_STATIC_ARRAY_LENGTH(ProgramEndings), PETSC_FALSE)) {
    snprintf(what, sizeof(what), "gmsh hands '%.60s' to another program", name);
    Judge(walk, path, line, what);
  } else {
    snprintf(file, sizeof(file), "%s%s", *name == '/' ? "" : directory, name);
    if (reading == READS_BY_NAME && IsData(name)) reading = READS_DATA;
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

/* Refuses a last line of several commands without a line end: gmsh silently reads only the first of them. */
static void JudgeLastLine(Walk *walk, const char *path, const char *text, size_t size, const GeoTokens *tokens)
{
  const int end = tokens->n - 1;

  if (!size || text[size - 1] == '\n' || tokens->wrong || walk->complaint->text[0]) return;
  for (int i = end - 2; i >= 0 && tokens->token[i].line == tokens->token[end - 1].line; i--)
    if (GeoTokenIs(&tokens->token[i], ";"))
      Complain(walk->complaint,
               "%s:%d: the last line has no line end, and gmsh reads only the first command of such a line; allowed: a "
               "line end after it",
               path, tokens->token[i].line);
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
  JudgeLastLine(walk, path, text, size, &tokens);
  PetscCall(GeoParametersAdd(text, &walk->files->declared));
  PetscCall(GeoDensitiesAdd(&walk->files->densities, &tokens));
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
  PetscBool known, script;
  Met      *met;

  PetscFunctionBeginUser;
  if (walk->complaint->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  if (walk->depth > DEPTH) {
    Judge(walk, name, 1, "files include each other too deeply");
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!realpath(name, path)) PetscCall(PetscStrncpy(path, name, sizeof(path)));
  PetscCall(Meet(walk, path, &met, &known));
  if (known && (met->followed || reading == READS_DATA)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GmshFileLoad(path, &text, &size));
  if (!known) walk->files->content = HashBytes(walk->files->content, text ? text : "", text ? size + 1 : 0);
  script = text && reading != READS_DATA ? PETSC_TRUE : PETSC_FALSE;
  for (size_t i = 0; script && reading == READS_BY_NAME && i < PETSC_STATIC_ARRAY_LENGTH(Headers); i++)
    if (!strncmp(text, Headers[i], strlen(Headers[i]))) script = PETSC_FALSE;
  if (script) {
    met->followed = PETSC_TRUE; /* the list may move from here on */
    walk->depth++;
    PetscCall(WalkScript(walk, name, text, size));
    walk->depth--;
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follows the .geo once, with what is known of the variables from the pass before. gmsh also reads the options beside
   it, if there are any. */
static PetscErrorCode WalkOnce(Walk *walk)
{
  char options[PETSC_MAX_PATH_LEN + 8];

  PetscFunctionBeginUser;
  PetscCall(ForgetMet(walk));
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
  walk->open  = now != before ? PETSC_TRUE : PETSC_FALSE;
  if (walk->open) Judge(walk, walk->scene->mesh_file, 1, "the names of its files cannot be followed");
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
  files->open = files->open || walk.open ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ForgetMet(&walk));
  PetscCall(PetscFree(walk.met));
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
  PetscCall(GeoDensitiesReset(&files->densities));
  *files = (GeoFiles){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
