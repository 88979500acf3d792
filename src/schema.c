#include "schema.h"
#include "refusal.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* What a key may hold; a key that may hold one of several has several bits. */
typedef enum {
  REAL    = 1 << 0,
  INTEGER = 1 << 1,
  BOOLEAN = 1 << 2,
  CHOICE  = 1 << 3, /* one of .values */
  TEXT    = 1 << 4,
  NAME    = 1 << 5, /* becomes part of file names and column heads */
  POINT   = 1 << 6, /* as many reals as the scene has dimensions */
  POINTS  = 1 << 7, /* two points */
  REALS   = 1 << 8, /* strictly increasing */
  TEXTS   = 1 << 9,
  CHOICES = 1 << 10,
  HISTORY = 1 << 11, /* [t, factor] pairs */
  MAP     = 1 << 12,
  LIST    = 1 << 13, /* of maps */
  FREE    = 1 << 14, /* a map whose keys are not ours */
} ValueType;

enum { REQUIRED = 1, SOLID = 2 /* only in 3D scenes */ };

typedef struct {
  const char *path; /* "*": any index of a list; "a|b": key a or key b */
  int         type, flags;
  const char *values; /* CHOICE, CHOICES: words apart by " | ", in the order of the enumeration that scene.h has for them */
  const char *range;  /* REAL, INTEGER, REALS: interval of a value; LIST: of the number of entries */
  const char *unit;
  const char *preset; /* default */
  const char *now;    /* the only values available yet, as .values; "": none */
  const char *help;
} SchemaKey;

/* One line per key, not in columns. */
// clang-format off
#define MOTION_KEYS(tool) \
  {tool ".motion", LIST, .help = "prescribed motions, summed"}, \
  {tool ".motion.*", MAP, .help = "displacement or rotation components"}, \
  {tool ".motion.*.ux|uy", REAL, .unit = "length", .help = "displacement, times the history"}, \
  {tool ".motion.*.uz", REAL, SOLID, .unit = "length"}, \
  {tool ".motion.*.rx|ry", REAL, SOLID, .unit = "degrees", .help = "rotation, times the history"}, \
  {tool ".motion.*.rz", REAL, .unit = "degrees"}, \
  {tool ".motion.*.history", HISTORY, .preset = "[[0, 0], [1, 1]]"}

static const SchemaKey Schema[] = {
  {"name", NAME, .help = "of the run and its results; default: the scene file's name"},
  {"mesh", MAP, REQUIRED, .help = "where the mesh comes from"},
  {"mesh.file", TEXT, REQUIRED, .help = ".geo (gmsh makes the mesh) or .msh (version 4.1)"},
  {"mesh.order", INTEGER, .range = "[1, 2]", .help = "of the elements; default: 1 for a .geo, its own for a .msh"},
  {"mesh.parameters", FREE, .help = "numbers and texts handed to the .geo"},
  {"geometry", CHOICE, .values = "solid | plane_strain | axisymmetric", .preset = "solid", .help = "axisymmetric: x = r, y = z"},
  {"kinematics", CHOICE, .values = "small | finite", .preset = "finite"},
  {"bodies", LIST, REQUIRED, .range = "[1, inf)"},
  {"bodies.*", MAP, .help = "a deformable body or a rigid tool"},
  {"bodies.*.volume", TEXT, .help = "physical volume (2D: surface) of a deformable body; needs material"},
  {"bodies.*.material", MAP, .help = "elastic law"},
  {"bodies.*.material.law", CHOICE, REQUIRED, .values = "linear | svk | neo_hookean", .help = "linear only with kinematics small"},
  {"bodies.*.material.E", REAL, REQUIRED, .range = "(0, inf)", .unit = "stress", .help = "Young's modulus"},
  {"bodies.*.material.nu", REAL, REQUIRED, .range = "(-1, 0.5)", .help = "Poisson's ratio"},
  {"bodies.*.formulation", CHOICE, .values = "full | enhanced | fbar", .preset = "full", .now = "full"},
  {"bodies.*.surface", TEXT, .help = "physical surface of a rigid tool; needs rigid"},
  {"bodies.*.rigid", MAP, .help = "makes the surface a meshed rigid tool"},
  {"bodies.*.rigid.point", POINT, .unit = "length", .help = "that rotations turn about; default: the origin"},
  MOTION_KEYS("bodies.*.rigid"),
  {"supports", LIST, .help = "surfaces held at 0"},
  {"supports.*", MAP, .help = "at least one component"},
  {"supports.*.surface", TEXT, REQUIRED, .help = "physical surface"},
  {"supports.*.ux|uy", REAL, .unit = "length", .help = "0: the component is held"},
  {"supports.*.uz", REAL, SOLID, .unit = "length"},
  {"loads", LIST, .help = "each a value times its history, of one kind"},
  {"loads.*", MAP, .help = "displacement components, pressure, traction or body_force"},
  {"loads.*.surface", TEXT, .help = "where a displacement, pressure or traction acts"},
  {"loads.*.volume", TEXT, .help = "where a body force acts"},
  {"loads.*.ux|uy",REAL, .unit = "length", .help = "imposed displacement"},
  {"loads.*.uz", REAL, SOLID, .unit = "length"},
  {"loads.*.pressure", REAL, .unit = "stress", .help = "against the outward normal"},
  {"loads.*.follower", BOOLEAN, .preset = "false", .help = "the pressure follows the deformed face"},
  {"loads.*.traction", POINT, .unit = "force per reference area"},
  {"loads.*.body_force", POINT, .unit = "force per reference volume"},
  {"loads.*.history", HISTORY, .preset = "[[0, 0], [1, 1]]", .help = "factor over the load parameter t"},
  {"contact", LIST, .help = "pairs of surfaces"},
  {"contact.*", MAP, .help = "one pair"},
  {"contact.*.name", NAME,REQUIRED, .help = "that probes and results use"},
  {"contact.*.slave", TEXT, REQUIRED, .help = "physical surface of a deformable body"},
  {"contact.*.master", TEXT | MAP, REQUIRED, .help = "physical surface, or an analytic one"},
  {"contact.*.master.plane|cylinder|sphere", MAP, .now = ""},
  {"contact.*.master.plane.point", POINT, REQUIRED, .unit = "length"},
  {"contact.*.master.plane.normal", POINT, REQUIRED, .help = "out of the obstacle"},
  {"contact.*.master.cylinder.point", POINT, REQUIRED, .unit = "length"},
  {"contact.*.master.cylinder.axis", POINT, REQUIRED | SOLID, .help = "its direction"},
  {"contact.*.master.sphere.centre", POINT, REQUIRED, .unit = "length"},
  {"contact.*.master.cylinder|sphere.radius", REAL, REQUIRED, .range = "(0, inf)", .unit = "length"},
  {"contact.*.master.cylinder|sphere.side", CHOICE, .values = "outside | inside", .preset = "outside"},
  MOTION_KEYS("contact.*.master.plane|cylinder|sphere"),
  {"contact.*.smoother", CHOICE, .values = "facet | diffuse", .preset = "facet", .now = "facet"},
  {"contact.*.formulation", CHOICE, .values = "node_to_surface | surface_to_surface", .preset = "node_to_surface", .now = "node_to_surface"},
  {"contact.*.offset", CHOICE, .values = "held | live", .preset = "held", .help = "of surface_to_surface"},
  {"contact.*.degree", CHOICE, .values = "4 | 2", .preset = "4", .help = "of the diffuse fit"},
  {"contact.*.support", REAL, .range = "(0, inf)", .unit = "spacings", .help = "radius of the diffuse fit; default by dimension and degree"},
  {"contact.*.weight", REAL, .range = "[3, inf)", .help = "exponent of the diffuse fit; default by dimension and degree"},
  {"contact.*.frame", CHOICE, .values = "local | global", .preset = "local", .help = "of the diffuse fit"},
  {"contact.*.derivatives", CHOICE, .values = "full | diffuse", .preset = "full", .help = "diffuse: the cheap tangent"},
  {"contact.*.feature_angle", REAL, .range = "(0, 180]", .unit = "degrees", .preset = "45", .help = "lists end at sharper edges"},
  {"contact.*.symmetry", TEXTS, .help = "planar surfaces beyond which the model goes on as its mirror image"},
  {"contact.*.initial_overlap", CHOICE, .values = "refuse | resolve | ramp | ignore", .preset = "refuse", .now = "refuse"},
  {"contact.*.stabilise", BOOLEAN, .preset = "false", .now = "false"},
  {"contact.*.penalty", MAP, .help = "force per penetration and area, and its adjustment"},
  {"contact.*.penalty.initial", REAL | CHOICE, .values = "auto", .range = "(0, inf)", .unit = "force per length and area", .preset = "auto"},
  {"contact.*.penalty.scale", REAL, .range = "(0, inf)", .preset = "1", .help = "factor on the automatic penalty"},
  {"contact.*.penalty.adjust", BOOLEAN, .preset = "false", .now = "false", .help = "needs g_min, g_max and unit"},
  {"contact.*.penalty.when", CHOICE, .values = "step | converged", .preset = "converged"},
  {"contact.*.penalty.g_min|g_max", REAL, .range = "(0, inf)", .unit = "unit", .help = "window of the penetration"},
  {"contact.*.penalty.unit",CHOICE, .values = "length | spacing"},
  {"contact.*.penalty.clamp", REAL, .range = "(1, inf)", .preset = "100", .help = "largest factor of one adjustment"},
  {"contact.*.penalty.range", REAL, .range = "(1, inf)", .preset = "1e4", .help = "largest factor away from the automatic penalty"},
  {"stepping", MAP, .help = "load steps"},
  {"stepping.control", CHOICE, .values = "fixed | iterations | contact", .preset = "iterations", .now = "fixed | iterations"},
  {"stepping.initial", REAL, .range = "(0, 1]", .preset = "0.1", .help = "first step of the load parameter"},
  {"stepping.N_c", INTEGER, .range = "[1, inf)", .unit = "nodes", .help = "new contact per step; not with N_c_fraction"},
  {"stepping.N_c_fraction", REAL, .range = "(0, 1]", .help = "new contact per step, of the slave area"},
  {"stepping.prediction", CHOICE, .values = "converged | tangent", .preset = "converged"},
  {"stepping.dt_min", REAL, .range = "(0, 1]", .preset = "1e-5", .help = "smallest step before the run gives up"},
  {"stepping.dt_max", REAL, .range = "(0, 1]", .preset = "1"},
  {"stepping.growth", REAL, .range = "[1, inf)", .preset = "4", .help = "largest factor from one step to the next"},
  {"stepping.at", REALS, .range = "(0, 1]", .help = "load parameters that steps must land on"},
  {"solver", MAP, .help = "linear and nonlinear solver"},
  {"solver.type", CHOICE, .values = "direct | iterative | auto", .preset = "auto", .now = "direct | auto"},
  {"solver.tolerance", REAL, .range = "(0, 1)", .preset = "1e-8", .help = "residual over reference force"},
  {"solver.max_iterations", INTEGER, .range = "[1, 10000]", .preset = "30", .help = "of Newton's method in one solve"},
  {"probes", LIST, .help = "scalars for steps.csv and summary.json"},
  {"probes.*",MAP, .help = "of exactly one kind"},
  {"probes.*.name", NAME, REQUIRED, .help = "its column in steps.csv"},
  {"probes.*.reaction", TEXT, .help = "force on a surface through supports and imposed displacements; needs component"},
  {"probes.*.contact_force", TEXT, .help = "force of a pair on its master; needs component"},
  {"probes.*.displacement", POINT, .unit = "length", .help = "of the node at this reference point; needs component"},
  {"probes.*.distance", POINTS, .unit = "length", .help = "of the nodes at two reference points"},
  {"probes.*.gap", TEXT, .help = "of a pair's slave node; needs at: a point"},
  {"probes.*.contact_edge", TEXT, .help = "end of a pair's contact zone along axis, towards side, at a coordinate"},
  {"probes.*.pressure_max|pressure_mean", TEXT, .help = "over a pair's nodes"},
  {"probes.*.pressure_deviation", TEXT, .unit = "per cent", .help = "from a pair's mean pressure"},
  {"probes.*.component", CHOICE, .values = "x | y | z"},
  {"probes.*.body",TEXT, .help = "volume of the node, where two bodies have one at the point"},
  {"probes.*.change", BOOLEAN, .preset = "false", .help = "distance: minus the reference distance"},
  {"probes.*.at", POINT | MAP, .unit = "length", .help = "gap: a point; contact_edge, pressure_max: one reference coordinate, such as {z: 100}"},
  {"probes.*.at.x|y", REAL, .unit = "length"},
  {"probes.*.at.z", REAL, SOLID, .unit = "length"},
  {"probes.*.axis", CHOICE, .values = "x | y | z"},
  {"probes.*.side", CHOICE, .values = "min | max"},
  {"probes.*.measure", CHOICE, .values = "max | rms", .preset = "max"},
  {"probes.*.excluding",REAL, .range = "(0, inf)", .unit = "face sizes", .help = "leaves out nodes that near to a free edge"},
  {"probes.*.only", REAL, .range = "(0, inf)", .unit = "face sizes", .help = "takes only nodes that near to a free edge"},
  {"probes.*.absolute", BOOLEAN, .preset = "false"},
  {"probes.*.factor",REAL, .preset = "1"},
  {"output", MAP, .help = "what is written"},
  {"output.every",INTEGER, .range = "[0, inf)", .unit = "steps", .preset = "1", .help = "0: only the last state"},
  {"output.fields", CHOICES, .values = "displacement | stress | contact", .help = "default: all"},
  {"output.checkpoint", INTEGER, .range = "[0, inf)", .unit = "steps", .preset = "0", .now = "0"},
  {"petsc", FREE, .help = "PETSc options without the dash, such as snes_monitor"},
};
// clang-format on

enum { SCHEMA_KEYS = sizeof Schema / sizeof Schema[0] };

/* ---- paths ---- */

/* Length of the component that p starts with, up to the next dot or the end. */
static size_t ComponentLength(const char *p)
{
  return strcspn(p, ".");
}

static int ComponentIsIndex(const char *p)
{
  const size_t n = ComponentLength(p);

  return n > 0 && n < 10 && strspn(p, "0123456789") >= n;
}

/* Is one of the words of a list (apart by the characters of apart) the n characters at text? Returns its place from 0, or -1. */
static int WordFind(const char *words, const char *apart, const char *text, size_t n)
{
  for (int i = 0; words && *words; i++) {
    const size_t length = strcspn(words, apart);

    if (length == n && !strncmp(words, text, n)) return i;
    words += length;
    words += strspn(words, apart);
  }
  return -1;
}

/* Does the path match the first n characters of the pattern? */
static int PatternMatches(const char *pattern, size_t n, const char *path)
{
  const char *end = pattern + n;

  while (pattern < end && *path) {
    const size_t np = ComponentLength(pattern), nt = ComponentLength(path);
    char         component[80];

    snprintf(component, sizeof component, "%.*s", (int)np, pattern);
    if (!strcmp(component, "*") ? !ComponentIsIndex(path) : WordFind(component, "|", path, nt) < 0) return 0;
    pattern += np;
    path += nt;
    if (pattern < end)
      pattern++;
    else
      return !*path;
    if (*path)
      path++;
    else
      return 0;
  }
  return pattern >= end && !*path;
}

/* Length of the part of a pattern before its last component: its parent's pattern. */
static size_t PatternParent(const char *pattern)
{
  const char *dot = strrchr(pattern, '.');

  return dot ? (size_t)(dot - pattern) : 0;
}

static const char *PatternKey(const char *pattern)
{
  const char *dot = strrchr(pattern, '.');

  return dot ? dot + 1 : pattern;
}

static int SchemaIsChild(const SchemaKey *key, const char *path)
{
  return PatternMatches(key->path, PatternParent(key->path), path);
}

static const SchemaKey *SchemaFind(const char *path)
{
  for (int i = 0; i < SCHEMA_KEYS; i++) {
    if (PatternMatches(Schema[i].path, strlen(Schema[i].path), path)) return &Schema[i];
  }
  return NULL;
}

/* PathJoin - parent.key, or key alone below the root, into path[PATH_LENGTH]. Not collective. */
void PathJoin(char path[PATH_LENGTH], const char *parent, const char *key)
{
  snprintf(path, PATH_LENGTH, "%.*s%s%.*s", PATH_LENGTH / 2, parent, *parent ? "." : "", PATH_LENGTH / 2 - 2, key);
}

static void PathJoinIndex(char *path, const char *parent, int index)
{
  char key[16];

  snprintf(key, sizeof key, "%d", index);
  PathJoin(path, parent, key);
}

/* ---- nodes ---- */

/* The child that the first component of path names; NULL if there is none. */
static Node NodeChild(Node node, const char *path)
{
  const size_t n = ComponentLength(path);

  if (node->kind == NODE_LIST && ComponentIsIndex(path) && atoi(path) < node->n) return node->child[atoi(path)];
  for (int i = 0; node->kind == NODE_MAP && i < node->n; i++) {
    if (strlen(node->key[i]) == n && !strncmp(node->key[i], path, n)) return node->child[i];
  }
  return NULL;
}

/* NodeFind - the value at a path below a node, list indices included; NULL if there is none. Not collective. */
Node NodeFind(Node node, const char *path)
{
  while (node && *path) {
    node = NodeChild(node, path);
    path += ComponentLength(path);
    if (*path) path++;
  }
  return node;
}

/* NodeReal - the value of a scalar that is a number in decimal notation, from its first character to its last; no hexadecimal, nan, inf.

   Not collective. Returns 0 where it is not one (or too large for a double). The C locale is the program's. */
int NodeReal(Node node, double *value)
{
  char *end;

  if (node->kind != NODE_SCALAR || !node->plain || !*node->text || node->text[strspn(node->text, "0123456789+-.eE")]) return 0;
  *value = strtod(node->text, &end);
  return !*end && isfinite(*value);
}

static int NodeInteger(Node node, long *value)
{
  char *end;

  if (node->kind != NODE_SCALAR || !node->plain || !*node->text || node->text[strspn(node->text, "0123456789+-")]) return 0;
  errno  = 0;
  *value = strtol(node->text, &end, 10);
  return !*end && !errno;
}

static int NodeBoolean(Node node, int *value)
{
  *value = node->kind == NODE_SCALAR && node->plain && !strcmp(node->text, "true");
  return *value || (node->kind == NODE_SCALAR && node->plain && !strcmp(node->text, "false"));
}

/* ---- refusals ---- */

static const char *DocumentWhereNode(Document *document, Node node, const char *path)
{
  if (!node->set)
    snprintf(document->where, sizeof document->where, "%.400s:%d%s%s", document->file, node->line, *path ? ": " : "", path);
  else if (!strcmp(node->set, path))
    snprintf(document->where, sizeof document->where, "-set %s", path);
  else
    snprintf(document->where, sizeof document->where, "-set %.400s: %s", node->set, path);
  return document->where;
}

/* DocumentWhere - "FILE:LINE: PATH", the line being that of the path or of its nearest ancestor in the file; "-set KEY" in place of file and
   line if it came from there. Valid until the next call. Not collective. */
const char *DocumentWhere(Document *document, const char *path)
{
  Node        node = document->root, next = node;
  const char *rest = path;

  while (*rest && (next = NodeChild(node, rest))) {
    node = next;
    rest += ComponentLength(rest);
    if (*rest) rest++;
  }
  return DocumentWhereNode(document, node, path);
}

static void DocumentRefuseList(Document *document, const char *where, const char *format, va_list arguments) __attribute__((noreturn));
static void DocumentRefuseList(Document *document, const char *where, const char *format, va_list arguments)
{
  char text[1024];

  vsnprintf(text, sizeof text, format, arguments);
  (void)!RefuseInput(document->comm, "%s: %s", where, text);
  exit(EXIT_WRONG_INPUT);
}

/* DocumentRefuse - refuses the value at a path, which need not be there. Collective, does not return; printf's format. */
void DocumentRefuse(Document *document, const char *path, const char *format, ...)
{
  va_list arguments;

  va_start(arguments, format);
  DocumentRefuseList(document, DocumentWhere(document, path), format, arguments);
}

/* DocumentRefuseNode - as DocumentRefuse(), of a node that need not be in the tree yet. */
void DocumentRefuseNode(Document *document, Node node, const char *path, const char *format, ...)
{
  va_list arguments;

  va_start(arguments, format);
  DocumentRefuseList(document, DocumentWhereNode(document, node, path), format, arguments);
}

/* ---- what a key allows, in words ---- */

static void Append(char *text, size_t size, const char *apart, const char *more)
{
  const size_t n = strlen(text);

  snprintf(text + n, size - n, "%s%s", n ? apart : "", more);
}

static void SchemaAllowed(const SchemaKey *key, char *text, size_t size)
{
  static const struct {
    int         type;
    const char *words;
  } Types[] = {
    {REAL,    "a number"                                                           },
    {INTEGER, "an integer"                                                         },
    {BOOLEAN, "true | false"                                                       },
    {TEXT,    "a name"                                                             },
    {NAME,    "a name (letters, digits, _ - .)"                                    },
    {POINT,   "[x, y, z] (2D: [x, y])"                                             },
    {POINTS,  "[[x, y, z], [x, y, z]] (2D: [[x, y], [x, y]])"                      },
    {REALS,   "an increasing list of numbers"                                      },
    {TEXTS,   "a list of names"                                                    },
    {CHOICES, "a list of"                                                          },
    {HISTORY, "[[t, factor], ...], at least two, t increasing from 0 within [0, 1]"},
    {MAP,     "a map"                                                              },
    {LIST,    "a list of maps"                                                     },
    {FREE,    "a map of plain values"                                              },
  };

  text[0] = 0;
  if (key->type & CHOICE) Append(text, size, " | ", key->values);
  for (size_t i = 0; i < sizeof Types / sizeof Types[0]; i++) {
    if (key->type & Types[i].type) Append(text, size, " | ", Types[i].words);
  }
  if (key->type & CHOICES) Append(text, size, " ", key->values);
  if (key->range) Append(text, size, key->type & LIST ? ", entries in " : " in ", key->range);
  if (key->unit) Append(text, size, ", ", key->unit);
}

static void SchemaRefuse(Document *document, const SchemaKey *key, Node node, const char *path, const char *wrong) __attribute__((noreturn));
static void SchemaRefuse(Document *document, const SchemaKey *key, Node node, const char *path, const char *wrong)
{
  static const char *const Kinds[] = {"", "this list ", "this map "};
  char                     allowed[400];

  SchemaAllowed(key, allowed, sizeof allowed);
  if (node->kind == NODE_SCALAR && node->plain && !*node->text) DocumentRefuseNode(document, node, path, "has no value; allowed: %s", allowed);
  if (node->kind == NODE_SCALAR)
    DocumentRefuseNode(document, node, path, "%s%.100s%s %s; allowed: %s", node->plain ? "" : "\"", node->text, node->plain ? "" : "\"", wrong, allowed);
  DocumentRefuseNode(document, node, path, "%s%s; allowed: %s", Kinds[node->kind], wrong, allowed);
}

/* ---- checks of one value: NULL, or what is wrong with it ---- */

static const char WrongType[] = "has the wrong type", OutOfRange[] = "is out of range";

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

  return *text && *text != '.' && *text != '-' && !text[strspn(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.")] ? NULL
                                                                                                                                           : "is no name";
}

static const char *CheckText(Node node)
{
  const int null = node->plain && (!*node->text || !strcmp(node->text, "~") || !strcmp(node->text, "null"));

  if (null || !*node->text) return "is empty";
  for (const char *c = node->text; *c; c++) {
    if ((unsigned char)*c < ' ') return "has a control character";
  }
  return NULL;
}

/* The reason of the last type that does not fit, unless one does. */
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
  if (type & TEXT) wrong = CheckText(node);
  return wrong;
}

static const char *CheckPoint(Node node, const char *range)
{
  const char *wrong;

  if (node->kind != NODE_LIST || node->n < 2 || node->n > 3) return WrongType;
  for (int i = 0; i < node->n; i++) {
    if ((wrong = CheckReal(node->child[i], range))) return wrong;
  }
  return NULL;
}

static const char *CheckHistory(Node node)
{
  double t, before = 0, factor;

  if (node->n < 2) return "has less than two points";
  for (int i = 0; i < node->n; i++) {
    Node pair = node->child[i];

    if (pair->kind != NODE_LIST || pair->n != 2 || !NodeReal(pair->child[0], &t) || !NodeReal(pair->child[1], &factor)) return WrongType;
    if (t < 0 || t > 1) return "has a t outside [0, 1]";
    if (!i && t != 0) return "does not start at t = 0";
    if (i && t <= before) return "is not increasing in t";
    before = t;
  }
  return NULL;
}

static const char *CheckEntries(const SchemaKey *key, Node node)
{
  const int   type = key->type & REALS ? REAL : key->type & TEXTS ? TEXT : CHOICE;
  const char *wrong;
  double      value, before = -HUGE_VAL;

  for (int i = 0; i < node->n; i++) {
    if (node->child[i]->kind != NODE_SCALAR) return WrongType;
    if ((wrong = CheckScalar(key, type, node->child[i]))) return wrong;
    if (key->type & (TEXTS | CHOICES)) {
      for (int j = 0; j < i; j++) {
        if (!strcmp(node->child[i]->text, node->child[j]->text)) return "names something twice";
      }
    } else if (NodeReal(node->child[i], &value)) {
      if (value <= before) return "is not increasing";
      before = value;
    }
  }
  return NULL;
}

/* A list of plain values, pairs or points; lists of maps are SchemaCheckList()'s. */
static const char *CheckList(const SchemaKey *key, Node node)
{
  if (key->type & POINT) return CheckPoint(node, key->range);
  if (key->type & POINTS) return node->n == 2 && !CheckPoint(node->child[0], NULL) && !CheckPoint(node->child[1], NULL) ? NULL : WrongType;
  if (key->type & HISTORY) return CheckHistory(node);
  if (key->type & (REALS | TEXTS | CHOICES)) return CheckEntries(key, node);
  return WrongType;
}

/* ---- the walk over the document ---- */

/* Edit distance with a bounded row: keys longer than that are not near to any of ours. */
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

static void SchemaRefuseUnknown(Document *document, Node node, const char *parent, const char *path, const char *unknown) __attribute__((noreturn));
static void SchemaRefuseUnknown(Document *document, Node node, const char *parent, const char *path, const char *unknown)
{
  char        allowed[600] = "", word[80];
  const char *nearest      = "";
  int         least = 1000, length = 0;

  for (int i = 0; i < SCHEMA_KEYS; i++) {
    if (!SchemaIsChild(&Schema[i], parent)) continue;
    for (const char *key = PatternKey(Schema[i].path); *key;) {
      const size_t n = strcspn(key, "|");
      const int    d = WordDistance(unknown, strlen(unknown), key, n);

      snprintf(word, sizeof word, "%.*s", (int)n, key);
      Append(allowed, sizeof allowed, ", ", word);
      if (d < least) {
        least   = d;
        nearest = key;
        length  = (int)n;
      }
      key += n + (key[n] == '|');
    }
  }
  DocumentRefuseNode(document, node, path, "unknown key, did you mean %.*s? allowed: %s", length, nearest, allowed);
}

static void SchemaRefuseMissing(Document *document, const SchemaKey *key, Node node, const char *path)
{
  char allowed[400], missing[PATH_LENGTH];

  SchemaAllowed(key, allowed, sizeof allowed);
  PathJoin(missing, path, PatternKey(key->path));
  DocumentRefuseNode(document, node, missing, "is missing; allowed: %s", allowed);
}

static void SchemaCheckFree(Document *document, Node node, const char *path)
{
  char below[PATH_LENGTH];

  for (int i = 0; i < node->n; i++) {
    PathJoin(below, path, node->key[i]);
    if (!*node->key[i] || strpbrk(node->key[i], " \t\n="))
      DocumentRefuseNode(document, node->child[i], below, "is no name of a parameter or option; allowed: no blanks, no =");
    if (node->child[i]->kind != NODE_SCALAR) DocumentRefuseNode(document, node->child[i], below, "has the wrong type; allowed: a number or a text");
  }
}

/* Before anything else is said about a map: a misspelt key is not a missing one. */
static void SchemaCheckKeys(Document *document, Node node, const char *path)
{
  char below[PATH_LENGTH];

  for (int i = 0; i < node->n; i++) {
    PathJoin(below, path, node->key[i]);
    if (strchr(node->key[i], '.') || !SchemaFind(below)) SchemaRefuseUnknown(document, node->child[i], path, below, node->key[i]);
  }
}

typedef void (*NodeVisit)(Document *, const SchemaKey *, Node, const char *path);

static void SchemaWalk(Document *document, Node node, const char *path, NodeVisit visit)
{
  const SchemaKey *key = SchemaFind(path);
  char             below[PATH_LENGTH];

  if (node->kind == NODE_MAP && (!key || key->type & MAP)) SchemaCheckKeys(document, node, path);
  if (key) visit(document, key, node, path);
  if (key && !(key->type & (node->kind == NODE_MAP ? MAP : LIST))) return;
  for (int i = 0; i < node->n; i++) {
    if (node->kind == NODE_MAP)
      PathJoin(below, path, node->key[i]);
    else
      PathJoinIndex(below, path, i);
    SchemaWalk(document, node->child[i], below, visit);
  }
}

static void SchemaVisitMissing(Document *document, Node node, const char *path)
{
  for (int i = 0; i < SCHEMA_KEYS; i++) {
    if (!(Schema[i].flags & REQUIRED) || !SchemaIsChild(&Schema[i], path) || NodeChild(node, PatternKey(Schema[i].path))) continue;
    if (Schema[i].flags & SOLID && document->dim == 2) continue;
    SchemaRefuseMissing(document, &Schema[i], node, path);
  }
}

/* Type and range; required keys of a map. */
static void SchemaVisitValue(Document *document, const SchemaKey *key, Node node, const char *path)
{
  const char *wrong = NULL;

  if (node->kind == NODE_MAP) {
    if (key->type & FREE)
      SchemaCheckFree(document, node, path);
    else if (key->type & MAP)
      SchemaVisitMissing(document, node, path);
    else
      wrong = WrongType;
  } else if (node->kind == NODE_LIST) {
    if (key->type & LIST)
      wrong = RangeHolds(key->range, node->n) ? NULL : "is empty";
    else
      wrong = CheckList(key, node);
  } else
    wrong = CheckScalar(key, key->type, node);
  if (wrong) SchemaRefuse(document, key, node, path, wrong);
}

/* Values that call for what a later release brings. */
static void SchemaVisitAvailable(Document *document, const SchemaKey *key, Node node, const char *path)
{
  double value, now;
  char  *end;

  if (!key->now) return;
  if (!*key->now) DocumentRefuseNode(document, node, path, "not available yet");
  if (WordFind(key->now, " |", node->text, strlen(node->text)) >= 0) return;
  now = strtod(key->now, &end);
  if (key->type & INTEGER && NodeReal(node, &value) && !*end && value == now) return;
  DocumentRefuseNode(document, node, path, "%s is not available yet; available: %s", node->text, key->now);
}

/* A 2D scene has no third direction: no such keys, no such component, points of two coordinates. */
static void SchemaVisitDimension(Document *document, const SchemaKey *key, Node node, const char *path)
{
  static const char Solid[] = "geometry: solid";

  if (document->dim == 2 && key->flags & SOLID) DocumentRefuseNode(document, node, path, "has no meaning in 2D; allowed: only with %s", Solid);
  if (document->dim == 2 && key->type & CHOICE && node->kind == NODE_SCALAR && !strcmp(node->text, "z"))
    DocumentRefuseNode(document, node, path, "z has no meaning in 2D; allowed: x | y, z only with %s", Solid);
  for (int i = 0; node->kind == NODE_LIST && i < (key->type & POINTS ? 2 : key->type & POINT ? 1 : 0); i++) {
    if ((key->type & POINTS ? node->child[i] : node)->n != document->dim)
      DocumentRefuseNode(document, node, path, "has not as many coordinates as the scene; allowed: %d numbers", document->dim);
  }
}

/* SchemaCheck - validates the document against the table: unknown and missing keys, types and ranges, then what is not available yet, then
   what a 2D scene cannot have. Collective; refuses the first mistake. Sets document->dim. */
void SchemaCheck(Document *document)
{
  Node geometry;

  if (document->root->kind != NODE_MAP) DocumentRefuse(document, "", "a scene is a map; allowed: KEY: VALUE lines");
  geometry      = NodeFind(document->root, "geometry");
  document->dim = geometry && geometry->kind == NODE_SCALAR && strcmp(geometry->text, "solid") ? 2 : 3;
  SchemaWalk(document, document->root, "", SchemaVisitValue);
  SchemaVisitMissing(document, document->root, "");
  SchemaWalk(document, document->root, "", SchemaVisitAvailable);
  SchemaWalk(document, document->root, "", SchemaVisitDimension);
}

/* ---- accessors, after SchemaCheck() ---- */

/* The text of the scalar at a path, else the table's default, else NULL; *key is the table's line. */
static const char *SchemaScalar(Document *document, const char *format, va_list arguments, const SchemaKey **key)
{
  char path[PATH_LENGTH];
  Node node;

  vsnprintf(path, sizeof path, format, arguments);
  *key = SchemaFind(path);
  if (!*key) {
    fprintf(stderr, "burnish: the schema has no key %s\n", path);
    abort();
  }
  node = NodeFind(document->root, path);
  return node ? node->text : (*key)->preset;
}

/* SchemaHas - is there a value at this path in the document? printf's format. Not collective, as all accessors. */
int SchemaHas(Document *document, const char *format, ...)
{
  char    path[PATH_LENGTH];
  va_list arguments;

  va_start(arguments, format);
  vsnprintf(path, sizeof path, format, arguments);
  va_end(arguments);
  return NodeFind(document->root, path) != NULL;
}

/* SchemaCount - number of entries of the list or map at a path; 0 if there is none. */
int SchemaCount(Document *document, const char *format, ...)
{
  char    path[PATH_LENGTH];
  va_list arguments;
  Node    node;

  va_start(arguments, format);
  vsnprintf(path, sizeof path, format, arguments);
  va_end(arguments);
  node = NodeFind(document->root, path);
  return node ? node->n : 0;
}

#define SCHEMA_SCALAR(text, key)                            \
  do {                                                      \
    va_list arguments;                                      \
    va_start(arguments, format);                            \
    text = SchemaScalar(document, format, arguments, &key); \
    va_end(arguments);                                      \
  } while (0)

/* SchemaReal - the number at a path, or its default; 0 where neither is. */
double SchemaReal(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text ? strtod(text, NULL) : 0;
}

/* SchemaInteger - the integer at a path, or its default; 0 where neither is. */
int SchemaInteger(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text ? atoi(text) : 0;
}

/* SchemaBoolean - 1 for true, 0 for false, or the default. */
int SchemaBoolean(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text && !strcmp(text, "true");
}

/* SchemaChoice - which of the table's values stands at a path, counted from 0; -1 where neither value nor default is one of them. */
int SchemaChoice(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text ? WordFind(key->values, " |", text, strlen(text)) : -1;
}

/* SchemaText - the text at a path, or its default, or NULL. It belongs to the document. */
const char *SchemaText(Document *document, const char *format, ...)
{
  const SchemaKey *key;
  const char      *text;

  SCHEMA_SCALAR(text, key);
  return text;
}

/* SchemaReference - prints every key, by the path that -set takes, with what it allows, its default and what it means; N stands for an index
   into a list. Not collective. */
void SchemaReference(FILE *file)
{
  char allowed[400];

  for (int i = 0; i < SCHEMA_KEYS; i++) {
    const SchemaKey *key = &Schema[i];

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
