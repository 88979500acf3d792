#include "scene.h"
#include "schema.h"
#include "refusal.h"
#include <errno.h>
#include <string.h>
#include <yaml.h>

/* A scene is a few kB of text. The bound keeps a wrong file (a mesh, a device) from being read whole by every rank. */
enum { SCENE_MAX_BYTES = 16 << 20 };
/* The schema is 6 levels deep. The bound keeps the recursions over the tree from exhausting the stack. */
enum { SCENE_MAX_DEPTH = 32 };

/* ---- text to tree ---- */

typedef struct {
  Document        *document;
  const char      *set; /* key of the -set whose value is read, or NULL */
  yaml_document_t *yaml;
  PetscBool       *visited; /* per libyaml node: a second visit is an alias */
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

/* Adds a child; key is copied (NULL for a list). */
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

static PetscErrorCode TreeReadMap(TreeReader *reader, const yaml_node_t *yaml, const char *path, int depth, Node map)
{
  char below[PATH_LENGTH];
  Node child;

  PetscFunctionBeginUser;
  for (yaml_node_pair_t *pair = yaml->data.mapping.pairs.start; pair < yaml->data.mapping.pairs.top; pair++) {
    const yaml_node_t *key  = yaml_document_get_node(reader->yaml, pair->key);
    const int          line = (int)key->start_mark.line + 1;
    const char        *text = (const char *)key->data.scalar.value;

    if (key->type != YAML_SCALAR_NODE) DocumentRefuseNode(reader->document, map, path, "a key is a list or a map (line %d); allowed: names", line);
    PathJoin(below, path, text);
    for (int i = 0; i < map->n; i++) {
      if (strcmp(map->key[i], text)) continue;
      PetscCall(NodeCreate(NODE_SCALAR, line, reader->set, &child));
      DocumentRefuseNode(reader->document, child, below, "duplicate key, first in line %d; allowed: once", map->child[i]->line);
    }
    PetscCall(TreeRead(reader, pair->value, line, below, depth + 1, &child));
    PetscCall(NodeAppend(map, text, child));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* line: of the key of a map's value; 0: where the value itself starts */
static PetscErrorCode TreeRead(TreeReader *reader, int id, int line, const char *path, int depth, Node *node)
{
  static const char *const Tags[] = {YAML_DEFAULT_SCALAR_TAG, YAML_DEFAULT_SEQUENCE_TAG, YAML_DEFAULT_MAPPING_TAG};
  const yaml_node_t       *yaml   = yaml_document_get_node(reader->yaml, id);
  const NodeKind           kind   = yaml->type == YAML_SCALAR_NODE ? NODE_SCALAR : yaml->type == YAML_SEQUENCE_NODE ? NODE_LIST : NODE_MAP;
  char                     below[PATH_LENGTH], index[16];
  Node                     child;

  PetscFunctionBeginUser;
  PetscCall(NodeCreate(kind, line ? line : (int)yaml->start_mark.line + 1, reader->set, node));
  if (depth > SCENE_MAX_DEPTH) DocumentRefuseNode(reader->document, *node, path, "is nested too deeply; allowed: %d levels", SCENE_MAX_DEPTH);
  if (reader->visited[id]) DocumentRefuseNode(reader->document, *node, path, "is a YAML alias; allowed: the value written out");
  reader->visited[id] = PETSC_TRUE;
  if (strcmp((const char *)yaml->tag, Tags[kind])) DocumentRefuseNode(reader->document, *node, path, "has a YAML tag; allowed: plain values");
  if (kind == NODE_SCALAR) {
    (*node)->plain = yaml->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    PetscCall(PetscStrallocpy((const char *)yaml->data.scalar.value, &(*node)->text));
    if (strlen((*node)->text) != yaml->data.scalar.length) DocumentRefuseNode(reader->document, *node, path, "has a zero character; allowed: text");
  } else if (kind == NODE_MAP) {
    PetscCall(TreeReadMap(reader, yaml, path, depth, *node));
  } else {
    for (yaml_node_item_t *item = yaml->data.sequence.items.start; item < yaml->data.sequence.items.top; item++) {
      snprintf(index, sizeof index, "%d", (*node)->n);
      PathJoin(below, path, index);
      PetscCall(TreeRead(reader, *item, 0, below, depth + 1, &child));
      PetscCall(NodeAppend(*node, NULL, child));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the first character of a line (from 0) that is no space a tab? */
static PetscBool LineStartsWithTab(const char *text, size_t length, size_t line)
{
  size_t i = 0;

  for (; i < length && line; i++) line -= text[i] == '\n';
  while (i < length && text[i] == ' ') i++;
  return i < length && text[i] == '\t' ? PETSC_TRUE : PETSC_FALSE;
}

/* Ends with libyaml's own complaint. A tab is named, because it cannot be seen in an editor. */
static PetscErrorCode DocumentRefuseYaml(Document *document, const yaml_parser_t *parser, const char *text, size_t length, const char *set)
{
  const yaml_mark_t mark = parser->problem_mark;
  int               line = (int)mark.line + 1;
  Node              place;

  PetscFunctionBeginUser;
  if (parser->error == YAML_READER_ERROR) {
    line = 1;
    for (size_t i = 0; i < parser->problem_offset && i < length; i++) line += text[i] == '\n';
  }
  PetscCall(NodeCreate(NODE_SCALAR, line, set, &place));
  if (parser->error != YAML_READER_ERROR && LineStartsWithTab(text, length, mark.line))
    DocumentRefuseNode(document, place, set ? set : "", "a tab; allowed: spaces");
  DocumentRefuseNode(document, place, set ? set : "", "malformed YAML: %s%s%s; allowed: one YAML document", parser->problem, parser->context ? " " : "",
                     parser->context ? parser->context : "");
}

/* The tree of a text: one YAML document. path: where the tree belongs. set: the -set that it came from, or NULL. */
static PetscErrorCode DocumentParse(Document *document, const char *text, size_t length, const char *path, const char *set, Node *root)
{
  yaml_parser_t   parser;
  yaml_document_t yaml, second;
  TreeReader      reader = {document, set, &yaml, NULL};
  Node            place;
  PetscBool       more;

  PetscFunctionBeginUser;
  PetscCheck(yaml_parser_initialize(&parser), PETSC_COMM_SELF, PETSC_ERR_MEM, "libyaml has no memory for a parser");
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
  if (!yaml_parser_load(&parser, &yaml)) PetscCall(DocumentRefuseYaml(document, &parser, text, length, set));
  PetscCall(NodeCreate(NODE_SCALAR, 1, set, &place));
  if (!yaml_document_get_root_node(&yaml)) DocumentRefuseNode(document, place, path, "has no value; allowed: %s", set ? "a YAML value" : "a scene");
  PetscCall(PetscCalloc1((yaml.nodes.top - yaml.nodes.start) + 1, &reader.visited));
  PetscCall(TreeRead(&reader, 1, 0, path, 0, root));
  if (!yaml_parser_load(&parser, &second)) PetscCall(DocumentRefuseYaml(document, &parser, text, length, set));
  more        = yaml_document_get_root_node(&second) ? PETSC_TRUE : PETSC_FALSE;
  place->line = (int)second.start_mark.line + 1;
  if (more) DocumentRefuseNode(document, place, path, "a second YAML document; allowed: one");
  yaml_document_delete(&second);
  yaml_document_delete(&yaml);
  yaml_parser_delete(&parser);
  PetscCall(PetscFree(reader.visited));
  PetscCall(NodeDestroy(&place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 reads, all get the text: every rank then parses, and refuses, the same. */
static PetscErrorCode FileBroadcast(MPI_Comm comm, const char *name, char **text, size_t *length)
{
  PetscMPIInt rank;
  int         size[2] = {0, 0}; /* bytes, errno */
  FILE       *file;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(rank ? 1 : SCENE_MAX_BYTES + 1, text));
  if (!rank) {
    errno = 0;
    file  = fopen(name, "rb");
    if (file) {
      size[0] = (int)fread(*text, 1, SCENE_MAX_BYTES + 1, file);
      size[1] = ferror(file) ? errno : 0;
      fclose(file);
    } else
      size[1] = errno ? errno : EIO;
  }
  PetscCallMPI(MPI_Bcast(size, 2, MPI_INT, 0, comm));
  if (size[1]) PetscCall(RefuseInput(comm, "%s: cannot be read (%s); allowed: a scene file", name, strerror(size[1])));
  if (size[0] > SCENE_MAX_BYTES) PetscCall(RefuseInput(comm, "%s: is too large for a scene; allowed: %d bytes", name, SCENE_MAX_BYTES));
  if (rank) {
    PetscCall(PetscFree(*text));
    PetscCall(PetscMalloc1(size[0] + 1, text));
  }
  PetscCallMPI(MPI_Bcast(*text, size[0], MPI_CHAR, 0, comm));
  *length = (size_t)size[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- -set ---- */

/* The place of a child, made empty if the map lacks the key or if the index is the list's length. */
static PetscErrorCode NodeSlot(Document *document, Node place, Node node, const char *key, Node **slot)
{
  Node  child = NodeFind(node, key);
  char *end;
  long  index;

  PetscFunctionBeginUser;
  if (node->kind == NODE_SCALAR)
    DocumentRefuseNode(document, place, place->set, "'%s' is below a single value; allowed: keys of a map, indices of a list", key);
  if (node->kind == NODE_LIST) {
    index = strtol(key, &end, 10);
    if (*end || strspn(key, "0123456789") != strlen(key) || index > node->n)
      DocumentRefuseNode(document, place, place->set, "'%s' is no index of this list; allowed: 0 to %d", key, node->n);
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

/* One -set: replaces or adds the value at the path, with the maps and lists that lead to it. */
static PetscErrorCode DocumentSet(Document *document, const char *set, const char *text)
{
  struct _n_Node place = {.set = set};
  Node           node = document->root, value, *slot = NULL;
  char           key[PATH_LENGTH];
  const char    *rest = set;

  PetscFunctionBeginUser;
  PetscCall(DocumentParse(document, text, strlen(text), set, set, &value));
  if (node->kind != NODE_MAP) DocumentRefuse(document, "", "a scene is a map; allowed: KEY: VALUE lines");
  while (rest) {
    const size_t n = strcspn(rest, ".");

    if (!n || n >= sizeof key)
      DocumentRefuseNode(document, &place, set, "is no path; allowed: keys and indices with dots between them, such as contact.0.slave");
    snprintf(key, sizeof key, "%.*s", (int)n, rest);
    rest = rest[n] ? rest + n + 1 : NULL;
    PetscCall(NodeSlot(document, &place, node, key, &slot));
    if (rest && !*slot)
      PetscCall(NodeCreate(rest[strspn(rest, "0123456789")] == '.' || !rest[strspn(rest, "0123456789")] ? NODE_LIST : NODE_MAP, 0, set, slot));
    node = *slot;
  }
  PetscCall(NodeDestroy(slot));
  *slot = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- canonical text ---- */

typedef struct {
  char *key;
  Node  value;
} NodeEntry;

static int NodeEntryCompare(const void *a, const void *b)
{
  return strcmp(((const NodeEntry *)a)->key, ((const NodeEntry *)b)->key);
}

/* Adds a copy of the tree to a libyaml document, keys in alphabetical order; *id is its root there. */
static PetscErrorCode NodeToYaml(Node node, yaml_document_t *yaml, int *id)
{
  NodeEntry *entries;
  int        key, value;

  PetscFunctionBeginUser;
  if (node->kind == NODE_SCALAR) {
    *id = yaml_document_add_scalar(yaml, NULL, (yaml_char_t *)node->text, -1, node->plain ? YAML_PLAIN_SCALAR_STYLE : YAML_DOUBLE_QUOTED_SCALAR_STYLE);
  } else if (node->kind == NODE_LIST) {
    *id = yaml_document_add_sequence(yaml, NULL, node->n && node->child[0]->kind == NODE_MAP ? YAML_BLOCK_SEQUENCE_STYLE : YAML_FLOW_SEQUENCE_STYLE);
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

/* The document as one YAML text that depends on its keys and values alone: not on comments, layout, order of keys, file or -set. */
static PetscErrorCode DocumentText(Document *document, char **text)
{
  yaml_document_t yaml;
  yaml_emitter_t  emitter;
  char           *buffer = NULL;
  size_t          size   = 0;
  FILE           *stream = open_memstream(&buffer, &size);
  int             root;

  PetscFunctionBeginUser;
  PetscCheck(stream && yaml_emitter_initialize(&emitter) && yaml_document_initialize(&yaml, NULL, NULL, NULL, 1, 1), PETSC_COMM_SELF, PETSC_ERR_MEM,
             "No memory for the scene's text");
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

/* ---- tree to scene ---- */

static const char *const Displacements[] = {"ux", "uy", "uz"}, *const Rotations[] = {"rx", "ry", "rz"}, *const Axes[] = {"x", "y", "z"};

static Document *SceneDocument(Scene scene)
{
  return (Document *)scene->document;
}

static PetscErrorCode PathCreate(char **path, const char *list, int i)
{
  char text[PATH_LENGTH];

  PetscFunctionBeginUser;
  snprintf(text, sizeof text, "%s.%d", list, i);
  PetscCall(PetscStrallocpy(text, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static Node SceneNode(Scene scene, const char *path, const char *key)
{
  char text[PATH_LENGTH];

  PathJoin(text, path, key);
  return NodeFind(SceneDocument(scene)->root, text);
}

/* A list of numbers into v; absent: v stays as it is. Returns how many there are. */
static int SceneReals(Scene scene, const char *path, const char *key, double *v)
{
  Node list = SceneNode(scene, path, key);

  for (int i = 0; list && i < list->n; i++) (void)NodeReal(list->child[i], &v[i]);
  return list ? list->n : 0;
}

/* path's history, or the load parameter itself. */
static PetscErrorCode SceneReadHistory(Scene scene, const char *path, History *history)
{
  Node list = SceneNode(scene, path, "history");

  PetscFunctionBeginUser;
  history->n = list ? list->n : 2;
  PetscCall(PetscCalloc2(history->n, &history->t, history->n, &history->v));
  if (!list) history->t[1] = history->v[1] = 1;
  for (int i = 0; list && i < list->n; i++) {
    (void)NodeReal(list->child[i]->child[0], &history->t[i]);
    (void)NodeReal(list->child[i]->child[1], &history->v[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Text at path.key, NULL if there is none; the scene keeps its own copy. */
static PetscErrorCode SceneReadText(Scene scene, const char *path, const char *key, char **text)
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(SchemaText(SceneDocument(scene), "%s.%s", path, key), text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int SceneHas(Scene scene, const char *path, const char *key)
{
  return SceneNode(scene, path, key) != NULL;
}

static void SceneRefuse(Scene scene, const char *path, const char *key, const char *what, const char *about) __attribute__((noreturn));
static void SceneRefuse(Scene scene, const char *path, const char *key, const char *what, const char *about)
{
  char text[PATH_LENGTH];

  PathJoin(text, path, key);
  DocumentRefuse(SceneDocument(scene), *key ? text : path, "%s%s%s", about ? about : "", about ? " " : "", what);
}

static PetscErrorCode SceneReadPairs(Scene scene, const char *key, int *n, ScenePair **pairs)
{
  Node map = NodeFind(SceneDocument(scene)->root, key);

  PetscFunctionBeginUser;
  *n = map ? map->n : 0;
  PetscCall(PetscCalloc1(*n, pairs));
  for (int i = 0; i < *n; i++) {
    const Node value = map->child[i];

    PetscCall(PetscStrallocpy(map->key[i] + (map->key[i][0] == '-'), &(*pairs)[i].key));
    PetscCall(PetscStrallocpy(value->plain && (!strcmp(value->text, "null") || !strcmp(value->text, "~")) ? "" : value->text, &(*pairs)[i].value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadMesh(Scene scene)
{
  const char *file = SchemaText(SceneDocument(scene), "mesh.file"), *dot = strrchr(file, '.');
  const int   geo = dot && !strcmp(dot, ".geo");
  char        path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (!geo && (!dot || strcmp(dot, ".msh"))) SceneRefuse(scene, "mesh", "file", "is no mesh file; allowed: a .geo or a .msh file", file);
  if (snprintf(path, sizeof path, "%s%s%s", file[0] == '/' ? "" : scene->directory, file[0] == '/' ? "" : "/", file) >= (int)sizeof path)
    SceneRefuse(scene, "mesh", "file", "the path is too long", NULL);
  PetscCall(PetscStrallocpy(path, &scene->mesh_file));
  scene->order = SchemaHas(SceneDocument(scene), "mesh.order") ? SchemaInteger(SceneDocument(scene), "mesh.order") : geo;
  PetscCall(SceneReadPairs(scene, "mesh.parameters", &scene->n_parameters, &scene->parameters));
  for (int i = 0; i < scene->n_parameters; i++) {
    if (!scene->parameters[i].value[0]) SceneRefuse(scene, "mesh.parameters", scene->parameters[i].key, "has no value; allowed: a number or a text", NULL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadMotions(Scene scene, SceneBody *body)
{
  const int n = SchemaCount(SceneDocument(scene), "%s.rigid.motion", body->path);
  char      path[PATH_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(6 * n, &body->motions));
  for (int i = 0; i < n; i++) {
    const int before = body->n_motions;

    snprintf(path, sizeof path, "%s.rigid.motion.%d", body->path, i);
    for (int k = 0; k < 6; k++) {
      const char *key = k < 3 ? Displacements[k] : Rotations[k - 3];

      if (!SceneHas(scene, path, key)) continue;
      if (scene->geometry == GEOMETRY_AXISYMMETRIC && k != 1) SceneRefuse(scene, path, key, "would break the symmetry about the axis; allowed: uy", NULL);
      body->motions[body->n_motions].component = k;
      body->motions[body->n_motions].value     = SchemaReal(SceneDocument(scene), "%s.%s", path, key);
      PetscCall(SceneReadHistory(scene, path, &body->motions[body->n_motions++].history));
    }
    if (body->n_motions == before) SceneRefuse(scene, path, "", "moves nothing; allowed: at least one displacement (ux ...) or rotation (rz ...)", NULL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadBody(Scene scene, SceneBody *body)
{
  static const char Needs[] = "a body is volume with material, or surface with rigid";

  PetscFunctionBeginUser;
  body->rigid = SceneHas(scene, body->path, "surface");
  if (body->rigid == SceneHas(scene, body->path, "volume"))
    SceneRefuse(scene, body->path, "", body->rigid ? "has both a volume and a surface; allowed:" : "has neither a volume nor a surface; allowed:", NULL);
  if (!SceneHas(scene, body->path, body->rigid ? "rigid" : "material"))
    SceneRefuse(scene, body->path, body->rigid ? "rigid" : "material", Needs, "is missing; allowed:");
  if (SceneHas(scene, body->path, body->rigid ? "material" : "rigid"))
    SceneRefuse(scene, body->path, body->rigid ? "material" : "rigid", Needs, "has no place here; allowed:");
  PetscCall(SceneReadText(scene, body->path, body->rigid ? "surface" : "volume", &body->name));
  if (body->rigid) {
    (void)SceneReals(scene, body->path, "rigid.point", body->point);
    PetscCall(SceneReadMotions(scene, body));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  body->material.law = (MaterialLaw)SchemaChoice(SceneDocument(scene), "%s.material.law", body->path);
  body->material.E   = SchemaReal(SceneDocument(scene), "%s.material.E", body->path);
  body->material.nu  = SchemaReal(SceneDocument(scene), "%s.material.nu", body->path);
  if (body->material.law == MATERIAL_LINEAR && scene->kinematics == KINEMATICS_FINITE)
    SceneRefuse(scene, body->path, "material.law", "linear needs kinematics: small; allowed with finite: svk | neo_hookean", NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SceneBody *SceneFindBody(Scene scene, const char *name, int rigid)
{
  for (int i = 0; i < scene->n_bodies; i++) {
    if (scene->bodies[i].rigid == rigid && !strcmp(scene->bodies[i].name, name)) return &scene->bodies[i];
  }
  return NULL;
}

static PetscErrorCode SceneReadBodies(Scene scene)
{
  int deformable = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(SchemaCount(SceneDocument(scene), "bodies"), &scene->bodies));
  for (int i = 0; i < SchemaCount(SceneDocument(scene), "bodies"); i++) {
    SceneBody *body = &scene->bodies[i];

    PetscCall(PathCreate(&body->path, "bodies", i));
    PetscCall(SceneReadBody(scene, body));
    if (SceneFindBody(scene, body->name, body->rigid))
      SceneRefuse(scene, body->path, body->rigid ? "surface" : "volume", "is a body already; allowed: once", body->name);
    scene->n_bodies++;
    deformable += !body->rigid;
  }
  if (!deformable) SceneRefuse(scene, "bodies", "", "has only rigid tools; allowed: at least one volume with material", NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void SceneRefuseRigid(Scene scene, const char *path, const char *key, const char *surface)
{
  if (surface && SceneFindBody(scene, surface, 1))
    SceneRefuse(scene, path, key, "is a rigid tool, moved by its own motion; allowed: a surface of a deformable body", surface);
}

static PetscErrorCode SceneReadSupports(Scene scene)
{
  PetscFunctionBeginUser;
  scene->n_supports = SchemaCount(SceneDocument(scene), "supports");
  PetscCall(PetscCalloc1(scene->n_supports, &scene->supports));
  for (int i = 0; i < scene->n_supports; i++) {
    SceneSupport *support = &scene->supports[i];
    int           held    = 0;

    PetscCall(PathCreate(&support->path, "supports", i));
    PetscCall(SceneReadText(scene, support->path, "surface", &support->surface));
    SceneRefuseRigid(scene, support->path, "surface", support->surface);
    for (int k = 0; k < 3; k++) {
      if (!SceneHas(scene, support->path, Displacements[k])) continue;
      if (SchemaReal(SceneDocument(scene), "%s.%s", support->path, Displacements[k]) != 0)
        SceneRefuse(scene, support->path, Displacements[k], "a support holds at 0; allowed: 0 (an imposed displacement is a load, under loads:)", NULL);
      support->fixed[k] = 1;
      held++;
    }
    if (!held) SceneRefuse(scene, support->path, "", "holds nothing; allowed: at least one of ux: 0, uy: 0, uz: 0 (3D)", NULL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadLoad(Scene scene, SceneLoad *load)
{
  static const char *const Kinds[] = {"displacement", "pressure", "traction", "body_force"};
  int                      kinds   = 0;
  const char              *region;

  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) load->has[k] = SceneHas(scene, load->path, Displacements[k]);
  for (int kind = LOAD_DISPLACEMENT; kind <= LOAD_BODY_FORCE; kind++) {
    if (kind == LOAD_DISPLACEMENT ? !(load->has[0] || load->has[1] || load->has[2]) : !SceneHas(scene, load->path, Kinds[kind])) continue;
    load->kind = (LoadKind)kind;
    kinds++;
  }
  if (kinds != 1)
    SceneRefuse(scene, load->path, "", "allowed: exactly one of displacement (ux, uy, uz), pressure, traction, body_force",
                kinds ? "has more than one kind;" : "has no kind;");
  region = load->kind == LOAD_BODY_FORCE ? "volume" : "surface";
  if (!SceneHas(scene, load->path, region)) SceneRefuse(scene, load->path, region, Kinds[load->kind], "is missing; allowed: where it acts, for a");
  if (SceneHas(scene, load->path, "surface") && SceneHas(scene, load->path, "volume"))
    SceneRefuse(scene, load->path, load->kind == LOAD_BODY_FORCE ? "surface" : "volume", region, "has no place here; allowed: only");
  PetscCall(SceneReadText(scene, load->path, region, &load->region));
  if (load->kind == LOAD_BODY_FORCE && !SceneFindBody(scene, load->region, 0))
    SceneRefuse(scene, load->path, region, "is no deformable body; allowed: a volume under bodies:", load->region);
  if (load->kind != LOAD_BODY_FORCE) SceneRefuseRigid(scene, load->path, region, load->region);
  load->follower = SchemaBoolean(SceneDocument(scene), "%s.follower", load->path);
  if (load->follower && load->kind != LOAD_PRESSURE)
    SceneRefuse(scene, load->path, "follower", "only a pressure follows the face; allowed: with pressure", NULL);
  if (load->kind == LOAD_PRESSURE)
    load->value[0] = SchemaReal(SceneDocument(scene), "%s.pressure", load->path);
  else if (load->kind != LOAD_DISPLACEMENT)
    (void)SceneReals(scene, load->path, Kinds[load->kind], load->value);
  for (int k = 0; k < 3; k++) {
    if (load->has[k]) load->value[k] = SchemaReal(SceneDocument(scene), "%s.%s", load->path, Displacements[k]);
  }
  PetscCall(SceneReadHistory(scene, load->path, &load->history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadLoads(Scene scene)
{
  PetscFunctionBeginUser;
  scene->n_loads = SchemaCount(SceneDocument(scene), "loads");
  PetscCall(PetscCalloc1(scene->n_loads, &scene->loads));
  for (int i = 0; i < scene->n_loads; i++) {
    PetscCall(PathCreate(&scene->loads[i].path, "loads", i));
    PetscCall(SceneReadLoad(scene, &scene->loads[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadContact(Scene scene, SceneContact *contact)
{
  Node symmetry = SceneNode(scene, contact->path, "symmetry");

  PetscFunctionBeginUser;
  PetscCall(SceneReadText(scene, contact->path, "name", &contact->name));
  PetscCall(SceneReadText(scene, contact->path, "slave", &contact->slave));
  PetscCall(SceneReadText(scene, contact->path, "master", &contact->master));
  if (!contact->master) SceneRefuse(scene, contact->path, "master", "is empty; allowed: a surface, or one of plane, cylinder, sphere", NULL);
  SceneRefuseRigid(scene, contact->path, "slave", contact->slave);
  if (!strcmp(contact->slave, contact->master))
    SceneRefuse(scene, contact->path, "master", "is the slave too; allowed: another surface (self contact is not available yet)", contact->master);
  contact->smoother      = (SmootherKind)SchemaChoice(SceneDocument(scene), "%s.smoother", contact->path);
  contact->formulation   = (ContactFormulation)SchemaChoice(SceneDocument(scene), "%s.formulation", contact->path);
  contact->feature_angle = SchemaReal(SceneDocument(scene), "%s.feature_angle", contact->path);
  contact->penalty_auto  = SchemaChoice(SceneDocument(scene), "%s.penalty.initial", contact->path) == 0;
  contact->penalty       = contact->penalty_auto ? 0 : SchemaReal(SceneDocument(scene), "%s.penalty.initial", contact->path);
  contact->penalty_scale = SchemaReal(SceneDocument(scene), "%s.penalty.scale", contact->path);
  if (SceneHas(scene, contact->path, "penalty.g_min") && SceneHas(scene, contact->path, "penalty.g_max") &&
      SchemaReal(SceneDocument(scene), "%s.penalty.g_min", contact->path) >= SchemaReal(SceneDocument(scene), "%s.penalty.g_max", contact->path))
    SceneRefuse(scene, contact->path, "penalty.g_min", "is not below g_max; allowed: g_min < g_max", NULL);
  contact->n_symmetry = symmetry ? symmetry->n : 0;
  PetscCall(PetscCalloc1(contact->n_symmetry, &contact->symmetry));
  for (int i = 0; i < contact->n_symmetry; i++) PetscCall(PetscStrallocpy(symmetry->child[i]->text, &contact->symmetry[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadContacts(Scene scene)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(SchemaCount(SceneDocument(scene), "contact"), &scene->contacts));
  for (int i = 0; i < SchemaCount(SceneDocument(scene), "contact"); i++) {
    PetscCall(PathCreate(&scene->contacts[i].path, "contact", i));
    PetscCall(SceneReadContact(scene, &scene->contacts[i]));
    for (int j = 0; j < i; j++) {
      if (!strcmp(scene->contacts[i].name, scene->contacts[j].name))
        SceneRefuse(scene, scene->contacts[i].path, "name", "names another pair already; allowed: names used once", scene->contacts[i].name);
    }
    scene->n_contacts++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadStepping(Scene scene)
{
  Document *document = SceneDocument(scene);

  PetscFunctionBeginUser;
  if (SchemaHas(document, "stepping.N_c") && SchemaHas(document, "stepping.N_c_fraction"))
    SceneRefuse(scene, "stepping", "N_c_fraction", "stands beside N_c; allowed: one of them", NULL);
  scene->stepping.control = (StepControlKind)SchemaChoice(document, "stepping.control");
  scene->stepping.initial = SchemaReal(document, "stepping.initial");
  scene->stepping.dt_min  = SchemaReal(document, "stepping.dt_min");
  scene->stepping.dt_max  = SchemaReal(document, "stepping.dt_max");
  scene->stepping.growth  = SchemaReal(document, "stepping.growth");
  if (scene->stepping.dt_min > scene->stepping.dt_max) SceneRefuse(scene, "stepping", "dt_min", "is above dt_max; allowed: dt_min <= initial <= dt_max", NULL);
  if (SchemaHas(document, "stepping.initial") && (scene->stepping.initial < scene->stepping.dt_min || scene->stepping.initial > scene->stepping.dt_max))
    SceneRefuse(scene, "stepping", "initial", "is not between dt_min and dt_max; allowed: dt_min <= initial <= dt_max", NULL);
  scene->stepping.initial = PetscMin(PetscMax(scene->stepping.initial, scene->stepping.dt_min), scene->stepping.dt_max);
  scene->stepping.n_at    = SchemaCount(document, "stepping.at");
  PetscCall(PetscCalloc1(scene->stepping.n_at, &scene->stepping.at));
  (void)SceneReals(scene, "stepping", "at", scene->stepping.at);
  scene->solver.tolerance      = SchemaReal(document, "solver.tolerance");
  scene->solver.max_iterations = SchemaInteger(document, "solver.max_iterations");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- probes ---- */

/* What a probe of each kind needs and may have beside name, absolute and factor; in the order of ProbeKind. */
static const struct {
  const char *kind, *needs, *takes;
} ProbeForms[PROBE_KINDS] = {
  [PROBE_REACTION]           = {"reaction",           "component", ""                      },
  [PROBE_CONTACT_FORCE]      = {"contact_force",      "component", ""                      },
  [PROBE_DISPLACEMENT]       = {"displacement",       "component", "body"                  },
  [PROBE_DISTANCE]           = {"distance",           "",          "body change"           },
  [PROBE_GAP]                = {"gap",                "at",        ""                      },
  [PROBE_CONTACT_EDGE]       = {"contact_edge",       "axis side", "at"                    },
  [PROBE_PRESSURE_MAX]       = {"pressure_max",       "",          "at"                    },
  [PROBE_PRESSURE_MEAN]      = {"pressure_mean",      "",          ""                      },
  [PROBE_PRESSURE_DEVIATION] = {"pressure_deviation", "",          "measure excluding only"},
};
static const char ProbeCommon[] = "name absolute factor";

static int HasWord(const char *words, const char *word)
{
  const size_t n = strlen(word);

  for (const char *w = words; *w; w += strcspn(w, " "), w += *w == ' ') {
    if (strcspn(w, " ") == n && !strncmp(w, word, n)) return 1;
  }
  return 0;
}

/* Exactly one kind, what it needs, and nothing that it does not take. */
static void SceneProbeKind(Scene scene, SceneProbe *probe)
{
  static const char *const Optional[] = {"component", "body", "change", "at", "axis", "side", "measure", "excluding", "only"};
  Node                     node       = NodeFind(SceneDocument(scene)->root, probe->path);
  int                      kinds      = 0;
  char                     allowed[200];

  for (int k = 0; k < PROBE_KINDS; k++) {
    if (!SceneHas(scene, probe->path, ProbeForms[k].kind)) continue;
    probe->kind = (ProbeKind)k;
    kinds++;
  }
  if (kinds != 1) {
    allowed[0] = 0;
    for (int k = 0; k < PROBE_KINDS; k++) snprintf(allowed + strlen(allowed), sizeof allowed - strlen(allowed), "%s%s", k ? ", " : "", ProbeForms[k].kind);
    SceneRefuse(scene, probe->path, "", allowed, kinds ? "has more than one kind; allowed: exactly one of" : "has no kind; allowed: exactly one of");
  }
  snprintf(allowed, sizeof allowed, "%s %s %s %s", ProbeForms[probe->kind].kind, ProbeForms[probe->kind].needs, ProbeForms[probe->kind].takes, ProbeCommon);
  for (size_t i = 0; i < sizeof Optional / sizeof Optional[0]; i++) {
    if (HasWord(ProbeForms[probe->kind].needs, Optional[i]) && !SceneHas(scene, probe->path, Optional[i]))
      SceneRefuse(scene, probe->path, Optional[i], ProbeForms[probe->kind].kind, "is missing; needed by");
  }
  for (int i = 0; i < node->n; i++) {
    if (!HasWord(allowed, node->key[i])) SceneRefuse(scene, probe->path, node->key[i], allowed, "has no place in this kind of probe; allowed:");
  }
}

static void SceneRefuseProbeTarget(Scene scene, SceneProbe *probe)
{
  char pairs[400] = "allowed: the name of a pair under contact:";

  for (int i = 0; i < scene->n_contacts; i++) {
    if (!strcmp(scene->contacts[i].name, probe->target)) return;
    snprintf(pairs + strlen(pairs), sizeof pairs - strlen(pairs), "%s %s", i ? "," : "", scene->contacts[i].name);
  }
  SceneRefuse(scene, probe->path, ProbeForms[probe->kind].kind, pairs, "there is no contact pair of this name;");
}

/* at: a point for a gap, else one reference coordinate. */
static void SceneReadProbeAt(Scene scene, SceneProbe *probe)
{
  Node at = SceneNode(scene, probe->path, "at");

  if (probe->kind == PROBE_GAP) {
    if (at->kind != NODE_LIST) SceneRefuse(scene, probe->path, "at", "has the wrong type; allowed: the point of a slave node", NULL);
    (void)SceneReals(scene, probe->path, "at", probe->point[0]);
    return;
  }
  if (!at && probe->kind == PROBE_CONTACT_EDGE && scene->dim == 3)
    SceneRefuse(scene, probe->path, "at", "is missing; needed by contact_edge in 3D, such as {z: 100}", NULL);
  if (!at) return;
  if (at->kind != NODE_MAP || at->n != 1) SceneRefuse(scene, probe->path, "at", "is not one coordinate; allowed: one of {x: }, {y: }, {z: }", NULL);
  probe->has_at = 1;
  for (int k = 0; k < 3; k++) {
    if (!strcmp(at->key[0], Axes[k])) probe->at_axis = k;
  }
  (void)NodeReal(at->child[0], &probe->at_value);
  if (probe->kind == PROBE_CONTACT_EDGE && probe->at_axis == probe->axis)
    SceneRefuse(scene, probe->path, "at", "fixes the axis along which the edge is sought; allowed: another coordinate", NULL);
}

static PetscErrorCode SceneReadProbe(Scene scene, SceneProbe *probe)
{
  Document   *document = SceneDocument(scene);
  const char *path     = probe->path;
  Node        points;

  PetscFunctionBeginUser;
  PetscCall(SceneReadText(scene, path, "name", &probe->name));
  SceneProbeKind(scene, probe);
  if (probe->kind == PROBE_DISPLACEMENT) {
    (void)SceneReals(scene, path, "displacement", probe->point[0]);
  } else if (probe->kind == PROBE_DISTANCE) {
    points = SceneNode(scene, path, "distance");
    for (int i = 0; i < 2; i++) {
      for (int k = 0; k < points->child[i]->n; k++) (void)NodeReal(points->child[i]->child[k], &probe->point[i][k]);
    }
  } else {
    PetscCall(SceneReadText(scene, path, ProbeForms[probe->kind].kind, &probe->target));
    if (probe->kind != PROBE_REACTION) SceneRefuseProbeTarget(scene, probe);
  }
  probe->component = PetscMax(0, SchemaChoice(document, "%s.component", path));
  probe->axis      = PetscMax(0, SchemaChoice(document, "%s.axis", path));
  probe->max_side  = SchemaChoice(document, "%s.side", path) == 1;
  SceneReadProbeAt(scene, probe);
  PetscCall(SceneReadText(scene, path, "body", &probe->body));
  if (probe->body && !SceneFindBody(scene, probe->body, 0))
    SceneRefuse(scene, path, "body", "is no deformable body; allowed: a volume under bodies:", probe->body);
  probe->change      = SchemaBoolean(document, "%s.change", path);
  probe->rms         = SchemaChoice(document, "%s.measure", path) == 1;
  probe->edge_filter = SceneHas(scene, path, "excluding") ? 1 : SceneHas(scene, path, "only") ? 2 : 0;
  probe->edge_faces  = probe->edge_filter ? SchemaReal(document, "%s.%s", path, probe->edge_filter == 1 ? "excluding" : "only") : 0;
  if (SceneHas(scene, path, "excluding") && SceneHas(scene, path, "only"))
    SceneRefuse(scene, path, "only", "stands beside excluding; allowed: one of them", NULL);
  probe->absolute = SchemaBoolean(document, "%s.absolute", path);
  probe->factor   = SchemaReal(document, "%s.factor", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadProbes(Scene scene)
{
  PetscFunctionBeginUser;
  scene->n_probes = SchemaCount(SceneDocument(scene), "probes");
  PetscCall(PetscCalloc1(scene->n_probes, &scene->probes));
  for (int i = 0; i < scene->n_probes; i++) {
    PetscCall(PathCreate(&scene->probes[i].path, "probes", i));
    PetscCall(SceneReadProbe(scene, &scene->probes[i]));
    for (int j = 0; j < i; j++) {
      if (!strcmp(scene->probes[i].name, scene->probes[j].name))
        SceneRefuse(scene, scene->probes[i].path, "name", "names another probe already; allowed: names used once", scene->probes[i].name);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadOutput(Scene scene)
{
  const char *const names[] = {"displacement", "stress", "contact"};
  int *const        flags[] = {&scene->output.displacement, &scene->output.stress, &scene->output.contact};
  Node              fields  = NodeFind(SceneDocument(scene)->root, "output.fields");

  PetscFunctionBeginUser;
  scene->output.every = SchemaInteger(SceneDocument(scene), "output.every");
  for (int k = 0; k < 3; k++) {
    *flags[k] = !fields;
    for (int i = 0; fields && i < fields->n; i++) *flags[k] |= !strcmp(fields->child[i]->text, names[k]);
  }
  PetscCall(SceneReadPairs(scene, "petsc", &scene->n_petsc, &scene->petsc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the whole ---- */

static PetscErrorCode DocumentRead(MPI_Comm comm, const char *file, int n_set, char *const *set, Document **document)
{
  char  *text;
  size_t length;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(document));
  (*document)->comm = comm;
  PetscCall(PetscStrallocpy(file, &(*document)->file));
  PetscCall(FileBroadcast(comm, file, &text, &length));
  PetscCall(DocumentParse(*document, text, length, "", NULL, &(*document)->root));
  PetscCall(PetscFree(text));
  PetscCall(PetscCalloc1(n_set, &(*document)->set_key));
  for (int i = 0; i < n_set; i++) {
    const char *equals = strchr(set[i], '=');
    char       *key;

    if (!equals) PetscCall(RefuseInput(comm, "-set %s: has no value; allowed: KEY=VALUE", set[i]));
    PetscCall(PetscStrallocpy(set[i], &key));
    key[equals - set[i]]                       = 0;
    (*document)->set_key[(*document)->n_set++] = key;
    PetscCall(DocumentSet(*document, key, equals + 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneReadNames(Scene scene, const char *file)
{
  const char *slash = strrchr(file, '/'), *stem = slash ? slash + 1 : file;
  char       *dot;

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(file, &scene->file));
  PetscCall(PetscStrallocpy(slash ? file : ".", &scene->directory));
  if (slash) scene->directory[PetscMax(1, slash - file)] = 0;
  PetscCall(PetscStrallocpy(SchemaHas(SceneDocument(scene), "name") ? SchemaText(SceneDocument(scene), "name") : stem, &scene->name));
  dot = strrchr(scene->name, '.');
  if (!SchemaHas(SceneDocument(scene), "name") && dot && dot > scene->name) *dot = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SceneRead - reads, edits, validates and converts a scene file.

   Collective. file: as the process can open it on rank 0. set[n_set]: KEY=VALUE edits, in order, the last of a key wins. scene: free with
   SceneDestroy(). Refuses (exit status 1) the first mistake; see schema.c for the keys. */
PetscErrorCode SceneRead(MPI_Comm comm, const char *file, int n_set, char *const *set, Scene *scene)
{
  Document *document;

  PetscFunctionBeginUser;
  PetscCall(DocumentRead(comm, file, n_set, set, &document));
  SchemaCheck(document);
  PetscCall(PetscNew(scene));
  (*scene)->document = document;
  PetscCall(SceneReadNames(*scene, file));
  PetscCall(DocumentText(document, &(*scene)->text));
  (*scene)->geometry   = (Geometry)SchemaChoice(document, "geometry");
  (*scene)->kinematics = (Kinematics)SchemaChoice(document, "kinematics");
  (*scene)->dim        = document->dim;
  PetscCall(SceneReadMesh(*scene));
  PetscCall(SceneReadBodies(*scene));
  PetscCall(SceneReadSupports(*scene));
  PetscCall(SceneReadLoads(*scene));
  PetscCall(SceneReadContacts(*scene));
  PetscCall(SceneReadStepping(*scene));
  PetscCall(SceneReadProbes(*scene));
  PetscCall(SceneReadOutput(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairsDestroy(int n, ScenePair **pairs)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) {
    PetscCall(PetscFree((*pairs)[i].key));
    PetscCall(PetscFree((*pairs)[i].value));
  }
  PetscCall(PetscFree(*pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneDestroyBodies(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_bodies; i++) {
    SceneBody *body = &scene->bodies[i];

    for (int k = 0; k < body->n_motions; k++) PetscCall(PetscFree2(body->motions[k].history.t, body->motions[k].history.v));
    PetscCall(PetscFree(body->motions));
    PetscCall(PetscFree(body->path));
    PetscCall(PetscFree(body->name));
  }
  PetscCall(PetscFree(scene->bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneDestroyContacts(Scene scene)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < scene->n_contacts; i++) {
    SceneContact *contact = &scene->contacts[i];

    for (int k = 0; k < contact->n_symmetry; k++) PetscCall(PetscFree(contact->symmetry[k]));
    PetscCall(PetscFree(contact->symmetry));
    PetscCall(PetscFree(contact->path));
    PetscCall(PetscFree(contact->name));
    PetscCall(PetscFree(contact->slave));
    PetscCall(PetscFree(contact->master));
  }
  PetscCall(PetscFree(scene->contacts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DocumentDestroy(Document *document)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < document->n_set; i++) PetscCall(PetscFree(document->set_key[i]));
  PetscCall(PetscFree(document->set_key));
  PetscCall(PetscFree(document->file));
  PetscCall(NodeDestroy(&document->root));
  PetscCall(PetscFree(document));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SceneDestroy - frees a scene. Not collective. */
PetscErrorCode SceneDestroy(Scene *scene)
{
  Scene s = *scene;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneDestroyBodies(s));
  PetscCall(SceneDestroyContacts(s));
  for (int i = 0; i < s->n_supports; i++) {
    PetscCall(PetscFree(s->supports[i].path));
    PetscCall(PetscFree(s->supports[i].surface));
  }
  for (int i = 0; i < s->n_loads; i++) {
    PetscCall(PetscFree2(s->loads[i].history.t, s->loads[i].history.v));
    PetscCall(PetscFree(s->loads[i].path));
    PetscCall(PetscFree(s->loads[i].region));
  }
  for (int i = 0; i < s->n_probes; i++) {
    PetscCall(PetscFree(s->probes[i].path));
    PetscCall(PetscFree(s->probes[i].name));
    PetscCall(PetscFree(s->probes[i].target));
    PetscCall(PetscFree(s->probes[i].body));
  }
  PetscCall(PetscFree(s->supports));
  PetscCall(PetscFree(s->loads));
  PetscCall(PetscFree(s->probes));
  PetscCall(PetscFree(s->stepping.at));
  PetscCall(PairsDestroy(s->n_parameters, &s->parameters));
  PetscCall(PairsDestroy(s->n_petsc, &s->petsc));
  PetscCall(PetscFree(s->file));
  PetscCall(PetscFree(s->directory));
  PetscCall(PetscFree(s->text));
  PetscCall(PetscFree(s->name));
  PetscCall(PetscFree(s->mesh_file));
  PetscCall(DocumentDestroy(SceneDocument(s)));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SceneWhere - "FILE:LINE: PATH.KEY" for the start of a message about the value at path.key; the line of its nearest ancestor if the file
   lacks it, "-set ..." if it came from there.

   Not collective. path: of a scene's part ("contact.0"), or ""; key: below it, or "". The text is valid until the next call. */
const char *SceneWhere(Scene scene, const char *path, const char *key)
{
  char text[PATH_LENGTH];

  PathJoin(text, path ? path : "", key ? key : "");
  if (!key || !*key) snprintf(text, sizeof text, "%s", path ? path : "");
  return DocumentWhere(SceneDocument(scene), text);
}

/* SceneReference - prints the scene reference: every key with type, range, unit, default and help. Not collective: for one rank. */
PetscErrorCode SceneReference(FILE *file)
{
  PetscFunctionBeginUser;
  SchemaReference(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}
