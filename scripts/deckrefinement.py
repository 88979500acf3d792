"""A deck on a mesh that is once refined: each quadrilateral becomes four and each brick eight, with the sets, surfaces
and loads on faces of the deck."""
import itertools

import numpy

from meshfiles.deck import FACES, ORDERS, resolve
from meshfiles.shapes import SHAPES

SIGNS = {"quad": ((-1, -1), (1, -1), (1, 1), (-1, 1)),
         "hex": ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1))}
# Cards that the mesh is made of, which are written anew, and cards that ask for output
MESH = {"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE"}
OUTPUT = {"NODE PRINT", "NODE FILE", "NODE OUTPUT", "EL PRINT", "EL FILE", "ELEMENT OUTPUT", "CONTACT FILE",
          "CONTACT PRINT", "CONTACT OUTPUT", "SECTION PRINT", "HEADING"}
# Cards that stay as they are; a deck with any other is not refined
KEPT = {"MATERIAL", "ELASTIC", "PLASTIC", "DENSITY", "EXPANSION", "SOLID SECTION", "BOUNDARY", "CONTACT PAIR",
        "SURFACE INTERACTION", "SURFACE BEHAVIOR", "FRICTION", "AMPLITUDE", "STEP", "STATIC", "END STEP", "ENDSTEP",
        "CONTROLS", "INITIAL CONDITIONS", "TIME POINTS", "HYPERELASTIC"}
WHOLE = 1e6  # weights of corners as whole numbers, so that they can be compared


def _linear(signs, xi):
    """Values at xi of the functions that are 1 at one corner and linear along the edges."""
    return numpy.prod([(1 + numpy.multiply(s, x)) / 2 for s, x in zip(numpy.transpose(signs), xi)], axis=0)


def _serendipity(shape, signs, xi):
    """Values at xi of the shape functions of an element with nodes at its corners and edges."""
    linear = _linear(signs, xi)
    if len(SHAPES[shape].edges) + len(signs) != SHAPES[shape].nodes:
        return linear
    middles = []
    for a, b in SHAPES[shape].edges:
        along = next(d for d in range(len(xi)) if signs[a][d] != signs[b][d])
        across = [(1 + signs[a][d] * xi[d]) / 2 for d in range(len(xi)) if d != along]
        middles.append((1 - xi[along]**2) * numpy.prod(across))
    corners = list(linear)
    for value, (a, b) in zip(middles, SHAPES[shape].edges):
        corners[a] -= value / 2
        corners[b] -= value / 2
    return numpy.array(corners + middles)


class _Refinement:
    """Nodes and elements of the refined mesh. Nodes are known by the corners of the deck's elements between which they
    are, so that surfaces that touch stay apart."""

    def __init__(self, part):
        self.part, self.nodes = part, dict(part.nodes)
        self.numbers, self.parents = {}, {}  # node by its corners and back
        for shape, nodes in part.elements.values():
            n = SHAPES[shape].corners
            for node in nodes[:n]:
                self._know(((node, round(WHOLE)), ), node)
            for node, (a, b) in zip(nodes[n:], SHAPES[shape].edges):
                self._know(tuple(sorted(((nodes[a], round(WHOLE / 2)), (nodes[b], round(WHOLE / 2))))), node)
        self.next = max(self.nodes) + 1
        self.elements = {number: self._split(shape, nodes) for number, (shape, nodes) in part.elements.items()}

    def _know(self, key, node):
        self.numbers[key] = node
        self.parents[node] = [corner for corner, _ in key]

    def _node(self, shape, nodes, xi):
        signs = SIGNS[shape.rstrip("0123456789")]
        weights = numpy.rint(WHOLE * _linear(signs, xi)).astype(int)
        key = tuple(sorted((node, int(weight)) for node, weight in zip(nodes, weights) if weight))
        if key not in self.numbers:
            places = numpy.array([self.part.nodes[node] for node in nodes])
            self.nodes[self.next] = (_serendipity(shape, signs, xi) @ places).tolist()
            self._know(key, self.next)
            self.next += 1
        return self.numbers[key]

    def _split(self, shape, nodes):
        """The smaller elements, in the order of the corners at which they are."""
        signs = SIGNS[shape.rstrip("0123456789")]
        local = [*signs] + [numpy.add(signs[a], signs[b]) / 2 for a, b in SHAPES[shape].edges]
        return [[self._node(shape, nodes, (numpy.add(corner, xi)) / 2) for xi in local[:SHAPES[shape].nodes]]
                for corner in signs]

    def name(self, number, corner):
        return 8 * number - 7 + corner

    def pieces(self, number, label=None):
        """Numbers of the smaller elements of one, those at its face with a label."""
        shape = self.part.elements[number][0]
        corners = range(len(self.elements[number])) if label is None else \
            FACES[shape.rstrip("0123456789")][label - 1]
        return [self.name(number, corner) for corner in corners]

    def within(self, numbers):
        """The nodes of a set and those between its nodes."""
        own = set(numbers)
        corners = {node for node in own if self.parents.get(node) == [node]}
        new = [node for node, parents in self.parents.items()
               if node not in self.part.nodes and corners.issuperset(parents) and self._meant(node, own)]
        return sorted(own) + new

    def _meant(self, node, own):
        """Middle nodes of the deck between these corners belong to the set, too."""
        pairs = itertools.combinations(sorted(self.parents[node]), 2)
        middles = [self.numbers.get(tuple((corner, round(WHOLE / 2)) for corner in pair)) for pair in pairs]
        return all(middle in own for middle in middles if middle in self.part.nodes)


def _lines(numbers):
    return [", ".join(map(str, numbers[k:k + 8])) for k in range(0, len(numbers), 8)]


def _mesh(part, mesh):
    lines = ["*NODE", *(f"{n}, {x:.15g}, {y:.15g}, {z:.15g}" for n, (x, y, z) in sorted(mesh.nodes.items()))]
    for kind, numbers in part.types.items():
        lines.append(f"*ELEMENT, TYPE={kind}")
        for number in numbers:
            order = ORDERS.get(part.elements[number][0])
            for corner, nodes in enumerate(mesh.elements[number]):
                listed = [nodes[order.index(k)] for k in range(len(nodes))] if order else nodes
                lines += [text + "," for text in _lines([mesh.name(number, corner), *listed])]
                lines[-1] = lines[-1].rstrip(",")
    for name in part.nsets:
        lines += [f"*NSET, NSET={name}", *_lines(mesh.within(resolve(part.nsets, name, "*NSET")))]
    for name in part.elsets:
        numbers = [n for n in resolve(part.elsets, name, "*ELSET") if n in part.elements]
        lines += [f"*ELSET, ELSET={name}", *_lines([piece for n in numbers for piece in mesh.pieces(n)])]
    for name, (kind, entries) in part.surfaces.items():
        lines.append(f"*SURFACE, NAME={name}, TYPE={kind}")
        for entry in entries:
            table = part.nsets if kind == "NODE" else part.elsets
            numbers = [int(entry[0])] if entry[0].isdigit() else resolve(table, entry[0], name)
            if kind == "NODE":
                lines += [str(node) for node in mesh.within(numbers)]
            else:
                lines += [f"{piece}, {entry[1]}" for n in numbers for piece in mesh.pieces(n, int(entry[1][1:]))]
    return lines


def _pressures(part, mesh, card):
    """Pressures on the smaller faces; None for other loads."""
    lines = []
    for line in card.lines:
        if not (line[1].upper().startswith("P") and line[1][1:].isdigit()):
            return None
        numbers = [int(line[0])] if line[0].isdigit() else resolve(part.elsets, line[0], card.where)
        lines += [", ".join([str(piece), *line[1:]]) for n in numbers for piece in mesh.pieces(n, int(line[1][1:]))]
    return lines


def refined(deck):
    """The text of a deck on the refined mesh; None where it has elements or cards that this does not know, or forces at
    nodes, which say nothing of the nodes between them."""
    part = deck.whole
    if any(shape not in ("quad4", "quad8", "hex8", "hex20") for shape, _ in part.elements.values()) or deck.left_out:
        return None
    mesh = _Refinement(part)
    text = _mesh(part, mesh)
    for card in deck.cards:
        if card.name in MESH | OUTPUT:
            continue
        if card.name not in KEPT | {"DLOAD"}:
            return None
        lines = _pressures(part, mesh, card) if card.name == "DLOAD" else [", ".join(line) for line in card.lines]
        if lines is None:
            return None
        words = [f"{key}={value}" if value else key for key, value in card.parameters.items()]
        text += [", ".join(["*" + card.name, *words]), *lines]
    return "\n".join(text) + "\n"
