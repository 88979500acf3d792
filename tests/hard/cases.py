"""The hard cases as data: what is run, what makes it hard, and what must come of it. Figures are bounds, rounded up
from what was measured; where facets fail and the diffuse surface does not, that is the outcome written down."""
import cmath
import pathlib
from dataclasses import dataclass, field
from math import inf, radians

from expect import All, Balance, Certified, Done, Most, Near, Refused, Same, Stops, Told, Turned, Uniform

HERE = pathlib.Path(__file__).resolve().parent
RUNS, SCENES = HERE.parent.parent / "runs", HERE.parent / "scenes"
GROUPS = ("geometry", "contact", "guards", "steps", "certificate", "numbers")


@dataclass
class Case:
    group: str
    name: str
    hard: str  # what makes it so
    scene: pathlib.Path | None  # None: tested elsewhere, by what `expected` names
    overrides: list = field(default_factory=list)
    expected: object = None  # one expectation, or a tuple by variant
    pairs: int = 1  # contact pairs of the scene
    ranks: float = 1e-7  # by how much probes may depend on the number of ranks, of the largest: paths amplify round-off


def mesh(**parameters):
    """Overrides of the mesh's parameters."""
    return [f"mesh.parameters.{name}={value}" for name, value in parameters.items()]


SQUEEZE, SOLID = HERE / "squeeze.yaml", HERE / "squeeze_solid.yaml"
PUNCH, ARCH, LIP = HERE / "punch.yaml", HERE / "arch.yaml", HERE / "lip.yaml"
SPHERES, PIPE, SLIDE = RUNS / "spheres.yaml", RUNS / "pipe_pinch.yaml", RUNS / "slide_flat.yaml"
STACK = SCENES / "stack.yaml"
FORCES = ("force", "top", "bottom")  # of the punch: one force
ANSWER = ("force", "sideways")
VECTOR = ("sideways", "down")
SWAPPED, UNSWAPPED = (["contact.0.slave=lower_contact", "contact.0.master=upper_contact"],
                      ["contact.0.slave=upper_contact", "contact.0.master=lower_contact"])

# The squeezed blocks drawn closer by an overlap between rollers: p = M overlap / (2 H + M / penalty), M the modulus
# without side strain.
OVERLAP, MODULUS = 0.002, 1000 * 0.7 / (1.3 * 0.4)
CLOSED = [
    "supports=[{surface: lower_far, uy: 0}, {surface: upper_far, uy: 0}, {surface: lower_x_low, ux: 0}, {surface: "
    "upper_x_low, ux: 0}, "
    "{surface: lower_x_high, ux: 0}, {surface: upper_x_high, ux: 0}]", "loads=[]"
]
# The punch as a flat block, and its solid form.
FLAT = mesh(bulge=0) + ["loads.0.ux=0"]
FLAT_SOLID = mesh(n_z=1, bulge=0) + [
    "geometry=solid", "supports=[{surface: lower_far, ux: 0, uy: 0, uz: 0}]",
    "loads=[{surface: upper_far, ux: 0, uy: -0.05, uz: 0}]"
]
# The squeezed blocks with a lower one in two halves.
SEAM = mesh(seam=1) + [
    "bodies.2={volume: right, material: {law: linear, E: 1000, nu: 0.3}}",
    "loads.3={surface: right_x_high, pressure: 1}",
    "supports=[{surface: lower_far, uy: 0}, {surface: right_far, uy: 0}, {surface: lower_x_low, ux: 0}, {surface: "
    "right_x_low, ux: 0}, "
    "{surface: upper_x_low, ux: 0}]"
]
# Two rigid walls alone hold the upper block; the corner node is in both pairs.
WALLS = [
    "contact=[{name: joint, slave: upper_contact, master: {plane: {point: [0, 0], normal: [0, 1]}}, penalty: {initial: "
    "auto, scale: 100}}, "
    "{name: wall, slave: upper_x_low, master: {plane: {point: [0, 0], normal: [1, 0]}}, penalty: {initial: auto, "
    "scale: 100}}]",
    "supports=[{surface: lower_far, ux: 0, uy: 0}]",
    "loads=[{surface: upper_far, pressure: 1}, {surface: upper_x_high, pressure: 1}]",
    "probes.2={name: wall, contact_force: wall, component: x, absolute: true}"
]
# Nothing but contact holds the upper block.
HELD = mesh(n_lower=13,
            gap=0.01) + ["supports=[{surface: lower_far, ux: 0, uy: 0}]", "loads=[{surface: upper_far, pressure: 1}]"]
# A block over a thin plate over a floor: the master is both their upper sides, 1.5 apart, and the penalty so soft that
# the block goes right into the plate.
SVK = "material: {law: svk, E: 1000, nu: 0.3}"
PLATE = mesh(floor=1.5, thickness=0.1) + [
    f"bodies=[{{volume: lower, {SVK}}}, {{volume: floor, {SVK}}}, {{volume: upper, {SVK}}}]", "contact.0.master=tops",
    "contact.0.penalty.scale=1e-4",
    "supports=[{surface: lower_bottom, ux: 0, uy: 0}, {surface: floor_bottom, ux: 0, uy: 0}]", "loads.0.uy=-1.5"
]
# A coarse pipe whose symmetry the contact does not know, by Newton steps that no line search shortens.
PLAIN = ["mesh.order=1", "contact.0.symmetry=[]", "petsc={snes_linesearch_type: basic}",
         "probes=[{name: plate_force, reaction: plate_top, component: y, absolute: true}]"]
PINCHED = mesh(n_arc=6, n_len=2)
STROKE = ("plate_force",)
UNJUDGED = "output.certificate=false"
NEEDLE = mesh(**{"from": 0.6, "to": 0.64}, n_lower=4, n_upper=2, bulge=0, gap=0.02) + \
    ["loads.0.ux=0", "loads.0.uy=-0.2", "stepping.initial=1"]
SPIKE = mesh(**{"from": 0.44, "to": 0.56}, n_lower=3, n_upper=8, bulge=0, wedge=1) + \
    ["loads.0.ux=0", "loads.0.uy=-0.1", "stepping.initial=0.5"]
# A sheet that its ends hold.
HELD_SHEET = ["supports=[{surface: lower_x_low, ux: 0, uy: 0}, {surface: lower_x_high, ux: 0, uy: 0}]", "loads.0.ux=0"]
PSI = 0.45359237 * 9.80665 / 0.0254**2 / 1e6  # MPa
INCH = 25.4  # mm
TURNED = complex(0.01, -0.05) * cmath.exp(1j * radians(30))


STIFF = All(Balance(*FORCES), Same("contact.0.penalty.scale=1e3", probes=ANSWER, bound=0.003))


def closed(penalty):
    return MODULUS * OVERLAP / (1 + MODULUS / penalty)


def units(length, stress):
    """The punch's lengths and stresses in other units, by number of mm and MPa in one of them."""
    moduli = [f"bodies.{i}.material.E={1000 / stress!r}" for i in (0, 1)]
    return mesh(unit=repr(1 / length)) + [f"loads.0.ux={0.01 / length!r}", f"loads.0.uy={-0.05 / length!r}", *moduli]


CASES = [
    Case("geometry", "free edge", "half of the slave has no master below, lists are one-sided", PUNCH,
         FLAT + mesh(**{
             "from": 0.5,
             "to": 1.5
         }), All(Balance(*FORCES), Same(*mesh(n_lower=48, n_upper=40), probes=("force",), bound=0.01))),
    Case("geometry", "corner", "a quarter of the slave has a master below", PUNCH,
         FLAT_SOLID + mesh(n_lower=6, n_upper=5, **{
             "from": 0.5,
             "to": 1.5
         }), All(Balance(*FORCES), Same(*mesh(n_lower=12, n_upper=10), probes=("force",), bound=0.1))),
    Case("geometry", "five nodes", "fewer than a fit of degree 4 needs: the ladder of fall-backs", SQUEEZE,
         mesh(n_lower=4), Uniform(1, (0.08, 0.01, 0.15, 0.05))),
    Case("geometry", "collinear or repeated points", "no plane through them, no fit", None,
         expected="a guard fires (unit test_diffusefit)"),
    Case("geometry", "duplicated nodes", "the master is two bodies side by side that share no nodes", SQUEEZE,
         SEAM + mesh(n_lower=14) + ["contact.0.master=tops"], Uniform(1, (0.7, 0.006, 0.7, 0.005))),
    Case("geometry", "jittered nodes", "every interface node moved by up to a quarter of a face", SOLID,
         mesh(jitter=0.25), Uniform(1, (0.4, 0.07, 0.25, 0.04))),
    Case("geometry", "spacing 1:20", "faces of one surface of very different length", SQUEEZE,
         mesh(n_lower=13, ratio=20), Uniform(1, (0.2, 0.02, 0.8, 0.02))),
    Case("geometry", "sharp edge", "the surface turns by 90 degrees: a fit must not see past it", SQUEEZE,
         mesh(n_lower=14, shape=1, rise=0.5, height=1), Uniform(1, (0.8, 0.01, 0.8, 0.005))),
    Case("geometry", "saddle", "curvatures of both signs", SOLID, mesh(n_lower=10, n_upper=8, shape=3),
         Uniform(1, (inf, inf, 0.2, 0.6))),
    Case("geometry", "sphere in a spherical seat", "closed surface, overlap 1/20 of the facets' sagitta", SPHERES,
         mesh(n_inner=5, n_outer=6), Near("mean_pressure", 15.224, (inf, inf, 0.07, 0.05))),
    Case("geometry", "the same, frame: global", "no one reference plane", SPHERES,
         mesh(n_inner=5, n_outer=6) + ["contact.0.frame=global"],
         (Done(), Done(), Refused("turns by 90 degrees"), Refused("turns by 90 degrees"))),
    Case(
        "geometry", "thin wall", "the master's far side is nearer than its next node", SQUEEZE,
        mesh(n_lower=13, wall=0.005, n_height=1) + ["contact.0.master=skin"],
        All(Uniform(1, (0.05, 0.001, 0.05, 0.002)),
            Same("contact.0.master=lower_contact", probes=("force", "deviation"), bound=1e-9))),
    Case("geometry", "nodes on nodes", "every slave node exactly on a vertex of the master", SQUEEZE, mesh(n_upper=12),
         Uniform(1, (1e-9, 1e-9, 0.03, 0.01))),
    Case("geometry", "nodes on middles", "slave nodes exactly on vertices and on middles of faces", SQUEEZE,
         mesh(n_upper=24), Uniform(1, (1e-9, 1e-9, 0.5, 0.02))),
    Case("geometry", "quadrature points on nodes",
         "the middle of a slave face exactly on a vertex that dents: facets have no normal there", SQUEEZE, [],
         Uniform(1, (0.12, 0.01, 0.07, 0.01))),
    Case("geometry", "the same, penalty 1e3", "stiffer: facets push the point to either side of the vertex", SQUEEZE,
         ["contact.0.penalty.scale=1e3"],
         (Uniform(1, 0.12), Stops("line search|max_iterations"), Uniform(1, 0.07), Uniform(1, 0.01))),
    Case("geometry", "master 8 times coarser", "a slave node in the middle of a large face", SQUEEZE,
         mesh(n_lower=3, n_upper=24), Uniform(1, (1e-9, 1e-9, 0.8, 0.002))),
    Case("geometry", "master 8 times finer", "most of the master's faces meet no slave node", SQUEEZE,
         mesh(n_lower=24, n_upper=3), Uniform(1, (0.1, 0.001, 0.15, 0.002))),
    Case("geometry", "one element thick", "thin plates bend at any error of the pressure", SQUEEZE,
         mesh(n_lower=13, n_height=1, height=0.05), Uniform(1, (0.08, 0.002, 0.07, 0.005))),
    Case("contact", "gap exactly 0", "contact alone holds a body that touches without force", SQUEEZE, mesh(n_lower=13),
         Uniform(1, (0.16, 0.008, 0.1, 0.008))),
    Case("contact", "initial overlap", "the scene does not say what to do", PUNCH, mesh(gap=-0.01),
         Refused("initial_overlap")),
    Case(
        "contact", "initial overlap, ramp", "no load but the overlap, brought in with t", SQUEEZE,
        mesh(n_lower=13, gap=-OVERLAP) + CLOSED +
        ["contact.0.initial_overlap=ramp", "contact.0.penalty={initial: 1e6}"],
        All(Near("force", closed(1e6), 0.005), Same("contact.0.initial_overlap=resolve", probes=("force",),
                                                    bound=1e-5))),
    Case(
        "contact", "lost and regained", "pressed, lifted off, pressed again", PUNCH,
        ["loads.0.history=[[0, 0], [0.3, 1], [0.5, -0.2], [1, 1]]"],
        All(Most("contact_nodes", 0, t=0.5),
            Same("loads.0.history=[[0, 0], [1, 1]]", probes=ANSWER, bound=(1e-8, 1e-8, 1e-5, 0.005)))),
    Case("contact", "large slip", "20 facets in 8 steps", SLIDE, ["stepping.initial=0.1"],
         # What ties and springs hold of a free body's motions, here its rotation, is a part of the answer. It is told, and
         # bounded by 1e-7 of the forces.
         All(Near("force_y", 160, (1e-9, 1e-9, 1e-9, 1e-7)), Most("force_x", 160e-9),
             Told("stabilisation.force_share", most=1e-7), Told("stabilisation.held_force_share", most=1e-7))),
    Case("contact", "edge on face", "a sharp edge pressed into a face", PUNCH, mesh(bulge=0, wedge=1),
         All(Balance(*FORCES), Same("stepping.initial=0.02", probes=ANSWER, bound=(1e-8, 1e-8, 2e-4, 2e-4)))),
    Case("contact", "face on edge", "the edge is the master, where a fit must end", PUNCH,
         mesh(bulge=0, wedge=1) + SWAPPED,
         All(Balance(*FORCES), Same("stepping.initial=0.02", probes=ANSWER, bound=(1e-8, 1e-8, 0.001, 0.0005)))),
    *(Case(
        "contact", f"penalty {scale:.0e}".replace("e-0", "e-"), "soft: nearly all of the overlap stays", SQUEEZE,
        mesh(n_lower=13, gap=-OVERLAP) + CLOSED +
        ["contact.0.initial_overlap=resolve", f"contact.0.penalty={{initial: {6e3 * scale:g}}}"],
        Near("force", closed(6e3 * scale), 0.001)) for scale in (1e-4, 1e-2)),
    *(Case("contact", f"penalty {scale}", "stiff: the linear system is badly conditioned", PUNCH,
           [f"contact.0.penalty.scale={scale}"], STIFF) for scale in ("1e2", "1e4")),
    Case("contact", "penalty 1e6",
         "stiffer: where a slave point meets an edge between facets they push it there from either side", PUNCH,
         ["contact.0.penalty.scale=1e6"], STIFF, ranks=1e-3),  # a failed step leaves another history of offsets
    Case("contact", "nu = 0.499", "bulk modulus 500 times the shear modulus", SQUEEZE,
         mesh(n_lower=13) + ["bodies.0.material.nu=0.499", "bodies.1.material.nu=0.499"],
         Uniform(1, (0.12, 0.006, 0.07, 0.005))),
    Case("contact", "slave 8 times denser", "more conditions than the master can follow", PUNCH,
         mesh(n_lower=6, n_upper=40),
         All(Balance(*FORCES), Same(*mesh(n_lower=48, n_upper=40), probes=("force",), bound=0.1))),
    Case("contact", "master 8 times denser", "few slave points for the master", PUNCH, mesh(n_lower=48, n_upper=6),
         All(Balance(*FORCES), Same(*mesh(n_lower=48, n_upper=40), probes=("force",), bound=(0.2, 0.1, 0.2, 0.1)))),
    Case("contact", "slave and master swapped", "the answer should not depend on the choice", PUNCH, SWAPPED,
         All(Balance(*FORCES), Same(*UNSWAPPED, probes=("force",), bound=0.005))),
    Case(
        "contact", "two pairs that share nodes", "a slave node on the seam of two masters is in both pairs", SQUEEZE,
        SEAM + [
            "contact.1={name: other, slave: upper_contact, master: right_contact, "
            "smoother: facet, formulation: node_to_surface, penalty: {initial: auto, scale: 100}}",
            "probes.1={name: other, contact_force: other, component: y, absolute: true}"
        ], All(Near("force", 0.5, 0.1), Near("other", 0.5, 0.1)), pairs=2),
    Case("contact", "corner of two walls", "the corner node is in two pairs, which alone hold the body", SQUEEZE, WALLS,
         All(Uniform(1, 1e-6), Near("wall", 0.5, 1e-6)), pairs=2),
    Case("guards", "held by nothing", "nothing holds a loaded body until it touches", SQUEEZE,
         [*HELD, "contact.0.stabilise=false"], Stops("singular", "holds 'upper'", "stabilise: auto")),
    Case("guards", "held by contact only", "it is moved until it touches, and springs must leave no force behind", SQUEEZE,
         [*HELD, "contact.0.stabilise=auto"], All(Near("force", 1, 1e-6), Told("stabilisation.force_share", most=1e-6))),
    Case("guards", "chatter", "a pinched pipe without mirrored neighbours, no line search: nodes come and go", PIPE,
         [*mesh(n_arc=16, n_wall=2, n_len=4), *PLAIN, "stepping.initial=0.04"],
         Same("petsc={}", probes=STROKE, bound=0.001)),
    Case(
        "guards", "cycle",
        "the same, coarser and with a stiffer penalty: where no step is settled the contact set repeats itself", PIPE, [
            *mesh(n_arc=10, n_len=4), *PLAIN, "petsc={snes_linesearch_type: basic, ksp_type: gmres}",
            "contact.0.penalty.scale=1e4", "stepping.initial=0.1"
        ],
        All(Same("petsc={}", probes=STROKE, bound=(1e-8, 1e-8, 1e-5, 5e-4)),
            Told("cycles.found", least=1, last=r"repeats every \d .*: (node|face) \d+ of 'crown'"))),
    Case(
        "guards", "through a thin plate", "with a penalty so soft that it resists nothing: steps are judged", STACK,
        [*PLATE, "stepping.initial=0.1"],
        Stops("cannot be certified; contact 'joint'", r"node \d+", r"stands 0\.050\d deep", t=0.2, within=0.001)),
    Case(
        "guards", "the same, not judged", "the floor below belongs to the master, and is nearer from t = 0.7 on", STACK,
        [*PLATE, "stepping.initial=0.1", UNJUDGED],
        Stops("lost behind a master", r"'joint': node \d+ was 0\.8 behind its master", "in front of another part of it",
              t=0.7, within=0.001)),
    Case(
        "guards", "over a thin plate at a leap", "in one step from above the plate to near the floor", STACK,
        [*PLATE, "stepping={control: fixed, initial: 1, dt_min: 0.6}"],
        Stops("lost behind a master", r"'joint': node \d+ was 1\.25 behind its master",
              "0.35 in front of another part of it", t=0)),
    Case("guards", "penalty 1e10", "rounding of positions alone is a force above any tolerance", SQUEEZE,
         mesh(n_lower=13) + ["contact.0.penalty.scale=1e10"],
         All(Stops("penalty is too stiff: rounding of positions", r"node \d+"), Told("linear.inaccurate", least=1))),
    Case(
        "guards", "stiffness 1:1e9", "one body is as good as rigid: rounding in it hides the load, no refinement helps",
        SQUEEZE,
        mesh(n_lower=13) + ["bodies.1.material.E=1e12"],
        All(Same("bodies.1.material.E=1e9", probes=("force", "deviation"), bound=1e-4), Told("linear.refined", least=1),
            Told("linear.inaccurate", least=1))),
    Case("steps", "dt 10 times too large", "half of the pipe's stroke at once",
         PIPE, PINCHED + ["stepping.initial=0.5"],
         Same("stepping.initial=0.05", probes=STROKE, bound=(1e-8, 1e-8, 2e-4, 5e-4))),
    Case("steps", "whole load in one step", "every node of the contact zone at once", PUNCH, ["stepping.initial=1"],
         Same("stepping.initial=0.1", probes=ANSWER, bound=(1e-8, 1e-8, 1e-5, 0.005))),
    Case("steps", "snap-through", "a plane presses a shallow arch past its limit load, at t = 0.38: it jumps, and the run says so",
         ARCH, [], Told("jumps.found", least=1,
                        last=r"from t = 0\.3[0-7]\d* to 0\.3[789]\d*: node \d+ \(0, 15, 0\) moved by (1\.9|[23])")),
    Case("steps", "edge that folds", "friction folds the edge of a rubber ring, which jumps: tangents are indefinite and not symmetric",
         LIP, [], (Stops("no equilibrium"), Stops("no equilibrium"), Told("damping.steps", least=1),
                   Told("damping.steps", least=1))),
    Case("steps", "N_c beyond all candidates", "fewer open nodes than the control asks for", PUNCH,
         ["stepping={control: contact, initial: 0.1, N_c: 10000}"],
         Same("stepping={control: fixed, initial: 0.1}", probes=ANSWER, bound=(1e-8, 1e-8, 1e-5, 0.005))),
    Case("steps", "dt at the floor", "every step as small as allowed", PUNCH,
         ["stepping={control: iterations, initial: 0.05, dt_min: 0.05, dt_max: 0.05}"],
         Same("stepping={control: fixed, initial: 0.1}", probes=ANSWER, bound=(1e-8, 1e-8, 1e-5, 1e-4))),
    Case("steps", "no way on at the floor", "two iterations are too few and dt must not be smaller", PUNCH,
         ["stepping={control: fixed, initial: 0.5, dt_min: 0.5, damping: none}", "solver.max_iterations=2"],
         Stops("no equilibrium from t = 0 to 0.5", "max_iterations", "dt_min 0.5")),
    Case("certificate", "fast thin wall", "a block crosses in one step ten times the thickness of a sheet", PUNCH,
         mesh(**{"from": 0.3, "to": 0.7}, wall=0.02, n_height=1, gap=0.2, n_upper=8) +
         [*HELD_SHEET, "loads.0.uy=-0.3", "stepping.initial=1"], Certified()),
    Case("certificate", "needle", "a tool a sixth as wide as a face, in one step", PUNCH,
         NEEDLE + ["contact.0.penalty.scale=100"], Certified()),
    Case("certificate", "needle, soft penalty", "it goes into the face by more than a tenth of its own faces", PUNCH,
         NEEDLE, Stops("cannot be certified", r"contact 'joint': node 1[123] \(0\.6.* stands .* deep")),
    Case("certificate", "spike", "a wedge between the nodes of coarse faces", PUNCH,
         SPIKE + ["contact.0.penalty.scale=100"], Certified()),
    Case("certificate", "spike, soft penalty", "its tip goes into the face by more than half of its own faces", PUNCH,
         SPIKE, Stops("cannot be certified", r"contact 'joint': .* \(0\.5, 0, 0\) of 'upper_contact' stands .* deep")),
    Case("certificate", "past a corner", "a tool slides half over the end of the other block, in one step", PUNCH,
         mesh(**{"from": 0.6, "to": 0.9}, n_lower=12, n_upper=4, bulge=0, gap=0.01) +
         ["loads.0.ux=0.25", "loads.0.uy=-0.02", "stepping.initial=1"], Certified()),
    Case("certificate", "coarse master", "faces twelve times as long as the slave's", PUNCH,
         mesh(n_lower=2, n_upper=20) + ["loads.0.uy=-0.1", "stepping.initial=1"],
         (Certified(), Certified(), Stops("cannot be certified", r"node 2 \(0\.5, 0, 0\) of 'lower_contact' stands"), Certified())),
    Case("certificate", "coarse slave", "the master's nodes between the slave's go into it", PUNCH,
         mesh(n_lower=24, n_upper=3, bulge=0) + ["loads.0.uy=-0.05", "stepping.initial=1"],
         (Certified(), Certified(), Stops("cannot be certified", r"node \d+ \(.* stands"), Certified())),
    Case("certificate", "needle in space", "a rod a fifth as wide as a face, in one step", PUNCH,
         FLAT_SOLID + mesh(**{"from": 0.6, "to": 0.65}, n_lower=4, n_upper=1, n_height=2, gap=0.02) +
         ["loads.0.uy=-0.1", "stepping.initial=1", "contact.0.penalty.scale=100"], Certified()),
    Case("certificate", "edge over edge", "blocks overlap by a quarter: their edges cross, no corner is near", PUNCH,
         FLAT_SOLID + mesh(**{"from": 0.52, "to": 1.5}, n_lower=4, n_upper=3, n_height=2, gap=0.02) +
         ["loads.0.uy=-0.05", "stepping.initial=1"], Certified()),
    Case("certificate", "fast thin wall in space", "crossed by five times its thickness in one step", PUNCH,
         FLAT_SOLID + mesh(**{"from": 0.3, "to": 0.7}, wall=0.04, n_lower=6, n_upper=3, n_height=1, gap=0.1) +
         ["supports=[{surface: lower_x_low, ux: 0, uy: 0, uz: 0}, {surface: lower_x_high, ux: 0, uy: 0, uz: 0}]",
          "loads.0.uy=-0.3", "stepping.initial=1"], Certified()),
    Case("certificate", "two sheets", "a tenth of their thickness apart, pushed by three times that in one step", PUNCH,
         mesh(**{"from": 0.2, "to": 0.8}, wall=0.05, n_height=1, height=0.055, gap=0.005, bulge=0) +
         [*HELD_SHEET, "loads.0.uy=-0.15", "stepping.initial=1"], Certified()),
    Case("certificate", "steps ten times too large", "closes a gap of seven faces and slides by seven in one step", PUNCH,
         mesh(gap=0.3) + ["loads.0.uy=-0.35", "loads.0.ux=0.3", "stepping.initial=1"], Certified()),
    Case("certificate", "penalty too soft", "the blocks go into each other by five faces", PUNCH,
         mesh(bulge=0) + ["contact.0.penalty.scale=1e-3", "loads.0.uy=-0.2", "stepping.initial=1"],
         Stops("cannot be certified", "contact 'joint': node [0-9]+ .* stands .* deep")),
    Case("numbers", "m-N", "lengths and stresses 1e-3 and 1e6 times as large", PUNCH, units(1e3, 1e-6),
         Turned(*units(1, 1), probes=VECTOR, scale=1e3, bound=1e-8)),
    Case("numbers", "inch-lbf", "units that are no powers of ten", PUNCH, units(INCH, PSI),
         Turned(*units(1, 1), probes=VECTOR, scale=1 / (PSI * INCH), bound=1e-8)),
    Case("numbers", "far from the origin", "coordinates of 1e4 lengths: gaps are differences", PUNCH, mesh(away=1e4),
         Turned(*mesh(away=0), probes=VECTOR, bound=1e-6)),
    Case("numbers", "turned by 30 degrees", "nothing along an axis", PUNCH,
         mesh(angle=30) + [f"loads.0.ux={TURNED.real!r}", f"loads.0.uy={TURNED.imag!r}"],
         Turned(*mesh(angle=0), "loads.0.ux=0.01", "loads.0.uy=-0.05", probes=VECTOR, angle=30, bound=1e-6)),
    Case(
        "numbers", "mirrored", "left for right: the other order of every list", PUNCH, mesh(**{
            "from": 0.05,
            "to": 0.7
        }),
        Same(*mesh(**{
            "from": 0.3,
            "to": 0.95
        }), "loads.0.ux=-0.01", probes=ANSWER, scale={"sideways": -1}, bound=1e-8)),
]
