/* The table of all keys of a scene, and how a path finds its key in it, see schemakeys.h. */
#include "schemakeys.h"
#include "base/choices.h"
#include "document.h"
#include "scenedefaults.h"
#include "smooth/smoother.h"
#include <string.h>

/* clang-format would align the table in columns, and is therefore off here. */
// clang-format off
/* The keys of the motion of a rigid tool or of an analytic master */
#define MOTION_KEYS(tool) \
  {tool ".motion", LIST, \
   .help = "prescribed motions, which are added. A component may be an expression of t, which is the value at t itself " \
           "and takes no history"}, \
  {tool ".motion.*", MAP, .help = "displacement components, rotation components or both"}, \
  {tool ".motion.*.ux|uy", REAL | FORMULA, .unit = "length", \
   .help = "displacement component, multiplied by the history; axisymmetric, ux moves every part of the tool away " \
           "from the axis, as the jaws of a chuck do"}, \
  {tool ".motion.*.uz", REAL | FORMULA, SOLID, .unit = "length", \
   .help = "displacement component, multiplied by the history"}, \
  {tool ".motion.*.rx|ry", REAL | FORMULA, SOLID, .unit = "degrees", \
   .help = "rotation component, multiplied by the history"}, \
  {tool ".motion.*.rz", REAL | FORMULA, .unit = "degrees", .help = "rotation component, multiplied by the history"}, \
  {tool ".motion.*.history", HISTORY, .preset = "[[0, 0], [1, 1]]", .help = "factor over the load parameter t"}, \
  {tool ".motion.*.during", NAME | TEXTS, \
   .help = "step, or list of steps one after the other, in which it moves, from 0 to the whole way; it stays there. In " \
           "the place of history"}, \
  {tool ".free", CHOICES, .values = "ux | uy | uz | rx | ry | rz", \
   .help = "components of the motion that are unknowns: the tool moves along them until its contact balances force " \
           "and moment. In the plane ux, uy and rz, axisymmetric uy alone"}, \
  {tool ".force", POINT | FORMULA, .unit = "force", \
   .help = "force on the tool at its point, in the plane over thickness, axisymmetric on the whole tool; it acts along " \
           "the free displacements. Numbers are multiplied by the history, expressions are of t; the default is no " \
           "force"}, \
  {tool ".moment", MAP, .help = "moment on the tool along its free rotations; the default is none"}, \
  {tool ".moment.x|y", REAL | FORMULA, SOLID, .unit = "force times length", \
   .help = "moment on the tool, which does its work along the rotation vector (rx, ry, rz), as force"}, \
  {tool ".moment.z", REAL | FORMULA, .unit = "force times length", \
   .help = "moment on the tool, which does its work along the rotation vector (rx, ry, rz), as force"}, \
  {tool ".history", HISTORY, .preset = "[[0, 0], [1, 1]]", \
   .help = "factor on force and moment over the load parameter t"}, \
  {tool ".during", NAME | TEXTS, \
   .help = "steps in which force and moment act, in the place of history, as loads.N.during"}

const SchemaKey SchemaKeys[] = {
  {"name", NAME, .help = "name of the run and of its results; the default is the name of the scene file"},
  {"mesh", MAP, REQUIRED, .help = "the mesh and its source"},
  {"mesh.file", FILENAME, REQUIRED,
   .help = "a .geo file, from which gmsh makes the mesh; geometry of a CAD program (.step, .stp, .brep, .igs, .iges), "
           "which is meshed once; a .msh file; or a mesh of another program (.inp, .med, .unv, .cgns, .bdf, .nas, .vtk, "
           ".vtu), which is converted once"},
  {"mesh.order", INTEGER, .range = "[1, 2]",
   .help = "order of the elements; the default is 1 for a .geo file, 2 for CAD geometry, and that of the file for the "
           "others"},
  {"mesh.size", REAL, .range = "(0, inf)", .unit = "length",
   .help = "of CAD geometry: size of the elements, which are smaller on strongly curved faces; the default is a fifteenth "
           "of the diagonal of each body"},
  {"mesh.surfaces", LIST,
   .help = "of CAD geometry: surfaces (in the plane curves) that are named or meshed more finely"},
  {"mesh.surfaces.*", MAP, .help = "a surface with a point, a size, or both"},
  {"mesh.surfaces.*.name", TEXT, REQUIRED,
   .help = "name that the scene gives to the surface, or without point a name that it has"},
  {"mesh.surfaces.*.point", POINT, .unit = "length",
   .help = "point on the surface, not on its edge; entries of the same name make one surface of several"},
  {"mesh.surfaces.*.body", TEXT,
   .help = "body whose surface is meant, where surfaces of two bodies have the point"},
  {"mesh.surfaces.*.size", REAL, .range = "(0, inf)", .unit = "length",
   .help = "size of the elements on the surface; they grow away from it"},
  {"mesh.parameters", FREE, .help = "numbers and texts that are passed to the .geo file"},
  {"mesh.sizes", FILENAME,
   .help = "a view of gmsh (.pos) with element sizes that take the place of those of the .geo file; curves and surfaces "
           "that the .geo divides itself (Transfinite) keep their divisions"},
  {"geometry", CHOICE, .values = "solid | plane_strain | axisymmetric | plane_stress", .preset = "solid",
   .help = "geometry of the model; for axisymmetric, x is the radius and y is the axial coordinate; plane_stress is for "
           "thin parts, free to become thinner or thicker"},
  {"thickness", REAL, .range = "(0, inf)", .unit = "length", .preset = "1",
   .help = "of geometry plane_strain and plane_stress: thickness of all bodies. Forces in the scene and in the results are "
           "those on the whole thickness; without the key they are per unit of it"},
  {"kinematics", CHOICE, .values = "small | finite", .preset = "finite",
   .help = "whether strains and displacements are small or finite"},
  {"bodies", LIST, REQUIRED, .range = "[1, inf)", .help = "the bodies of the scene"},
  {"bodies.*", MAP, .help = "a deformable body or a rigid tool"},
  {"bodies.*.volume", TEXT, .help = "physical volume (2D: surface) of a deformable body; needs material"},
  {"bodies.*.material", MAP, .help = "material of a deformable body"},
  {"bodies.*.material.law", CHOICE, REQUIRED, .values = CHOICE_WORDS(ELASTIC_LAWS),
   .help = "law of the material; linear is allowed only with kinematics: small; von_mises yields and needs yield or "
           "hardening.table; umat is a routine of the user's"},
  {"bodies.*.material.E", REAL, .range = "(0, inf)", .unit = "stress",
   .help = "Young's modulus of linear, svk, neo_hookean, isochoric_neo_hookean, von_mises and umat; needed there, or mu"},
  {"bodies.*.material.nu", REAL, .range = "(-1, 0.5]",
   .help = "Poisson's ratio of the undeformed state; 0.5 is incompressible. Every material has one of nu, K and "
           "incompressible"},
  {"bodies.*.material.K", REAL, .range = "(0, inf)", .unit = "stress",
   .help = "bulk modulus of the undeformed state, instead of nu"},
  {"bodies.*.material.incompressible", BOOLEAN, .preset = "false",
   .help = "true: the volume does not change, instead of nu; needs formulation: mixed"},
  {"bodies.*.material.mu", REAL, .range = "(0, inf)", .unit = "stress",
   .help = "shear modulus, instead of E; of arruda_boyce a constant, which is needed"},
  {"bodies.*.material.c10", REAL, .unit = "stress", .help = "constant of mooney_rivlin and yeoh, needed there"},
  {"bodies.*.material.c01", REAL, .unit = "stress", .help = "constant of mooney_rivlin, needed there"},
  {"bodies.*.material.c20|c30", REAL, .unit = "stress", .preset = "0", .help = "constant of yeoh"},
  {"bodies.*.material.terms", PAIRS, .unit = "mu a stress",
   .help = "constants [[mu, alpha], ...] of ogden and hyperfoam, needed there; the shear modulus of ogden is half the sum of "
           "mu alpha, that of hyperfoam the sum of mu"},
  {"bodies.*.material.lambda_m", REAL, .range = "(1, inf)",
   .help = "stretch of arruda_boyce at which the chains lock, needed there"},
  {"bodies.*.material.yield", REAL, .range = "(0, inf)", .unit = "stress",
   .help = "of von_mises: stress at which plastic flow starts in tension (Kirchhoff stress with finite strains)"},
  {"bodies.*.material.hardening", MAP,
   .help = "of von_mises: rise of the yield stress over the equivalent plastic strain, the sum of the terms that are "
           "named; without the key there is none"},
  {"bodies.*.material.hardening.linear", REAL, .range = "[0, inf)", .unit = "stress",
   .help = "slope of the yield stress over the equivalent plastic strain"},
  {"bodies.*.material.hardening.table", TABLE, .unit = "strain and stress",
   .help = "yield stress (true stress) over the equivalent plastic strain, in the place of yield and of all terms; it "
           "must not fall, is linear between its points, and goes on with its last slope"},
  {"bodies.*.material.hardening.voce", MAP, .help = "(saturation - yield)*(1 - exp(-rate*strain))"},
  {"bodies.*.material.hardening.voce.saturation", REAL, REQUIRED, .range = "(0, inf)", .unit = "stress",
   .help = "yield stress at large strains without the other terms; not below yield"},
  {"bodies.*.material.hardening.voce.rate", REAL, REQUIRED, .range = "(0, inf)", .help = "rate of the saturation"},
  {"bodies.*.material.hardening.swift", MAP,
   .help = "strength*(e0 + strain)^exponent - yield, where e0 = (yield/strength)^(1/exponent)"},
  {"bodies.*.material.hardening.swift.strength", REAL, REQUIRED, .range = "(0, inf)", .unit = "stress",
   .help = "yield stress at e0 + strain = 1"},
  {"bodies.*.material.hardening.swift.exponent", REAL, REQUIRED, .range = "(0, 1]", .help = "exponent"},
  {"bodies.*.material.kinematic", LIST, .range = "[1, 4]",
   .help = "of von_mises: backstresses of Armstrong and Frederick, which are added"},
  {"bodies.*.material.kinematic.*", MAP, .help = "a backstress"},
  {"bodies.*.material.kinematic.*.C", REAL, REQUIRED, .range = "(0, inf)", .unit = "stress",
   .help = "slope of the backstress over the plastic strain, in tension and at its start"},
  {"bodies.*.material.kinematic.*.gamma", REAL, .range = "[0, inf)", .preset = "0",
   .help = "rate of its recovery: in tension it grows to C/gamma; 0: it grows on"},
  {"bodies.*.material.perzyna", MAP,
   .help = "of von_mises: the plastic strain grows at the rate speed*((stress - yield stress)/overstress)^power"},
  {"bodies.*.material.perzyna.overstress", REAL, REQUIRED, .range = "(0, inf)", .unit = "stress",
   .help = "excess over the yield stress at the rate speed"},
  {"bodies.*.material.perzyna.speed", REAL, REQUIRED, .range = "(0, inf)",
   .help = "plastic strain in a unit of the load parameter t, which is the time"},
  {"bodies.*.material.perzyna.power", REAL, .range = "[1, inf)", .preset = "1", .help = "power of the excess"},
  {"bodies.*.material.library", FILENAME,
   .help = "of umat, needed there: a shared library with Abaqus's UMAT interface, loaded with -trust on the command line only; "
           "the path counts from the folder of the scene. E and nu are the moduli of the undeformed state there, for "
           "penalties"},
  {"bodies.*.material.constants", NUMBERS, .help = "of umat: PROPS"},
  {"bodies.*.material.unsymmetric", BOOLEAN, .preset = "false",
   .help = "of umat: true takes the whole of DDSDDE, false its symmetric part"},
  {"bodies.*.material.states", INTEGER, .range = "[0, 100]", .preset = "0", .help = "of umat: NSTATV"},
  {"bodies.*.formulation", CHOICE, .values = "full | enhanced | fbar | mixed | auto", .preset = "auto",
   .help = "formulation of the elements; enhanced and fbar are for first-order quadrilaterals and bricks, of which "
           "enhanced bends without locking and fbar keeps its volume without locking. mixed has pressures of its own, "
           "for materials that keep their volume nearly or exactly. auto: mixed where the bulk modulus is above 20 times the shear modulus (nu above 0.475), "
           "otherwise full; von_mises takes fbar for quadrilaterals and bricks of order 1 and mixed for the others, umat fbar and full"},
  {"bodies.*.pretension", MAP,
   .help = "tightens the body, which is the shank of a bolt: its unloaded length becomes shorter by what the force "
           "needs. What it clamps must hold it from the start, so touch: nothing else resists the force"},
  {"bodies.*.pretension.axis", POINT, REQUIRED,
   .help = "direction of the bolt, of any length; about an axis it is [0, 1]. It does not turn with the body"},
  {"bodies.*.pretension.force", REAL | FORMULA, REQUIRED, .unit = "force",
   .help = "tension in the bolt, the mean over its length; in the plane over thickness, axisymmetric over 360 degrees. "
           "A number is multiplied by the history, an expression is of t"},
  {"bodies.*.pretension.history", HISTORY, .preset = "[[0, 0], [1, 1]]",
   .help = "factor on force over the load parameter t"},
  {"bodies.*.pretension.during", NAME | TEXTS,
   .help = "steps in which the force acts, in the place of history, as loads.N.during"},
  {"bodies.*.pretension.locked", REAL | NAME, .range = "[0, 1]",
   .help = "load parameter, or name of a step whose start it is, from which the bolt keeps the unloaded length that it has "
           "then, and its force follows from the other loads; the default is never"},
  {"bodies.*.surface", TEXT, .help = "physical surface of a rigid tool; needs rigid"},
  {"bodies.*.rigid", MAP, .help = "makes the surface a meshed rigid tool"},
  {"bodies.*.rigid.point", POINT, .unit = "length",
   .help = "point about which the tool rotates; the default is the origin"},
  MOTION_KEYS("bodies.*.rigid"),
  {"supports", LIST, .help = "surfaces whose displacement is held at 0, held by springs or imposed by an expression"},
  {"supports.*", MAP, .help = "a surface with at least one component or springs"},
  {"supports.*.surface", TEXT, REQUIRED, .help = "physical surface"},
  {"supports.*.ux|uy", REAL | FORMULA, .unit = "length",
   .help = "0 holds this component of the displacement, with during where it is when the support comes; an expression "
           "imposes it, as in loads"},
  {"supports.*.uz", REAL | FORMULA, SOLID, .unit = "length",
   .help = "0 holds this component of the displacement, with during where it is when the support comes; an expression "
           "imposes it, as in loads"},
  {"supports.*.spring", POINT, .range = "[0, inf)", .unit = "force per length and area",
   .help = "stiffness of springs from the surface to the ground, along each axis; an axisymmetric scene has the radius "
           "as x. They act on the reference area along the axes, however the body moves"},
  {"supports.*.history", HISTORY, .help = "factor on spring over the load parameter t; without the key it is 1"},
  {"supports.*.during", NAME | TEXTS,
   .help = "step, or list of steps one after the other, in which the support holds; several entries for one surface let "
           "it come again. Where it comes, 0 holds the displacement that is there by then, and an expression is reached "
           "at the end of the first step, from there evenly. Where it leaves, its last forces fade evenly over the step "
           "that follows. Springs come and fade as loads.N.during, in the place of history; in the first step of all "
           "they are there from the start"},
  {"loads", LIST,
   .help = "loads, each of one kind and equal to its value multiplied by its history. A value may be an expression "
           "such as \"1e7 + 1e6*cos(2*theta)\", in x, y, z (reference coordinates), r = sqrt(x^2 + y^2), theta = "
           "atan2(y, x) in radians, and the load parameter t; axisymmetric scenes have r = x and no theta, scenes in "
           "the plane no z. An expression with t is the value at t itself and takes no history, not even the default "
           "one. Of functions there are sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, exp, ln, log10, "
           "sqrt, abs, sign, min and max, besides pi, ^ for powers, comparisons and a ? b : c"},
  {"loads.*", MAP, .help = "displacement components, a pressure, a traction, a force or a body force"},
  {"loads.*.surface", TEXT, .help = "physical surface on which a displacement, a pressure, a traction or a force acts; for displacements and "
           "forces it may be a curve or points"},
  {"loads.*.volume", TEXT, .help = "physical volume on which a body force acts"},
  {"loads.*.ux|uy", REAL | FORMULA, .unit = "length", .help = "imposed displacement component"},
  {"loads.*.uz", REAL | FORMULA, SOLID, .unit = "length", .help = "imposed displacement component"},
  {"loads.*.pressure", REAL | FORMULA, .unit = "stress", .help = "pressure, positive against the outward normal"},
  {"loads.*.follower", BOOLEAN, .preset = "false", .help = "true: the pressure acts on the deformed face"},
  {"loads.*.where", CHOICE, .values = "everywhere | open", .preset = "everywhere",
   .help = "open: the pressure is that of a fluid that enters between surfaces in contact; it acts where contact "
           "presses less than the fluid, as far as such places are connected to the wetted end; a master that deforms needs "
           "such a load of its own"},
  {"loads.*.from", TEXT | POINT, .unit = "length",
   .help = "wetted end of where: open, from which the fluid enters: a physical surface with nodes of the loaded one, or "
           "a point of the loaded one in the reference state, which is taken to its nearest node; the default in two "
           "dimensions is the end of the loaded line that is open at the start, if only one is"},
  {"loads.*.to", TEXT | POINT, .unit = "length",
   .help = "end at which the fluid of where: open leaks, like from; the default in two dimensions is the other end of "
           "the loaded line, else no leak is looked for"},
  {"loads.*.traction", POINT | FORMULA, .unit = "force per reference area", .help = "traction of fixed direction"},
  {"loads.*.force", POINT | FORMULA, .unit = "force",
   .help = "force of fixed direction in all: spread evenly over the faces of a surface, or in equal parts over the nodes "
           "of a curve or of points; in the plane over thickness, axisymmetric over 360 degrees; an expression may have t "
           "only"},
  {"loads.*.body_force", POINT | FORMULA, .unit = "force per reference volume",
   .help = "body force, such as the weight"},
  {"loads.*.history", HISTORY, .preset = "[[0, 0], [1, 1]]",
   .help = "factor on the value over the load parameter t; not allowed beside an expression with t"},
  {"loads.*.during", NAME | TEXTS,
   .help = "step, or list of steps one after the other, in which the load acts, in the place of history: it grows in the "
           "first one, stays until the last one ends, and goes to 0 in the step that follows. A displacement grows over "
           "all of them and stays"},
  {"contact", LIST, .help = "contact pairs of a slave and a master surface, and lists of surfaces that meet each other"},
  {"contact.*", MAP, .help = "one contact pair, with slave and master, or a list of surfaces"},
  {"contact.*.name", NAME, REQUIRED, .help = "name of the pair in probes and results"},
  {"contact.*.surfaces", TEXTS | CHOICE, .values = "all",
   .help = "surfaces of deformable bodies, each in contact with itself and with all others, both sides treated alike; "
           "rigid tools among them are masters. all: the outer faces of every body, and every tool. It takes the place "
           "of slave and master. With one surface the pair has the entry's name, else the names are NAME.SLAVE.MASTER, "
           "with bodies' names for all; entries that name two of these surfaces as slave and master replace their pair. "
           "Sides of a sharp convex edge of one body are joined: A+B is then the name of one surface"},
  {"contact.*.exclude", LIST, .help = "pairs of surfaces, or of bodies where surfaces is all, that do not meet"},
  {"contact.*.exclude.*", TEXTS, .help = "two names, or one: it does not meet itself"},
  {"contact.*.during", NAME | TEXTS,
   .help = "step, or list of steps one after the other, in which the pair is there: it comes over the first one, where that "
           "is not the first of all, and fades over the step that follows the last one. Elsewhere the surfaces pass "
           "through each other, and must not be deeper in each other than elements when it comes"},
  {"contact.*.history", HISTORY,
   .help = "part of the pair that is there over the load parameter t, from 0 to 1, as during makes it; without both it is 1"},
  {"contact.*.slave", TEXT, .help = "physical surface of a deformable body; needed without surfaces"},
  {"contact.*.master", TEXT | MAP,
   .help = "a physical surface or an analytic surface; needed without surfaces. With surfaces, an analytic surface that "
           "each of them meets as well"},
  {"contact.*.master.plane|cylinder|sphere", MAP, .help = "an analytic rigid master"},
  {"contact.*.master.plane.point", POINT, REQUIRED, .unit = "length", .help = "a point of the plane"},
  {"contact.*.master.plane.normal", POINT, REQUIRED, .help = "normal that points out of the obstacle, of any length"},
  {"contact.*.master.cylinder.point", POINT, REQUIRED, .unit = "length", .help = "a point of the cylinder's axis"},
  {"contact.*.master.cylinder.axis", POINT, REQUIRED | SOLID,
   .help = "direction of the cylinder's axis, of any length"},
  {"contact.*.master.sphere.centre", POINT, REQUIRED, .unit = "length", .help = "centre of the sphere"},
  {"contact.*.master.cylinder|sphere.radius", REAL, REQUIRED, .range = "(0, inf)", .unit = "length", .help = "radius"},
  {"contact.*.master.cylinder|sphere.side", CHOICE, .values = "outside | inside", .preset = "outside",
   .help = "side of the surface on which the slave is"},
  MOTION_KEYS("contact.*.master.plane|cylinder|sphere"),
  {"contact.*.roles", CHOICE, .values = "auto | keep", .preset = "auto",
   .help = "auto: where the master is a body with an edge sharper than 90 degrees that stands on the slave at the start, "
           "and no probe asks for a place on the slave, slave and master are taken the other way round; keep: they stay"},
  {"contact.*.master_normal", CHOICE, .values = "auto | flip | keep", .preset = "auto",
   .help = "side of a meshed rigid master on which the slave is; auto: where the slave starts; flip: against the "
           "normals of the mesh; keep: along them"},
  {"contact.*.smoother", CHOICE, .values = SMOOTHER_CHOICES, .preset = "diffuse",
   .help = "surface of the master in the contact: its faces (facet) or a smooth surface near them (diffuse)"},
  {"contact.*.formulation", CHOICE, .values = "node_to_surface | surface_to_surface | auto", .preset = "auto",
   .help = "where the gap is measured: at the nodes of the slave, or at quadrature points of its faces; auto: "
           "surface_to_surface, and node_to_surface where the master is an analytic surface (but for faces of 6-node "
           "triangles)"},
  {"contact.*.offset", CHOICE, .values = "held | live", .preset = "held",
   .help = "of surface_to_surface; held: the offsets are computed before each solve; live: they follow the nodes "
           "within the solve"},
  {"contact.*.degree", CHOICE, .values = "4 | 2", .preset = "4", .help = "polynomial degree of the diffuse fit"},
  {"contact.*.support", REAL, .range = "(0, inf)", .unit = "spacings",
   .help = "radius of the support of the diffuse fit; the default depends on dimension and degree"},
  {"contact.*.weight", REAL, .range = "[3, inf)",
   .help = "exponent of the weight of the diffuse fit; the default depends on dimension and degree"},
  {"contact.*.frame", CHOICE, .values = "local | global", .preset = "local",
   .help = "reference plane of the diffuse fit: one for each slave point, or one for all"},
  {"contact.*.derivatives", CHOICE, .values = "full | diffuse", .preset = "full",
   .help = "tangent of the diffuse fit; diffuse neglects the variation of the weights and is cheaper"},
  {"contact.*.feature_angle", REAL, .range = "(0, 180]", .unit = "degrees", .preset = "45",
   .help = "the neighbourhood of a slave point ends at edges that are as sharp as this angle, or sharper"},
  {"contact.*.symmetry", TEXTS,
   .help = "planar surfaces beyond which the model continues as its mirror image; without the key these are the planes at "
           "which slave or master end square to a support that fixes the normal displacement alone; []: none"},
  {"contact.*.initial_overlap", CHOICE | MAP, .values = "refuse | resolve | ramp | ignore", .preset = "refuse",
   .help = "treatment of overlapping meshes; refuse: as wrong input; resolve: the overlap is removed at once; ramp: "
           "it is removed gradually until t = 1; ignore: it counts as a gap of 0"},
  {"contact.*.initial_overlap.add", REAL | FORMULA, REQUIRED, .unit = "length",
   .help = "interference of parts whose meshes touch: what the slave overlaps the master besides its mesh. It is "
           "multiplied by t, or is an expression with t, as in loads"},
  {"contact.*.stabilise", CHOICE, .values = "auto | true | false", .preset = "auto",
   .help = "auto: a body of the pair that supports leave free is moved into contact along its load, and very weak "
           "springs hold what contact does not; true: so are bodies that supports hold; false: nothing is done"},
  {"contact.*.law", CHOICE, .values = CHOICE_WORDS(CONTACT_LAWS), .preset = "penalty",
   .help = "law of the contact pressure over the gap"},
  {"contact.*.friction", MAP, .help = "Coulomb friction; without the key there is none"},
  {"contact.*.friction.mu", REAL | FORMULA, REQUIRED, .range = "[0, inf)",
   .help = "coefficient of friction, or an expression, as in loads; where that is below 0 it counts as 0"},
  {"contact.*.friction.history", HISTORY,
   .help = "factor on mu over the load parameter t; without the key it is 1. Not allowed beside an expression with t"},
  {"contact.*.friction.over_pressure", TABLE, .unit = "stress and factor",
   .help = "factor on mu over the contact pressure, linear between the points and constant beyond the last one"},
  {"contact.*.friction.cohesion", REAL, .range = "[0, inf)", .unit = "stress", .preset = "0",
   .help = "traction that sticks without pressure, where surfaces are in contact: they slip at cohesion + mu p"},
  {"contact.*.friction.tau_max", REAL, .range = "(0, inf)", .unit = "stress",
   .help = "largest traction of friction, whatever the pressure; without the key there is none"},
  {"contact.*.friction.stick", MAP, .help = "how surfaces stick"},
  {"contact.*.friction.stick.penalty", REAL | CHOICE, .values = "auto", .range = "(0, inf)",
   .unit = "force per length and area", .preset = "auto",
   .help = "traction over the elastic slip of surfaces that stick; auto: the stiffness of the softer body's elements "
           "below the surface, or penalty.initial if that is less, raised by the run where it chooses both penalties and "
           "elastic slip leaves more than 0.4 % of error"},
  {"contact.*.friction.stick.slip", REAL, .range = "(0, 1]", .unit = "face size",
   .help = "largest elastic slip of a node, in sizes of the slave's faces around it: each step has the penalty for it by "
           "the pressures with which it begins, and the automatic one before there is pressure. Not allowed beside "
           "stick.penalty"},
  {"contact.*.penalty", MAP, .help = "the penalty (force per penetration and area) and its adjustment"},
  {"contact.*.penalty.initial", REAL | CHOICE, .values = "auto", .range = "(0, inf)",
   .unit = "force per length and area", .preset = "auto",
   .help = "penalty at the start of the run"},
  {"contact.*.penalty.scale", REAL | CHOICE, .values = "auto", .range = "(0, inf)", .preset = "auto",
   .help = "factor on the penalty; for initial: auto, 1 is the stiffness of the softer body's elements below the "
           "surface; auto: " SCENE_PENALTY_SCALE_TEXT " (" SCENE_FRICTION_SCALE_TEXT " with friction), raised by the run where penetration leaves more than 0.4 % of error in forces or displacements, or 4 % in the mean pressure; with accuracy a number is raised, too, until penetration leaves a third of what is allowed; "
           "1 with another initial value, adjust or augment"},
  {"contact.*.penalty.adjust", BOOLEAN, .preset = "false",
   .help = "true: the penalty follows the penetration; needs g_min, g_max and unit"},
  {"contact.*.penalty.when", CHOICE, .values = "step | converged", .preset = "converged",
   .help = "of adjust; step: the new penalty is used from the next step on; converged: each step is solved again "
           "until the penetrations are in the window"},
  {"contact.*.penalty.augment", BOOLEAN, .preset = "false",
   .help = "true: the penalty is kept, pressures and tractions of friction become multipliers, and each step is solved "
           "again until no node in contact is beyond g_max; needs g_max and unit"},
  {"contact.*.penalty.max_updates", INTEGER, .range = "[1, 1000]", .preset = "10",
   .help = "largest number of multiplier updates of augment in one step; the step is then accepted as it is, and the "
           "report counts such steps"},
  {"contact.*.penalty.g_min|g_max", REAL, .range = "(0, inf)", .unit = "unit",
   .help = "window of the penetration; for augment, g_max bounds the penetration on either side, and the elastic slip "
           "of nodes that stick"},
  {"contact.*.penalty.unit", CHOICE, .values = "length | spacing",
   .help = "unit of g_min and g_max; spacing is the slave node's face size"},
  {"contact.*.penalty.clamp", REAL, .range = "(1, inf)", .preset = "100", .help = "largest factor of one adjustment"},
  {"contact.*.penalty.range", REAL, .range = "(1, inf)", .preset = "1e4",
   .help = "largest factor by which the penalty may differ from the automatic one"},
  {"stepping", MAP, .help = "load steps"},
  {"stepping.control", CHOICE, .values = CHOICE_WORDS(STEP_CONTROLS), .preset = "iterations",
   .help = "control of the step size; contact needs N_c or N_c_fraction"},
  {"stepping.initial", REAL, .range = "(0, 1]", .preset = "0.1",
   .help = "first step of the load parameter; with accuracy, where strains are small and nothing yields or rubs, the "
           "default is dt_max, as the way to the answer does not count"},
  {"stepping.N_c", INTEGER, .range = "[1, inf)", .unit = "nodes",
   .help = "number of nodes that come into contact in a step; not allowed with N_c_fraction"},
  {"stepping.N_c_fraction", REAL, .range = "(0, 1]",
   .help = "fraction of the slave area that comes into contact in a step"},
  {"stepping.prediction", CHOICE, .values = "converged | tangent", .preset = "converged",
   .help = "prediction of control: contact; converged: from the solution of the step; tangent: by one linear solve "
           "before the step"},
  {"stepping.dt_min", REAL, .range = "(0, 1]", .preset = "1e-5",
   .help = "smallest step of the load parameter; the run ends if it needs a smaller one"},
  {"stepping.dt_max", REAL, .range = "(0, 1]", .preset = "1", .help = "largest step of the load parameter"},
  {"stepping.growth", REAL, .range = "[1, inf)", .preset = "4", .help = "largest factor from one step to the next"},
  {"stepping.plastic_strain", REAL, .range = "(0, inf)",
   .help = "largest growth of the equivalent plastic strain of a quadrature point in a step; a step with more is "
           "repeated with a smaller dt, down to dt_min. Without the key there is no bound"},
  {"stepping.plastic_lag", REAL, .range = "[0, inf)", .preset = "0.2",
   .help = "largest part by which the stresses of bodies that yield may lag behind their flow in a step, the mean "
           "weighted with plastic work; a step with more is repeated with a smaller dt as long as that lessens it, "
           "down to dt_min. 0: no bound, as without the key where control is fixed"},
  {"stepping.contact_travel", REAL, .range = "[0, 1]", .preset = "0.02",
   .help = "how far a contact with friction may travel along its slave in a step, as it does where bodies roll: the part "
           "of its force at nodes that have come into contact in the step and stick, at most that of nodes that have "
           "left, over the larger one of the forces before and now. A step with more is repeated with a smaller dt as "
           "long as that lessens it, down to dt_min. 0: no bound, as without the key where control is fixed"},
  {"stepping.damping", CHOICE, .values = "none | last | auto", .preset = "last",
   .help = "where static steps fail, Newton's method goes on with a tangent that is stiffened as long as it is not "
           "positive definite; the end is a static equilibrium, and the last screen says how much energy was lost. last: "
           "where the run would stop, and once before, after six failed solves for a load, or after a failed one where an "
           "unstable equilibrium follows a stable one; auto: each time after three failed solves for a load, where an "
           "unstable equilibrium after a stable one counts as a failure; none: never"},
  {"stepping.at", REALS, .range = "(0, 1]", .help = "load parameters at which a step must end"},
  {"stepping.steps", LIST, .range = "[1, inf)",
   .help = "parts of the way from t = 0 to 1, with names that `during` uses. Each may have many load steps, and one ends "
           "at each of their ends"},
  {"stepping.steps.*", MAP, .help = "a step with a name"},
  {"stepping.steps.*.name", NAME, REQUIRED, .help = "its name"},
  {"stepping.steps.*.until", REAL, REQUIRED, .range = "(0, 1]",
   .help = "load parameter at which it ends; increasing from one step to the next, the last one 1"},
  {"solver", MAP, .help = "nonlinear and linear solver"},
  {"solver.type", CHOICE, .values = "direct | iterative | auto", .preset = "auto",
   .help = "linear solver; auto chooses it by the number of unknowns. Mixed triangles and tetrahedra of first order "
           "need the direct one"},
  {"solver.tolerance", REAL, .range = "(0, 1)", .preset = "1e-8",
   .help = "residual over the reference force at which a solve has converged"},
  {"solver.max_iterations", INTEGER, .range = "[1, 10000]", .preset = "30",
   .help = "largest number of iterations of Newton's method in one solve"},
  {"solver.hold_rolling", BOOLEAN, .preset = "true",
   .help = "true: where a body rolls that only contact holds, without friction, and what stops the roll is no more than "
           "errors of the mesh, it is held as by a coefficient of friction of 0.001 at most, in space of 0.01 or 0.1 where "
           "that fails; the last screen says what it took; false: it never is"},
  {"probes", LIST, .help = "scalar results in steps.csv and summary.json"},
  {"probes.*", MAP, .help = "a probe of exactly one kind"},
  {"probes.*.name", NAME, REQUIRED, .help = "name of its column in steps.csv"},
  {"probes.*.reaction", TEXT,
   .help = "force on this surface through supports and imposed displacements, or the force that moves or holds this "
           "rigid tool, which is the opposite of the forces of all contact on it; needs component"},
  {"probes.*.reaction_torque", TEXT, .unit = "force times length",
   .help = "moment about an axis of the forces that reaction adds up: on this surface, or on this rigid tool; needs axis "
           "in 3D, in the plane it is z"},
  {"probes.*.contact_force", TEXT, .help = "force of this contact pair on its master; needs component"},
  {"probes.*.contact_torque", TEXT, .unit = "force times length",
   .help = "moment about an axis of the forces of this contact pair on its master, friction's among them; needs axis in "
           "3D, in the plane it is z"},
  {"probes.*.tool_motion", TEXT, .unit = "length",
   .help = "displacement of the point of the rigid tool that is this pair's master; needs component"},
  {"probes.*.tool_rotation", TEXT, .unit = "degrees",
   .help = "component of the rotation vector of the rigid tool that is this pair's master; needs component in 3D"},
  {"probes.*.bolt_force", TEXT, .unit = "force", .help = "tension in this body, which has pretension"},
  {"probes.*.bolt_shortening", TEXT, .unit = "length",
   .help = "what tightening has taken from the unloaded length of this body, which has pretension"},
  {"probes.*.displacement", POINT, .unit = "length",
   .help = "displacement of the point of a body that is here in the reference configuration; needs component"},
  {"probes.*.distance", POINTS, .unit = "length", .help = "distance of two points of bodies, given in the reference configuration"},
  {"probes.*.gap", TEXT, .help = "gap at a slave node of this contact pair; needs at with a point"},
  {"probes.*.contact_edge", TEXT,
   .help = "end of the contact zone of this pair along an axis; needs axis and side, and in 3D at"},
  {"probes.*.pressure_max|pressure_mean", TEXT, .help = "largest or mean contact pressure over the nodes of this pair"},
  {"probes.*.pressure_deviation", TEXT, .unit = "per cent",
   .help = "deviation of the contact pressure from the mean pressure of this pair"},
  {"probes.*.contact_area", TEXT, .unit = "area",
   .help = "reference area of the slave nodes of this contact pair that bear pressure"},
  {"probes.*.friction_force", TEXT, .help = "friction force of this contact pair on its master; needs component"},
  {"probes.*.friction_torque", TEXT, .unit = "force times length",
   .help = "moment of the friction forces of this contact pair on its master, about an axis; needs axis in 3D, in the "
           "plane it is z"},
  {"probes.*.slipped_area", TEXT, .unit = "area", .help = "reference area of the nodes of this contact pair that slip"},
  {"probes.*.elastic_slip", TEXT, .unit = "length",
   .help = "largest elastic slip of a node of this contact pair, by which what sticks gives way"},
  {"probes.*.fluid_front", TEXT,
   .help = "coordinate to which the fluid of where: open has come on this surface; needs axis and side"},
  {"probes.*.fluid_area", TEXT, .help = "part of this surface that the fluid of where: open wets, from 0 to 1"},
  {"probes.*.seal_pressure", TEXT, .unit = "stress",
   .help = "lowest pressure of the fluid of where: open that would overcome the contact on this surface as it is; no "
           "value after a leak"},
  {"probes.*.component", CHOICE, .values = "x | y | z", .help = "component of a force or displacement"},
  {"probes.*.body", TEXT, .help = "volume of the node, if two bodies have a node at the point"},
  {"probes.*.change", BOOLEAN, .preset = "false", .help = "of distance; true: the reference distance is subtracted"},
  {"probes.*.at", POINT | MAP, .unit = "length",
   .help = "for gap a point; for a torque a point of the axis, by default the origin; for pressure_mean the middle "
           "of a patch; for contact_edge and pressure_max one reference coordinate, such as {z: 100}"},
  {"probes.*.within", REAL, .range = "(0, inf)", .unit = "length",
   .help = "of pressure_mean: the mean is that of a patch of this radius around the point at; what lies at the "
           "distance r counts by (1 - (r/within)^2)^2"},
  {"probes.*.at.x|y", REAL, .unit = "length", .help = "reference coordinate"},
  {"probes.*.at.z", REAL, SOLID, .unit = "length", .help = "reference coordinate"},
  {"probes.*.axis", CHOICE, .values = "x | y | z",
   .help = "of contact_edge and fluid_front: axis along which the end is searched; of a torque: its own"},
  {"probes.*.side", CHOICE, .values = "min | max",
   .help = "of contact_edge and fluid_front: the lower or the upper end"},
  {"probes.*.measure", CHOICE, .values = "max | rms", .preset = "max",
   .help = "of pressure_deviation: the largest deviation or the root of the mean square"},
  {"probes.*.excluding", REAL, .range = "(0, inf)", .unit = "face sizes",
   .help = "of pressure_deviation: nodes within this distance of a free edge are left out"},
  {"probes.*.only", REAL, .range = "(0, inf)", .unit = "face sizes",
   .help = "of pressure_deviation: only nodes within this distance of a free edge are taken"},
  {"probes.*.absolute", BOOLEAN, .preset = "false", .help = "true: the absolute value is taken"},
  {"probes.*.factor", REAL, .preset = "1", .help = "factor on the value"},
  {"output", MAP, .help = "results that are written"},
  {"output.every", INTEGER, .range = "[0, inf)", .unit = "steps", .preset = "1",
   .help = "steps between two outputs of the fields; 0: only the last state is written"},
  {"output.fields", CHOICES, .values = "displacement | stress | contact | principal | strain",
   .help = "fields that are written; the default is displacement, stress and contact. principal: principal stresses and "
           "their directions; strain: strain and energy density"},
  {"output.checkpoint", INTEGER, .range = "[0, inf)", .unit = "steps", .preset = "0",
   .help = "steps between two checkpoints; 0: only when the run ends early"},
  {"output.certificate", BOOLEAN, .preset = "true",
   .help = "true: each step is judged before it is accepted: nothing passed through anything unseen"},
  {"output.error", CHOICE, .values = "false | true | history", .preset = "false",
   .help = "true: the error of each probe is estimated at the end, split by cause; one more solve for each. history: where "
           "the answer depends on the way to it, what the load steps leave, too, by a second run with half of them"},
  {"accuracy", MAP,
   .help = "meshes are made and solved on until a probe is accurate; the run ends with status 5 if it does not get there"},
  {"accuracy.probe", TEXT, REQUIRED, .help = "name of the probe; its error must have an estimate (output.error)"},
  {"accuracy.to", REAL, REQUIRED, .range = "(0, 100)", .unit = "per cent",
   .help = "the error that is allowed: the sum of the magnitudes of all estimated parts, over the probe's value"},
  {"accuracy.densities", FREE,
   .help = "parameters of the .geo file that refine the mesh, each `count` (a number of elements), `size` (of elements) "
           "or `divisor` (of sizes); the default is those whose Name in the .geo begins with elements or faces (count), "
           "element size (size) or divides (divisor)"},
  {"accuracy.meshes", INTEGER, .range = "[1, 100]", .preset = "10", .help = "number of meshes at most"},
  {"accuracy.limit", MAP, .help = "what the run may use; a mesh that is forecast to need more is not begun"},
  {"accuracy.limit.time", REAL, .range = "(0, inf)", .unit = "s", .help = "CPU time of all meshes and ranks together"},
  {"accuracy.limit.memory", REAL, .range = "(0, inf)", .unit = "MB", .help = "memory of the largest rank"},
  {"sensitivity", TEXTS,
   .help = "derivatives of probes by numbers of the scene at the end of the load, each PROBE:KEY or PROBE:KEY,KEY, such as "
           "force:bodies.0.material.E; the result is in sensitivity.csv"},
  {"certificate", MAP, .help = "what a step must hold to be certified"},
  {"certificate.penetration", REAL, .range = "(0, inf)", .unit = "face sizes", .preset = "0.1",
   .help = "largest depth to which faces may cross, in sizes of the smaller face, besides what the shape of faces "
           "explains; at most a quarter of the height of the elements below them"},
  {"units", MAP,
   .help = "words for the user's units, which results and pictures then name. Nothing is converted: numbers must be in "
           "consistent units"},
  {"units.length", TEXT, .help = "such as mm"},
  {"units.force", TEXT, .help = "such as N"},
  {"units.stress", TEXT, .help = "such as MPa; the default is force over length squared"},
  {"petsc", FREE, .help = "PETSc options without the dash, such as snes_monitor"},
};
// clang-format on

const int SchemaKeysCount = sizeof SchemaKeys / sizeof SchemaKeys[0];

/*@
  WordFind - returns the index of a word in a list of words.

  Not collective

  Input Parameters:
+ words - the list, or NULL
. apart - characters that separate the words of the list
. text  - the word
- n     - its number of characters

  Note:
  The index is counted from 0. It is -1 if the list does not have the word.
@*/
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

/* Tells whether a component of a pattern, names with | between them or *, stands for one of a path. np, nt: lengths. */
static int ComponentMatches(const char *pattern, size_t np, const char *path, size_t nt)
{
  if (np == 1 && *pattern == '*') return KeyPathComponentIsIndex(path);
  for (size_t first = 0, n; first < np; first += n + 1) {
    const char *bar = memchr(pattern + first, '|', np - first);

    n = bar ? (size_t)(bar - pattern) - first : np - first;
    if (n == nt && !memcmp(pattern + first, path, n)) return 1;
  }
  return 0;
}

/* Tells whether a path matches the first n characters of a pattern. */
static int PatternMatches(const char *pattern, size_t n, const char *path)
{
  const char *end = pattern + n;

  while (pattern < end && *path) {
    const size_t np = KeyPathComponent(pattern), nt = KeyPathComponent(path);

    if (!ComponentMatches(pattern, np, path, nt)) return 0;
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

/* Returns the length of a pattern without its last component, which is the pattern of its parent. */
static size_t PatternParent(const char *pattern)
{
  const char *dot = strrchr(pattern, '.');

  return dot ? (size_t)(dot - pattern) : 0;
}

/*@
  SchemaKeyName - returns the last component of a key's path.

  Not collective

  Input Parameter:
. key - entry of the table

  Note:
  The component is "a|b" if the entry stands for key a and for key b.
@*/
const char *SchemaKeyName(const SchemaKey *key)
{
  const char *dot = strrchr(key->path, '.');

  return dot ? dot + 1 : key->path;
}

/*@
  SchemaKeyIsChild - tells whether a key belongs to the map at a path.

  Not collective

  Input Parameters:
+ key  - entry of the table
- path - path of the map

  Note:
  It returns 1 or 0.
@*/
int SchemaKeyIsChild(const SchemaKey *key, const char *path)
{
  return PatternMatches(key->path, PatternParent(key->path), path);
}

/*@
  SchemaKeyFind - returns the entry of the table that describes a path.

  Not collective

  Input Parameter:
. path - path of a value in a document

  Note:
  It returns NULL if the schema has no such key.
@*/
const SchemaKey *SchemaKeyFind(const char *path)
{
  for (int i = 0; i < SchemaKeysCount; i++) {
    if (PatternMatches(SchemaKeys[i].path, strlen(SchemaKeys[i].path), path)) return &SchemaKeys[i];
  }
  return NULL;
}
