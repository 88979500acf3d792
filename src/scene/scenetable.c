/* Tables of a scene in files of comma-separated values, see scenetable.h. */
#include "scenetable.h"
#include "schemakeys.h"
#include "base/refusal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The most characters of a field that a message repeats. A wrong file may hold anything. */
#define TABLE_SHOWN 40
/* The most columns of a row: what more there is in one is hardly a table over t. */
enum { TABLE_COLUMNS = 1000 };
/* The characters that a pair of numbers takes as YAML, at most. */
enum { TABLE_PAIR = 64 };

/* A file of comma-separated values while it is read */
typedef struct {
  Document   *document;
  Node        node;            /* the map in the scene */
  const char *path;            /* of the map in the scene */
  char        name[2048];      /* of the file */
  int         line, column[2]; /* line of the row, counted from 1; columns of t and of the values, counted from 0 */
  const char *word[2];         /* names of the columns in the head; NULL: there is a number */
  double      end, before;     /* value of the first column at t = 1; that of the last row */
  int         rows, over;      /* rows so far; 1: the first column is t and ends within [0, 1] */
  char       *text;            /* the pairs as YAML */
  size_t      length;
} Table;

/* Returns what separates the fields of a row: semicolons, else tabs, else commas, else blanks. A comma beside
   semicolons is thus part of a field, which is no number then. */
static const char *RowSeparator(const char *row)
{
  const size_t n = strcspn(row, "\n");

  if (memchr(row, ';', n)) return ";\n";
  if (memchr(row, '\t', n)) return "\t\n";
  return memchr(row, ',', n) ? ",\n" : " \n";
}

/* Gives the field of a row that starts at *at, without blanks and quotes around it, and moves *at behind it. *at is
   NULL behind the last field. */
static size_t NextField(const char *apart, const char **at, const char **field)
{
  const char *end, *stop;

  *at += *apart == ' ' ? strspn(*at, " ") : 0;
  end = stop = *at + strcspn(*at, apart);
  *field     = *at;
  *at        = *end && *end != '\n' ? end + 1 : NULL;
  while (*field < stop && strchr(" \"\r", **field)) (*field)++;
  while (stop > *field && strchr(" \"\r", stop[-1])) stop--;
  return (size_t)(stop - *field);
}

/* Tells whether a field of n characters is a number. */
static int FieldNumber(const char *field, size_t n, double *value)
{
  char text[TABLE_SHOWN + 1], *end;

  if (!n || n > TABLE_SHOWN) return 0;
  memcpy(text, field, n);
  text[n] = 0;
  if (text[strspn(text, "0123456789+-.eE")]) return 0;
  *value = strtod(text, &end);
  return !*end && isfinite(*value);
}

/* Refuses a row of the file. */
static PetscErrorCode TableRefuse(const Table *table, const char *what, const char *field, size_t n)
{
  PetscFunctionBeginUser;
  PetscCall(RefuseInput(table->document->comm, "%s:%d: %.*s%s%s (table of %s)", table->name, table->line,
                        (int)PetscMin(n, TABLE_SHOWN), field ? field : "", field && n ? " " : "", what, table->path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the columns that the scene names in the head of the file. */
static PetscErrorCode TableHead(Table *table, const char *row)
{
  const char *const apart = RowSeparator(row);

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    const char *at    = row, *field;
    int         found = -1;

    if (!table->word[k]) continue;
    for (int c = 0; at && c < TABLE_COLUMNS && found < 0; c++) {
      const size_t n = NextField(apart, &at, &field);

      if (strlen(table->word[k]) == n && !strncmp(table->word[k], field, n)) found = c;
    }
    if (found < 0)
      PetscCall(TableRefuse(table, "is no column of the head of the file; allowed: one of its names, or its number",
                            table->word[k], strlen(table->word[k])));
    table->column[k] = found;
    table->word[k]   = NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a t that does not go on from the row before. */
static PetscErrorCode TableCheck(const Table *table, double t, const char *field, size_t n)
{
  PetscFunctionBeginUser;
  if (!table->rows && t != 0)
    PetscCall(TableRefuse(table, "is the first value of the table's first column; allowed: 0", field, n));
  if (table->rows && t <= table->before)
    PetscCall(TableRefuse(table, "does not increase from one row to the next; allowed: increasing values", field, n));
  if (table->over && t > 1)
    PetscCall(
      TableRefuse(table, "is beyond t = 1; allowed: values up to 1, or `end:` with the value that is t = 1", field, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes a row of the file: a head, a comment, an empty line or numbers. */
static PetscErrorCode TableRow(Table *table, const char *row)
{
  const char *const apart = RowSeparator(row);
  const char       *at = row, *field, *t_field = NULL;
  double            pair[2] = {0, 0}, number;
  size_t            n, t_length = 0;
  int               found[2] = {0, 0}, numbers = 0, fields = 0;

  PetscFunctionBeginUser;
  if (*row == '#' || !row[strspn(row, " \t\r")] || row[strspn(row, " \t\r")] == '\n')
    PetscFunctionReturn(PETSC_SUCCESS);
  for (int c = 0; at && c < TABLE_COLUMNS; c++, fields++) {
    n = NextField(apart, &at, &field);
    numbers += FieldNumber(field, n, &number);
    for (int k = 0; k < 2; k++)
      if (!table->word[k] && c == table->column[k]) found[k] = FieldNumber(field, n, &pair[k]) ? 1 : -1;
    if (c == table->column[0]) t_field = field, t_length = n;
  }
  if (!table->rows && !numbers) {
    PetscCall(TableHead(table, row));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int k = 0; k < 2; k++) {
    if (table->word[k])
      PetscCall(TableRefuse(table, "is named as a column, but the file has no head; allowed: its number, from 1",
                            table->word[k], strlen(table->word[k])));
    if (!found[k])
      PetscCall(TableRefuse(table, "the row has too few columns; allowed: those that the scene names", NULL, 0));
    if (found[k] < 0)
      PetscCall(
        TableRefuse(table,
                    "the row has a field that is no number; allowed: numbers such as 1.5e3, with a point, apart "
                    "by commas, semicolons or tabs",
                    NULL, 0));
  }
  pair[0] /= table->end;
  PetscCall(TableCheck(table, pair[0], t_field, t_length));
  table->before = pair[0];
  table->length +=
    (size_t)sprintf(table->text + table->length, "%s[%.17g, %.17g]", table->rows++ ? ", " : "[", pair[0], pair[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the rows of a file. */
static PetscErrorCode TableRows(Table *table, const char *text)
{
  size_t lines = 2;

  PetscFunctionBeginUser;
  for (const char *c = text; *c; c++) lines += *c == '\n';
  PetscCall(PetscMalloc1(lines * TABLE_PAIR, &table->text));
  if (!strncmp(text, "\xef\xbb\xbf", 3)) text += 3; /* the mark of UTF-8, which spreadsheets write */
  for (table->line = 1; *text; table->line++) {
    PetscCall(TableRow(table, text));
    text += strcspn(text, "\n");
    text += *text == '\n';
  }
  if (table->rows < 2)
    PetscCall(TableRefuse(table, "the table ends with less than two rows; allowed: two or more", NULL, 0));
  strcpy(table->text + table->length, "]");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a column, which is a number from 1 or a name of the head. */
static PetscErrorCode TableColumn(Table *table, const char *key, int k)
{
  const Node node = NodeChild(table->node, key);
  long       column;

  PetscFunctionBeginUser;
  table->column[k] = k;
  if (!node) PetscFunctionReturn(PETSC_SUCCESS);
  if (node->kind != NODE_SCALAR || !*node->text ||
      (NodeInteger(node, &column) && (column < 1 || column > TABLE_COLUMNS)))
    PetscCall(DocumentRefuseNode(table->document, node, table->path,
                                 "%s is no column; allowed: its number, from 1, or its name in the head of the file",
                                 key));
  if (NodeInteger(node, &column))
    table->column[k] = (int)column - 1;
  else
    table->word[k] = node->text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the map in the scene that names a file. */
static PetscErrorCode TableMap(Table *table, const char *scene_file)
{
  static const char *const keys[] = {"csv", "column", "over", "end"};
  const Node               csv = NodeChild(table->node, "csv"), end = NodeChild(table->node, "end");
  const char              *slash = strrchr(scene_file, '/');

  PetscFunctionBeginUser;
  for (int i = 0; i < table->node->n; i++) {
    int known = 0;

    for (int k = 0; k < (table->over ? 4 : 3); k++) known = known || !strcmp(table->node->key[i], keys[k]);
    if (!known)
      PetscCall(DocumentRefuseNode(table->document, table->node->child[i], table->path,
                                   "unknown key %.40s; allowed: csv, column, over%s", table->node->key[i],
                                   table->over ? ", end" : ""));
  }
  if (!csv || csv->kind != NODE_SCALAR || !*csv->text || strlen(csv->text) > 1000)
    PetscCall(DocumentRefuseNode(table->document, table->node, table->path,
                                 "csv is missing; allowed: {csv: FILE, column: 2}, with the name of a file"));
  if (end && (!NodeReal(end, &table->end) || table->end <= 0))
    PetscCall(DocumentRefuseNode(table->document, end, table->path,
                                 "end is no number above 0; allowed: the value of the first column that is t = 1"));
  PetscCall(TableColumn(table, "over", 0));
  PetscCall(TableColumn(table, "column", 1));
  snprintf(table->name, sizeof table->name, "%.*s%s", *csv->text == '/' || !slash ? 0 : (int)(slash - scene_file) + 1,
           scene_file, csv->text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts the numbers of a file in the place of the map that names it. */
static PetscErrorCode ReadTable(Document *document, Node node, const char *path, int over, const char *scene_file)
{
  Table          table = {.document = document, .node = node, .path = path, .end = 1, .over = over};
  char          *text  = NULL;
  size_t         length;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  PetscCall(TableMap(&table, scene_file));
  code = DocumentReadFile(document->comm, table.name, "a table of comma-separated values", &text, &length);
  if (!code && strlen(text) != length)
    code = RefuseInput(document->comm,
                       "%s: has a zero character; allowed: a table of comma-separated values (table of "
                       "%s)",
                       table.name, path);
  if (!code) code = TableRows(&table, text);
  if (!code) code = DocumentReplace(document, node, path, table.text);
  PetscCall(PetscFree(text));
  PetscCall(PetscFree(table.text));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the tables of a node and of all nodes below it. */
static PetscErrorCode ReadTablesBelow(Document *document, Node node, const char *path, const char *scene_file)
{
  const SchemaKey *key = SchemaKeyFind(path);
  char             below[KEY_PATH_LENGTH];

  PetscFunctionBeginUser;
  if (key && key->type & (HISTORY | TABLE)) {
    if (node->kind == NODE_MAP) PetscCall(ReadTable(document, node, path, (key->type & HISTORY) != 0, scene_file));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int i = 0; i < node->n; i++) {
    if (node->kind == NODE_MAP)
      KeyPathJoin(below, path, node->key[i]);
    else
      KeyPathJoinIndex(below, path, i);
    PetscCall(ReadTablesBelow(document, node->child[i], below, scene_file));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SceneReadTables - reads the tables that stand in files of their own into the document.

  Collective

  Input Parameters:
+ document - the document, before SchemaCheck()
- file     - the scene file, in whose folder relative names start

  Note:
  It refuses a file that cannot be read, and a row that is no row of a table, with file and line.
@*/
PetscErrorCode SceneReadTables(Document *document, const char *file)
{
  PetscFunctionBeginUser;
  PetscCall(ReadTablesBelow(document, document->root, "", file));
  PetscFunctionReturn(PETSC_SUCCESS);
}
