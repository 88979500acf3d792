/* The scene as a tree of YAML values: paths, nodes, refusals, reading, -set and the canonical text, see document.h. */
#include "document.h"
#include "base/refusal.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* The first buffer and the largest size of a scene file, in bytes. A scene is a text of a few kB. The bound prevents
   every rank from reading the whole of a wrong file, such as a mesh or a device. */
enum { SCENE_FIRST_BYTES = 64 << 10, SCENE_MAX_BYTES = 16 << 20 };
/* The largest depth of the tree, in levels. The schema is 6 levels deep. The bound prevents the recursions over the
   tree from exhausting the stack. */
enum { SCENE_MAX_DEPTH = 32 };

/* Paths */

/*@
  KeyPathComponent - returns the length of the first component of a path, up to the next dot or the end.

  Not collective

  Input Parameter:
. path - keys and indices with dots between them
@*/
size_t KeyPathComponent(const char *path)
{
  return strcspn(path, ".");
}

/*@
  KeyPathComponentIsIndex - tells whether the first component of a path is an index of a list.

  Not collective

  Input Parameter:
. path - keys and indices with dots between them

  Note:
  It returns 1 for an index, else 0. An index has at most 9 digits.
@*/
int KeyPathComponentIsIndex(const char *path)
{
  const size_t n = KeyPathComponent(path);

  return n > 0 && n < 10 && strspn(path, "0123456789") >= n;
}

/*@
  KeyPathJoin - writes the path "parent.key".

  Not collective

  Input Parameters:
+ parent - path of the map, or "" for the root, below which the path is the key alone
- key    - key in the map

  Output Parameter:
. path - the joined path [KEY_PATH_LENGTH]
@*/
void KeyPathJoin(char path[KEY_PATH_LENGTH], const char *parent, const char *key)
{
  snprintf(path, KEY_PATH_LENGTH, "%.*s%s%.*s", KEY_PATH_LENGTH / 2, parent, *parent ? "." : "",
           KEY_PATH_LENGTH / 2 - 2, key);
}

/*@
  KeyPathJoinIndex - writes the path "parent.index".

  Not collective

  Input Parameters:
+ parent - path of the list
- index  - index in the list, counted from 0

  Output Parameter:
. path - the joined path [KEY_PATH_LENGTH]
@*/
void KeyPathJoinIndex(char path[KEY_PATH_LENGTH], const char *parent, int index)
{
  char key[16];

  snprintf(key, sizeof key, "%d", index);
  KeyPathJoin(path, parent, key);
}

/* Nodes */

/*@
  NodeChild - returns the child of a list or a map that the first component of a path names.

  Not collective

  Input Parameters:
+ node - the list or map
- path - path that begins with a key of the map or an index of the list

  Note:
  It returns NULL if there is no such child.
@*/
Node NodeChild(Node node, const char *path)
{
  const size_t n = KeyPathComponent(path);

  if (node->kind == NODE_LIST && KeyPathComponentIsIndex(path) && atoi(path) < node->n) return node->child[atoi(path)];
  for (int i = 0; node->kind == NODE_MAP && i < node->n; i++) {
    if (strlen(node->key[i]) == n && !strncmp(node->key[i], path, n)) return node->child[i];
  }
  return NULL;
}

/*@
  NodeFind - returns the value at a path below a node.

  Not collective

  Input Parameters:
+ node - where the path begins
- path - keys of maps and indices of lists, with dots between them

  Note:
  It returns NULL if there is no such value.
@*/
Node NodeFind(Node node, const char *path)
{
  while (node && *path) {
    node = NodeChild(node, path);
    path += KeyPathComponent(path);
    if (*path) path++;
  }
  return node;
}

/*@
  NodeReal - gives the value of a scalar that is a finite number in decimal notation.

  Not collective

  Input Parameter:
. node - the scalar

  Output Parameter:
. value - its value

  Note:
  It returns 1 if the whole text is such a number without quotes, else 0. Hexadecimal numbers, nan, inf and numbers that
  are too large for a double are refused in this way. The program must have the C locale.
@*/
int NodeReal(Node node, double *value)
{
  char *end;

  if (node->kind != NODE_SCALAR || !node->plain || !*node->text || node->text[strspn(node->text, "0123456789+-.eE")])
    return 0;
  *value = strtod(node->text, &end);
  return !*end && isfinite(*value);
}

/*@
  NodeInteger - gives the value of a scalar that is a whole number in decimal notation.

  Not collective

  Input Parameter:
. node - the scalar

  Output Parameter:
. value - its value

  Note:
  It returns 1 if the whole text is such a number without quotes, else 0.
@*/
int NodeInteger(Node node, long *value)
{
  char *end;

  if (node->kind != NODE_SCALAR || !node->plain || !*node->text || node->text[strspn(node->text, "0123456789+-")])
    return 0;
  errno  = 0;
  *value = strtol(node->text, &end, 10);
  return !*end && !errno;
}

/*@
  NodeBoolean - gives the value of a scalar that is true or false.

  Not collective

  Input Parameter:
. node - the scalar

  Output Parameter:
. value - 1 for true, 0 for false

  Note:
  It returns 1 if the text is one of these two words without quotes, else 0.
@*/
int NodeBoolean(Node node, int *value)
{
  *value = node->kind == NODE_SCALAR && node->plain && !strcmp(node->text, "true");
  return *value || (node->kind == NODE_SCALAR && node->plain && !strcmp(node->text, "false"));
}

/* Refusals */

/* Writes the place of a node for a message, see DocumentWhere(). */
static const char *DocumentWhereNode(Document *document, Node node, const char *path)
{
  if (!node->set)
    snprintf(document->where, sizeof document->where, "%.400s:%d%s%s", document->file, node->line, *path ? ": " : "",
             path);
  else if (!strcmp(node->set, path))
    snprintf(document->where, sizeof document->where, "-set %s", path);
  else
    snprintf(document->where, sizeof document->where, "-set %.400s: %s", node->set, path);
  return document->where;
}

/*@
  DocumentWhere - returns the place of a value for a message, as "FILE:LINE: PATH".

  Not collective

  Input Parameters:
+ document - the document
- path     - path of the value, which need not be in the document

  Note:
  The line is that of the value, or of its nearest ancestor that the document has. If that came from a -set, "-set KEY"
  replaces file and line. The text is valid until the next call.
@*/
const char *DocumentWhere(Document *document, const char *path)
{
  Node        node = document->root, next = node;
  const char *rest = path;

  while (*rest && (next = NodeChild(node, rest))) {
    node = next;
    rest += KeyPathComponent(rest);
    if (*rest) rest++;
  }
  return DocumentWhereNode(document, node, path);
}

/* Refuses the value at a place with a formatted message. */
static PetscErrorCode DocumentRefuseList(Document *document, const char *where, const char *format, va_list arguments)
{
  char text[1024];

  PetscFunctionBeginUser;
  vsnprintf(text, sizeof text, format, arguments);
  PetscCall(RefuseInput(document->comm, "%s: %s", where, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DocumentRefuse - refuses the value at a path.

  Collective

  Input Parameters:
+ document - the document
. path     - path of the value, which need not be in the document
. format   - format of the message, as for printf()
- ...      - arguments of the format

  Note:
  It returns REFUSED, see RefuseInput().
@*/
PetscErrorCode DocumentRefuse(Document *document, const char *path, const char *format, ...)
{
  va_list        arguments;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  va_start(arguments, format);
  code = DocumentRefuseList(document, DocumentWhere(document, path), format, arguments);
  va_end(arguments);
  PetscFunctionReturn(code);
}

/*@
  DocumentRefuseNode - refuses a node, which need not be in the tree yet.

  Collective

  Input Parameters:
+ document - the document
. node     - the node, whose line or -set the message names
. path     - path of the node
. format   - format of the message, as for printf()
- ...      - arguments of the format

  Note:
  It returns REFUSED, see RefuseInput().
@*/
PetscErrorCode DocumentRefuseNode(Document *document, Node node, const char *path, const char *format, ...)
{
  va_list        arguments;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  va_start(arguments, format);
  code = DocumentRefuseList(document, DocumentWhereNode(document, node, path), format, arguments);
  va_end(arguments);
  PetscFunctionReturn(code);
}

/* From the text to the tree */

/* The reader of one libyaml document */
typedef struct {
  Document        *document;
  const char      *set; /* key of the -set whose value is read, or NULL */
  yaml_document_t *yaml;
  PetscBool       *visited; /* whether a libyaml node has been read; a node that is read twice is a YAML alias */
} TreeReader;

static PetscErrorCode NodeDestroy(Node *node)
{
  PetscFunctionBeginUser;
  if (!*node) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < (*node)->n; i++) {
    PetscCall(NodeDestroy(&(*node)->child[i]));
    if ((*node)->kind == NODE_MAP) PetscCall(PetscFree((*node)->key[i]));
  }
  PetscCall(PetscFree((*node)->child));
  PetscCall(PetscFree((*node)->key));
  PetscCall(PetscFree((*node)->text));
  PetscCall(PetscFree(*node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NodeCreate(NodeKind kind, int line, const char *set, Node *node)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(node));
  (*node)->kind = kind;
  (*node)->line = line;
  (*node)->set  = set;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a child, which may be NULL, to a list or a map. The key is copied. It is NULL for a list. */
static PetscErrorCode NodeAppend(Node node, const char *key, Node child)
{
  Node  *children;
  char **keys;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(node->n + 1, &children));
  PetscCall(PetscArraycpy(children, node->child, node->n));
  PetscCall(PetscFree(node->child));
  node->child          = children;
  node->child[node->n] = child;
  if (key) {
    PetscCall(PetscCalloc1(node->n + 1, &keys));
    PetscCall(PetscArraycpy(keys, node->key, node->n));
    PetscCall(PetscFree(node->key));
    node->key = keys;
    PetscCall(PetscStrallocpy(key, &node->key[node->n]));
  }
  node->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TreeRead(TreeReader *, int id, int line, const char *path, int depth, Node *);

/* Reads a map. Each child is added to the map before it is read, so that a refusal leaves no node outside the tree. */
static PetscErrorCode TreeReadMap(TreeReader *reader, const yaml_node_t *yaml, const char *path, int depth, Node map)
{
  char below[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  for (yaml_node_pair_t *pair = yaml->data.mapping.pairs.start; pair < yaml->data.mapping.pairs.top; pair++) {
    const yaml_node_t *key   = yaml_document_get_node(reader->yaml, pair->key);
    const int          line  = (int)key->start_mark.line + 1;
    const char        *text  = (const char *)key->data.scalar.value;
    struct _n_Node     again = {.line = line, .set = reader->set};

    if (key->type != YAML_SCALAR_NODE)
      PetscCall(
        DocumentRefuseNode(reader->document, map, path, "a key is a list or a map (line %d); allowed: names", line));
    KeyPathJoin(below, path, text);
    for (int i = 0; i < map->n; i++) {
      if (!strcmp(map->key[i], text))
        PetscCall(DocumentRefuseNode(reader->document, &again, below, "duplicate key, first in line %d; allowed: once",
                                     map->child[i]->line));
    }
    PetscCall(NodeAppend(map, text, NULL));
    PetscCall(TreeRead(reader, pair->value, line, below, depth + 1, &map->child[map->n - 1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a list in the same way. */
static PetscErrorCode TreeReadList(TreeReader *reader, const yaml_node_t *yaml, const char *path, int depth, Node list)
{
  char below[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  for (yaml_node_item_t *item = yaml->data.sequence.items.start; item < yaml->data.sequence.items.top; item++) {
    KeyPathJoinIndex(below, path, list->n);
    PetscCall(NodeAppend(list, NULL, NULL));
    PetscCall(TreeRead(reader, *item, 0, below, depth + 1, &list->child[list->n - 1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads one libyaml node and all nodes below it. For the value of a map, `line` is the line of its key. If it is 0, the
   line on which the value itself starts is taken. */
static PetscErrorCode TreeRead(TreeReader *reader, int id, int line, const char *path, int depth, Node *node)
{
  static const char *const Tags[] = {YAML_DEFAULT_SCALAR_TAG, YAML_DEFAULT_SEQUENCE_TAG, YAML_DEFAULT_MAPPING_TAG};
  const yaml_node_t       *yaml   = yaml_document_get_node(reader->yaml, id);
  const NodeKind           kind   = yaml->type == YAML_SCALAR_NODE     ? NODE_SCALAR
                                    : yaml->type == YAML_SEQUENCE_NODE ? NODE_LIST
                                                                       : NODE_MAP;

  PetscFunctionBeginUser;
  PetscCall(NodeCreate(kind, line ? line : (int)yaml->start_mark.line + 1, reader->set, node));
  if (depth > SCENE_MAX_DEPTH)
    PetscCall(
      DocumentRefuseNode(reader->document, *node, path, "is nested too deeply; allowed: %d levels", SCENE_MAX_DEPTH));
  if (reader->visited[id])
    PetscCall(DocumentRefuseNode(reader->document, *node, path, "is a YAML alias; allowed: the value written out"));
  reader->visited[id] = PETSC_TRUE;
  if (strcmp((const char *)yaml->tag, Tags[kind]))
    PetscCall(DocumentRefuseNode(reader->document, *node, path, "has a YAML tag; allowed: plain values"));
  if (kind == NODE_SCALAR) {
    (*node)->plain = yaml->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    PetscCall(PetscStrallocpy((const char *)yaml->data.scalar.value, &(*node)->text));
    if (strlen((*node)->text) != yaml->data.scalar.length)
      PetscCall(DocumentRefuseNode(reader->document, *node, path, "has a zero character; allowed: text"));
  } else if (kind == NODE_MAP)
    PetscCall(TreeReadMap(reader, yaml, path, depth, *node));
  else
    PetscCall(TreeReadList(reader, yaml, path, depth, *node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether the first character that is no space is a tab, on a line that is counted from 0. */
static PetscBool LineStartsWithTab(const char *text, size_t length, size_t line)
{
  size_t i = 0;

  for (; i < length && line; i++) line -= text[i] == '\n';
  while (i < length && text[i] == ' ') i++;
  return i < length && text[i] == '\t' ? PETSC_TRUE : PETSC_FALSE;
}

/* Refuses malformed YAML with the message of libyaml. A tab has a message of its own, because it cannot be seen in an
   editor. */
static PetscErrorCode DocumentRefuseYaml(Document *document, const yaml_parser_t *parser, const char *text,
                                         size_t length, const char *set)
{
  const yaml_mark_t mark  = parser->problem_mark;
  struct _n_Node    place = {.line = (int)mark.line + 1, .set = set};

  PetscFunctionBeginUser;
  if (parser->error == YAML_READER_ERROR) {
    place.line = 1;
    for (size_t i = 0; i < parser->problem_offset && i < length; i++) place.line += text[i] == '\n';
  }
  if (parser->error != YAML_READER_ERROR && LineStartsWithTab(text, length, mark.line))
    PetscCall(DocumentRefuseNode(document, &place, set ? set : "", "a tab; allowed: spaces"));
  PetscCall(DocumentRefuseNode(document, &place, set ? set : "", "malformed YAML: %s%s%s; allowed: one YAML document",
                               parser->problem, parser->context ? " " : "", parser->context ? parser->context : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the tree of a libyaml document. The caller still owns the libyaml document. */
static PetscErrorCode DocumentReadTree(Document *document, yaml_document_t *yaml, const char *path, const char *set,
                                       Node *root)
{
  struct _n_Node place  = {.line = 1, .set = set};
  TreeReader     reader = {document, set, yaml, NULL};
  PetscErrorCode code;

  PetscFunctionBeginUser;
  if (!yaml_document_get_root_node(yaml))
    PetscCall(
      DocumentRefuseNode(document, &place, path, "has no value; allowed: %s", set ? "a YAML value" : "a scene"));
  PetscCall(PetscCalloc1((yaml->nodes.top - yaml->nodes.start) + 1, &reader.visited));
  code = TreeRead(&reader, 1, 0, path, 0, root);
  PetscCall(PetscFree(reader.visited));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a second YAML document in the text. */
static PetscErrorCode DocumentCheckSingle(Document *document, yaml_document_t *second, const char *path,
                                          const char *set)
{
  struct _n_Node place = {.line = (int)second->start_mark.line + 1, .set = set};

  PetscFunctionBeginUser;
  if (yaml_document_get_root_node(second))
    PetscCall(DocumentRefuseNode(document, &place, path, "a second YAML document; allowed: one"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the tree of a text, which is one YAML document. `path` is the place of the tree in the scene. `set` is the key
   of the -set that the text came from, or NULL. After a refusal *root holds the nodes that were read until then, and
   the memory of libyaml is free. */
static PetscErrorCode DocumentParse(Document *document, const char *text, size_t length, const char *path,
                                    const char *set, Node *root)
{
  yaml_parser_t   parser;
  yaml_document_t yaml;
  PetscErrorCode  code = PETSC_SUCCESS;

  PetscFunctionBeginUser;
  PetscCheck(yaml_parser_initialize(&parser), PETSC_COMM_SELF, PETSC_ERR_MEM, "libyaml has no memory for a parser");
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
  for (int k = 0; !code && k < 2; k++) {
    if (!yaml_parser_load(&parser, &yaml)) {
      code = DocumentRefuseYaml(document, &parser, text, length, set);
      break;
    }
    code = k ? DocumentCheckSingle(document, &yaml, path, set) : DocumentReadTree(document, &yaml, path, set, root);
    yaml_document_delete(&yaml);
  }
  yaml_parser_delete(&parser);
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DocumentReadFile - reads a file on rank 0 and gives its text to all ranks.

  Collective

  Input Parameters:
+ comm - communicator of all ranks
. name - path with which rank 0 can open the file
- what - what the file should be, for messages: "a scene file"

  Output Parameters:
+ text   - the text, which ends with a zero; the caller frees it with PetscFree(), also after a refusal
- length - its length without that zero

  Note:
  Every rank parses and refuses the same text.
@*/
PetscErrorCode DocumentReadFile(MPI_Comm comm, const char *name, const char *what, char **text, size_t *length)
{
  PetscMPIInt rank;
  int         size[2] = {0, 0}; /* number of bytes, errno */
  FILE       *file;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(SCENE_FIRST_BYTES, text));
  if (!rank) {
    errno = 0;
    file  = fopen(name, "rb");
    if (file) {
      for (int room = SCENE_FIRST_BYTES; size[0] < room && !feof(file) && !ferror(file);) {
        size[0] += (int)fread(*text + size[0], 1, (size_t)(room - size[0]), file);
        if (size[0] < room || room > SCENE_MAX_BYTES) continue;
        room *= 2;
        PetscCall(PetscRealloc((size_t)room, text));
      }
      size[1] = ferror(file) ? errno : 0;
      fclose(file);
    } else
      size[1] = errno ? errno : EIO;
  }
  PetscCallMPI(MPI_Bcast(size, 2, MPI_INT, 0, comm));
  if (size[1]) PetscCall(RefuseInput(comm, "%s: cannot be read (%s); allowed: %s", name, strerror(size[1]), what));
  if (size[0] > SCENE_MAX_BYTES)
    PetscCall(RefuseInput(comm, "%s: is too large; allowed: %s of %d bytes at most", name, what, SCENE_MAX_BYTES));
  if (rank) {
    PetscCall(PetscFree(*text));
    PetscCall(PetscMalloc1(size[0] + 1, text));
  }
  PetscCallMPI(MPI_Bcast(*text, size[0], MPI_CHAR, 0, comm));
  (*text)[size[0]] = 0;
  *length          = (size_t)size[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edits of -set */

/* Gives the slot of a child. A new empty slot is added if the map lacks the key or if the index is the list's length.
 */
static PetscErrorCode NodeSlot(Document *document, Node place, Node node, const char *key, Node **slot)
{
  Node  child = NodeFind(node, key);
  char *end;
  long  index;

  PetscFunctionBeginUser;
  if (node->kind == NODE_SCALAR)
    PetscCall(DocumentRefuseNode(document, place, place->set,
                                 "'%s' is below a single value; allowed: keys of a map, indices of a list", key));
  if (node->kind == NODE_LIST) {
    index = strtol(key, &end, 10);
    if (*end || strspn(key, "0123456789") != strlen(key) || index > node->n)
      PetscCall(DocumentRefuseNode(document, place, place->set, "'%s' is no index of this list; allowed: 0 to %d", key,
                                   node->n));
  }
  if (!child) {
    PetscCall(NodeAppend(node, node->kind == NODE_MAP ? key : NULL, NULL));
    *slot = &node->child[node->n - 1];
  } else {
    for (int i = 0; i < node->n; i++) {
      if (node->child[i] == child) *slot = &node->child[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts *value at the path of a -set and creates the missing maps and lists above it. *value is NULL as soon as the tree
   owns it. */
static PetscErrorCode DocumentPut(Document *document, const char *set, Node *value)
{
  struct _n_Node place = {.set = set};
  Node           node = document->root, *slot = NULL;
  char           key[KEY_PATH_LENGTH];
  const char    *rest = set;

  PetscFunctionBeginUser;
  if (node->kind != NODE_MAP) PetscCall(DocumentRefuse(document, "", "a scene is a map; allowed: KEY: VALUE lines"));
  while (rest) {
    const size_t n = strcspn(rest, ".");

    if (!n || n >= sizeof key)
      PetscCall(
        DocumentRefuseNode(document, &place, set,
                           "is no path; allowed: keys and indices with dots between them, such as contact.0.slave"));
    snprintf(key, sizeof key, "%.*s", (int)n, rest);
    rest = rest[n] ? rest + n + 1 : NULL;
    PetscCall(NodeSlot(document, &place, node, key, &slot));
    if (rest && !*slot)
      PetscCall(
        NodeCreate(rest[strspn(rest, "0123456789")] == '.' || !rest[strspn(rest, "0123456789")] ? NODE_LIST : NODE_MAP,
                   0, set, slot));
    node = *slot;
  }
  PetscCall(NodeDestroy(slot));
  *slot  = *value;
  *value = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Applies one -set, which replaces or adds the value at a path. */
static PetscErrorCode DocumentSet(Document *document, const char *set, const char *text)
{
  Node           value = NULL;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  code = DocumentParse(document, text, strlen(text), set, set, &value);
  if (!code) code = DocumentPut(document, set, &value);
  PetscCall(NodeDestroy(&value));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Canonical text */

/* An entry of a map, to be sorted by its key */
typedef struct {
  char *key;
  Node  value;
} NodeEntry;

static int NodeEntryCompare(const void *a, const void *b)
{
  return strcmp(((const NodeEntry *)a)->key, ((const NodeEntry *)b)->key);
}

/* Adds a copy of the tree to a libyaml document, with the keys in alphabetical order. *id is the number of its root in
   that document. */
static PetscErrorCode NodeToYaml(Node node, yaml_document_t *yaml, int *id)
{
  NodeEntry *entries;
  int        key, value;

  PetscFunctionBeginUser;
  if (node->kind == NODE_SCALAR) {
    *id = yaml_document_add_scalar(yaml, NULL, (yaml_char_t *)node->text, -1,
                                   node->plain ? YAML_PLAIN_SCALAR_STYLE : YAML_DOUBLE_QUOTED_SCALAR_STYLE);
  } else if (node->kind == NODE_LIST) {
    *id = yaml_document_add_sequence(
      yaml, NULL, node->n && node->child[0]->kind == NODE_MAP ? YAML_BLOCK_SEQUENCE_STYLE : YAML_FLOW_SEQUENCE_STYLE);
    for (int i = 0; i < node->n; i++) {
      PetscCall(NodeToYaml(node->child[i], yaml, &value));
      yaml_document_append_sequence_item(yaml, *id, value);
    }
  } else {
    *id = yaml_document_add_mapping(yaml, NULL, YAML_BLOCK_MAPPING_STYLE);
    PetscCall(PetscCalloc1(node->n + 1, &entries));
    for (int i = 0; i < node->n; i++) entries[i] = (NodeEntry){node->key[i], node->child[i]};
    qsort(entries, (size_t)node->n, sizeof *entries, NodeEntryCompare);
    for (int i = 0; i < node->n; i++) {
      key = yaml_document_add_scalar(yaml, NULL, (yaml_char_t *)entries[i].key, -1, YAML_PLAIN_SCALAR_STYLE);
      PetscCall(NodeToYaml(entries[i].value, yaml, &value));
      yaml_document_append_mapping_pair(yaml, *id, key, value);
    }
    PetscCall(PetscFree(entries));
  }
  PetscCheck(*id, PETSC_COMM_SELF, PETSC_ERR_MEM, "libyaml has no memory for a node");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DocumentText - writes the document as one canonical YAML text.

  Not collective

  Input Parameter:
. document - the document

  Output Parameter:
. text - the text, to be freed with PetscFree()

  Note:
  The text depends on the keys and values only. It does not depend on comments, layout, order of keys, file or -set.
@*/
PetscErrorCode DocumentText(Document *document, char **text)
{
  yaml_document_t yaml;
  yaml_emitter_t  emitter;
  char           *buffer = NULL;
  size_t          size   = 0;
  FILE           *stream = open_memstream(&buffer, &size);
  int             root;

  PetscFunctionBeginUser;
  PetscCheck(stream && yaml_emitter_initialize(&emitter) && yaml_document_initialize(&yaml, NULL, NULL, NULL, 1, 1),
             PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for the scene's text");
  PetscCall(NodeToYaml(document->root, &yaml, &root));
  yaml_emitter_set_output_file(&emitter, stream);
  yaml_emitter_set_unicode(&emitter, 1);
  yaml_emitter_set_width(&emitter, -1);
  PetscCheck(yaml_emitter_dump(&emitter, &yaml), PETSC_COMM_SELF, PETSC_ERR_LIB, "libyaml: %s", emitter.problem);
  yaml_emitter_flush(&emitter);
  yaml_emitter_delete(&emitter);
  fclose(stream);
  PetscCall(PetscStrallocpy(buffer, text));
  free(buffer);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives a node and all nodes below it the place of another one, for messages. */
static void NodeTakePlace(Node node, const struct _n_Node *place)
{
  node->line = place->line;
  node->set  = place->set;
  for (int i = 0; i < node->n; i++) NodeTakePlace(node->child[i], place);
}

/*@
  DocumentReplace - replaces a value by another one, which keeps its place in messages.

  Collective

  Input Parameters:
+ document - the document
. node     - the value, a node of the tree
. path     - its path
- text     - the new value as YAML
@*/
PetscErrorCode DocumentReplace(Document *document, Node node, const char *path, const char *text)
{
  struct _n_Node place = *node, before;
  Node           value = NULL;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  code = DocumentParse(document, text, strlen(text), path, place.set, &value);
  if (!code) {
    NodeTakePlace(value, &place);
    before = *node;
    *node  = *value;
    *value = before;
  }
  PetscCall(NodeDestroy(&value));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whole documents */

/* Applies the edits in order and keeps their keys for messages. */
static PetscErrorCode DocumentEdit(Document *document, int n_set, char *const *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_set, &document->set_key));
  for (int i = 0; i < n_set; i++) {
    const char *equals = strchr(set[i], '=');
    char       *key;

    if (!equals) PetscCall(RefuseInput(document->comm, "-set %s: has no value; allowed: KEY=VALUE", set[i]));
    PetscCall(PetscStrallocpy(set[i], &key));
    key[equals - set[i]]                 = 0;
    document->set_key[document->n_set++] = key;
    PetscCall(DocumentSet(document, key, equals + 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DocumentCreate(MPI_Comm comm, const char *file, Document **document)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(document));
  (*document)->comm = comm;
  PetscCall(PetscStrallocpy(file, &(*document)->file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DocumentReadText - reads a document from a text in memory and applies edits to it.

  Collective

  Input Parameters:
+ comm  - communicator of all ranks
. name  - name that replaces the file name in messages
. text  - the document as a YAML text, the same on all ranks
. n_set - number of edits
- set   - edits KEY=VALUE, in order

  Output Parameter:
. document - the document, to be freed with DocumentDestroy()

  Note:
  It refuses a text that is no plain YAML. After a refusal there is no document, and all memory is free.
@*/
PetscErrorCode DocumentReadText(MPI_Comm comm, const char *name, const char *text, int n_set, char *const *set,
                                Document **document)
{
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(DocumentCreate(comm, name, document));
  code = DocumentParse(*document, text, strlen(text), "", NULL, &(*document)->root);
  if (!code) code = DocumentEdit(*document, n_set, set);
  if (code) PetscCall(DocumentDestroy(*document));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DocumentRead - reads a document from a file and applies edits to it.

  Collective

  Input Parameters:
+ comm  - communicator of all ranks
. file  - path with which rank 0 can open the file
. n_set - number of edits
- set   - edits KEY=VALUE, in order

  Output Parameter:
. document - the document, to be freed with DocumentDestroy()

  Note:
  It refuses a file that cannot be read or is no plain YAML. After a refusal there is no document, and all memory is
  free.
@*/
PetscErrorCode DocumentRead(MPI_Comm comm, const char *file, int n_set, char *const *set, Document **document)
{
  PetscErrorCode code;
  char          *text = NULL;
  size_t         length;

  PetscFunctionBeginUser;
  PetscCall(DocumentCreate(comm, file, document));
  code = DocumentReadFile(comm, file, "a scene file", &text, &length);
  if (!code) code = DocumentParse(*document, text, length, "", NULL, &(*document)->root);
  PetscCall(PetscFree(text));
  if (!code) code = DocumentEdit(*document, n_set, set);
  if (code) PetscCall(DocumentDestroy(*document));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  DocumentDestroy - frees a document.

  Not collective

  Input Parameter:
. document - from DocumentRead() or DocumentReadText()
@*/
PetscErrorCode DocumentDestroy(Document *document)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < document->n_set; i++) PetscCall(PetscFree(document->set_key[i]));
  PetscCall(PetscFree(document->set_key));
  PetscCall(PetscFree(document->file));
  PetscCall(NodeDestroy(&document->root));
  PetscCall(PetscFree(document));
  PetscFunctionReturn(PETSC_SUCCESS);
}
