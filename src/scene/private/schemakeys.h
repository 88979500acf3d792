/* The table of all keys of a scene, one entry per key. The validation, -set, the scene reference and the message "not
   available yet" all come from this table. SchemaKeyFind() finds the entry of a path, SchemaKeyIsChild() tells whether
   a key belongs to a map, SchemaKeyName() gives its last word, and WordFind() finds a word in a list of words. For
   schema.c only; other parts use schema.h. */
#pragma once
#include <stddef.h>

/* The types of a value. A key that allows several types has several bits. */
typedef enum {
  REAL     = 1 << 0,
  INTEGER  = 1 << 1,
  BOOLEAN  = 1 << 2,
  CHOICE   = 1 << 3, /* one word of .values */
  TEXT     = 1 << 4,
  NAME     = 1 << 5, /* a text that becomes part of file names and column heads */
  POINT    = 1 << 6, /* as many reals as the scene has dimensions */
  POINTS   = 1 << 7, /* two points */
  REALS    = 1 << 8, /* a strictly increasing list of reals */
  TEXTS    = 1 << 9,
  CHOICES  = 1 << 10, /* a list of words of .values */
  HISTORY  = 1 << 11, /* a list of pairs [t, factor] */
  MAP      = 1 << 12,
  LIST     = 1 << 13, /* a list of maps */
  FREE     = 1 << 14, /* a map whose keys are not in the table */
  FILENAME = 1 << 15, /* a path of a file */
  FORMULA  = 1 << 16, /* an expression; with POINT, each of its entries may be one */
  PAIRS    = 1 << 17, /* a list of pairs of reals */
  TABLE    = 1 << 18, /* a list of pairs [a, b], the a increasing from 0 */
  NUMBERS  = 1 << 19, /* a list of reals in any order */
} ValueType;

/* The longest name of the scene, a pair or a probe, in characters. The name of a pair becomes part of a path in
   results.vtkhdf, for which report/fields.c has 512 characters. The name of the scene becomes the name of a directory,
   which has at most 255 characters. */
#define SCHEMA_LONGEST_NAME 100
/* The longest name of a group of the mesh, in characters. gmsh 4.8 cuts longer names off when it writes a mesh. */
#define SCHEMA_LONGEST_GROUP 127

/* The flags of a key. A REQUIRED key must be in its map. A SOLID key is allowed in 3D scenes only. */
enum { REQUIRED = 1, SOLID = 2 };

typedef struct {
  /* The path of the key. "*" stands for any index of a list, and "a|b" stands for key a or key b. */
  const char *path;
  int         type, flags;
  /* The allowed words of CHOICE and CHOICES, with " | " between them, in the order of the enumeration that scene.h has
     for them. */
  const char *values;
  const char *range; /* the interval of a REAL, an INTEGER or each of REALS; of a LIST, that of its number of entries */
  const char *unit;
  const char *preset; /* the default */
  const char *now;    /* the only values that are available yet, written as .values; "" if none is */
  const char *help;
} SchemaKey;

extern const SchemaKey SchemaKeys[];
extern const int       SchemaKeysCount;

const SchemaKey *SchemaKeyFind(const char *path);
int              SchemaKeyIsChild(const SchemaKey *, const char *path);
const char      *SchemaKeyName(const SchemaKey *);
int              WordFind(const char *words, const char *apart, const char *text, size_t n);
