"""Keyword files of Abaqus and CalculiX (.inp): cards with their parameters and data lines, and the mesh that they
define. A deck is read with all files that it includes."""
import contextlib
import dataclasses
import math
import pathlib

import numpy

from meshfiles.mesh import Mesh, MeshError
from meshfiles.shapes import SHAPES

# Faces by corners in the order of the labels S1, S2, ...
FACES = {
    "tri": ((0, 1), (1, 2), (2, 0)),
    "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "tet": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "hex": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
}
# For each node of our shape, its place in an element of the deck
ORDERS = {
    "tet10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
    "hex20": [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14],
}
SOLIDS = {("C3D", 4): "tet4", ("C3D", 10): "tet10", ("C3D", 8): "hex8", ("C3D", 20): "hex20", ("C3D", 27): "hex27"}
PLANES = {3: "tri3", 6: "tri6", 4: "quad4", 8: "quad8"}
RIGID = {"R3D3": "tri3", "R3D4": "quad4", "SFM3D3": "tri3", "SFM3D4": "quad4", "R2D2": "edge2", "RAX2": "edge2",
         "T3D2": "edge2"}
DEEPEST_INCLUDE = 20  # files that include each other in a circle would never end
MOST = 10_000_000  # numbers that one line may generate: more than a mesh has that these scripts can read


@dataclasses.dataclass
class Card:
    """A keyword with its parameters and its data lines."""

    name: str  # upper case, without blanks at the ends
    parameters: dict  # names in upper case; a parameter without a value has the value ""
    lines: list  # of data, each a list of texts
    file: str
    line: int

    @property
    def where(self):
        return f"{self.file}:{self.line}: *{self.name}"


def read_cards(file, depth=0, cards=None):
    """All cards of a deck, the text of included files in its place."""
    if depth > DEEPEST_INCLUDE:
        raise MeshError(f"{file}: files include each other more than {DEEPEST_INCLUDE} deep")
    if pathlib.Path(file).exists() and not pathlib.Path(file).is_file():
        raise MeshError(f"{file} is no file but a folder, a device or a pipe; allowed: files")
    try:
        text = pathlib.Path(file).read_text(errors="replace")
    except OSError as error:
        raise MeshError(f"cannot read {file}: {error.strerror}") from None
    cards, pending = [] if cards is None else cards, ""
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("**"):
            continue
        if pending or line.startswith("*"):
            pending += line
            if pending.endswith(","):  # the card goes on in the next line
                continue
            card, pending = _card(pending, str(file), number), ""
            if card.name == "INCLUDE":
                read_cards(_included(card, file), depth + 1, cards)
            else:
                cards.append(card)
        elif cards:
            cards[-1].lines.append([part.strip() for part in line.split(",")])
        elif depth:  # what stands before the first card of a deck itself is no part of it
            raise MeshError(f"{file}:{number}: data stand before any card; allowed: a card before them, such as *NODE")
    return cards


@contextlib.contextmanager
def reading(card):
    """Refuses a text at the place of a number in the lines of a card, and lines that are too short."""
    try:
        yield
    except IndexError:
        raise MeshError(f"{card.where}: a line has too few entries") from None
    except ValueError as error:
        raise MeshError(f"{card.where}: what is no number stands where a number is needed ({error})") from None


def _card(text, file, line):
    parts = [part.strip() for part in text[1:].split(",")]
    parameters = {}
    for part in parts[1:]:
        if part:
            name, _, value = part.partition("=")
            parameters[name.strip().upper()] = value.strip().strip('"')
    return Card(" ".join(parts[0].upper().split()), parameters, [], file, line)


def _included(card, file):
    if "INPUT" not in card.parameters:
        raise MeshError(f"{card.where} has no parameter INPUT")
    return pathlib.Path(file).parent / card.parameters["INPUT"]


def shape_of_type(kind):
    """Our shape for a type of element of the deck, or None where it makes neither bodies nor rigid faces. Refuses solid
    elements that are not available."""
    name = kind.upper()
    if name in RIGID:
        return RIGID[name]
    for prefix in ("C3D", "CPE", "CPS", "CAX"):
        if name.startswith(prefix):
            digits = "".join(c for c in name[len(prefix):len(prefix) + 2] if c.isdigit())
            nodes = int(digits) if digits else 0
            shape = SOLIDS.get((prefix, nodes)) if prefix == "C3D" else PLANES.get(nodes)
            if shape is None:
                raise MeshError(f"elements of type {kind} are not available; there are C3D4, C3D8, C3D10, C3D20 and, "
                                "in the plane, CAX, CPE and CPS with 3, 4, 6 and 8 nodes")
            return shape
    return None


class _Part:
    """Nodes, elements and sets of one part, by their numbers in the deck."""

    def __init__(self):
        self.nodes = {}
        self.elements = {}  # number -> (shape, nodes)
        self.nsets, self.elsets, self.surfaces, self.sections, self.types = {}, {}, {}, [], {}


def _key(table, name):
    """The spelling under which a set is kept: names are the same in upper and lower case."""
    for old in table:
        if old.upper() == name.upper():
            return old
    return name


def _read_nodes(part, card):
    names = []
    for line in card.lines:
        if not line[0]:
            continue
        place = [float(text) if text else 0.0 for text in line[1:4]]
        part.nodes[int(line[0])] = place + [0.0] * (3 - len(place))
        names.append(int(line[0]))
    if "NSET" in card.parameters:
        part.nsets.setdefault(_key(part.nsets, card.parameters["NSET"]), []).extend(names)


def _read_elements(part, card):
    kind = card.parameters.get("TYPE", "")
    shape = shape_of_type(kind)
    if shape is None:
        if "ELSET" in card.parameters:  # others may name the set
            part.elsets.setdefault(_key(part.elsets, card.parameters["ELSET"]), [])
        return kind
    size, names, numbers = SHAPES[shape].nodes, [], []
    for line in card.lines:
        numbers += [int(text) for text in line if text]
        if len(numbers) <= size:  # the element goes on in the next line
            continue
        nodes = numbers[1:size + 1]  # programs that write such files leave what follows unread
        order = ORDERS.get(shape)
        part.elements[numbers[0]] = (shape, [nodes[k] for k in order] if order else nodes)
        names.append(numbers[0])
        numbers = []
    if numbers:
        raise MeshError(f"{card.where} of type {kind}: element {numbers[0]} has {len(numbers) - 1} nodes, not {size}")
    if "ELSET" in card.parameters:
        part.elsets.setdefault(_key(part.elsets, card.parameters["ELSET"]), []).extend(names)
    part.types.setdefault(kind.upper(), []).extend(names)
    return None


def _generated(card, values):
    """The numbers of a line of GENERATE: first, last and step."""
    numbers = range(values[0], values[1] + 1, *values[2:]) if len(values) in (2, 3) and values[-1] > 0 else None
    if numbers is None or len(numbers) > MOST:
        raise MeshError(f"{card.where}, GENERATE: {', '.join(map(str, values))}; allowed: a first and a last number, "
                        f"and a step of 1 or more, for at most {MOST} numbers")
    return numbers


def _read_set(table, card, parameter):
    name = card.parameters.get(parameter)
    if name is None:
        raise MeshError(f"{card.where} has no parameter {parameter}")
    members = table.setdefault(_key(table, name), [])
    for line in card.lines:
        if "GENERATE" in card.parameters:
            members.extend(_generated(card, [int(text) for text in line if text]))
            continue
        for text in line:
            if text.lstrip("-").isdigit():
                members.append(int(text))
            elif text:
                members.append(text)  # another set, which may come later


def _read_surface(part, card):
    name = card.parameters.get("NAME")
    if name is None:
        raise MeshError(f"{card.where} has no parameter NAME")
    kind = card.parameters.get("TYPE", "ELEMENT").upper()
    if kind in ("NODE", "ELEMENT"):
        part.surfaces[_key(part.surfaces, name)] = (kind, [line for line in card.lines if line[0]])


def resolve(table, name, where, seen=()):
    """Numbers of a set, those of sets inside it too."""
    key = _key(table, name)
    if key not in table:
        raise MeshError(f"{where}: there is no set '{name}'")
    if key in seen:
        raise MeshError(f"{where}: the set '{name}' contains itself")
    numbers = []
    for member in table[key]:
        numbers += [member] if isinstance(member, int) else resolve(table, member, where, (*seen, key))
    return numbers


class Deck:
    """The mesh of a deck: parts, their copies in the assembly, sets and surfaces; and its other cards for whoever wants
    them."""

    def __init__(self, file):
        self.file = pathlib.Path(file)
        self.cards = read_cards(file)
        self.whole = _Part()
        self.left_out = {}  # types of elements that were not read
        self._offset, self._copies = 0, {}  # of the next copy of a part; of each copy by its name
        self._read()

    def _read(self):
        parts, instance, part = {}, None, self.whole
        for card in self.cards:
            if card.name == "PART":
                part = parts.setdefault(card.parameters.get("NAME", "").upper(), _Part())
            elif card.name in ("END PART", "ASSEMBLY"):
                part = self.whole
            elif card.name == "INSTANCE":
                instance, part = card, _Part()
            elif card.name == "END INSTANCE":
                self._place(parts, instance, part)
                instance, part = None, self.whole
            elif card.name == "STEP":
                part = self.whole
            else:
                with reading(card):
                    self._read_card(part, card)

    def _read_card(self, part, card):
        instance = card.parameters.get("INSTANCE")
        if card.name == "NODE":
            _read_nodes(part, card)
        elif card.name == "ELEMENT":
            kind = _read_elements(part, card)
            if kind is not None:
                self.left_out[kind or "without a type"] = self.left_out.get(kind, 0) + len(card.lines)
        elif card.name in ("NSET", "ELSET"):
            table = part.nsets if card.name == "NSET" else part.elsets
            before = len(table.get(_key(table, card.parameters.get(card.name, "")), []))
            _read_set(table, card, card.name)
            if instance:
                members = table[_key(table, card.parameters[card.name])]
                members[before:] = [self._number(instance, member, card) for member in members[before:]]
        elif card.name == "SURFACE":
            _read_surface(part, card)
        elif card.name == "SOLID SECTION" and "ELSET" in card.parameters:
            part.sections.append(card.parameters["ELSET"])

    def _number(self, instance, member, card):
        """Number in the assembly of a part's node or element, or the name of the copy's set."""
        if instance.upper() in self._copies:
            return member + self._copies[instance.upper()] if isinstance(member, int) else f"{instance}.{member}"
        raise MeshError(f"{card.where}: there is no instance '{instance}'")

    def _place(self, parts, card, own):
        """Adds a copy of a part: its numbers are shifted, its sets are named INSTANCE.SET, and SET where that is free."""
        name = card.parameters.get("NAME", "")
        part = parts.get(card.parameters.get("PART", "").upper())
        if part is None:
            raise MeshError(f"{card.where}: there is no part '{card.parameters.get('PART', '')}'")
        offset = self._offset
        self._copies[name.upper()] = offset
        move = _motion(card)
        for table in (part, own):
            for number, place in table.nodes.items():
                self.whole.nodes[number + offset] = move(place)
            for number, (shape, nodes) in table.elements.items():
                self.whole.elements[number + offset] = (shape, [node + offset for node in nodes])
            self._copy_sets(table, name, offset)
        self._offset += max([0, *part.nodes, *part.elements, *own.nodes, *own.elements])

    def _copy_sets(self, part, instance, offset):
        for source, target in ((part.nsets, self.whole.nsets), (part.elsets, self.whole.elsets)):
            for name, members in source.items():
                copied = [member + offset if isinstance(member, int) else f"{instance}.{member}" for member in members]
                target.setdefault(f"{instance}.{name}", []).extend(copied)
                if _key(target, name) not in target:
                    target[name] = list(copied)
        for name, (kind, lines) in part.surfaces.items():
            copied = [[str(int(line[0]) + offset) if line[0].isdigit() else f"{instance}.{line[0]}", *line[1:]]
                      for line in lines]
            self.whole.surfaces[f"{instance}.{name}"] = (kind, copied)
            self.whole.surfaces.setdefault(_key(self.whole.surfaces, name), (kind, copied))
        self.whole.sections += [f"{instance}.{name}" for name in part.sections]
        for kind, numbers in part.types.items():
            self.whole.types.setdefault(kind, []).extend(number + offset for number in numbers)

    # The mesh

    def mesh(self, dim):
        """The mesh: bodies are sets of elements, surfaces are those of *SURFACE, sets of rigid faces, and the outer
        faces between the nodes of *NSET."""
        part = self.whole
        order = sorted(part.nodes)
        if not order or not part.elements:
            raise MeshError("the deck defines no " + ("elements of bodies" if order else "nodes outside of parts"))
        self._row = {number: row for row, number in enumerate(order)}
        mesh = Mesh(dim, [part.nodes[number] for number in order])
        self._place_of = {}  # number of an element -> (shape, index)
        by_shape = {}
        for number, (shape, nodes) in part.elements.items():
            by_shape.setdefault(shape, []).append((number, nodes))
        for shape, members in by_shape.items():
            try:
                rows = [[self._row[node] for node in nodes] for _, nodes in members]
            except KeyError as missing:
                raise MeshError(f"an element has node {missing.args[0]}, which the deck does not define") from None
            for (number, _), index in zip(members, mesh.add_elements(shape, rows)):
                self._place_of[number] = (shape, index)
        self._bodies(mesh)
        for name, (kind, lines) in part.surfaces.items():
            self._surface(mesh, name, kind, lines)
        for name in part.nsets:
            self._node_set(mesh, name)
        for kind, count in self.left_out.items():
            mesh.notes.append(f"{count} elements of type {kind} were left out")
        return mesh

    def row(self, node):
        """Index in the mesh of a node by its number."""
        return self._row[node]

    def has_row(self, node):
        return node in self._row

    def _add(self, mesh, name, numbers):
        by_shape = {}
        for number in numbers:
            if number in self._place_of:
                shape, index = self._place_of[number]
                by_shape.setdefault(shape, []).append(index)
        for shape, indices in by_shape.items():
            mesh.group(name, SHAPES[shape].dim).add(shape, indices)

    def _bodies(self, mesh):
        """Sets of *SOLID SECTION come first, as they say what a body is; then all other sets, then types of elements for
        what is left. Sets of rigid faces make surfaces."""
        part = self.whole
        sections = [_key(part.elsets, name) for name in part.sections]
        for name in dict.fromkeys([*sections, *part.elsets]):
            self._add(mesh, name, resolve(part.elsets, name, "*ELSET"))
        for kind, numbers in part.types.items():
            if SHAPES[part.elements[numbers[0]][0]].dim == mesh.dim:
                self._add(mesh, kind, numbers)

    def _surface(self, mesh, name, kind, lines):
        group = mesh.group(name, mesh.dim - 1)
        if kind == "NODE":
            nodes = [n for line in lines for n in self._numbers(self.whole.nsets, line[0], f"*SURFACE {name}")]
            mesh.add_faces_of_nodes(group, [self._row[node] for node in nodes])
            return
        for line in lines:
            numbers = self._numbers(self.whole.elsets, line[0], f"*SURFACE {name}")
            label = line[1].upper() if len(line) > 1 else ""
            if label in ("SPOS", "SNEG", "") and all(self._is_face(mesh, number) for number in numbers):
                self._add(mesh, name, numbers)
            else:
                self.add_labelled(mesh, group, numbers, label, name)

    def _is_face(self, mesh, number):
        return number in self._place_of and SHAPES[self._place_of[number][0]].dim == mesh.dim - 1

    @staticmethod
    def _numbers(table, text, where):
        return [int(text)] if text.isdigit() else resolve(table, text, where)

    def add_labelled(self, mesh, group, numbers, label, name):
        """Adds the faces with a label such as S2; without a label, all outer faces of these elements."""
        if label and not (label[0] == "S" and label[1:].isdigit()):
            raise MeshError(f"*SURFACE {name}: the label '{label}' is not available; there are S1 to S6")
        by_shape = {}
        for number in numbers:
            if number not in self._place_of:
                continue
            shape, index = self._place_of[number]
            if SHAPES[shape].dim == mesh.dim:
                by_shape.setdefault(shape, []).append(index)
        for shape, indices in by_shape.items():
            if label:
                mesh.add_cell_face(group, shape, indices, _face_number(shape, int(label[1:]), name))
                continue
            for kind, f, outer in mesh.outer_faces():
                chosen = numpy.intersect1d(outer, indices) if kind == shape else ()
                if len(chosen):
                    mesh.add_cell_face(group, shape, chosen, f)

    def _node_set(self, mesh, name):
        """A set of nodes names the outer faces between them; where there are none, the nodes."""
        rows = [self._row[node] for node in resolve(self.whole.nsets, name, "*NSET") if node in self._row]
        surfaces = {surface.upper() for surface in self.whole.surfaces}
        label = name if name.upper() not in surfaces else f"{name}.nodes"
        group = mesh.group(label, mesh.dim - 1)
        if rows:
            mesh.add_faces_of_nodes(group, rows)
        if rows and not group.size:
            mesh.group(label, 0).add("point", mesh.add_elements("point", rows))


def _face_number(shape, label, name):
    """Number of our face for a face label of the deck."""
    faces = FACES["".join(c for c in shape if c.isalpha())]
    if not 1 <= label <= len(faces):
        raise MeshError(f"*SURFACE {name}: there is no face S{label} of a {shape}")
    for f, corners in enumerate(SHAPES[shape].faces):
        if set(corners) == set(faces[label - 1]):
            return f
    raise AssertionError(shape)


def _motion(card):
    """The translation, then the rotation about an axis through two points (degrees), of an instance's data lines."""
    lines = [[float(text) if text else 0.0 for text in line] for line in card.lines if any(line)]
    shift = numpy.array((lines[0] + [0.0] * 3)[:3]) if lines else numpy.zeros(3)
    if len(lines) < 2:
        return lambda place: (numpy.asarray(place) + shift).tolist()
    a, b, angle = numpy.array(lines[1][:3]), numpy.array(lines[1][3:6]), math.radians(lines[1][6])
    axis = (b - a) / numpy.linalg.norm(b - a)

    def move(place):
        r = numpy.asarray(place) + shift - a
        turned = (r * math.cos(angle) + numpy.cross(axis, r) * math.sin(angle) +
                  axis * axis.dot(r) * (1 - math.cos(angle)))
        return (a + turned).tolist()

    return move
