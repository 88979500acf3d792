/* Validation of a document against the table of keys, values with their defaults, and the reference, see schema.h. */
#include "schema.h"
#include "schemakeys.h"
#include "base/refusal.h"
#include "scene/expression.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* What a key allows, in words */

/* Appends a text, with `apart` before it if it is not the first. */
static void Append(char *text, size_t size, const char *apart, const char *more)
{
  const size_t n = strlen(text);

  snprintf(text + n, size - n, "%s%s", n ? apart : "", more);
}

/* Writes what a key allows: its types, its range and its unit. */
static void SchemaAllowed(const SchemaKey *key, char *text, size_t size)
{
  static const struct {
    int         type;
    const char *words;
  } Types[] = {
    {REAL, "a number"},
    {INTEGER, "an integer"},
    {BOOLEAN, "true | false"},
    {TEXT, "a name (at most 127 characters)"},
    {FILENAME, "a file name"},
    {NAME, "a name (letters, digits, _ - ., at most 100 characters)"},
    {POINT, "[x, y, z] (2D: [x, y])"},
    {POINTS, "[[x, y, z], [x, y, z]] (2D: [[x, y], [x, y]])"},
    {REALS, "an increasing list of numbers"},
    {NUMBERS, "a list of numbers"},
    {TEXTS, "a list of names"},
    {CHOICES, "a list of"},
    {HISTORY, "[[t, factor], ...], at least two, t increasing from 0 within [0, 1] | {csv: FILE, column: 2}"},
    {TABLE, "[[a, b], ...], at least two, a increasing from 0 | {csv: FILE, column: 2}"},
    {PAIRS, "a list of pairs of numbers"},
    {MAP, "a map"},
    {LIST, "a list of maps"},
    {FREE, "a map of plain values"},
  };

  text[0] = 0;
  if (key->type & CHOICE) Append(text, size, " | ", key->values);
  for (size_t i = 0; i < sizeof Types / sizeof Types[0]; i++) {
    if (key->type & Types[i].type) Append(text, size, " | ", Types[i].words);
  }
  if (key->type & FORMULA)
    Append(text, size, "", key->type & POINT ? " of numbers or expressions" : " | an expression");
  if (key->type & CHOICES) Append(text, size, " ", key->values);
  if (key->range) Append(text, size, key->type & LIST ? ", entries in " : " in ", key->range);
  if (key->unit) Append(text, size, ", ", key->unit);
}

/* Appends the keys of the map at a path; a name of several is a name of each. */
static void AppendKeys(const char *path, char *text, size_t size)
{
  char word[80];

  for (int i = 0; i < SchemaKeysCount; i++) {
    if (!SchemaKeyIsChild(&SchemaKeys[i], path)) continue;
    for (const char *key = SchemaKeyName(&SchemaKeys[i]); *key;) {
      const size_t n = strcspn(key, "|");

      snprintf(word, sizeof word, "%.*s", (int)n, key);
      Append(text, size, ", ", word);
      key += n + (key[n] == '|');
    }
  }
}

/* Writes what a key at a path allows, for messages: the keys of its map, too. */
static void SchemaAllowedAt(const SchemaKey *key, const char *path, char *text, size_t size)
{
  char keys[600] = "";

  SchemaAllowed(key, text, size);
  if (!(key->type & MAP)) return;
  AppendKeys(path, keys, sizeof keys);
  if (*keys) Append(text, size, " of ", keys);
}

/* Refuses the value of a key, with what is wrong and what is allowed. */
static PetscErrorCode SchemaRefuse(Document *document, const SchemaKey *key, Node node, const char *path,
                                   const char *wrong)
{
  static const char *const Kinds[] = {"", "this list ", "this map "};
  char                     allowed[1000];

  PetscFunctionBeginUser;
  SchemaAllowedAt(key, path, allowed, sizeof allowed);
  if (node->kind == NODE_SCALAR && node->plain && !*node->text)
    PetscCall(DocumentRefuseNode(document, node, path, "has no value; allowed: %s", allowed));
  if (node->kind == NODE_SCALAR)
    PetscCall(DocumentRefuseNode(document, node, path, "%s%.100s%s %s; allowed: %s", node->plain ? "" : "\"",
                                 node->text, node->plain ? "" : "\"", wrong, allowed));
  PetscCall(DocumentRefuseNode(document, node, path, "%s%s; allowed: %s", Kinds[node->kind], wrong, allowed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks of one value. Each returns NULL, or the words that say what is wrong with the value. */

static const char WrongType[] = "has the wrong type", OutOfRange[] = "is out of range";

/* Tells whether a value is in an interval such as "(0, inf)", or 1 if there is no interval. */
static int RangeHolds(const char *range, double value)
{
  char  *end;
  double low, high;

  if (!range) return 1;
  low  = strtod(range + 1, &end);
  high = strtod(end + 1, &end);
  return (range[0] == '[' ? value >= low : value > low) && (*end == ']' ? value <= high : value < high);
}

static const char *CheckReal(Node node, const char *range)
{
  double value;

  if (!NodeReal(node, &value)) return WrongType;
  return RangeHolds(range, value) ? NULL : OutOfRange;
}

static const char *CheckInteger(Node node, const char *range)
{
  long value;

  if (!NodeInteger(node, &value)) return WrongType;
  return RangeHolds(range, (double)value) && value == (int)value ? NULL : OutOfRange;
}

static const char *CheckName(Node node)
{
  const char *text = node->text;

  if (strlen(text) > SCHEMA_LONGEST_NAME) return "is too long";
  return *text && *text != '.' && *text != '-' &&
             !text[strspn(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.")]
           ? NULL
           : "is no name";
}

static const char *CheckText(Node node, size_t longest)
{
  const int null = node->plain && (!*node->text || !strcmp(node->text, "~") || !strcmp(node->text, "null"));

  if (null || !*node->text) return "is empty";
  if (strlen(node->text) > longest) return "is too long";
  for (const char *c = node->text; *c; c++) {
    if ((unsigned char)*c < ' ') return "has a control character";
  }
  return NULL;
}

/* Checks a number or an expression, whose names and syntax SceneReadValue() checks. */
static const char *CheckFormula(Node node, const char *range)
{
  double value;

  if (node->kind != NODE_SCALAR) return WrongType;
  return NodeReal(node, &value) ? CheckReal(node, range) : CheckText(node, EXPRESSION_LONGEST);
}

/* Checks a scalar against all types that a key allows. If none fits, the reason is that of the last type. */
static const char *CheckScalar(const SchemaKey *key, int type, Node node)
{
  const char *wrong = WrongType;
  int         truth;

  if (type & CHOICE && WordFind(key->values, " |", node->text, strlen(node->text)) >= 0) return NULL;
  if (type & CHOICE) wrong = "is not allowed";
  if (type & BOOLEAN && NodeBoolean(node, &truth)) return NULL;
  if (type & REAL) wrong = CheckReal(node, key->range);
  if (type & INTEGER) wrong = CheckInteger(node, key->range);
  if (type & NAME) wrong = CheckName(node);
  if (type & TEXT) wrong = CheckText(node, SCHEMA_LONGEST_GROUP);
  if (type & FILENAME) wrong = CheckText(node, PETSC_MAX_PATH_LEN - 1);
  if (type & FORMULA && !(type & POINT)) wrong = CheckFormula(node, key->range);
  return wrong;
}

static const char *CheckPoint(Node node, int type, const char *range)
{
  const char *wrong;

  if (node->kind != NODE_LIST || node->n < 2 || node->n > 3) return WrongType;
  for (int i = 0; i < node->n; i++) {
    if ((wrong = type & FORMULA ? CheckFormula(node->child[i], range) : CheckReal(node->child[i], range))) return wrong;
  }
  return NULL;
}

static const char *CheckTable(Node node)
{
  double a, b, before = 0;

  if (node->n < 2) return "has less than two points";
  for (int i = 0; i < node->n; i++) {
    Node pair = node->child[i];

    if (pair->kind != NODE_LIST || pair->n != 2 || !NodeReal(pair->child[0], &a) || !NodeReal(pair->child[1], &b))
      return WrongType;
    if (!i && a != 0) return "does not start at 0";
    if (i && a <= before) return "is not increasing";
    before = a;
  }
  return NULL;
}

static const char *CheckHistory(Node node)
{
  double t, before = 0, factor;

  if (node->n < 2) return "has less than two points";
  for (int i = 0; i < node->n; i++) {
    Node pair = node->child[i];

    if (pair->kind != NODE_LIST || pair->n != 2 || !NodeReal(pair->child[0], &t) || !NodeReal(pair->child[1], &factor))
      return WrongType;
    if (t < 0 || t > 1) return "has a t outside [0, 1]";
    if (!i && t != 0) return "does not start at t = 0";
    if (i && t <= before) return "is not increasing in t";
    before = t;
  }
  return NULL;
}

static const char *CheckPairs(Node node)
{
  double value;

  for (int i = 0; i < node->n; i++) {
    Node pair = node->child[i];

    if (pair->kind != NODE_LIST || pair->n != 2 || !NodeReal(pair->child[0], &value) ||
        !NodeReal(pair->child[1], &value))
      return WrongType;
  }
  return node->n ? NULL : "is empty";
}

static const char *CheckEntries(const SchemaKey *key, Node node)
{
  const int   type = key->type & (REALS | NUMBERS) ? REAL : key->type & TEXTS ? TEXT : CHOICE;
  const char *wrong;
  double      value, before = -HUGE_VAL;

  for (int i = 0; i < node->n; i++) {
    if (node->child[i]->kind != NODE_SCALAR) return WrongType;
    if ((wrong = CheckScalar(key, type, node->child[i]))) return wrong;
    if (key->type & (TEXTS | CHOICES)) {
      for (int j = 0; j < i; j++) {
        if (!strcmp(node->child[i]->text, node->child[j]->text)) return "names something twice";
      }
    } else if (key->type & REALS && NodeReal(node->child[i], &value)) {
      if (value <= before) return "is not increasing";
      before = value;
    }
  }
  return NULL;
}

/* Checks a list of plain values, of pairs or of points. SchemaVisitValue() checks lists of maps. */
static const char *CheckList(const SchemaKey *key, Node node)
{
  if (key->type & POINT) return CheckPoint(node, key->type, key->range);
  if (key->type & POINTS)
    return node->n == 2 && !CheckPoint(node->child[0], REAL, NULL) && !CheckPoint(node->child[1], REAL, NULL)
             ? NULL
             : WrongType;
  if (key->type & HISTORY) return CheckHistory(node);
  if (key->type & TABLE) return CheckTable(node);
  if (key->type & PAIRS) return CheckPairs(node);
  if (key->type & (REALS | NUMBERS | TEXTS | CHOICES)) return CheckEntries(key, node);
  return WrongType;
}

/* The walk over the document */

/* Returns the edit distance of two words. Its row is bounded, because a word longer than LONGEST characters resembles
   no key of the schema. */
static int WordDistance(const char *a, size_t na, const char *b, size_t nb)
{
  enum { LONGEST = 40 };
  int row[LONGEST + 1];

  if (na > LONGEST || nb > LONGEST) return LONGEST;
  for (size_t j = 0; j <= nb; j++) row[j] = (int)j;
  for (size_t i = 1; i <= na; i++) {
    int diagonal = row[0];

    row[0] = (int)i;
    for (size_t j = 1; j <= nb; j++) {
      const int change = diagonal + (a[i - 1] != b[j - 1]);
      const int insert = 1 + (row[j] < row[j - 1] ? row[j] : row[j - 1]);

      diagonal = row[j];
      row[j]   = change < insert ? change : insert;
    }
  }
  return row[nb];
}

/* How unlike a key of n letters a word is: their edit distance, less the letters with which both begin, from three on.
 */
static int WordUnlike(const char *word, const char *key, size_t n)
{
  size_t same = 0;

  while (same < n && word[same] && word[same] == key[same]) same++;
  return WordDistance(word, strlen(word), key, n) - (same >= 3 ? (int)same : 0);
}

/* Keys that other programs have and that users look for, and what there is instead. */
static const struct {
  const char *key, *instead;
} Wanted[] = {
  {"cyclic", "sides of a sector that repeat by a rotation cannot be tied to each other; allowed: a sector whose sides "
             "are planes of symmetry, held by supports and named by symmetry under contact, or the whole part"},
};

/* Refuses an unknown key and names all keys that are allowed and the most similar one, if half of its letters are
   right, or what there is in its place. */
static PetscErrorCode SchemaRefuseUnknown(Document *document, Node node, const char *parent, const char *path,
                                          const char *unknown)
{
  char        allowed[1000] = "";
  const char *nearest       = "";
  int         least = 1000, length = 0;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Wanted); i++)
    if (!strcmp(unknown, Wanted[i].key)) PetscCall(DocumentRefuseNode(document, node, path, "%s", Wanted[i].instead));
  AppendKeys(parent, allowed, sizeof allowed);
  for (const char *key = allowed; *key;) {
    const size_t n = strcspn(key, ",");
    const int    d = WordUnlike(unknown, key, n);

    if (d < least) {
      least   = d;
      nearest = key;
      length  = (int)n;
    }
    key += n + strspn(&key[n], ", ");
  }
  if (2 * least <= (int)strlen(unknown))
    PetscCall(DocumentRefuseNode(document, node, path, "unknown key, did you mean %.*s? allowed: %s", length, nearest,
                                 allowed));
  PetscCall(DocumentRefuseNode(document, node, path, "unknown key; allowed: %s", allowed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SchemaRefuseMissing(Document *document, const SchemaKey *key, Node node, const char *path)
{
  char allowed[1000], missing[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  KeyPathJoin(missing, path, SchemaKeyName(key));
  SchemaAllowedAt(key, missing, allowed, sizeof allowed);
  PetscCall(DocumentRefuseNode(document, node, missing, "is missing; allowed: %s", allowed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks a map whose keys are not in the schema. */
static PetscErrorCode SchemaCheckFree(Document *document, Node node, const char *path)
{
  char below[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  for (int i = 0; i < node->n; i++) {
    KeyPathJoin(below, path, node->key[i]);
    if (!*node->key[i] || strpbrk(node->key[i], " \t\n="))
      PetscCall(DocumentRefuseNode(document, node->child[i], below,
                                   "is no name of a parameter or option; allowed: no blanks, no ="));
    if (node->child[i]->kind != NODE_SCALAR)
      PetscCall(DocumentRefuseNode(document, node->child[i], below, "has the wrong type; allowed: a number or a text"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses unknown keys of a map. This comes before all other checks of the map, so that a misspelt key is not reported
   as a missing one. */
static PetscErrorCode SchemaCheckKeys(Document *document, Node node, const char *path)
{
  char below[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  for (int i = 0; i < node->n; i++) {
    KeyPathJoin(below, path, node->key[i]);
    if (strchr(node->key[i], '.') || !SchemaKeyFind(below))
      PetscCall(SchemaRefuseUnknown(document, node->child[i], path, below, node->key[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef PetscErrorCode (*NodeVisit)(Document *, const SchemaKey *, Node, const char *path);

/* Visits a node and all nodes below it that the schema describes. */
static PetscErrorCode SchemaWalk(Document *document, Node node, const char *path, NodeVisit visit)
{
  const SchemaKey *key = SchemaKeyFind(path);
  char             below[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  if (node->kind == NODE_MAP && (!key || key->type & MAP)) PetscCall(SchemaCheckKeys(document, node, path));
  if (key) PetscCall(visit(document, key, node, path));
  if (key && !(key->type & (node->kind == NODE_MAP ? MAP : LIST))) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < node->n; i++) {
    if (node->kind == NODE_MAP)
      KeyPathJoin(below, path, node->key[i]);
    else
      KeyPathJoinIndex(below, path, i);
    PetscCall(SchemaWalk(document, node->child[i], below, visit));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a map that lacks a required key. */
static PetscErrorCode SchemaVisitMissing(Document *document, Node node, const char *path)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < SchemaKeysCount; i++) {
    if (!(SchemaKeys[i].flags & REQUIRED) || !SchemaKeyIsChild(&SchemaKeys[i], path) ||
        NodeChild(node, SchemaKeyName(&SchemaKeys[i])))
      continue;
    if (SchemaKeys[i].flags & SOLID && document->dim == 2) continue;
    PetscCall(SchemaRefuseMissing(document, &SchemaKeys[i], node, path));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks the type and the range of a value, and the required keys of a map. */
static PetscErrorCode SchemaVisitValue(Document *document, const SchemaKey *key, Node node, const char *path)
{
  const char *wrong = NULL;

  PetscFunctionBeginUser;
  if (node->kind == NODE_MAP) {
    if (key->type & FREE)
      PetscCall(SchemaCheckFree(document, node, path));
    else if (key->type & MAP)
      PetscCall(SchemaVisitMissing(document, node, path));
    else
      wrong = WrongType;
  } else if (node->kind == NODE_LIST) {
    if (key->type & LIST)
      wrong = RangeHolds(key->range, node->n) ? NULL : "is empty";
    else
      wrong = CheckList(key, node);
  } else
    wrong = CheckScalar(key, key->type, node);
  if (wrong) PetscCall(SchemaRefuse(document, key, node, path, wrong));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses values that are not available yet. */
static PetscErrorCode SchemaVisitAvailable(Document *document, const SchemaKey *key, Node node, const char *path)
{
  double value, now;
  char  *end;

  PetscFunctionBeginUser;
  if (!key->now) PetscFunctionReturn(PETSC_SUCCESS);
  if (!*key->now) PetscCall(DocumentRefuseNode(document, node, path, "not available yet"));
  if (WordFind(key->now, " |", node->text, strlen(node->text)) >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  now = strtod(key->now, &end);
  if (key->type & INTEGER && NodeReal(node, &value) && !*end && value == now) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DocumentRefuseNode(document, node, path, "%s is not available yet; available: %s", node->text, key->now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses keys and components of the third direction in a 2D scene, and points with a wrong number of coordinates. */
static PetscErrorCode SchemaVisitDimension(Document *document, const SchemaKey *key, Node node, const char *path)
{
  static const char Solid[] = "geometry: solid";

  PetscFunctionBeginUser;
  if (document->dim == 2 && key->flags & SOLID)
    PetscCall(DocumentRefuseNode(document, node, path, "has no meaning in 2D; allowed: only with %s", Solid));
  if (document->dim == 2 && key->type & CHOICE && node->kind == NODE_SCALAR && !strcmp(node->text, "z"))
    PetscCall(
      DocumentRefuseNode(document, node, path, "z has no meaning in 2D; allowed: x | y, z only with %s", Solid));
  for (int i = 0; node->kind == NODE_LIST && i < (key->type & POINTS ? 2 : key->type & POINT ? 1 : 0); i++) {
    if ((key->type & POINTS ? node->child[i] : node)->n != document->dim)
      PetscCall(DocumentRefuseNode(document, node, path,
                                   "has not as many coordinates as the scene; allowed: %d numbers", document->dim));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SchemaCheck - validates a document against the table of keys and sets document->dim.

  Collective

  Input Parameter:
. document - the document

  Note:
  It refuses the first mistake. It checks unknown and missing keys, types and ranges first, then the values that are not
  available yet, then the values that a 2D scene cannot have.
@*/
PetscErrorCode SchemaCheck(Document *document)
{
  Node geometry;

  PetscFunctionBeginUser;
  if (document->root->kind != NODE_MAP)
    PetscCall(DocumentRefuse(document, "", "a scene is a map; allowed: KEY: VALUE lines"));
  geometry      = NodeFind(document->root, "geometry");
  document->dim = geometry && geometry->kind == NODE_SCALAR && strcmp(geometry->text, "solid") ? 2 : 3;
  PetscCall(SchemaWalk(document, document->root, "", SchemaVisitValue));
  PetscCall(SchemaVisitMissing(document, document->root, ""));
  PetscCall(SchemaWalk(document, document->root, "", SchemaVisitAvailable));
  PetscCall(SchemaWalk(document, document->root, "", SchemaVisitDimension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Accessors, to be called after SchemaCheck() */

/* Returns the text of the scalar at a path, or the default of the table, or NULL if there is neither. *key is the entry
   of the table. */
static const char *SchemaScalar(Document *document, const char *format, va_list arguments, const SchemaKey **key)
{
  char path[KEY_PATH_LENGTH];
  Node node;

  vsnprintf(path, sizeof path, format, arguments);
  *key = SchemaKeyFind(path);
  if (!*key) {
    fprintf(stderr, "burnish: the schema has no key %s\n", path);
    abort();
  }
  node = NodeFind(document->root, path);
  return node ? node->text : (*key)->preset;
}

/*@
  SchemaHas - tells whether the document has a value at a path.

  Not collective

  Input Parameters:
+ document - the document
. format   - format of the path, as for printf()
- ...      - arguments of the format

  Note:
  It returns 1 or 0. A default does not count.
@*/
int SchemaHas(Document *document, const char *format, ...)
{
  char    path[KEY_PATH_LENGTH];
  va_list arguments;

  va_start(arguments, format);
  vsnprintf(path, sizeof path, format, arguments);
  va_end(arguments);
  return NodeFind(document->root, path) != NULL;
}

/*@
  SchemaCount - returns the number of entries of the list or map at a path.

  Not collective

  Input Parameters:
+ document - the document
. format   - format of the path, as for printf()
- ...      - arguments of the format

  Note:
  It returns 0 if the document has no such value.
@*/
int SchemaCount(Document *document, const char *format, ...)
{
  char    path[KEY_PATH_LENGTH];
  va_list arguments;
  Node    node;

  va_start(arguments, format);
  vsnprintf(path, sizeof path, format, arguments);
  va_end(arguments);
  node = NodeFind(document->root, path);
  return node ? node->n : 0;
}

/* Sets text and key to the result of SchemaScalar() for the path of the calling accessor. */
#define SCHEMA_SCALAR(text, key)                            \
  do {                                                      \
    va_list arguments;                                      \
    va_start(arguments, format);                            \
    text = SchemaScalar(document, format, arguments, &key); \
    va_end(arguments);                                      \
  } while (0)

/*@
  SchemaReal - returns the number at a path, or its default.

  Not collective

  Input Parameters:
+ document - the document
. format   - format of the path, as for printf()
- ...      - arguments of the format

  Note:
  It returns 0 if there is neither a value nor a default.
@*/
double SchemaReal(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text ? strtod(text, NULL) : 0;
}

/*@
  SchemaInteger - returns the integer at a path, or its default.

  Not collective

  Input Parameters:
+ document - the document
. format   - format of the path, as for printf()
- ...      - arguments of the format

  Note:
  It returns 0 if there is neither a value nor a default.
@*/
int SchemaInteger(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text ? atoi(text) : 0;
}

/*@
  SchemaBoolean - returns 1 if the value at a path, or its default, is true.

  Not collective

  Input Parameters:
+ document - the document
. format   - format of the path, as for printf()
- ...      - arguments of the format

  Note:
  It returns 0 if the value is false, or if there is neither a value nor a default.
@*/
int SchemaBoolean(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text && !strcmp(text, "true");
}

/*@
  SchemaChoice - returns the index of the word at a path, or of its default, among the words that the table allows.

  Not collective

  Input Parameters:
+ document - the document
. format   - format of the path, as for printf()
- ...      - arguments of the format

  Note:
  The index is counted from 0. It is -1 if neither the value nor the default is one of the words.
@*/
int SchemaChoice(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text ? WordFind(key->values, " |", text, strlen(text)) : -1;
}

/*@
  SchemaText - returns the text at a path, or its default.

  Not collective

  Input Parameters:
+ document - the document
. format   - format of the path, as for printf()
- ...      - arguments of the format

  Note:
  It returns NULL if there is neither a text nor a default. The text belongs to the document.
@*/
const char *SchemaText(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text;
}

/*@
  SchemaReference - prints every key with its path, what it allows, its default and its meaning.

  Not collective

  Input Parameter:
. file - the stream to print to

  Note:
  The path is written as -set takes it. N stands for an index of a list.
@*/
void SchemaReference(FILE *file)
{
  char allowed[400];

  for (int i = 0; i < SchemaKeysCount; i++) {
    const SchemaKey *key = &SchemaKeys[i];

    fprintf(file, "  ");
    for (const char *c = key->path; *c; c++) fputc(*c == '*' ? 'N' : *c, file);
    SchemaAllowed(key, allowed, sizeof allowed);
    fprintf(file, ": %s", allowed);
    if (key->flags & REQUIRED) fprintf(file, "; required");
    if (key->flags & SOLID) fprintf(file, "; 3D only");
    if (key->preset) fprintf(file, "; default %s", key->preset);
    if (key->now) fprintf(file, "%s%s%s", *key->now ? "; only " : "; not", key->now, " available yet");
    fprintf(file, "%s%s\n", key->help ? " - " : "", key->help ? key->help : "");
  }
}
