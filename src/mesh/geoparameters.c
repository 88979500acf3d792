/* Finds the declarations of parameters in the text of a .geo file, which is written in gmsh's own language. */
#include "geoparameters.h"
#include <ctype.h>
#include <string.h>

static PetscBool IsNameCharacter(char c)
{
  return isalnum((unsigned char)c) || c == '_' ? PETSC_TRUE : PETSC_FALSE;
}

/* Copies the text of a .geo file and replaces comments and the text between double quotes by blanks. The copy has the
   same length and is to be freed with PetscFree(). */
static PetscErrorCode GeoTextStrip(const char *text, char **stripped)
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(text, stripped));
  for (char *at = *stripped; *at;) {
    size_t n = 1;

    if (*at == '"') {
      n += strcspn(at + 1, "\"");
      memset(at + 1, ' ', n - 1);
      n += at[n] == '"';
    } else if (!strncmp(at, "//", 2)) {
      n = strcspn(at, "\n");
      memset(at, ' ', n);
    } else if (!strncmp(at, "/*", 2)) {
      const char *end = strstr(at + 2, "*/");

      n = end ? (size_t)(end + 2 - at) : strlen(at);
      memset(at, ' ', n);
    }
    at += n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool HasName(const GeoNames *names, const char *name)
{
  for (int i = 0; i < names->n; i++)
    if (!strcmp(names->name[i], name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Adds the name at `at` unless the list has it. Does nothing if no name begins there. */
static PetscErrorCode AddName(const char *at, GeoNames *names)
{
  char  *name;
  size_t n = 0;

  PetscFunctionBeginUser;
  at += strspn(at, " \t\r\n");
  while (IsNameCharacter(at[n])) n++;
  if (!n || isdigit((unsigned char)*at)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(n + 3, &name));
  memcpy(name, at, n);
  if (at[n] == '~') memcpy(name + n, "_*", 2);
  if (HasName(names, name)) {
    PetscCall(PetscFree(name));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (names->n == names->room) {
    names->room = 2 * names->room + 16;
    PetscCall(PetscRealloc((size_t)names->room * sizeof(char *), &names->name));
  }
  names->name[names->n++] = name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the names of the list after DefineConstant: "[name = value, name = {value, ...}, name]". */
static PetscErrorCode AddList(const char *at, GeoNames *declared)
{
  int depth = 0;

  PetscFunctionBeginUser;
  at += strspn(at, " \t\r\n");
  if (*at != '[' && *at != '(') PetscFunctionReturn(PETSC_SUCCESS);
  for (; *at; at++) {
    depth += strchr("[({", *at) ? 1 : strchr("])}", *at) ? -1 : 0;
    if (!depth) break;
    if (depth == 1 && strchr("[(,", *at)) PetscCall(AddName(at + 1, declared));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the position after the next occurrence of a whole word, NULL if there is none. */
static const char *BehindWord(const char *start, const char *at, const char *word)
{
  const size_t n = strlen(word);

  for (; (at = strstr(at, word)); at += n)
    if ((at == start || !IsNameCharacter(at[-1])) && !IsNameCharacter(at[n])) return at + n;
  return NULL;
}

/* Determines whether the name that ends at `at` gets a value there: "n = 4", "n[] = ...", "n += 1", "n++". */
static PetscBool IsAssigned(const char *at)
{
  at += strspn(at, " \t");
  if (!strncmp(at, "[]", 2) || !strncmp(at, "()", 2)) at += 2;
  at += strspn(at, " \t");
  if (*at && strchr("+-*/", *at) && (at[1] == '=' || at[1] == at[0])) return PETSC_TRUE;
  return at[0] == '=' && at[1] != '=' ? PETSC_TRUE : PETSC_FALSE;
}

/* Words of gmsh's language that are not followed by a bracket, so that they look like names in an expression. */
static const char *const Keywords[] = {
  "Physical",   "Plane",    "Ruled",     "Surface",     "Curve",   "Line",           "Loop",      "Wire",
  "Volume",     "Point",    "Compound",  "Spline",      "BSpline", "Bezier",         "Circle",    "Ellipse",
  "Nurbs",      "Periodic", "Recombine", "Transfinite", "Mesh",    "Smooth",         "Coherence", "Delete",
  "Recursive",  "Macro",    "Function",  "Call",        "Return",  "Include",        "Merge",     "If",
  "Else",       "ElseIf",   "EndIf",     "For",         "In",      "EndFor",         "Using",     "Layers",
  "Left",       "Right",    "Alternate", "Progression", "Bump",    "Abort",          "Exit",      "Field",
  "Background", "Pi",       "General",   "Geometry",    "Solver",  "PostProcessing", "View",      "SetFactory",
  "newp",       "newl",     "newc",      "newll",       "news",    "newsl",          "newv",      "newreg",
  "Embed",      "Reverse",  "Hole",      "MeshSize",    NULL};

static PetscBool IsKeyword(const char *at, size_t n)
{
  for (int i = 0; Keywords[i]; i++)
    if (strlen(Keywords[i]) == n && !strncmp(at, Keywords[i], n)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Sorts the names of a text into those that get a value from it and those that occur in its expressions. Names of
   functions and of entities are followed by a bracket and are neither. */
static PetscErrorCode AddNames(const char *text, GeoParameters *parameters)
{
  PetscFunctionBeginUser;
  for (const char *at = text, *end; *at; at = end) {
    const char *before = at;

    for (end = at; IsNameCharacter(*end);) end++;
    if (end == at) {
      end++;
      continue;
    }
    while (before > text && strchr(" \t", before[-1])) before--;
    if (IsAssigned(end) || (before - text >= 3 && before < at && !strncmp(before - 3, "For", 3)))
      PetscCall(AddName(at, &parameters->assigned));
    else if (!strchr("([{", end[strspn(end, " \t")]) && !IsKeyword(at, (size_t)(end - at)))
      PetscCall(AddName(at, &parameters->used));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoParametersAdd - adds the names that the text of a .geo file declares, uses and gives values to.

  Not collective

  Input Parameter:
. text - text of the file

  Input/Output Parameter:
. parameters - zero before the first call, to be freed with GeoParametersReset()

  Note:
  Files that this one includes are not followed. Call the function for each of them.
@*/
PetscErrorCode GeoParametersAdd(const char *text, GeoParameters *parameters)
{
  char *code;

  PetscFunctionBeginUser;
  PetscCall(GeoTextStrip(text, &code));
  for (const char *at = code; (at = BehindWord(code, at, "DefineConstant"));)
    PetscCall(AddList(at, &parameters->declared));
  for (const char *at = code; (at = BehindWord(code, at, "Exists"));) {
    const size_t blanks = strspn(at, " \t");

    if (at[blanks] == '(' || at[blanks] == '[') PetscCall(AddName(at + blanks + 1, &parameters->declared));
  }
  PetscCall(AddNames(code, parameters));
  PetscCall(PetscFree(code));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoParametersFind - determines whether a name is a parameter.

  Not collective

  Input Parameters:
+ parameters - from GeoParametersAdd() for all files
- name       - name that the scene gives

  Note:
  Returns PETSC_TRUE if the files declare the name, also by a name that ends with "*", or if they use it without giving
  it a value.
@*/
PetscBool GeoParametersFind(const GeoParameters *parameters, const char *name)
{
  for (int i = 0; i < parameters->declared.n; i++) {
    const char  *known = parameters->declared.name[i];
    const size_t n     = strlen(known);

    if (!strcmp(known, name) || (known[n - 1] == '*' && !strncmp(known, name, n - 1))) return PETSC_TRUE;
  }
  return HasName(&parameters->used, name) && !HasName(&parameters->assigned, name) ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  GeoParametersText - lists the parameters for a message.

  Not collective

  Input Parameter:
. parameters - from GeoParametersAdd() for all files

  Output Parameter:
. text - the names, separated by commas; if there are none, a text that says how to declare one; to be freed with
  PetscFree()
@*/
PetscErrorCode GeoParametersText(const GeoParameters *parameters, char **text)
{
  static const char none[] = "nothing, as it declares none by DefineConstant[name = value]";
  const GeoNames   *names  = &parameters->declared;
  size_t            size   = sizeof(none);

  PetscFunctionBeginUser;
  for (int i = 0; i < names->n; i++) size += strlen(names->name[i]) + 2;
  PetscCall(PetscCalloc1(size, text));
  if (!names->n) PetscCall(PetscStrncpy(*text, none, size));
  for (int i = 0; i < names->n; i++) {
    if (i) PetscCall(PetscStrlcat(*text, ", ", size));
    PetscCall(PetscStrlcat(*text, names->name[i], size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoParametersReset - frees the names.

  Not collective

  Input Parameter:
. parameters - zero afterwards
@*/
PetscErrorCode GeoParametersReset(GeoParameters *parameters)
{
  GeoNames *const lists[] = {&parameters->declared, &parameters->used, &parameters->assigned};

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(lists); k++) {
    for (int i = 0; i < lists[k]->n; i++) PetscCall(PetscFree(lists[k]->name[i]));
    PetscCall(PetscFree(lists[k]->name));
  }
  *parameters = (GeoParameters){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
