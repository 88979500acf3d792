/* The one table of what a scene may say, a line per key: validation, -set, the scene reference and "not available yet"
   all come from it. For schema.c; the other parts ask schema.h. */
#pragma once
#include <stddef.h>

/* What a key may hold; a key that may hold one of several has several bits. */
typedef enum {
  REAL     = 1 << 0,
  INTEGER  = 1 << 1,
  BOOLEAN  = 1 << 2,
  CHOICE   = 1 << 3, /* one of .values */
  TEXT     = 1 << 4,
  NAME     = 1 << 5, /* becomes part of file names and column heads */
  POINT    = 1 << 6, /* as many reals as the scene has dimensions */
  POINTS   = 1 << 7, /* two points */
  REALS    = 1 << 8, /* strictly increasing */
  TEXTS    = 1 << 9,
  CHOICES  = 1 << 10,
  HISTORY  = 1 << 11, /* [t, factor] pairs */
  MAP      = 1 << 12,
  LIST     = 1 << 13, /* of maps */
  FREE     = 1 << 14, /* a map whose keys are not ours */
  FILENAME = 1 << 15, /* a path */
} ValueType;

/* The longest name of the scene, a pair or a probe, in characters. Names of pairs are parts of paths in results.h5, for
   which report/fields.c has 512 characters; a scene's name is one of a directory, of at most 255. */
#define SCHEMA_LONGEST_NAME 100
/* The longest name of a group of the mesh, in characters. gmsh 4.8 cuts longer ones off when it writes a mesh. */
#define SCHEMA_LONGEST_GROUP 127

enum { REQUIRED = 1, SOLID = 2 /* only in 3D scenes */ };

typedef struct {
  const char *path; /* "*": any index of a list; "a|b": key a or key b */
  int         type, flags;
  const char
    *values; /* CHOICE, CHOICES: words apart by " | ", in the order of the enumeration that scene.h has for them */
  const char *range; /* REAL, INTEGER, REALS: interval of a value; LIST: of the number of entries */
  const char *unit;
  const char *preset; /* default */
  const char *now;    /* the only values available yet, as .values; "": none */
  const char *help;
} SchemaKey;

extern const SchemaKey SchemaKeys[];
extern const int       SchemaKeysCount;

const SchemaKey *SchemaKeyFind(const char *path);                       /* NULL: no key of ours */
int              SchemaKeyIsChild(const SchemaKey *, const char *path); /* belongs to the map at path */
const char      *SchemaKeyName(const SchemaKey *); /* last component of its path, "a|b" where that stands for two */
int              WordFind(const char *words, const char *apart, const char *text, size_t n);
