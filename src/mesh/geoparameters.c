/* Declarations of parameters in the text of a .geo file, gmsh's own language. */
#include "geoparameters.h"
#include <ctype.h>
#include <string.h>

static PetscBool IsNameCharacter(char c)
{
  return isalnum((unsigned char)c) || c == '_' ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  GeoTextStrip - copies the text of a .geo file with blanks in the place of its comments.

  Not collective

  Input Parameters:
+ text    - of the file
- strings - whether what stands between double quotes becomes blank too

  Output Parameter:
. stripped - of the same length, to be freed with PetscFree()
@*/
PetscErrorCode GeoTextStrip(const char *text, PetscBool strings, char **stripped)
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(text, stripped));
  for (char *at = *stripped; *at;) {
    size_t n = 1;

    if (*at == '"') {
      n += strcspn(at + 1, "\"");
      if (strings) memset(at + 1, ' ', n - 1);
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

/* Adds the name at `at` unless it is there. Where no name begins, nothing happens. */
static PetscErrorCode AddName(const char *at, GeoParameters *parameters)
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
  for (int i = 0; i < parameters->n; i++) {
    if (strcmp(parameters->name[i], name)) continue;
    PetscCall(PetscFree(name));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (parameters->n == parameters->room) {
    parameters->room = 2 * parameters->room + 16;
    PetscCall(PetscRealloc((size_t)parameters->room * sizeof(char *), &parameters->name));
  }
  parameters->name[parameters->n++] = name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the names of the list behind DefineConstant: "[name = value, name = {value, ...}, name]". */
static PetscErrorCode AddList(const char *at, GeoParameters *parameters)
{
  int depth = 0;

  PetscFunctionBeginUser;
  at += strspn(at, " \t\r\n");
  if (*at != '[' && *at != '(') PetscFunctionReturn(PETSC_SUCCESS);
  for (; *at; at++) {
    depth += strchr("[({", *at) ? 1 : strchr("])}", *at) ? -1 : 0;
    if (!depth) break;
    if (depth == 1 && strchr("[(,", *at)) PetscCall(AddName(at + 1, parameters));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the next place behind a whole word, NULL if there is none. */
static const char *BehindWord(const char *start, const char *at, const char *word)
{
  const size_t n = strlen(word);

  for (; (at = strstr(at, word)); at += n)
    if ((at == start || !IsNameCharacter(at[-1])) && !IsNameCharacter(at[n])) return at + n;
  return NULL;
}

/*@
  GeoParametersAdd - adds the parameters that the text of a .geo file declares.

  Not collective

  Input Parameter:
. text - of the file; files that it includes are added by calls of their own

  Input/Output Parameter:
. parameters - zero at the start, to be freed with GeoParametersReset()
@*/
PetscErrorCode GeoParametersAdd(const char *text, GeoParameters *parameters)
{
  char *code;

  PetscFunctionBeginUser;
  PetscCall(GeoTextStrip(text, PETSC_TRUE, &code));
  for (const char *at = code; (at = BehindWord(code, at, "DefineConstant"));) PetscCall(AddList(at, parameters));
  for (const char *at = code; (at = BehindWord(code, at, "Exists"));) {
    const size_t blanks = strspn(at, " \t");

    if (at[blanks] == '(' || at[blanks] == '[') PetscCall(AddName(at + blanks + 1, parameters));
  }
  PetscCall(PetscFree(code));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoParametersFind - tells whether a name is a parameter.

  Not collective

  Input Parameters:
+ parameters - of all files
- name       - that the scene gives
@*/
PetscBool GeoParametersFind(const GeoParameters *parameters, const char *name)
{
  for (int i = 0; i < parameters->n; i++) {
    const char  *known = parameters->name[i];
    const size_t n     = strlen(known);

    if (!strcmp(known, name) || (known[n - 1] == '*' && !strncmp(known, name, n - 1))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/*@
  GeoParametersText - lists the parameters for a message.

  Not collective

  Input Parameter:
. parameters - of all files

  Output Parameter:
. text - the names with commas between them, or a word on how to declare one; to be freed with PetscFree()
@*/
PetscErrorCode GeoParametersText(const GeoParameters *parameters, char **text)
{
  static const char none[] = "nothing, as it declares none by DefineConstant[name = value]";
  size_t            size   = sizeof(none);

  PetscFunctionBeginUser;
  for (int i = 0; i < parameters->n; i++) size += strlen(parameters->name[i]) + 2;
  PetscCall(PetscCalloc1(size, text));
  if (!parameters->n) PetscCall(PetscStrncpy(*text, none, size));
  for (int i = 0; i < parameters->n; i++) {
    if (i) PetscCall(PetscStrlcat(*text, ", ", size));
    PetscCall(PetscStrlcat(*text, parameters->name[i], size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoParametersReset - frees the names.

  Not collective

  Input Parameter:
. parameters - is zero afterwards
@*/
PetscErrorCode GeoParametersReset(GeoParameters *parameters)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < parameters->n; i++) PetscCall(PetscFree(parameters->name[i]));
  PetscCall(PetscFree(parameters->name));
  *parameters = (GeoParameters){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
