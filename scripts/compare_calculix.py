"""Burnish beside CalculiX (ccx, Debian's package calculix-ccx) on pipe_pinch, cup_flattening and press_fit, one after
the other in one run: CPU seconds, iterations, failed steps, and the force against its reference. CalculiX's input is
written here from the same gmsh meshes: surface to surface penalty contact with Burnish's penalty, finite strain, the
same law, loads and supports. With friction its stick slope is Burnish's penalty for what sticks. The pipe also yields,
and is of rubber.
    compare_calculix.py [--burnish BINARY] [--ccx BINARY] [--repeats N] [--out DIR] [--record FILE] [CASE ...]     runs
    and prints compare_calculix.py --table FILE
    prints only
A CASE is a part of a row's name in the table: "pipe_pinch" or "pipe_pinch burnish enhanced". CPU seconds are user and
system of the process that solves, one rank, one thread, meshing apart; the table has the medians over the repeats,
which take turns, so that whatever else the machine does meets all."""
import argparse
import csv
import dataclasses
import math
import pathlib
import resource
import shlex
import shutil
import signal
import statistics
import subprocess
import sys

import numpy

import o_ring_calculix
from launch import environment, read_summary, timed

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLUMNS = ("scene", "code", "setting", "repeat", "status", "dofs", "steps", "steps_failed", "iterations", "cpu_s",
           "force", "error")
BRICK_SIDES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)
               )  # corners of CalculiX's faces S1 ...
PLANE_WIDTH, PLANE_ELEMENTS = 40, 20  # mm; the contact ends at 25
QUAD_SIDES = ((0, 1), (1, 2), (2, 3), (3, 0))
IRONING = {"slab": (68.96, 0.45), "tool": (689.6, 0.45)}  # E and nu; with less the laws of the two codes differ
NECKING_WAY = 5  # mm, of half the bar
NECKING_HARDENING = ("451, 0", "476, 0.006", "525, 0.019", "583, 0.038", "642, 0.066", "710, 0.147", "777, 0.5",
                     "831, 1")
SWAPPED = ("contact.0.slave=pipe_outer", "contact.0.master=plate_bottom")
BY_ITERATIONS = ("stepping.control=iterations", "stepping.initial=0.25", "stepping.at=[]")
AT_ONCE = ("stepping.initial=1", "stepping.at=[]")
ENHANCED = ("mesh.order=1", "bodies.0.formulation=enhanced")


# Laws of pipe and plate besides the scene's own: CalculiX's cards, and Burnish's material. Rubber has E = 20000 and
# nu = 0.49; the volume terms of the two codes agree to second order.
LAWS = {
    "yields": (["*ELASTIC", "20000, 0.3", "*PLASTIC", "200, 0", "400, 1"],
               "{law: von_mises, E: 20000, nu: 0.3, yield: 200, hardening: {linear: 200}}"),
    "rubber": (["*HYPERELASTIC, NEO HOOKE", f"{20000 / 5.96}, {0.12 / 20000}"],
               "{law: isochoric_neo_hookean, E: 20000, nu: 0.49}"),
}


@dataclasses.dataclass
class Setting:
    """A row of the table: a mesh, and what Burnish overrides or CalculiX is given."""
    scene: str
    code: str
    name: str
    order: int
    parameters: dict
    overrides: tuple = ()  # Burnish
    element: str = ""  # CalculiX
    slave: str = ""
    master: str = ""
    increment: float = 0.05
    contact: str = "SURFACE TO SURFACE"
    scale: float = 100  # of the penalty, as in the scenes
    mu: float = 0
    turn: float = 0  # of the press fit's bore (radians)
    law: str = ""  # of LAWS; the scene's own without it
    nu: float = 0  # of the O-ring

    def __str__(self):
        return f"{self.scene} {self.code} {self.name}"


def pipe(name, n_arc, n_wall, n_len, n_plate_y, *overrides, order=1):
    """Burnish on the pipe."""
    overrides = (*overrides, *((*ENHANCED, "bodies.1.formulation=enhanced") if order == 1 else ()))
    mesh = {"n_arc": n_arc, "n_wall": n_wall, "n_len": n_len, "n_plate_y": n_plate_y}
    return Setting("pipe_pinch", "burnish", f"{name}, {n_arc}x{n_wall}x{n_len}", order, mesh, overrides)


def cup(name, order, n_arc, n_wall, *overrides):
    return Setting("cup_flattening", "burnish", f"{name}, {n_arc}x{n_wall}", order, {
        "n_arc": n_arc,
        "n_wall": n_wall
    }, overrides)


def ccx_pipe(element, n_arc, n_wall, n_len, n_plate_y, increment, swapped=False, mu=0):
    """CalculiX on the pipe."""
    slave, master = ("pipe_outer", "plate_bottom") if swapped else ("plate_bottom", "pipe_outer")
    words = [f"mu {mu}"] * (mu > 0) + [element, f"{round(1 / increment)} steps"] + ["swapped"] * swapped
    name = ", ".join([*words, f"{n_arc}x{n_wall}x{n_len}"])
    mesh = {"n_arc": n_arc, "n_wall": n_wall, "n_len": n_len, "n_plate_y": n_plate_y}
    return Setting("pipe_pinch", "calculix", name, 1, mesh, element=element, slave=slave, master=master,
                   increment=increment, mu=mu)


def rubbing(setting, mu):
    """With friction."""
    return dataclasses.replace(setting, overrides=(*setting.overrides, f"contact.0.friction={{mu: {mu}}}"), mu=mu)


def of_law(setting, law):
    """With pipe and plate of another law."""
    overrides = tuple(f"bodies.{body}.material={LAWS[law][1]}" for body in (0, 1))
    return dataclasses.replace(setting, name=f"{law}, {setting.name}", overrides=(*setting.overrides, *overrides),
                               law=law)


def fit(code, turn):
    """The rings of runs/friction/press_fit.yaml with as many faces on either side. On 96 and 120 the facets' mean radii
    differ by the interference itself, and CalculiX is 18 % off."""
    mesh = {"n_inner": 120, "n_outer": 120, "n_wall": 6}
    elements = "CPE4" if code == "calculix" else "first order"
    return Setting("press_fit", code, f"mu 0.2, turned by {turn:g}, {elements}, 10 steps, 120 on 120", 1, mesh, (
        f"loads.0.ux='x*(cos({turn}*t)-1)-y*sin({turn}*t)'", f"loads.0.uy='x*sin({turn}*t)+y*(cos({turn}*t)-1)'"
    ), element="CPE4", slave="inner_contact", increment=0.1, mu=0.2, turn=turn)


def ccx_cup(increment, scale=100.0, contact="SURFACE TO SURFACE"):
    """CalculiX on the cup; the penalty's scale is named where it is not the scene's."""
    words = [f"CAX4, {round(1 / increment)} steps" if increment < 1 else "CAX4, one step"]
    words += (["node to surface"] if contact == "NODE TO SURFACE" else []) + ([f"scale {scale:g}"]
                                                                              if scale != 100 else [])
    return Setting("cup_flattening", "calculix", f"{', '.join(words)}, 120x3", 1, {
        "n_arc": 120,
        "n_wall": 3
    }, element="CAX4", slave="outer", increment=increment, contact=contact, scale=scale)


# N; several meshes, elements and penalties, 0.1 %
REFERENCES = {"pipe_pinch": 123920.0, "cup_flattening": 434500.0}
FIT_TORQUE = 18039.0  # N mm, where all of the press fit slips: see its scene
PIPE_WITH_FRICTION = (36, 1, 6, 1)  # n_arc, n_wall, n_len, n_plate_y
FRICTION = (0.2, 0.5)
STICKS, SLIPS = 0.0001, 0.0002  # turns of the press fit
SETTINGS = [
    ccx_pipe("C3D8I", 24, 2, 20, 2, 0.05),
    ccx_pipe("C3D8I", 24, 2, 20, 2, 0.05, swapped=True),
    ccx_pipe("C3D8I", 36, 1, 6, 1, 0.05),
    ccx_pipe("C3D8I", 36, 1, 6, 1, 0.25),
    pipe("enhanced, 20 steps", 24, 2, 20, 2, "stepping.initial=0.05"),
    pipe("enhanced, 20 steps, diffuse", 24, 2, 20, 2, "stepping.initial=0.05", "contact.0.smoother=diffuse"),
    pipe("enhanced, 20 steps, swapped", 24, 2, 20, 2, "stepping.initial=0.05", *SWAPPED),
    pipe("enhanced, 20 steps, swapped, diffuse", 24, 2, 20, 2, "stepping.initial=0.05", "contact.0.smoother=diffuse",
         *SWAPPED),
    pipe("enhanced, 20 steps, surface to surface", 24, 2, 20, 2, "stepping.initial=0.05",
         "contact.0.formulation=surface_to_surface"),
    pipe("enhanced, 4 steps", 24, 2, 20, 2, "stepping.initial=0.25"),
    pipe("enhanced, steps by iterations", 24, 2, 20, 2, *BY_ITERATIONS),
    pipe("enhanced, steps by iterations, swapped", 24, 2, 20, 2, *BY_ITERATIONS, *SWAPPED),
    pipe("enhanced, steps by contact", 24, 2, 20, 2, "stepping.control=contact"),
    pipe("enhanced, steps by contact, swapped", 24, 2, 20, 2, "stepping.control=contact", *SWAPPED),
    pipe("enhanced, one step", 24, 2, 20, 2, *AT_ONCE),
    pipe("enhanced, one step, swapped", 24, 2, 20, 2, *AT_ONCE, *SWAPPED),
    pipe("enhanced, one step, diffuse", 24, 2, 20, 2, *AT_ONCE, "contact.0.smoother=diffuse"),
    pipe("enhanced, 4 steps", 36, 1, 6, 1, "stepping.initial=0.25"),
    pipe("enhanced, 4 steps, diffuse", 36, 1, 6, 1, "stepping.initial=0.25", "contact.0.smoother=diffuse"),
    pipe("enhanced, 4 steps, swapped", 36, 1, 6, 1, "stepping.initial=0.25", *SWAPPED),
    pipe("enhanced, 4 steps, swapped, diffuse", 36, 1, 6, 1, "stepping.initial=0.25", "contact.0.smoother=diffuse",
         *SWAPPED),
    pipe("enhanced, steps by iterations", 36, 1, 6, 1, *BY_ITERATIONS),
    pipe("enhanced, one step", 36, 1, 6, 1, *AT_ONCE),
    pipe("second order, 20 steps", 24, 1, 10, 1, "stepping.initial=0.05", order=2),
    pipe("second order, 10 steps", 16, 1, 5, 1, "stepping.initial=0.1", order=2),
    pipe("second order, 4 steps", 16, 1, 5, 1, "stepping.initial=0.25", order=2),
    ccx_cup(0.025),
    ccx_cup(0.025, scale=1),
    ccx_cup(0.025, scale=10, contact="NODE TO SURFACE"),
    ccx_cup(0.1, scale=1),
    ccx_cup(1),
    cup("enhanced, 40 steps", 1, 120, 3, *ENHANCED, "stepping.control=fixed"),
    cup("enhanced, steps by contact", 1, 120, 3, *ENHANCED),
    cup("enhanced, one step", 1, 120, 3, *ENHANCED, "stepping.control=fixed", "stepping.initial=1"),
    cup("first order, steps by contact", 1, 120, 3, "mesh.order=1"),
    cup("second order, 40 steps", 2, 60, 2, "stepping.control=fixed"),
    cup("second order, steps by contact", 2, 60, 2),
    *(ccx_pipe("C3D8I", *PIPE_WITH_FRICTION, 0.05, mu=mu) for mu in FRICTION),
    *(rubbing(pipe(f"mu {mu}, enhanced, 20 steps", *PIPE_WITH_FRICTION, "stepping.initial=0.05"), mu)
      for mu in FRICTION),
    *(rubbing(pipe(f"mu {mu}, enhanced, 20 steps, surface to surface, diffuse", *PIPE_WITH_FRICTION,
                   "stepping.initial=0.05", "contact.0.smoother=diffuse", "contact.0.formulation=surface_to_surface"),
              mu) for mu in FRICTION),
    *(of_law(ccx_pipe("C3D8I", *PIPE_WITH_FRICTION, 0.05), law) for law in LAWS),
    *(of_law(pipe("enhanced, 20 steps", *PIPE_WITH_FRICTION, "stepping.initial=0.05"), law) for law in LAWS),
    *(fit(code, turn) for turn in (STICKS, SLIPS) for code in ("calculix", "burnish")),
]


# Where they have not their own names in runs and in meshes
SCENES = {
    "press_fit": "friction/press_fit.yaml",
    "ironing": "../tests/jobs/ironing.yaml",
    "necking": "../tests/scenes/necking.yaml"
}
GEOMETRIES = {
    "press_fit": "rings_turned.geo",
    "ironing": "../tests/jobs/ironing.geo",
    "necking": "../tests/scenes/necking.geo"
}

# Meshes, and CalculiX's input


class AbaqusMesh:
    """What gmsh writes in Abaqus' format, whose element numbering CalculiX shares: nodes {id: line}, elements {id:
    (type, nodes)}, groups {name: elements}."""

    def __init__(self, path):
        self.nodes, self.elements, self.groups = {}, {}, {}
        section = {}
        for line in path.read_text().splitlines():
            if line.startswith("*"):
                keyword, *options = [part.strip() for part in line.split(",")]
                section = {"": keyword.upper(), **dict(option.split("=") for option in options if "=" in option)}
                continue
            if section[""] == "*NODE":
                self.nodes[int(line.split(",")[0])] = line
            elif section[""] == "*ELEMENT":
                self.add_element(section["type"], line)
            elif section[""] == "*ELSET":
                self.groups.setdefault(section["ELSET"],
                                       []).extend(int(part) for part in line.split(",") if part.strip())

    def add_element(self, kind, line):
        number, *nodes = [int(part) for part in line.split(",") if part.strip()]
        if kind == "T3D3":  # the middle node stands between the ends: corners first
            nodes = [nodes[0], nodes[2], nodes[1]]
        self.elements[number] = (kind, nodes[:8] if kind == "M3D9" else nodes)

    def cells(self, groups):
        return {number: self.elements[number][1] for group in groups for number in self.groups[group]}

    def used(self, cells):
        """Lines of the nodes that the cells have; inner nodes of quadrilaterals are those of Burnish alone."""
        return [self.nodes[node] for node in sorted({node for nodes in cells.values() for node in nodes})]

    def group_nodes(self, group):
        return sorted({node for number in self.groups[group] for node in self.elements[number][1]})

    def sides(self, group, cells, shapes):
        """(cell, side) of the faces in group; a face's first nodes are its corners."""
        corners = len(shapes[0])
        faces = {frozenset(self.elements[number][1][:corners]) for number in self.groups[group]}
        sides = ((number, side + 1, frozenset(nodes[i]
                                              for i in shape))
                 for number, nodes in cells.items()
                 for side, shape in enumerate(shapes))
        return [(number, side) for number, side, nodes in sides if nodes in faces]


def make_mesh(setting, directory):
    """The gmsh file that both codes read."""
    path = directory / f"{setting.scene}-{setting.order}-{'x'.join(str(n) for n in setting.parameters.values())}.msh"
    if not path.exists():
        numbers = [part for key, value in setting.parameters.items() for part in ("-setnumber", key, str(value))]
        geometry = ROOT / "meshes" / GEOMETRIES.get(setting.scene, f"{setting.scene}.geo")
        dimension = "-3" if setting.scene == "pipe_pinch" else "-2"
        call("gmsh", geometry, dimension, "-order", setting.order, *numbers, "-format", "msh41", "-o", path)
    return path


def call(*command):
    finished = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    if finished.returncode:
        sys.exit(f"{' '.join(str(part) for part in command)}\n{finished.stdout}")


def numbered(items):
    """Lines of at most 16 numbers."""
    items = [str(item) for item in items]
    return [", ".join(items[i:i + 16]) + ("," if i + 16 < len(items) else "") for i in range(0, len(items), 16)]


def element_lines(element, name, cells):
    lines = [f"*ELEMENT, TYPE={element}, ELSET={name}"]
    for number, nodes in cells.items():
        lines += numbered([number, *nodes])
    return lines


def material(name, young, law=""):
    cards = LAWS[law][0] if law else ["*ELASTIC", f"{young}, 0.3"]
    return [f"*MATERIAL, NAME={name}", *cards, f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"]


def surface(name, sides):
    return [f"*SURFACE, NAME={name}", *(f"{number}, S{side}" for number, side in sides)]


def contact(setting, young, height):
    """The penalty, a force per length and area, is what the scenes' `scale` makes of the modulus over the height of a
    slave element; for node to surface CalculiX's default clearance stays. What sticks has a scale of 1."""
    return [
        "*SURFACE INTERACTION, NAME=LAW", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{setting.scale * young / height}", *(["*FRICTION", f"{setting.mu}, {young / height}"] if setting.mu else []),
        f"*CONTACT PAIR, INTERACTION=LAW, TYPE={setting.contact}", "SLAVE, MASTER"
    ]


def step(setting, loads, reaction):
    return ["*STEP, NLGEOM, INC=10000", "*STATIC", f"{setting.increment}, 1, 1e-5, {setting.increment}", *loads,
            f"*NODE PRINT, NSET={reaction}, TOTALS=YES, FREQUENCY=10000", "RF", "*END STEP"]


def fixed(mesh, supports):
    """Node sets of the groups and their supports {group: direction}."""
    lines = []
    for group, directions in supports.items():
        lines += [f"*NSET, NSET={group}", *numbered(mesh.group_nodes(group))]
        lines += [part for direction in directions for part in ("*BOUNDARY", f"{group}, {direction}, {direction}")]
    return lines


def pipe_input(setting, mesh):
    cells = mesh.cells(("pipe", "plate"))
    return [
        "*NODE", *mesh.nodes.values(), *element_lines(setting.element, "SOLID", cells),
        *material("SOLID", 20000, setting.law), *surface("SLAVE", mesh.sides(setting.slave, cells, BRICK_SIDES)),
        *surface("MASTER", mesh.sides(setting.master, cells, BRICK_SIDES)),
        *contact(setting, 20000, 20 / setting.parameters["n_plate_y"]), *fixed(mesh, {
            "symmetry_x": "1",
            "symmetry_z": "3",
            "pipe_cut": "2",
            "plate_top": ""
        }), *step(setting, ["*BOUNDARY", "plate_top, 2, 2, -50"], "plate_top")
    ]


def cup_input(setting, mesh):
    """The plane is a row of fixed elements, whose reaction is the force."""
    cells = mesh.cells(("cup",))
    first, block = max(mesh.nodes) + 1, max(mesh.elements) + 1
    nodes = {
        first + i: (PLANE_WIDTH * (i // 2) / PLANE_ELEMENTS, -101.2 - (i % 2))
        for i in range(2 * PLANE_ELEMENTS + 2)
    }
    plane = {block + i: [first + 2 * i + j for j in (1, 3, 2, 0)] for i in range(PLANE_ELEMENTS)}
    pressure = [f"{number}, P{side}, 200" for number, side in mesh.sides("inner", cells, QUAD_SIDES)]
    return [
        "*NODE", *mesh.nodes.values(), *(f"{node}, {r}, {z}, 0" for node, (r, z) in nodes.items()),
        *element_lines(setting.element, "CUP", cells), *element_lines("CAX4", "PLANE", plane), *material("CUP", 50000),
        *material("PLANE", 50000), *surface("SLAVE", mesh.sides(setting.slave, cells, QUAD_SIDES)),
        *surface("MASTER", [(number, 3) for number in plane]),
        *contact(setting, 50000, 2 / setting.parameters["n_wall"]), *fixed(mesh, {
            "axis": "1",
            "cut": "12"
        }), "*NSET, NSET=BASE", *numbered(nodes), "*BOUNDARY", "BASE, 1, 2",
        *step(setting, ["*DLOAD", *pressure], "BASE")
    ]


def fit_input(setting, mesh):
    """The bore turns; its reactions are printed node by node, for their moment. The mesh has its cells clockwise."""
    inner, outer = ({number: nodes[::-1] for number, nodes in mesh.cells((body,)).items()}
                    for body in ("inner", "outer"))
    cells = {**inner, **outer}
    places = {node: [float(x) for x in mesh.nodes[node].split(",")[1:3]] for node in mesh.group_nodes("bore")}
    turned = [
        f"{node}, {i + 1}, {i + 1}, {way:.10e}" for node, (x, y) in places.items()
        for i, way in enumerate((x * (math.cos(setting.turn) - 1) - y * math.sin(setting.turn),
                                 x * math.sin(setting.turn) + y * (math.cos(setting.turn) - 1)))
    ]
    return [
        "*NODE", *mesh.nodes.values(), *element_lines(setting.element, "SOLID", cells), *material("SOLID", 200000),
        "1.", *surface("SLAVE", mesh.sides(setting.slave, inner, QUAD_SIDES)),
        *surface("MASTER", mesh.sides("outer_contact", outer, QUAD_SIDES)),
        *contact(setting, 200000, 10 / setting.parameters["n_wall"]), *fixed(mesh, {
            "rim": "12",
            "bore": ""
        }), *step(setting, ["*BOUNDARY", *turned], "bore")
    ]


def ring_input(setting, mesh):
    """The O-ring, by scripts/o_ring_calculix.py."""
    nodes = numpy.zeros((max(mesh.nodes), 3))
    for node, line in mesh.nodes.items():
        nodes[node - 1] = [float(part) for part in line.split(",")[1:4]]
    cells = numpy.array(list(mesh.cells(("ring", )).values())) - 1
    return o_ring_calculix.deck(nodes, cells, setting.nu, setting.increment, setting.scale)


def ironing_input(setting, mesh):
    """A stiff tool is pressed into a slab and drawn over it."""
    parts = {body: mesh.cells((body, )) for body in ("slab", "tool")}
    cells = {**parts["slab"], **parts["tool"]}
    deck = ["*NODE", *mesh.used(cells)]
    for body, (young, nu) in IRONING.items():
        deck += [
            *element_lines(setting.element, body, parts[body]), f"*MATERIAL, NAME={body}", "*HYPERELASTIC, NEO HOOKE",
            f"{young / (4 * (1 + nu))!r}, {6 * (1 - 2 * nu) / young!r}",
            f"*SOLID SECTION, ELSET={body}, MATERIAL={body}", "1."
        ]
    return [
        *deck, *surface("SLAVE", mesh.sides("tool_sole", parts["tool"], QUAD_SIDES)),
        *surface("MASTER", mesh.sides("slab_top", parts["slab"], QUAD_SIDES)), *contact(setting, 68.96, 0.25),
        *fixed(mesh, {
            "slab_bottom": "12",
            "tool_top": ""
        }), "*AMPLITUDE, NAME=PRESS", "0, 0, 0.2, 1, 1, 1", "*AMPLITUDE, NAME=DRAW", "0, 0, 0.2, 0, 1, 1",
        *step(setting, [
            "*BOUNDARY, AMPLITUDE=PRESS", "tool_top, 2, 2, -1", "*BOUNDARY, AMPLITUDE=DRAW", "tool_top, 1, 1, 7"
        ], "tool_top")
    ]


def necking_input(setting, mesh):
    """A bar that is drawn until it necks."""
    cells = mesh.cells(("bar", ))
    return [
        "*NODE", *mesh.used(cells), *element_lines(setting.element, "BAR", cells), "*MATERIAL, NAME=BAR", "*ELASTIC",
        "200e3, 0.3", "*PLASTIC", *NECKING_HARDENING, "*SOLID SECTION, ELSET=BAR, MATERIAL=BAR", *fixed(mesh, {
            "middle": "2",
            "axis": "1",
            "end": ""
        }), *step(setting, ["*BOUNDARY", f"end, 2, 2, {NECKING_WAY}"], "end")
    ]


INPUTS = {
    "pipe_pinch": pipe_input,
    "cup_flattening": cup_input,
    "press_fit": fit_input,
    "o_ring": ring_input,
    "ironing": ironing_input,
    "necking": necking_input
}
# Reactions are those of the wedge of 2 degrees to which CalculiX expands axisymmetric elements.
WHOLE = {"cup_flattening": 180, "o_ring": 180, "necking": 180}


PROBES = {
    "pipe_pinch": "plate_force",
    "cup_flattening": "plane_force",
    "press_fit": "torque",
    "o_ring": "force",
    "ironing": "fy",
    "necking": "force"
}

# Runs


def timed_in(args, command, directory):
    """Exit status and CPU seconds of the one process; both codes have the same environment."""
    with open(directory / "output.txt", "w") as output:
        return timed(command, cwd=directory, env=environment(args.burnish), stdout=output, stderr=subprocess.STDOUT,
                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (args.limit, args.limit)))


def run_calculix(args, setting, directory):
    path = directory / "case.msh"
    call("gmsh", make_mesh(setting, args.out), "-save", "-format", "inp", "-o", path.with_suffix(".abaqus"))
    mesh = AbaqusMesh(path.with_suffix(".abaqus"))
    path.with_suffix(".inp").write_text("\n".join(INPUTS[setting.scene](setting, mesh)) + "\n")
    _, cpu = timed_in(args, [*args.launcher, args.ccx, "-i", "case"], directory)
    return {**read_calculix(directory, setting, mesh), "cpu_s": cpu}


def reaction(setting, directory, mesh):
    """The last reaction of the .dat file: the y component of its sum, or its moment about the origin."""
    rows = [line.split() for line in (directory / "case.dat").read_text().splitlines()]
    if setting.scene != "press_fit":
        return WHOLE.get(setting.scene, 1) * float([row for row in rows if len(row) == 3][-1][1])
    forces = {int(row[0]): [float(part) for part in row[1:3]] for row in rows if len(row) == 4 and row[0].isdigit()}
    places = {node: [float(part) for part in mesh.nodes[node].split(",")[1:3]] for node in forces}
    return sum(places[node][0] * force[1] - places[node][1] * force[0] for node, force in forces.items())


def read_calculix(directory, setting, mesh):
    """Increments from the .sta file, iterations (failed attempts included) from the .cvg file."""
    output = (directory / "output.txt").read_text()
    if "number of equations" not in output:
        sys.exit(f"CalculiX: nothing solved\n{output[-2000:]}")
    increments = [
        line.split()
        for line in (directory / "case.sta").read_text().splitlines()
        if line.split() and line.split()[0].isdigit()
    ]
    iterations = [
        line.split()
        for line in (directory / "case.cvg").read_text().splitlines()
        if line.split() and line.split()[0].isdigit()
    ]
    attempts = {tuple(row[:3]) for row in iterations}
    accepted = len({row[1] for row in increments})
    unknowns = int(output.split("number of equations")[1].split()[0])
    reached = bool(increments) and abs(float(increments[-1][4]) - 1) < 1e-9
    force = abs(reaction(setting, directory, mesh)) if reached else None
    return {"dofs": unknowns, "status": "done" if reached else "not converged", "steps": accepted,
            "steps_failed": len(attempts) - accepted, "iterations": len(iterations), "force": force}


def run_burnish(args, setting, directory):
    command = [
        *args.launcher, args.burnish, ROOT / "runs" / SCENES.get(setting.scene, f"{setting.scene}.yaml"), "-quiet",
        "-o", directory / "results"
    ]
    mesh = "mesh={file: %s}" % make_mesh(setting, args.out)
    for override in (mesh, "output.every=0", *(part for part in setting.overrides if not part.startswith("mesh."))):
        command += ["-set", override]
    returned, cpu = timed_in(args, command, directory)
    if returned == -signal.SIGXCPU:
        return {"status": "stopped", "cpu_s": cpu, "force": None}
    if returned not in (0, 2):  # 2: did not converge; the summary says how far it came
        sys.exit(f"{' '.join(str(part) for part in command)}\n{(directory / 'output.txt').read_text()}")
    summary = read_summary(directory / "results")
    return {
        "status": summary["status"],
        "steps": summary["steps"],
        "steps_failed": summary["steps_failed"],
        "iterations": summary["newton_iterations"],
        "dofs": summary["dofs"],
        "cpu_s": cpu,
        "force": abs(summary["probes"][PROBES[setting.scene]]) if returned == 0 else None
    }


def record(args, setting, repeat):
    directory = args.out / "run"
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    row = (run_burnish if setting.code == "burnish" else run_calculix)(args, setting, directory)
    own = not setting.mu and not setting.law  # what the reference is of
    reference = REFERENCES.get(setting.scene) if own else FIT_TORQUE if setting.turn == SLIPS else None
    error = 100 * (row["force"] / reference - 1) if row["force"] is not None and reference else None
    row.update(scene=setting.scene, code=setting.code, setting=setting.name, repeat=repeat, error=error)
    return row


def measure(args):
    """All runs; returns the CSV file."""
    chosen = [setting for setting in SETTINGS if not args.case or any(case in str(setting) for case in args.case)]
    path = args.record or args.out / "calculix.csv"
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        for repeat in range(args.repeats):
            for setting in chosen:
                row = record(args, setting, repeat)
                writer.writerow(row)
                file.flush()
                print(f"{setting}: {row['cpu_s']:.2f} s, {row['iterations']} iterations, {row['status']}",
                      file=sys.stderr)
    return path


def median(runs, name):
    values = [float(row[name]) for row in runs if row[name]]
    return statistics.median(values) if values else None


def table(path):
    """In Markdown; CPU seconds only as ratios to CalculiX's first row of the scene, whose own are printed below."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    names = ("scene", "code", "elements, steps, mesh", "dofs", "steps, failed", "iterations", "CPU time", "force, kN",
             "error, %")
    print(f"| {' | '.join(names)} |\n|{' --- |' * len(names)}")
    notes = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        unit = None
        for code, name in dict.fromkeys((row["code"], row["setting"]) for row in rows if row["scene"] == scene):
            runs = [row for row in rows if (row["scene"], row["code"], row["setting"]) == (scene, code, name)]
            first, cpu, force = runs[0], median(runs, "cpu_s"), median(runs, "force")
            if unit is None:
                unit = cpu
                notes.append(f"{scene}: 1 is {cpu:.1f} s ({code}, {name}), {len(runs)} runs")
            ratio = f"{cpu / unit:.2g}" if cpu < unit else f"{cpu / unit:.1f}"
            end = f"| {first['status']} | |"
            if force is not None:
                error = median(runs, "error")
                end = f"| {force / 1000:.2f} | {'' if error is None else f'{round(error, 2) + 0:+.2f}'} |"
            print(
                f"| {scene} | {code} | {name} | {first['dofs']} | {first['steps']}, {first['steps_failed']} | "
                f"{first['iterations']} | {ratio}",
                end)
    print("\n".join(notes))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", nargs="*", metavar="CASE")
    parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build" / "burnish")
    parser.add_argument("--ccx", default="ccx")
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "calculix")
    parser.add_argument("--limit", type=int, default=resource.RLIM_INFINITY, help="CPU seconds of a run")
    parser.add_argument("--record", type=pathlib.Path, help="raw records (default: calculix.csv in --out)")
    parser.add_argument("--launcher", type=shlex.split, default=[],
                        help="command put before each of the runs: a queue, taskset, nice")
    parser.add_argument("--table", type=pathlib.Path, help="raw records to print, nothing is run")
    args = parser.parse_args()
    if not args.table:
        if not shutil.which(args.ccx):
            sys.exit(f"{args.ccx}: CalculiX is not there: apt-get install calculix-ccx")
        args.burnish, args.out = args.burnish.resolve(), args.out.resolve()
        args.out.mkdir(parents=True, exist_ok=True)
    table(args.table or measure(args))


if __name__ == "__main__":
    main()
