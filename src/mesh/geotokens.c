/* Splits gmsh's language into tokens, see geotokens.h. The rules are those of gmsh's reference manual, section
   "Comments" and "Floating point expressions". */
#include "geotokens.h"
#include <ctype.h>
#include <string.h>

/* gmsh cuts a text after so many characters and reads what follows as commands. */
#define TEXT_LENGTH 1023

static PetscBool BeginsWord(char c)
{
  return isalpha((unsigned char)c) || c == '_' ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode AddToken(GeoTokens *tokens, GeoTokenKind kind, const char *at, size_t length, int line)
{
  PetscFunctionBeginUser;
  if (tokens->n == tokens->room) {
    tokens->room = 2 * tokens->room + 256;
    PetscCall(PetscRealloc((size_t)tokens->room * sizeof(GeoToken), &tokens->token));
  }
  tokens->token[tokens->n++] = (GeoToken){.kind = kind, .at = at, .length = (int)length, .line = line};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the length of a number: digits, a point, an exponent with digits. */
static size_t NumberLength(const char *at)
{
  size_t n = strspn(at, "0123456789"), e;

  if (at[n] == '.') n += 1 + strspn(at + n + 1, "0123456789");
  if (at[n] != 'e' && at[n] != 'E') return n;
  e = n + 1 + (at[n + 1] == '+' || at[n + 1] == '-');
  return isdigit((unsigned char)at[e]) ? e + strspn(at + e, "0123456789") : n;
}

/* Words after which gmsh notes its place in the file, or goes on from another one. It reads by lines, and comes back to
   the beginning of a line, whatever began on the line before. */
static const char *const Jumps[] = {"If",     "Else",  "ElseIf",   "EndIf", "For",
                                    "EndFor", "Macro", "Function", "Call",  "Return"};

/* Tells whether one of these words stands in n characters, with no letter beside it. */
static PetscBool HoldsJump(const char *at, size_t n)
{
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(Jumps); k++) {
      const size_t length = strlen(Jumps[k]);

      if (i + length > n || strncmp(at + i, Jumps[k], length)) continue;
      if ((!i || !isalpha((unsigned char)at[i - 1])) && (i + length == n || !isalpha((unsigned char)at[i + length])))
        return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

static PetscBool IsJump(const GeoToken *token)
{
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(Jumps); k++)
    if (GeoTokenIs(token, Jumps[k])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Returns the length of the blanks and comments that begin here. */
static size_t SkipLength(const char *at)
{
  const char *end;

  if (at[0] != '/' || (at[1] != '/' && at[1] != '*')) return strspn(at, " \t\r\n\f");
  if (at[1] == '/') return strcspn(at, "\n");
  end = strstr(at + 2, "*/");
  return end ? (size_t)(end + 2 - at) : strlen(at);
}

/* Tells whether the last token is a word that ends right before this place. */
static PetscBool IsJoined(const GeoTokens *tokens, const char *at)
{
  const GeoToken *last = tokens->n ? &tokens->token[tokens->n - 1] : NULL;

  return last && last->kind == GEO_WORD && last->at + last->length == at ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds the token that begins here. Returns how many characters it takes. */
static PetscErrorCode AddNext(GeoTokens *tokens, const char *at, int line, size_t *n)
{
  const char quote[] = {at[0], '\0'};

  PetscFunctionBeginUser;
  *n = 1;
  if (*at == '"' || *at == '\'') {
    const size_t length = strcspn(at + 1, quote);

    if (!at[1 + length]) tokens->wrong = "a text has no end";
    if (length > TEXT_LENGTH)
      tokens->wrong = "a text has more than 1023 characters, after which gmsh reads commands";
    else if (memchr(at + 1, '\n', length) || memchr(at + 1, '\r', length) || HoldsJump(at + 1, length) ||
             IsJoined(tokens, at))
      tokens->wrong =
        "gmsh may read a part of a text as commands, for its line end, its If or For, or the word that it "
        "is joined to";
    PetscCall(AddToken(tokens, tokens->wrong ? GEO_END : GEO_TEXT, at + 1, length, line));
    *n = length + 2;
  } else if (BeginsWord(*at)) {
    while (BeginsWord(at[*n]) || isdigit((unsigned char)at[*n])) (*n)++;
    PetscCall(AddToken(tokens, GEO_WORD, at, *n, line));
  } else if (isdigit((unsigned char)*at) || (*at == '.' && isdigit((unsigned char)at[1]))) {
    *n = NumberLength(at);
    PetscCall(AddToken(tokens, GEO_NUMBER, at, *n, line));
  } else {
    PetscCall(AddToken(tokens, GEO_SIGN, at, 1, line));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CountLines(const char *at, size_t n)
{
  int lines = 0;

  for (size_t i = 0; i < n; i++) lines += at[i] == '\n';
  return lines;
}

/* A comment that is joined to a word, or that goes over several lines behind a jump, may be no comment to gmsh. */
static void CheckComment(GeoTokens *tokens, const char *at, size_t n, int line)
{
  PetscBool jump = PETSC_FALSE;

  if (IsJoined(tokens, at) && strchr("EI", *tokens->token[tokens->n - 1].at))
    tokens->wrong = "gmsh may not see the comment that is joined to a word";
  if (at[1] != '*' || !memchr(at, '\n', n)) return;
  for (int k = tokens->n - 1; k >= 0 && tokens->token[k].line == line; k--)
    if (IsJump(&tokens->token[k])) jump = PETSC_TRUE;
  if (jump) tokens->wrong = "gmsh may read lines of the comment as commands, for the word before it, such as For";
}

/*@
  GeoTokensCreate - splits a text in gmsh's language.

  Not collective

  Input Parameters:
+ text - text, which must live as long as the tokens; a zero follows it
- size - its length in bytes

  Output Parameter:
. tokens - its tokens, to be freed with GeoTokensDestroy(); tokens->wrong says why the list stops before the text's end
@*/
PetscErrorCode GeoTokensCreate(const char *text, size_t size, GeoTokens *tokens)
{
  const char *at   = text;
  int         line = 1;

  PetscFunctionBeginUser;
  *tokens = (GeoTokens){0};
  while (*at && !tokens->wrong) {
    size_t n = SkipLength(at);

    if (*at == '/' && n) CheckComment(tokens, at, n, line);
    if (tokens->wrong) {
      PetscCall(AddToken(tokens, GEO_END, at, 0, line));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    if (!n) PetscCall(AddNext(tokens, at, line, &n));
    if (tokens->wrong) PetscFunctionReturn(PETSC_SUCCESS);
    line += CountLines(at, n);
    at += n;
  }
  if (at < text + size) tokens->wrong = "there is a byte that is zero";
  PetscCall(AddToken(tokens, GEO_END, at, 0, line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GeoTokenIs - compares a token with a word or a sign.

  Not collective

  Input Parameters:
+ token - token
- word  - the word, or the sign as a text of one character

  Note:
  A text between quotation marks is never equal to a word.
@*/
PetscBool GeoTokenIs(const GeoToken *token, const char *word)
{
  const size_t n = strlen(word);

  if (token->kind != GEO_WORD && token->kind != GEO_SIGN) return PETSC_FALSE;
  return (size_t)token->length == n && !strncmp(token->at, word, n) ? PETSC_TRUE : PETSC_FALSE;
}

/*@
  GeoTokensDestroy - frees the tokens.

  Not collective

  Input Parameter:
. tokens - zero afterwards
@*/
PetscErrorCode GeoTokensDestroy(GeoTokens *tokens)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(tokens->token));
  *tokens = (GeoTokens){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
