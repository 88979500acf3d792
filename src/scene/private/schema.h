/* The schema of a scene: validation against the table of keys, values with their defaults, and the scene reference.

   SchemaCheck() validates a whole document. Every refusal names the file and the line, or the -set, the key, the
   mistake and what is allowed. After SchemaCheck() the accessors SchemaHas() to SchemaText() read any value by its path
   ("contact.0.penalty.scale"). The path is given by a format and arguments, as for printf(). If the document has no
   value there, they return the default of the table. SchemaReference() prints the reference.

   A new key needs one line in the table of schemakeys.c and one line in scene.c, which reads it. */
#pragma once
#include "document.h"
#include <stdio.h>

PetscErrorCode SchemaCheck(Document *);
int            SchemaHas(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int            SchemaCount(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
double         SchemaReal(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int            SchemaInteger(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int            SchemaBoolean(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int            SchemaChoice(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
const char    *SchemaText(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
void           SchemaReference(FILE *);
