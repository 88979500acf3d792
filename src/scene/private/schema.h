/* What a scene may say: validation against the one table of keys, values with their defaults, the scene reference.

   SchemaCheck() validates a document as a whole; from then on the accessors below read any value by its path
   ("contact.0.penalty.scale", the path in printf's manner), or the table's default where the document has none. To add
   a key: one line in the table of schemakeys.c, one line in scene.c that reads it. Every refusal names file and line
   (or -set), key, what is wrong and what is allowed. */
#pragma once
#include "document.h"
#include <stdio.h>

PetscErrorCode SchemaCheck(Document *); /* also sets document->dim */
int            SchemaHas(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int            SchemaCount(Document *, const char *, ...)
  __attribute__((format(printf, 2, 3))); /* entries of a list or map, 0 if absent */
double SchemaReal(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int    SchemaInteger(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int    SchemaBoolean(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int    SchemaChoice(Document *, const char *, ...)
  __attribute__((format(printf, 2, 3))); /* position among the table's values */
const char *SchemaText(Document *, const char *, ...)
  __attribute__((format(printf, 2, 3))); /* NULL: absent and no default */
void SchemaReference(FILE *);
