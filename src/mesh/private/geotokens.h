/* Words, texts, numbers and signs of a file in gmsh's language, found as gmsh finds them.

   GeoTokensCreate() splits a text, GeoTokensDestroy() frees the list. GeoTokenIs() compares a token with a word or a
   sign. Comments are left out. A text that gmsh would end elsewhere than its quotation mark says (after 1023
   characters, or at a byte that is zero) stops the list: what gmsh makes of the rest cannot be told. */
#pragma once
#include "base/petsccompat.h"

typedef enum { GEO_END, GEO_WORD, GEO_TEXT, GEO_NUMBER, GEO_SIGN } GeoTokenKind;

typedef struct {
  GeoTokenKind kind;
  const char  *at; /* its first character in the file's text; of a GEO_TEXT the one behind the quotation mark */
  int          length, line;
} GeoToken;

typedef struct {
  int         n, room;
  GeoToken   *token; /* the last one, token[n-1], has the kind GEO_END */
  const char *wrong; /* what stopped the list at the last token, or NULL */
} GeoTokens;

PetscErrorCode GeoTokensCreate(const char *text, size_t size, GeoTokens *);
PetscBool      GeoTokenIs(const GeoToken *, const char *word);
PetscErrorCode GeoTokensDestroy(GeoTokens *);
