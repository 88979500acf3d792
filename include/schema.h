/* The one table of every key that a scene file may hold, and what follows from it: validation, defaults, the scene reference, and which
   values are "not available yet".

   A Document is the scene file's tree after -set. SchemaCheck() validates it as a whole; from then on the accessors below read any value by
   its path ("contact.0.penalty.scale"), or the table's default where the document has none. To add a key: one line in the table of
   schema.c, one line in scene.c that reads it. Every refusal names file and line (or -set), key, what is wrong and what is allowed. */
#pragma once
#include <petscsys.h>
#include <stdio.h>

enum { PATH_LENGTH = 512 }; /* longest path in a message; the table's own paths have less than 80 characters */

typedef enum { NODE_SCALAR, NODE_LIST, NODE_MAP } NodeKind;

typedef struct _n_Node {
  NodeKind         kind;
  char            *text;  /* scalar */
  int              plain; /* scalar written without quotes: a number or a boolean may be meant */
  int              line;  /* of its key in the file, from 1 */
  const char      *set;   /* key of the -set it came from, or NULL */
  int              n;     /* list, map */
  struct _n_Node **child;
  char           **key; /* map */
} * Node;

typedef struct {
  MPI_Comm comm;
  char    *file;
  Node     root;
  int      n_set;
  char   **set_key;                /* keys of the -set options, for messages */
  int      dim;                    /* 3 for geometry solid, else 2; set by SchemaCheck() */
  char     where[2 * PATH_LENGTH]; /* last text of DocumentWhere() */
} Document;

void        PathJoin(char path[PATH_LENGTH], const char *parent, const char *key);
Node        NodeFind(Node, const char *path); /* NULL: the document has no such value */
int         NodeReal(Node, double *value);    /* 1 if it is a finite number written in full, else 0 */
const char *DocumentWhere(Document *, const char *path);
void        DocumentRefuse(Document *, const char *path, const char *, ...) __attribute__((noreturn, format(printf, 3, 4)));
void        DocumentRefuseNode(Document *, Node, const char *path, const char *, ...) __attribute__((noreturn, format(printf, 4, 5)));

void        SchemaCheck(Document *);
int         SchemaHas(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int         SchemaCount(Document *, const char *, ...) __attribute__((format(printf, 2, 3))); /* entries of a list or map, 0 if absent */
double      SchemaReal(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int         SchemaInteger(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int         SchemaBoolean(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));
int         SchemaChoice(Document *, const char *, ...) __attribute__((format(printf, 2, 3))); /* position among the table's values */
const char *SchemaText(Document *, const char *, ...) __attribute__((format(printf, 2, 3)));   /* NULL: absent and no default */
void        SchemaReference(FILE *);
