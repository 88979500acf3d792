"""Answers of CalculiX 2.20 (Debian's calculix-ccx) for jobs of this folder on their own meshes: surface to surface
penalty contact, stiff, and the same supports, loads and laws.
    calculix.py JOB [--increment 0.1] [--stiffness 20] [--refine 1]
The stiffness of the contact is that many times the modulus over 1 mm. A spring of a millionth of the load holds what
only contact holds until it touches. Reactions of axisymmetric models are those of the whole circumference."""
import argparse
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SIDES = {
    "CPE6": ((0, 1), (1, 2), (2, 0)),
    "CAX6": ((0, 1), (1, 2), (2, 0)),
    "CAX8": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "C3D10": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
}
WEDGE = 180  # CalculiX expands axisymmetric elements to wedges of 2 degrees


class Mesh:
    """What gmsh writes in Abaqus' format: nodes {id: coordinates}, elements {id: (type, nodes)}, groups {name: ids}."""

    def __init__(self, geometry, dimension, order=2, refine=1):
        self.nodes, self.elements, self.groups = {}, {}, {}
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / "mesh.inp"
            numbers = ("-setnumber", "Mesh.SecondOrderIncomplete", "1", "-setnumber", "refine", str(refine))
            subprocess.run(["gmsh", geometry, f"-{dimension}", "-order", str(order), *numbers, "-format", "inp", "-o",
                            path, "-v", "1"], check=True)
            for line in path.read_text().splitlines():
                self.read(line)

    def read(self, line):
        if line.startswith("*"):
            words = [word.strip() for word in line.split(",")]
            self.section, self.options = words[0].upper(), dict(word.split("=") for word in words[1:] if "=" in word)
            return
        words = [word for word in line.split(",") if word.strip()]
        if self.section == "*NODE":
            self.nodes[int(words[0])] = [float(word) for word in words[1:]]
        elif self.section == "*ELEMENT":
            nodes = [int(word) for word in words[1:]]
            if self.options["type"] == "T3D3":  # the midside node stands between the ends: corners first
                nodes = [nodes[0], nodes[2], nodes[1]]
            self.elements[int(words[0])] = (self.options["type"], nodes)
        elif self.section == "*ELSET":
            self.groups.setdefault(self.options["ELSET"], []).extend(int(word) for word in words)

    def members(self, group):
        return {node for number in self.groups[group] for node in self.elements[number][1]}

    def sides(self, group, cells, kind):
        shapes = SIDES[kind]
        faces = {frozenset(self.elements[number][1][:len(shapes[0])]) for number in self.groups[group]}
        return [(number, side + 1) for number in cells for side, shape in enumerate(shapes)
                if frozenset(self.elements[number][1][i] for i in shape) in faces]

    def at(self, *point, group=None):
        nodes = self.members(group) if group else self.nodes
        return min(nodes, key=lambda node: sum((a - b)**2 for a, b in zip(self.nodes[node], point)))


def rows(items):
    items = [str(item) for item in items]
    return [", ".join(items[i:i + 12]) + ("," if i + 12 < len(items) else "") for i in range(0, len(items), 12)]


class Deck:
    """The input of one job."""

    def __init__(self, mesh, kind):
        self.mesh, self.kind = mesh, kind
        self.lines = ["*NODE", *(f"{node}, {', '.join(map(repr, x))}" for node, x in mesh.nodes.items())]
        self.cells, self.next_node, self.next_element = {}, max(mesh.nodes) + 1, max(mesh.elements) + 1

    def body(self, name, young, nu):
        cells = {number: self.mesh.elements[number][1] for number in self.mesh.groups[name]}
        self.cells.update(cells)
        self.lines.append(f"*ELEMENT, TYPE={self.kind}, ELSET={name}")
        for number, nodes in cells.items():
            self.lines += rows([number, *nodes])
        self.material(name, young, nu)

    def material(self, name, young, nu):
        self.lines += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young}, {nu}",
                       f"*SOLID SECTION, ELSET={name}, MATERIAL={name}", *(["1."] if self.kind[0:2] == "CP" else [])]

    def plane(self, name, x_0, x_1, y, up, young, n=40):
        """A row of elements whose upper (or lower) side is a rigid plane; its nodes are the set NAME_nodes."""
        first, block = self.next_node, self.next_element
        self.next_node, self.next_element = first + 2 * n + 2, block + n
        behind = y - 2 if up else y + 2
        low, high = (behind, y) if up else (y, behind)
        self.lines += ["*NODE", *(f"{first + i}, {x_0 + (x_1 - x_0) * (i // 2) / n!r}, {(low, high)[i % 2]!r}, 0"
                                  for i in range(2 * n + 2))]
        self.lines.append(f"*ELEMENT, TYPE=CAX4, ELSET={name}")
        self.lines += [f"{block + i}, {first + 2 * i}, {first + 2 * i + 2}, {first + 2 * i + 3}, {first + 2 * i + 1}"
                       for i in range(n)]
        self.material(name, young, 0.3)
        self.lines += [f"*NSET, NSET={name}_nodes", *rows(range(first, self.next_node)), f"*SURFACE, NAME={name}_side",
                       *(f"{block + i}, S{3 if up else 1}" for i in range(n))]

    def surface(self, group):
        self.lines += [f"*SURFACE, NAME={group}", *(f"{number}, S{side}"
                                                   for number, side in self.mesh.sides(group, self.cells, self.kind))]

    def pair(self, slave, master, stiffness):
        law = f"LAW_{slave}"
        self.lines += [f"*SURFACE INTERACTION, NAME={law}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
                       repr(stiffness), f"*CONTACT PAIR, INTERACTION={law}, TYPE=SURFACE TO SURFACE",
                       f"{slave}, {master}"]

    def support(self, group, directions):
        self.lines += [f"*NSET, NSET={group}", *rows(sorted(self.mesh.members(group)))]
        for direction in directions:
            self.lines += ["*BOUNDARY", f"{group}, {direction}, {direction}"]

    def spring(self, node, direction, stiffness):
        number = self.next_element
        self.next_element += 1
        self.lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{number}", f"{number}, {node}",
                       f"*SPRING, ELSET=SPRING{number}", f"{direction}", f"{stiffness!r}"]

    def pressure(self, group, value):
        return ["*DLOAD", *(f"{number}, P{side}, {value!r}"
                            for number, side in self.mesh.sides(group, self.cells, self.kind))]

    def traction(self, group, direction, value):
        """Consistent forces of a constant traction on flat second-order triangles: a third of the area on each
        midside node."""
        forces = {}
        for number in self.mesh.groups[group]:
            nodes = self.mesh.elements[number][1]
            a, b, c = (self.mesh.nodes[node] for node in nodes[:3])
            u, v = [p - q for p, q in zip(b, a)], [p - q for p, q in zip(c, a)]
            cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            for node in nodes[3:6]:
                forces[node] = forces.get(node, 0) + value * sum(part**2 for part in cross)**0.5 / 6
        return ["*CLOAD", *(f"{node}, {direction}, {force!r}" for node, force in forces.items())]

    def ring_traction(self, group, direction, value):
        """Consistent forces of a constant traction on the second-order lines of an axisymmetric model, over the whole
        circumference."""
        forces, gauss = {}, ((-0.6**0.5, 5 / 9), (0, 8 / 9), (0.6**0.5, 5 / 9))
        for number in self.mesh.groups[group]:
            first, last, middle = self.mesh.elements[number][1]
            points = [self.mesh.nodes[node] for node in (first, middle, last)]
            for s, weight in gauss:
                shapes = (s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2)
                slopes = (s - 0.5, -2 * s, s + 0.5)
                radius = sum(shape * point[0] for shape, point in zip(shapes, points))
                along = [sum(slope * point[d] for slope, point in zip(slopes, points)) for d in (0, 1)]
                for node, shape in zip((first, middle, last), shapes):
                    forces[node] = forces.get(node, 0) + (2 * math.pi * radius * math.hypot(*along) * weight * shape *
                                                          value)
        return ["*CLOAD", *(f"{node}, {direction}, {force!r}" for node, force in forces.items())]

    def step(self, increment, loads, finite=True, prints=()):
        self.lines += [f"*STEP{', NLGEOM' if finite else ''}, INC=10000", "*STATIC",
                       f"{increment}, 1, 1e-6, {increment}", *loads]
        for name, nodes in prints:
            self.lines += [f"*NODE PRINT, NSET={name}, FREQUENCY=1{', TOTALS=ONLY' if nodes is None else ''}",
                           "RF" if nodes is None else "U"]
        self.lines.append("*END STEP")

    def node_set(self, name, node):
        self.lines += [f"*NSET, NSET={name}", str(node)]


def pin_lug(args):
    mesh = Mesh(HERE / "pin_lug.geo", 3)
    deck, young = Deck(mesh, "C3D10"), 210000
    deck.body("lug", young, 0.3)
    deck.body("pin", young, 0.3)
    deck.surface("pin_skin")
    deck.surface("bore")
    deck.pair("pin_skin", "bore", args.stiffness * young)
    deck.support("symmetry_x", "1")
    deck.support("symmetry_z", "3")
    deck.support("clamp", "123")
    deck.spring(mesh.at(0, 9.95, 0), 2, 0.1)
    points = {"pin_rise": (0, 9.95, 0), "head": (0, 22, 0), "waist": (10, 0, 0)}
    for name, point in points.items():
        deck.node_set(name, mesh.at(*point))
    deck.step(args.increment, deck.traction("pin_end", 2, 64.30), prints=[(name, 1) for name in points])
    return deck


def belleville(args):
    mesh = Mesh(HERE / "belleville.geo", 2)
    deck, young = Deck(mesh, "CAX8"), 206000
    deck.body("washer", young, 0.3)
    deck.plane("floor", 10, 30, -1.6851, True, young)
    deck.plane("ram", 10, 30, 1.6851, False, young)
    deck.surface("under")
    deck.surface("over")
    deck.pair("under", "floor_side", args.stiffness * young)
    deck.pair("over", "ram_side", args.stiffness * young)
    deck.spring(mesh.at(19, 0), 2, 0.01)
    deck.lines += ["*BOUNDARY", "floor_nodes, 1, 2", "ram_nodes, 1, 1"]
    deck.step(args.increment, ["*BOUNDARY", "ram_nodes, 2, 2, -1.33"], prints=[("ram_nodes", None),
                                                                              ("floor_nodes", None)])
    return deck


def flange_gasket(args):
    mesh = Mesh(HERE / "flange_gasket.geo", 2)
    deck = Deck(mesh, "CAX6")
    deck.body("flange", 210000, 0.3)
    deck.body("gasket", 21000, 0.3)
    deck.surface("gasket_top")
    deck.surface("raised_face")
    deck.pair("gasket_top", "raised_face", args.stiffness * 21000)
    deck.support("gasket_middle", "2")
    deck.spring(mesh.at(95, 19.5), 2, 0.01)
    points = {"rim": (95, 19.5), "inner_edge": (50, 1.5)}
    for name, point in points.items():
        deck.node_set(name, mesh.at(*point))
    for name, x in (("gasket_outer", 68), ("gasket_inner", 54)):
        deck.node_set(name, mesh.at(x, 1.5, group="gasket_top"))
        points[name] = None
    bolts, pressure, end = (deck.pressure(*load) for load in (("bolt_ring", 40.), ("inside", 8.), ("pipe_end", -31.45)))
    prints = [(name, 1) for name in points]
    deck.step(args.increment, bolts, False, prints)
    deck.step(args.increment, [*bolts, *pressure[1:], *end[1:]], False, prints)
    return deck


def rollers_in_nip(args):
    """With svk for both covers, as CalculiX has no other law in common."""
    mesh = Mesh(HERE / "rollers_in_nip.geo", 2, refine=args.refine)
    deck = Deck(mesh, "CPE6")
    deck.body("upper", 3, 0.45)
    deck.body("lower", 10, 0.45)
    deck.surface("upper_skin")
    deck.surface("lower_skin")
    deck.pair("upper_skin", "lower_skin", args.stiffness * 3)
    deck.support("middle", "1")
    deck.support("lower_core", "12")
    deck.support("upper_core", "1")
    deck.step(args.increment, ["*BOUNDARY", "upper_core, 2, 2, -2."], prints=[("upper_core", None)])
    return deck


def ball_in_cone(args):
    mesh = Mesh(HERE / "ball_in_cone.geo", 2, refine=args.refine)
    deck = Deck(mesh, "CAX6")
    deck.body("ball", 210000, 0.3)
    deck.body("seat", 3000, 0.4)
    deck.surface("bore")
    deck.surface("ball_skin")
    deck.pair("bore", "ball_skin", args.stiffness * 3000)
    deck.support("axis", "1")
    deck.support("seat_bottom", "12")
    centre = mesh.at(0, 0, group="axis")
    deck.spring(centre, 2, 0.01)
    deck.node_set("ball_down", centre)
    deck.step(args.increment, deck.ring_traction("ball_top", 2, -3.183099), prints=[("ball_down", 1),
                                                                                    ("seat_bottom", None)])
    return deck


JOBS = {
    function.__name__: function
    for function in (pin_lug, belleville, flange_gasket, rollers_in_nip, ball_in_cone)
}
parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("job", choices=JOBS)
parser.add_argument("--increment", type=float, default=0.1)
parser.add_argument("--refine", type=float, default=1)
parser.add_argument("--stiffness", type=float, default=20)
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/calculix"))
args = parser.parse_args()
args.out.mkdir(parents=True, exist_ok=True)
(args.out / f"{args.job}.inp").write_text("\n".join(JOBS[args.job](args).lines) + "\n")
finished = subprocess.run(["ccx", "-i", args.job], cwd=args.out, capture_output=True, text=True)
(args.out / f"{args.job}.log").write_text(finished.stdout)
print("\n".join(finished.stdout.splitlines()[-3:]))
lines = (args.out / f"{args.job}.dat").read_text().splitlines()
print(*[line for line in lines if line.strip()][-40:], sep="\n")
