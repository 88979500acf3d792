/* The scene as a YAML tree with its marks: every value knows the line or the -set it came from. Knows no key of a
   scene: that is schema.h.

   DocumentRead() reads the file on rank 0, parses it on every rank and applies the -set edits in order. A value is
   found by its path, keys of maps and indices of lists with dots between them ("contact.0.penalty.scale"). Every
   refusal names file and line (or -set) and path.

   DocumentRefuse() and DocumentRefuseNode() return REFUSED of refusal.h, and every reader above them hands it up by
   PetscCall(). A longjmp() out of the readers would be shorter, but it would skip libyaml's destructors and PETSc's
   function stack, and everything allocated on the way would need a list of its own to be freed. */
#pragma once
#include <petscsys.h>

enum {
  KEY_PATH_LENGTH = 512
}; /* longest path in a message; the schema's own paths have less than 80 characters */

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
} *Node;

typedef struct {
  MPI_Comm comm;
  char    *file;
  Node     root;
  int      n_set;
  char   **set_key;                         /* keys of the -set options, for messages */
  int      dim;                             /* 3 for geometry solid, else 2; set by SchemaCheck() */
  char     where[2 * KEY_PATH_LENGTH]; /* last text of DocumentWhere() */
} Document;

PetscErrorCode DocumentRead(MPI_Comm, const char *file, int n_set, char *const *set, Document **);
PetscErrorCode DocumentReadText(MPI_Comm, const char *name, const char *text, int n_set, char *const *set,
                                Document **); /* name: for messages */
PetscErrorCode DocumentDestroy(Document *);
PetscErrorCode DocumentText(Document *,
                            char **text); /* one canonical YAML text: the same for the same keys and values */
const char    *DocumentWhere(Document *, const char *path);
PetscErrorCode DocumentRefuse(Document *, const char *path, const char *, ...) __attribute__((format(printf, 3, 4)));
PetscErrorCode DocumentRefuseNode(Document *, Node, const char *path, const char *, ...)
  __attribute__((format(printf, 4, 5)));

Node NodeChild(Node, const char *path); /* the child that the path's first component names, or NULL */
Node NodeFind(Node, const char *path);  /* NULL: the document has no such value */
/* 1 if it is a finite number, a whole number, true or false, written in full and without quotes; else 0 */
int NodeReal(Node, double *value);
int NodeInteger(Node, long *value);
int NodeBoolean(Node, int *value);

void   KeyPathJoin(char path[KEY_PATH_LENGTH], const char *parent, const char *key);
void   KeyPathJoinIndex(char path[KEY_PATH_LENGTH], const char *parent, int index);
size_t KeyPathComponent(const char *path);        /* length of its first component */
int    KeyPathComponentIsIndex(const char *path); /* 1: that is an index of a list */
