#include "schemakeys.h"
#include "base/choices.h"
#include "document.h"
#include "smooth/smoother.h"
#include <stdio.h>
#include <string.h>

/* One line per key, not in columns. */
// clang-format off
#define MOTION_KEYS(tool) \
  {tool ".motion", LIST, .help = "prescribed motions, summed"}, \
  {tool ".motion.*", MAP, .help = "displacement or rotation components"}, \
  {tool ".motion.*.ux|uy", REAL, .unit = "length", .help = "displacement, times the history"}, \
  {tool ".motion.*.uz", REAL, SOLID, .unit = "length"}, \
  {tool ".motion.*.rx|ry", REAL, SOLID, .unit = "degrees", .help = "rotation, times the history"}, \
  {tool ".motion.*.rz", REAL, .unit = "degrees"}, \
  {tool ".motion.*.history", HISTORY, .preset = "[[0, 0], [1, 1]]", .help = "factor over t"}

const SchemaKey SchemaKeys[] = {
  {"name", NAME, .help = "of the run and its results; default: the scene file's name"},
  {"mesh", MAP, REQUIRED, .help = "where the mesh comes from"},
  {"mesh.file", FILENAME, REQUIRED, .help = ".geo (gmsh makes the mesh) or .msh (version 4.1)"},
  {"mesh.order", INTEGER, .range = "[1, 2]", .help = "of the elements; default: 1 for a .geo, its own for a .msh"},
  {"mesh.parameters", FREE, .help = "numbers and texts handed to the .geo"},
  {"geometry", CHOICE, .values = "solid | plane_strain | axisymmetric", .preset = "solid", .help = "axisymmetric: x = r, y = z"},
  {"kinematics", CHOICE, .values = "small | finite", .preset = "finite", .help = "strains and displacements"},
  {"bodies", LIST, REQUIRED, .range = "[1, inf)", .help = "what the scene consists of"},
  {"bodies.*", MAP, .help = "a deformable body or a rigid tool"},
  {"bodies.*.volume", TEXT, .help = "physical volume (2D: surface) of a deformable body; needs material"},
  {"bodies.*.material", MAP, .help = "elastic law"},
  {"bodies.*.material.law", CHOICE, REQUIRED, .values = CHOICE_WORDS(ELASTIC_LAWS), .help = "linear only with kinematics small"},
  {"bodies.*.material.E", REAL, REQUIRED, .range = "(0, inf)", .unit = "stress", .help = "Young's modulus"},
  {"bodies.*.material.nu", REAL, REQUIRED, .range = "(-1, 0.5)", .help = "Poisson's ratio"},
  {"bodies.*.formulation", CHOICE, .values = "full | enhanced | fbar", .preset = "full", .help = "of first-order quadrilaterals and bricks: enhanced bends without locking, fbar is for nearly incompressible laws"},
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
  {"loads.*.traction", POINT, .unit = "force per reference area", .help = "of fixed direction"},
  {"loads.*.body_force", POINT, .unit = "force per reference volume", .help = "such as weight"},
  {"loads.*.history", HISTORY, .preset = "[[0, 0], [1, 1]]", .help = "factor over the load parameter t"},
  {"contact", LIST, .help = "pairs of surfaces"},
  {"contact.*", MAP, .help = "one pair"},
  {"contact.*.name", NAME,REQUIRED, .help = "that probes and results use"},
  {"contact.*.slave", TEXT, REQUIRED, .help = "physical surface of a deformable body"},
  {"contact.*.master", TEXT | MAP, REQUIRED, .help = "physical surface, or an analytic one"},
  {"contact.*.master.plane|cylinder|sphere", MAP, .help = "an analytic rigid master"},
  {"contact.*.master.plane.point", POINT, REQUIRED, .unit = "length", .help = "on it"},
  {"contact.*.master.plane.normal", POINT, REQUIRED, .help = "out of the obstacle"},
  {"contact.*.master.cylinder.point", POINT, REQUIRED, .unit = "length", .help = "on its axis"},
  {"contact.*.master.cylinder.axis", POINT, REQUIRED | SOLID, .help = "its direction"},
  {"contact.*.master.sphere.centre", POINT, REQUIRED, .unit = "length"},
  {"contact.*.master.cylinder|sphere.radius", REAL, REQUIRED, .range = "(0, inf)", .unit = "length"},
  {"contact.*.master.cylinder|sphere.side", CHOICE, .values = "outside | inside", .preset = "outside", .help = "where the slave is"},
  MOTION_KEYS("contact.*.master.plane|cylinder|sphere"),
  {"contact.*.smoother", CHOICE, .values = SMOOTHER_CHOICES, .preset = "facet", .help = "the master's surface: its faces, or a smooth one near them"},
  {"contact.*.formulation", CHOICE, .values = "node_to_surface | surface_to_surface", .preset = "node_to_surface",
   .help = "where the gap is measured: at the slave's nodes, or all over its faces"},
  {"contact.*.offset", CHOICE, .values = "held | live", .preset = "held", .help = "of surface_to_surface: taken before each solve; or moving with the nodes in it"},
  {"contact.*.degree", CHOICE, .values = "4 | 2", .preset = "4", .help = "of the diffuse fit"},
  {"contact.*.support", REAL, .range = "(0, inf)", .unit = "spacings", .help = "radius of the diffuse fit; default by dimension and degree"},
  {"contact.*.weight", REAL, .range = "[3, inf)", .help = "exponent of the diffuse fit; default by dimension and degree"},
  {"contact.*.frame", CHOICE, .values = "local | global", .preset = "local", .help = "of the diffuse fit"},
  {"contact.*.derivatives", CHOICE, .values = "full | diffuse", .preset = "full", .help = "diffuse: the cheap tangent"},
  {"contact.*.feature_angle", REAL, .range = "(0, 180]", .unit = "degrees", .preset = "45", .help = "lists end at sharper edges"},
  {"contact.*.symmetry", TEXTS, .help = "planar surfaces beyond which the model goes on as its mirror image"},
  {"contact.*.initial_overlap", CHOICE, .values = "refuse | resolve | ramp | ignore", .preset = "refuse",
   .help = "of the meshes: wrong input; pushed out at once; by and by until t = 1; counted as no gap"},
  {"contact.*.stabilise", BOOLEAN, .preset = "false", .help = "springs that vanish hold bodies that only contact holds, until it does"},
  {"contact.*.law", CHOICE, .values = CHOICE_WORDS(CONTACT_LAWS), .preset = "penalty", .help = "pressure over the gap"},
  {"contact.*.penalty", MAP, .help = "force per penetration and area, and its adjustment"},
  {"contact.*.penalty.initial", REAL | CHOICE, .values = "auto", .range = "(0, inf)", .unit = "force per length and area", .preset = "auto"},
  {"contact.*.penalty.scale", REAL, .range = "(0, inf)", .preset = "1", .help = "factor on the automatic penalty"},
  {"contact.*.penalty.adjust", BOOLEAN, .preset = "false", .help = "follows the penetration; needs g_min, g_max and unit"},
  {"contact.*.penalty.when", CHOICE, .values = "step | converged", .preset = "converged",
   .help = "step: the next step has the new penalty; converged: each step is solved again until the window holds"},
  {"contact.*.penalty.augment", BOOLEAN, .preset = "false",
   .help = "the penalty stays; forces become multipliers, and each step is solved on until no node in contact is beyond g_max; needs g_max and unit"},
  {"contact.*.penalty.max_updates", INTEGER, .range = "[1, 1000]", .preset = "10",
   .help = "of augment in one step, which then stands as it is; the report counts such steps"},
  {"contact.*.penalty.g_min|g_max", REAL, .range = "(0, inf)", .unit = "unit", .help = "window of the penetration; of augment: g_max, on either side"},
  {"contact.*.penalty.unit",CHOICE, .values = "length | spacing", .help = "of g_min and g_max; spacing: the slave node's face size"},
  {"contact.*.penalty.clamp", REAL, .range = "(1, inf)", .preset = "100", .help = "largest factor of one adjustment"},
  {"contact.*.penalty.range", REAL, .range = "(1, inf)", .preset = "1e4", .help = "largest factor away from the automatic penalty"},
  {"stepping", MAP, .help = "load steps"},
  {"stepping.control", CHOICE, .values = CHOICE_WORDS(STEP_CONTROLS), .preset = "iterations", .help = "contact needs N_c or N_c_fraction"},
  {"stepping.initial", REAL, .range = "(0, 1]", .preset = "0.1", .help = "first step of the load parameter"},
  {"stepping.N_c", INTEGER, .range = "[1, inf)", .unit = "nodes", .help = "new contact per step; not with N_c_fraction"},
  {"stepping.N_c_fraction", REAL, .range = "(0, 1]", .help = "new contact per step, of the slave area"},
  {"stepping.prediction", CHOICE, .values = "converged | tangent", .preset = "converged",
   .help = "of control contact: the step's own solution, or one linear solve before it"},
  {"stepping.dt_min", REAL, .range = "(0, 1]", .preset = "1e-5", .help = "smallest step before the run gives up"},
  {"stepping.dt_max", REAL, .range = "(0, 1]", .preset = "1", .help = "largest step"},
  {"stepping.growth", REAL, .range = "[1, inf)", .preset = "4", .help = "largest factor from one step to the next"},
  {"stepping.at", REALS, .range = "(0, 1]", .help = "load parameters that steps must land on"},
  {"solver", MAP, .help = "linear and nonlinear solver"},
  {"solver.type", CHOICE, .values = "direct | iterative | auto", .preset = "auto", .help = "auto: by the number of unknowns"},
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
  {"probes.*.component", CHOICE, .values = "x | y | z", .help = "of a force or displacement"},
  {"probes.*.body",TEXT, .help = "volume of the node, where two bodies have one at the point"},
  {"probes.*.change", BOOLEAN, .preset = "false", .help = "distance: minus the reference distance"},
  {"probes.*.at", POINT | MAP, .unit = "length", .help = "gap: a point; contact_edge, pressure_max: one reference coordinate, such as {z: 100}"},
  {"probes.*.at.x|y", REAL, .unit = "length"},
  {"probes.*.at.z", REAL, SOLID, .unit = "length"},
  {"probes.*.axis", CHOICE, .values = "x | y | z", .help = "contact_edge: along which it is looked for"},
  {"probes.*.side", CHOICE, .values = "min | max", .help = "contact_edge: its lower or upper end"},
  {"probes.*.measure", CHOICE, .values = "max | rms", .preset = "max", .help = "pressure_deviation: the largest, or the root of the mean square"},
  {"probes.*.excluding",REAL, .range = "(0, inf)", .unit = "face sizes", .help = "leaves out nodes that near to a free edge"},
  {"probes.*.only", REAL, .range = "(0, inf)", .unit = "face sizes", .help = "takes only nodes that near to a free edge"},
  {"probes.*.absolute", BOOLEAN, .preset = "false", .help = "without its sign"},
  {"probes.*.factor",REAL, .preset = "1", .help = "on the value"},
  {"output", MAP, .help = "what is written"},
  {"output.every",INTEGER, .range = "[0, inf)", .unit = "steps", .preset = "1", .help = "0: only the last state"},
  {"output.fields", CHOICES, .values = "displacement | stress | contact", .help = "default: all"},
  {"output.checkpoint", INTEGER, .range = "[0, inf)", .unit = "steps", .preset = "0"},
  {"petsc", FREE, .help = "PETSc options without the dash, such as snes_monitor"},
};
// clang-format on

const int SchemaKeysCount = sizeof SchemaKeys / sizeof SchemaKeys[0];

/* WordFind - place from 0, or -1, of the n characters at text among the words of a list (apart by the characters of
 * apart). Not collective. */
int WordFind(const char *words, const char *apart, const char *text, size_t n)
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
    const size_t np = KeyPathComponent(pattern), nt = KeyPathComponent(path);
    char         component[80];

    snprintf(component, sizeof component, "%.*s", (int)np, pattern);
    if (!strcmp(component, "*") ? !KeyPathComponentIsIndex(path) : WordFind(component, "|", path, nt) < 0) return 0;
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

/* SchemaKeyName - last component of a key's path; "a|b" where it stands for key a or key b. Not collective. */
const char *SchemaKeyName(const SchemaKey *key)
{
  const char *dot = strrchr(key->path, '.');

  return dot ? dot + 1 : key->path;
}

/* SchemaKeyIsChild - whether a key belongs to the map at a path. Not collective. */
int SchemaKeyIsChild(const SchemaKey *key, const char *path)
{
  return PatternMatches(key->path, PatternParent(key->path), path);
}

/* SchemaKeyFind - the key of the table that a path is of, NULL: none. Not collective. */
const SchemaKey *SchemaKeyFind(const char *path)
{
  for (int i = 0; i < SchemaKeysCount; i++) {
    if (PatternMatches(SchemaKeys[i].path, strlen(SchemaKeys[i].path), path)) return &SchemaKeys[i];
  }
  return NULL;
}
