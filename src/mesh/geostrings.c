/* Texts in variables of a .geo, see geostrings.h. */
#include "geostrings.h"
#include "base/hash.h"
#include <string.h>

/* Calls of StrCat in StrCat that are followed. Each takes some kilobytes of the stack. */
#define NESTED 16

static GeoString *Find(const GeoStrings *strings, const GeoToken *name)
{
  for (int i = 0; i < strings->n; i++)
    if (GeoTokenIs(name, strings->string[i].name)) return &strings->string[i];
  return NULL;
}

static PetscErrorCode CopyToken(const GeoToken *token, char **text)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(token->length + 1, text));
  memcpy(*text, token->at, (size_t)token->length);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes that a variable is set. `value` is its text, or any other token where it is set otherwise. */
static PetscErrorCode Note(GeoStrings *strings, const GeoToken *name, const GeoToken *value, PetscBool constant)
{
  GeoString *string = Find(strings, name);

  PetscFunctionBeginUser;
  if (!string) {
    if (strings->n == strings->room) {
      strings->room = 2 * strings->room + 16;
      PetscCall(PetscRealloc((size_t)strings->room * sizeof(GeoString), &strings->string));
    }
    string  = &strings->string[strings->n++];
    *string = (GeoString){.constant = constant};
    PetscCall(CopyToken(name, &string->name));
  }
  if (!string->times && value->kind == GEO_TEXT) PetscCall(CopyToken(value, &string->value));
  string->times++;
  string->constant = string->constant && constant ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes the name by which a constant is known to gmsh's database. Constants of one name have one value. */
static PetscErrorCode NoteShared(GeoStrings *strings, const GeoToken *name)
{
  char *text;

  PetscFunctionBeginUser;
  for (int i = 0; i < strings->n_shown; i++) {
    if (strlen(strings->shown[i]) == (size_t)name->length &&
        !strncmp(strings->shown[i], name->at, (size_t)name->length))
      strings->shared = PETSC_TRUE;
  }
  PetscCall(CopyToken(name, &text));
  PetscCall(PetscRealloc((size_t)(strings->n_shown + 1) * sizeof(char *), &strings->shown));
  strings->shown[strings->n_shown++] = text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether the variable at token i gets a value: NAME = or NAME += or NAME() = or NAME[] =. *value is the token
   of the value; it is the sign in front of it unless the whole value is one text. */
static PetscBool IsSet(const GeoTokens *tokens, int i, PetscBool constant, const GeoToken **value)
{
  const GeoToken *next = tokens->token + i + 1, *end = tokens->token + tokens->n - 1;

  if (next + 2 < end && (GeoTokenIs(next, "(") || GeoTokenIs(next, "[")) &&
      (GeoTokenIs(next + 1, ")") || GeoTokenIs(next + 1, "]")))
    next += 2;
  if (next < end && (GeoTokenIs(next, "+") || GeoTokenIs(next, "-"))) next++;
  if (next + 2 > end || !GeoTokenIs(next, "=") || GeoTokenIs(next + 1, "=")) return PETSC_FALSE;
  *value = next;
  next += constant && GeoTokenIs(next + 1, "{") ? 2 : 1;
  if (next->kind == GEO_TEXT && next < end &&
      (GeoTokenIs(next + 1, ";") || (constant && (GeoTokenIs(next + 1, ",") || GeoTokenIs(next + 1, "}") ||
                                                  GeoTokenIs(next + 1, "]") || GeoTokenIs(next + 1, ")")))))
    *value = next;
  return PETSC_TRUE;
}

/*@
  GeoStringsAdd - collects the variables that a file sets.

  Not collective

  Input Parameter:
. tokens - tokens of the file

  Input/Output Parameter:
. strings - the list, with strings->scene set and otherwise zero before the first call
@*/
PetscErrorCode GeoStringsAdd(GeoStrings *strings, const GeoTokens *tokens)
{
  int constants = 0, depth = 0; /* inside of DefineConstant[...], and how many brackets are open there */

  PetscFunctionBeginUser;
  for (int i = 0; i < tokens->n - 1; i++) {
    const GeoToken *token = tokens->token + i, *value;

    if (GeoTokenIs(token, "DefineConstant")) {
      constants = 1;
      depth     = 0;
    } else if (constants && token->kind == GEO_SIGN && strchr("[({", *token->at)) {
      depth++;
    } else if (constants && token->kind == GEO_SIGN && strchr("])}", *token->at)) {
      constants = --depth > 0;
    } else if (GeoTokenIs(token, "SetString") || GeoTokenIs(token, "SetNumber")) {
      strings->shared = PETSC_TRUE;
    } else if (constants && GeoTokenIs(token, "Name") && token[1].kind == GEO_TEXT) {
      PetscCall(NoteShared(strings, token + 1));
    } else if (token->kind == GEO_WORD && GeoTokenIs(token + 1, "~")) {
      PetscCall(Note(strings, token, token, PETSC_FALSE));
      Find(strings, token)->indexed = PETSC_TRUE;
    } else if (token->kind == GEO_WORD && IsSet(tokens, i, constants ? PETSC_TRUE : PETSC_FALSE, &value)) {
      PetscCall(Note(strings, token, value, constants ? PETSC_TRUE : PETSC_FALSE));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether some file sets variables whose computed names may be this one: NAME~{i} = ... */
static PetscBool MayBeSetByIndex(const GeoStrings *strings, const GeoToken *name)
{
  for (int i = 0; i < strings->n; i++) {
    const GeoString *other  = &strings->string[i];
    const int        length = (int)strlen(other->name);

    if (other->indexed && name->length > length && !strncmp(name->at, other->name, (size_t)length)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Returns the text of a variable, NULL if it is not known. A parameter of the scene is the value of a constant, and of
   a variable that no file sets. What other files set beside it depends on what gmsh comes to. */
static const char *Value(const GeoStrings *strings, const GeoToken *name)
{
  const GeoString *string = Find(strings, name);

  if (MayBeSetByIndex(strings, name)) return NULL;
  if (string && (string->times != 1 || (string->constant && strings->shared))) return NULL;
  for (int i = 0; i < strings->scene->n_parameters; i++) {
    if (!GeoTokenIs(name, strings->scene->parameters[i].key)) continue;
    return !string || string->constant ? strings->scene->parameters[i].value : NULL;
  }
  return string ? string->value : NULL;
}

/* Appends the texts of the arguments of StrCat(...), or gives the only one of Str(...). */
static PetscErrorCode EvaluateArguments(const GeoStrings *strings, const GeoTokens *tokens, int *at,
                                        const char *directory, char **text)
{
  const PetscBool joins                      = GeoTokenIs(&tokens->token[*at - 1], "StrCat");
  char            joined[PETSC_MAX_PATH_LEN] = "";
  PetscBool       known                      = PETSC_TRUE;
  int             n                          = 0;

  PetscFunctionBeginUser;
  if (!GeoTokenIs(&tokens->token[*at], "(") && !GeoTokenIs(&tokens->token[*at], "["))
    PetscFunctionReturn(PETSC_SUCCESS);
  do {
    char *part;

    if (tokens->token[*at].kind == GEO_END) break;
    (*at)++;
    PetscCall(GeoStringsEvaluate(strings, tokens, at, directory, &part));
    if (!part || strlen(joined) + strlen(part) >= sizeof(joined)) known = PETSC_FALSE;
    if (known) PetscCall(PetscStrlcat(joined, part, sizeof(joined)));
    PetscCall(PetscFree(part));
    n++;
  } while (known && GeoTokenIs(&tokens->token[*at], ","));
  if (!GeoTokenIs(&tokens->token[*at], ")") && !GeoTokenIs(&tokens->token[*at], "]")) known = PETSC_FALSE;
  if (tokens->token[*at].kind != GEO_END) (*at)++;
  if (known && (joins || n == 1)) PetscCall(PetscStrallocpy(joined, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether an expression can end in front of a token. */
static PetscBool EndsExpression(const GeoToken *token)
{
  return token->kind == GEO_SIGN && strchr(";,)]", *token->at) ? PETSC_TRUE : PETSC_FALSE;
}

/* Tells whether this many calls of StrCat and Str stand in front of each other: StrCat(StrCat(StrCat(... */
static PetscBool NestedTooDeeply(const GeoTokens *tokens, int at)
{
  int depth = 0;

  while (at >= 2 && depth < NESTED &&
         (GeoTokenIs(&tokens->token[at - 1], "StrCat") || GeoTokenIs(&tokens->token[at - 1], "Str"))) {
    at -= 2;
    depth++;
  }
  return depth >= NESTED ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  GeoStringsEvaluate - gives the text of an expression.

  Not collective

  Input Parameters:
+ strings   - variables of all files
. tokens    - tokens of the file with the expression
- directory - folder of this file, "" or with a slash at its end

  Input/Output Parameter:
. at - index of the first token of the expression, then of the token behind it

  Output Parameter:
. text - the text, to be freed with PetscFree(); NULL if it is only known while gmsh runs
@*/
PetscErrorCode GeoStringsEvaluate(const GeoStrings *strings, const GeoTokens *tokens, int *at, const char *directory,
                                  char **text)
{
  const GeoToken *token = &tokens->token[*at];

  PetscFunctionBeginUser;
  *text = NULL;
  if (token->kind == GEO_END) PetscFunctionReturn(PETSC_SUCCESS);
  (*at)++;
  if (token->kind == GEO_TEXT) {
    PetscCall(CopyToken(token, text));
  } else if (GeoTokenIs(token, "CurrentDirectory") || GeoTokenIs(token, "CurrentDir")) {
    PetscCall(PetscStrallocpy(directory, text));
  } else if (NestedTooDeeply(tokens, *at)) {
    PetscFunctionReturn(PETSC_SUCCESS);
  } else if (GeoTokenIs(token, "StrCat") || GeoTokenIs(token, "Str")) {
    PetscCall(EvaluateArguments(strings, tokens, at, directory, text));
  } else if (token->kind == GEO_WORD && EndsExpression(&tokens->token[*at])) {
    PetscCall(PetscStrallocpy(Value(strings, token), text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoStringsHash - gives a number that is equal for equal lists.

  Not collective

  Input Parameter:
. strings - the list
@*/
uint64_t GeoStringsHash(const GeoStrings *strings)
{
  uint64_t hash = HASH_START;

  for (int i = 0; i < strings->n; i++) {
    const GeoString *string = &strings->string[i];
    const char      *value  = string->value ? string->value : "";

    hash = HashBytes(hash, string->name, strlen(string->name) + 1);
    hash = HashBytes(hash, value, strlen(value) + 1);
    hash = HashBytes(hash, (const char *)&string->times, sizeof(string->times));
  }
  return HashBytes(hash, (const char *)&strings->shared, sizeof(strings->shared));
}

/*@
  GeoStringsDestroy - frees the list.

  Not collective

  Input Parameter:
. strings - empty afterwards
@*/
PetscErrorCode GeoStringsDestroy(GeoStrings *strings)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < strings->n; i++) {
    PetscCall(PetscFree(strings->string[i].name));
    PetscCall(PetscFree(strings->string[i].value));
  }
  for (int i = 0; i < strings->n_shown; i++) PetscCall(PetscFree(strings->shown[i]));
  PetscCall(PetscFree(strings->shown));
  PetscCall(PetscFree(strings->string));
  *strings = (GeoStrings){.scene = strings->scene};
  PetscFunctionReturn(PETSC_SUCCESS);
}
