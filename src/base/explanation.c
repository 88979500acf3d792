/* The table of messages with their causes and changes, and the code of a message. */
#include "base/explanation.h"
#include <string.h>

enum { PHRASES = 4 }; /* of a message, at most */

typedef struct {
  const char *code;
  const char *phrase[PHRASES]; /* parts of the message, any of which tells it; none: all others of the kind */
  const char *message, *cause, *change;
} Explanation;

/* The first entry that fits a message is its own, so the special ones stand before the general ones. */
static const Explanation Input[] = {
  {"B120",
   {"usage: burnish"},
   "the command line, then `usage: burnish`",
   "An option is unknown, given twice, lacks its value, or does not go with another one.",
   "Look at the list of options: `burnish -help`."},
  {"B121",
   {"(table of "},
   "a row of a csv file is no row of a table",
   "A file that the scene names by `csv` has a field that is no number, a value of t that does not increase or is "
   "beyond "
   "1, or fewer columns than the scene names.",
   "Correct the row that the message names. A table over seconds needs `end`, the duration."},
  {"B130",
   {"are prescribed on its whole surface in some steps only"},
   "a body that keeps its volume is enclosed in some steps only",
   "Displacements of the whole surface of a body are prescribed, so that the level of its pressure is free. Its "
   "elements hold their pressures otherwise then than in the other steps.",
   "Leave a part of its surface free in all steps, or take `nu` a little below 0.5."},
  {"B131",
   {"stands beside a displacement with `during`", "stands beside a history, which only springs take"},
   "a support has springs and displacements over time in one entry",
   "Springs have a `history`, or fade over a step. Displacements are prescribed or not, in the steps that `during` "
   "names.",
   "Write an entry for the springs and another one for the displacements, on the same surface."},
  {"B132",
   {"sides of a sector that repeat by a rotation"},
   "cyclic sectors",
   "The sides of a sector cannot be tied to each other by a rotation.",
   "Take a sector whose sides are planes of symmetry: hold their normal displacement by supports, and name them by "
   "`symmetry` under contact. Parts that twist, such as fans, need the whole model."},
  {"B137",
   {"lie on the same side of the face between them"},
   "a body is meshed twice",
   "Two cells of a body lie in the same place. Both would carry load, so that the body would be twice as stiff there. "
   "The volume group of the body names two volumes that overlap, as boolean operations of gmsh leave them, or one twice.",
   "Delete what was cut or united (`Delete` in gmsh's booleans), and list each volume once in the group."},
  {"B122",
   {"names a step, but there are none", "is no step;", "does not follow the step named before",
    "stands beside a history"},
   "`during` does not go with the steps",
   "`during` names a step that `stepping.steps` lacks, steps that do not follow each other, or stands beside "
   "`history`.",
   "Take names of `stepping.steps`, one after the other, and an entry of its own for what acts again later."},
  {"B143",
   {"is no key for a sensitivity", "has no number other than 0 in the scene, for a sensitivity",
    "names no probe and key"},
   "a number of the scene can have no sensitivity",
   "`sensitivity` needs a probe and the path of a number that the scene gives and that may change a little.",
   "Write PROBE:KEY, such as `force:bodies.0.material.E`, and give the key a number if it has its default."},
  {"B144",
   {"is not available where a fluid enters"},
   "the scene has no sensitivities",
   "A fluid wets places one by one, and the answer jumps with each: it has no derivative.",
   "Take differences of two runs with `-set` whose numbers are far enough apart."},
  {"B145",
   {"allowed for a sensitivity: parameters that"},
   "a parameter changes the connections of the mesh",
   "A sensitivity moves the nodes of the mesh. The generator has made other nodes or cells for the parameter.",
   "Take a parameter of a structured mesh, such as a radius, and no number or size of elements."},
  {"B123",
   {"geometry: plane_stress"},
   "the law or the element has no plane stress",
   "Plane stress is for elastic laws that are not incompressible, with `formulation: full` or `enhanced`.",
   "Take such a law or `nu` below 0.5; for yielding parts a thin solid with one element over the thickness."},
  {"B128",
   {"whose pressures leave none"},
   "more rubbers share a node than mixed tri3 and tet4 have pressures for",
   "Pressures jump between bonded bodies of different materials. A node has as many pressures as the model has "
   "dimensions, and the bodies take more.",
   "Take `mesh.order: 2`, whose elements hold their pressures themselves, or merge bodies of nearly the same rubber."},
  {"B129",
   {"the run began with pressures"},
   "a restart has another solver, for which mixed elements hold their pressures elsewhere",
   "Mixed triangles and tetrahedra of second order have pressures at their corners with the direct solver, and in the "
   "elements with the iterative one. The checkpoint has the unknowns of the solver with which the run began.",
   "Restart without `-set solver.type`, or begin anew with the other solver."},
  {"B111",
   {"is inverted ("},
   "cell of a body is inverted",
   "An element is turned inside out in the mesh: a curve of second order folds it, or the geometry has an entity the "
   "wrong way round.",
   "Mesh more finely where the surface is curved, or take `mesh.order: 1`, or turn the entity round in gmsh."},
  {"B112",
   {"gmsh failed", "gmsh was ended", "gmsh wrote no mesh"},
   "gmsh failed on the geometry",
   "The geometry cannot be meshed as it is, or gmsh is not installed. The lines of gmsh stand in the message.",
   "Open the file in gmsh and mesh it there with the same parameters."},
  {"B113",
   {"-trust on the command line"},
   "a command, option or law that `-trust` allows",
   "The scene or its geometry would run programs or code, or write files of its own choice.",
   "Remove the command. For a scene of people whom you trust, put `-trust` on the command line."},
  {"B107",
   {"is free to move"},
   "a body is free to move",
   "No support, imposed displacement or contact pair holds the body in the direction that the message names.",
   "Add a support, or put the body into a contact pair. In a model of one half, hold the plane of symmetry."},
  {"B109",
   {"lie in each other before any load", "by more than half of its wall before any load"},
   "the bodies lie in each other before any load",
   "The meshes overlap so far that their surfaces do not meet, mostly since a part is at a wrong place or in another "
   "unit of length.",
   "Move one of the bodies until they touch or are apart. An interference of parts that touch is "
   "`initial_overlap: {add: DEPTH}`."},
  {"B108",
   {"behind the master before any load"},
   "slave node lies behind the master before any load",
   "The meshes overlap a little at the start, and the scene does not say what becomes of it.",
   "`initial_overlap: resolve` removes the overlap at once, `ramp` along with t, `ignore` takes it as touching."},
  {"B110",
   {"holds the results of another scene", "holds results of an unknown scene"},
   "the folder holds the results of another scene",
   "A run does not overwrite results that another scene, or the same one with other values, has left.",
   "Choose another folder with `-o DIR`, or put `-overwrite` on the command line."},
  {"B116",
   {"does not show on which side"},
   "the start does not show on which side of the tool the slave is",
   "A meshed rigid tool has no inside. The slave stands on both sides of it, or on neither.",
   "Set `master_normal: keep` (the side to which the normals of the mesh point) or `flip`."},
  {"B115",
   {"no node at ", "no body at "},
   "no body at the point of a probe, or no node where one is needed",
   "The point is in reference coordinates. It must lie in a body; that of a gap must be a node of the slave surface.",
   "Take the nearest node, which the message names, or put a point into the geometry there."},
  {"B114",
   {"cells cannot be shared out"},
   "the cells cannot be shared out to the ranks",
   "There are more ranks than elements.",
   "Run on fewer ranks."},
  {"B106",
   {"serendipity elements", "are not available", "elements of two orders", "but the elements of '"},
   "elements that are not available, or of another order",
   "The mesh has wedges, pyramids, elements without their inner nodes, or elements of two orders.",
   "Mesh with triangles, quadrilaterals, tetrahedra or bricks of one order; in gmsh with "
   "`Mesh.SecondOrderIncomplete=0`. `mesh.order` is that of the file."},
  {"B124",
   {"' is not taken: "},
   "a mesh, a deck or a CAD file of another program is not taken",
   "The file is broken, holds no solids, has no surface at the point or of the name that the scene gives, or cannot be "
   "meshed. The message says which.",
   "Do what the message allows. The option `--list` of the script convert_mesh.py prints names and centres of "
   "surfaces."},
  {"B147",
   {"is there already; allowed: a new name"},
   "an import finds its scene or mesh there already",
   "A file of the name that -import would write exists. It is not replaced, as it may have been edited.",
   "Name a new scene behind the deck's name, or move the old files away."},
  {"B105",
   {"the mesh has no", "has no volume group", "has no cells of a volume group", "is needed: "},
   "the mesh has no group of this name",
   "The scene names a body or a surface that is no physical group of the mesh, or one of another dimension, or one "
   "without elements. Upper and lower case differ.",
   "Take one of the names that the message lists, or name the entity in the geometry with `Physical Surface`. A group "
   "is empty if the list or box that chooses its entities finds none."},
  {"B104",
   {"there is no such file", "cannot be read", "there is no file '", "' is no file"},
   "a file is not there or cannot be read",
   "Names of files in a scene start at the folder of the scene, and not at the present folder.",
   "Correct the name, or write the whole path."},
  {"B101",
   {"unknown key"},
   "unknown key",
   "The scene has a key that does not exist at this place, mostly a misspelt one or one that is indented too far.",
   "Take the key that the message proposes, or look at the scene reference."},
  {"B103",
   {"malformed YAML", "duplicate key", "YAML document"},
   "malformed YAML",
   "The file is no YAML: a bracket, comma, colon or quotation mark is missing, or lines are indented unevenly.",
   "Look at the line that the message names and at the one before it."},
  {"B119",
   {"an expression of "},
   "an expression that cannot be read",
   "The text is taken as an expression in place and time, and has an unknown name or a missing bracket at the named "
   "character.",
   "Write it with the names and functions that the message lists."},
  {"B117",
   {"is missing"},
   "a key is missing",
   "The scene lacks a key that something else in it needs.",
   "Add the key; the message says which one and what it may be."},
  {"B102",
   {"has the wrong type", "out of range", "is not allowed", "has no value"},
   "a value has the wrong type, is out of range or is not allowed",
   "The key exists, but not with this value.",
   "Take a value of those that the message allows; units are those of the scene reference."},
  {"B100",
   {NULL},
   "any other wrong input",
   "Something in the scene or its mesh does not go together.",
   "The message names file, line and key and ends with what is allowed. `-check` shows the rest of the model."},
};

static const Explanation Unsolved[] = {
  {"B155",
   {"as before a limit load"},
   "a limit load",
   "For the load, the bodies move faster from step to step, and the rates of the last steps grow without bound at the "
   "load parameter that the message names. The model carries no more than the load there: a body snaps through, buckles, "
   "or is pressed or drawn through an opening.",
   "That is a result: with damped steps, too, the run found no equilibrium behind it. It is looked for earlier with "
   "`stepping.damping: auto`, or where a displacement is imposed instead of the load."},
  {"B136",
   {"an edge against an edge has no contact"},
   "an edge meets an edge, which has no contact in space",
   "Two sharp edges cross each other. Contact is between points of one surface and faces of the other one, and no face "
   "lies against a face there: the bodies would cross without any force.",
   "Give both edges a rounding that the mesh resolves with three or more faces, which meet as faces do. Where faces "
   "press soon after, a larger `certificate.penetration` lets the edges stand in each other until then."},
  {"B125",
   {"folds over itself about"},
   "a face folds over itself",
   "A face of second order bends to a loop, in which it and its neighbours cross each other. The message names the face "
   "and the node about which its halves turned through each other. Contact holds faces apart, but not the halves of one "
   "face. Surfaces that crease ask for more than a face can follow.",
   "Refine the mesh at the place until the crease has several faces, or take first-order elements, whose creases are at "
   "nodes, where contact holds both sides apart."},
  {"B202",
   {"the step cannot be certified"},
   "the step cannot be certified",
   "Surfaces would cross deeper than is allowed, or something would have passed through something unseen: a penalty "
   "that is too soft, a slave that is coarser than its master, an edge that no pair knows, or the end of a slave beside "
   "which the body bulges against the master.",
   "Where the slave ends, add the surface beside it to the slave. Refine the slave at the place that the message names, exchange slave and master, or leave the penalty to the run. "
   "A soft penalty that is meant needs a larger `certificate.penetration`."},
  {"B203",
   {"an element turned inside out", "was inverted"},
   "an element turned inside out",
   "Elements are squeezed or sheared until they fold: steps too large, a mesh too coarse at a corner, or more "
   "deformation than the mesh can follow.",
   "Take a smaller `stepping.initial` and `dt_max`, refine or grade the mesh there, or take first-order elements."},
  {"B204",
   {"the linear system is singular", "nothing holds a body against its load"},
   "nothing holds a body, or the linear system is singular",
   "A body has lost its contact, or its load moves it along a surface that holds it only across.",
   "Hold the body by a support or a spring, add friction, or impose its displacement instead of a force."},
  {"B205",
   {"contact was lost behind a master"},
   "contact was lost behind a master",
   "A slave point slid over the end of its master, or passed a thin wall.",
   "Make the master longer, exchange slave and master, or take smaller steps."},
  {"B206",
   {"a rigid tool turned too far"},
   "a rigid tool turned too far in one step",
   "A moment turns a tool that little resists.",
   "Take smaller steps, or impose the rotation instead of the moment."},
  {"B207",
   {"the contact lists did not settle", "the contact set repeats itself"},
   "the contact lists did not settle, or the contact set repeats itself",
   "Nodes go in and out of contact and no set of them is in equilibrium, mostly at sharp edges or where faces of both "
   "sides have very different sizes.",
   "Round the edge, give both sides faces of like size, exchange slave and master, or take smaller steps."},
  {"B208",
   {"did not come into the window"},
   "the penetrations did not come into the window of the adjusted penalty",
   "`g_min` and `g_max` are closer together than the pressures of the nodes, or `range` is too small.",
   "Widen the window, raise `penalty.range`, or leave out `adjust`: the run chooses the penalty by itself."},
  {"B209",
   {"umat"},
   "a routine of the user's (law: umat) failed",
   "The routine crashed or gave a number that is not finite in the named element and point.",
   "Run it in a bar of one element first, with smaller steps."},
  {"B210",
   {"a fluid leaks", "fluid wets"},
   "a fluid leaks",
   "The fluid of `where: open` has come to the other end, which ends the load.",
   "That is a result. Where it should be tight, the contact pressure of the seal is too low."},
  {"B211",
   {"the volumes of incompressible bodies"},
   "the volumes of incompressible bodies did not settle",
   "Imposed displacements or tools change a volume that cannot change.",
   "Leave a surface of the body free, or give the material a finite bulk modulus (`nu: 0.4999`)."},
  {"B201",
   {"Newton's method did not converge", "the line search found no lower energy", "not-a-number"},
   "Newton's method found no equilibrium",
   "The step is too large, or there is no equilibrium near: a body snaps through or buckles, a material softens, or "
   "the load is more than the model can carry.",
   "Take a smaller `stepping.initial`, impose displacements instead of forces, or let damped steps "
   "begin earlier with `stepping.damping: auto`. The lines `try` of the last screen fit the scene at hand."},
  {"B153",
   {"confirmed by a second mesh", "with an error of"},
   "the accuracy that was asked for is not reached, or not confirmed",
   "A limit ended the loop over meshes before the error was below the wish, or before a second mesh had confirmed the "
   "estimate of the first one; or what is left of error does not come from the mesh.",
   "Raise `accuracy.limit`, `accuracy.meshes` or `accuracy.to`. Where another cause than the mesh leaves the most, change "
   "that one: a penalty that the scene gives, `solver.tolerance`."},
  {"B200",
   {NULL},
   "any other end without an equilibrium",
   "No equilibrium was found down to the smallest step.",
   "The lines `try` of the last screen fit the scene at hand. The last good state is on disk."},
};

static const Explanation Others[] = {
  {"B300",
   {NULL},
   "-time_limit is near, SIGUSR1 or SIGTERM",
   "The run was asked to end, and has written a checkpoint.",
   "Go on with `-restart DIR`, on any number of ranks."},
  {"B400",
   {NULL},
   "internal error or machine failure",
   "Memory or disk ran out, a library failed, or there is an error in the program.",
   "Look at the first lines of `error.log` in the run's folder. `-check` says how much memory the run needs."},
};

/* Warnings carry their codes in their texts. */
static const Explanation Warnings[] = {
  {"B501",
   {"loses its stability"},
   "warning: a law loses its stability (Drucker)",
   "The constants of the rubber give stresses that fall as strains grow, at the stretches that the message names.",
   "Fit the constants to tests over the whole range of strains, or with fewer terms: `scripts/fit_rubber.py`."},
  {"B502",
   {"in the same unit of length"},
   "warning: a displacement is many times the diagonal of the model",
   "Mesh and scene are in different units of length.",
   "Bring all lengths into one unit; stresses are forces over that unit squared."},
  {"B503",
   {"lock (too stiff)"},
   "warning: elements lock (too stiff)",
   "First-order elements with full integration cannot keep a volume and bend at the same time.",
   "`mesh.order: 2`, `formulation: mixed` for elastic bodies, `formulation: fbar` for plastic ones."},
  {"B504",
   {"in common, as node"},
   "warning: slave and master have nodes in common",
   "Both surfaces were made from one entity, so they are one body there and never part.",
   "Give each body its own entity in the geometry, at the same place."},
  {"B505",
   {"nothing used the PETSc option"},
   "warning: nothing used the PETSc option",
   "The option is misspelt, or no solver of this run knows it.",
   "Look at `options.unused` in summary.json and at PETSc's `-help`."},
  {"B506",
   {"met '"},
   "warning: no node of the slave met its master",
   "The surfaces never came near each other, or look away from each other.",
   "`-check` shows the gaps at the start. Look at loads, places of the bodies and `master_normal`."},
  {"B154",
   {"and no contact pressed"},
   "warning: surfaces cross, and no contact pressed",
   "An elastic edge or corner sinks into coarse faces by less than they can see: in surface to surface contact by up to "
   "a third of a face. The results are those of no contact.",
   "Finer faces on both sides there, or `formulation: node_to_surface` with the body of the edge as `slave`."},
  {"B157",
   {"forces across the edge are not to be trusted"},
   "warning: a sharp edge of the master stands between the points of the slave",
   "Contact is measured at points of the slave. The few of them that are behind the edge are pressed out along its "
   "sides, so that the edge has a force across it that depends on where they lie.",
   "Make the body of the edge the slave, or list both as `surfaces`. Edges of rigid tools press by themselves, but not "
   "with friction or a fluid: refine the slave there until its faces are smaller than the dent, or round the edge."},
  {"B156",
   {"which no estimated error holds"},
   "warning: a zone of contact has few faces",
   "The zone ends within a face, and estimated errors take what is in contact as known. With few faces from the zone's "
   "end to its middle that leaves more than they say.",
   "Finer elements where the surfaces touch, as many as the message names, or `-to` and `-probe`, with which the change "
   "of the answer from mesh to mesh counts too."},
  {"B507",
   {"face sizes behind its master", "face sizes deep in its slave"},
   "warning: nodes stood more than a face size behind the other surface",
   "The penalty is too soft for what presses, or the points of the slave are too far apart.",
   "Leave `penalty` out, so that the run chooses it; refine the slave or exchange the sides."},
  {"B508",
   {"is not what the checkpoint left"},
   "warning: a file is not what the checkpoint left",
   "A file of the results was changed, removed or cut short between the two runs.",
   "It begins anew after the named step; the other results are whole."},
};

typedef struct {
  const Explanation *entries;
  size_t             n;
} Table;

#define TABLE(entries)                            \
  {                                               \
    entries, sizeof(entries) / sizeof(entries)[0] \
  }
static const Table Tables[] = {TABLE(Input), TABLE(Unsolved), TABLE(Others), TABLE(Warnings)};
enum { TABLES = sizeof(Tables) / sizeof(Tables)[0] };

static int Fits(const Explanation *entry, const char *message)
{
  if (!entry->phrase[0]) return 1;
  for (int i = 0; i < PHRASES && entry->phrase[i]; i++)
    if (strstr(message, entry->phrase[i])) return 1;
  return 0;
}

/*@
  ExplanationOf - returns the code of a message, for example B202

  Not collective

  Input Parameters:
+ message - as it is printed, without a code
- kind    - how the run ended

  Note:
  Plain C.
@*/
const char *ExplanationOf(const char *message, ExplanationKind kind)
{
  const Table *table = &Tables[kind];
  size_t       i     = 0;

  if (kind == EXPLANATION_STOPPED) return Others[0].code;
  if (kind == EXPLANATION_FAILURE) return Others[1].code;
  while (!Fits(&table->entries[i], message)) i++; /* the last one fits all */
  return table->entries[i].code;
}

/*@
  ExplanationAppend - puts the code behind a message, such as " [B202]"

  Not collective

  Input Parameters:
+ message - the text, without a code; an empty one stays empty
. size    - of its array
- kind    - how the run ended

  Note:
  A message that fills its array loses its last characters. Plain C.
@*/
void ExplanationAppend(char *message, size_t size, ExplanationKind kind)
{
  const char  *code   = ExplanationOf(message, kind);
  const size_t needed = strlen(code) + 4; /* the blank, the brackets and the end */
  size_t       length = strlen(message);

  if (!length || size < needed) return;
  if (length > size - needed) length = size - needed;
  snprintf(message + length, size - length, " [%s]", code);
}

/*@
  ExplanationPrint - prints what is known of a code

  Not collective

  Input Parameters:
+ code - such as B202, or all
- file - the stream to print to, or NULL

  Note:
  Returns 0 if there is no such code. Plain C.
@*/
int ExplanationPrint(const char *code, FILE *file)
{
  int found = 0;

  for (int t = 0; t < TABLES; t++) {
    for (size_t i = 0; i < Tables[t].n; i++) {
      const Explanation *entry = &Tables[t].entries[i];

      if (strcmp(code, "all") && strcmp(code, entry->code)) continue;
      if (file)
        fprintf(file, "%s%s  %s\ncause   %s\nchange  %s\n", found ? "\n" : "", entry->code, entry->message,
                entry->cause, entry->change);
      found++;
    }
  }
  return found;
}
