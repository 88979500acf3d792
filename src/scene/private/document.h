/* The scene as a tree of YAML values. Every value records the line or the -set that it came from. This part knows no
   key of a scene; schema.h does.

   DocumentRead() reads the file on rank 0, parses it on every rank and applies the -set edits in order.
   DocumentReadText() does the same with a text in memory. NodeFind() finds a value by its path, which consists of keys
   of maps and indices of lists with dots between them ("contact.0.penalty.scale"). NodeReal(), NodeInteger() and
   NodeBoolean() convert a value. DocumentText() writes the tree as one canonical YAML text.

   DocumentRefuse() and DocumentRefuseNode() refuse a value. Their message names the file and the line, or the -set, and
   the path. They return REFUSED of refusal.h, and every caller returns it to its own caller by PetscCall(). A longjmp()
   out of the readers would be shorter, but it would skip libyaml's destructors and PETSc's function stack. All memory
   that was allocated until then would also have to be kept in a list to be freed. */
#pragma once
#include <petscsys.h>

/* The size of a path in characters, and so the longest path in a message. The paths of the schema have less than 80
   characters. */
enum { KEY_PATH_LENGTH = 512 };

typedef enum { NODE_SCALAR, NODE_LIST, NODE_MAP } NodeKind;

typedef struct _n_Node {
  NodeKind         kind;
  char            *text;  /* of a scalar */
  int              plain; /* 1: a scalar without quotes, which may be a number or a boolean */
  int              line;  /* line of its key in the file, counted from 1 */
  const char      *set;   /* key of the -set that it came from, or NULL */
  int              n;     /* number of children of a list or a map */
  struct _n_Node **child;
  char           **key; /* keys of a map [n] */
} *Node;

typedef struct {
  MPI_Comm comm;
  char    *file;
  Node     root;
  int      n_set;
  char   **set_key;                    /* keys of the -set options, for messages */
  int      dim;                        /* 3 for geometry solid, else 2; SchemaCheck() sets it */
  char     where[2 * KEY_PATH_LENGTH]; /* the text that DocumentWhere() has returned last */
} Document;

PetscErrorCode DocumentRead(MPI_Comm, const char *file, int n_set, char *const *set, Document **);
PetscErrorCode DocumentReadText(MPI_Comm, const char *name, const char *text, int n_set, char *const *set, Document **);
PetscErrorCode DocumentReadFile(MPI_Comm, const char *name, const char *what, char **text, size_t *length);
PetscErrorCode DocumentReplace(Document *, Node, const char *path, const char *text);
PetscErrorCode DocumentDestroy(Document *);
PetscErrorCode DocumentText(Document *, char **text);
const char    *DocumentWhere(Document *, const char *path);
PetscErrorCode DocumentRefuse(Document *, const char *path, const char *, ...) __attribute__((format(printf, 3, 4)));
PetscErrorCode DocumentRefuseNode(Document *, Node, const char *path, const char *, ...)
  __attribute__((format(printf, 4, 5)));

Node NodeChild(Node, const char *path);
Node NodeFind(Node, const char *path);
int  NodeReal(Node, double *value);
int  NodeInteger(Node, long *value);
int  NodeBoolean(Node, int *value);

void   KeyPathJoin(char path[KEY_PATH_LENGTH], const char *parent, const char *key);
void   KeyPathJoinIndex(char path[KEY_PATH_LENGTH], const char *parent, int index);
size_t KeyPathComponent(const char *path);
int    KeyPathComponentIsIndex(const char *path);
