"""A mesh as all readers give it: nodes, elements by shape, named groups; and what the solver needs of it: complete
elements of second order, faces for groups that other programs give by their nodes, gmsh's format 4.1."""
import dataclasses

import numpy

from meshfiles.shapes import BY_NUMBER, COMPLETE, SHAPES, face_nodes, mirrored


class MeshError(Exception):
    """The file cannot be taken; the text says why and what is allowed."""


@dataclasses.dataclass
class Group:
    """A named set of elements of one dimension."""

    name: str
    dim: int
    members: dict  # shape -> indices of elements

    def add(self, shape, indices):
        old = self.members.get(shape, numpy.zeros(0, int))
        self.members[shape] = numpy.union1d(old, numpy.asarray(indices, int))

    @property
    def size(self):
        return sum(len(indices) for indices in self.members.values())


class Mesh:
    """dim is that of the scene: elements of this dimension make bodies, those of one less make surfaces."""

    def __init__(self, dim, coordinates):
        self.dim = dim
        self.nodes = numpy.asarray(coordinates, float).reshape(-1, 3)
        self.elements = {}  # shape -> n x nodes
        self.groups = []
        self.notes = []  # what the user should know
        self._faces = None

    def add_elements(self, shape, connectivity):
        """Appends elements and returns their indices."""
        new = numpy.asarray(connectivity, int).reshape(-1, SHAPES[shape].nodes)
        old = self.elements.get(shape, numpy.zeros((0, SHAPES[shape].nodes), int))
        self.elements[shape] = numpy.vstack((old, new))
        return numpy.arange(len(old), len(old) + len(new))

    def group(self, name, dim):
        """The group of this name and dimension, made if it is not there."""
        for group in self.groups:
            if (group.name, group.dim) == (name, dim):
                return group
        self.groups.append(Group(name, dim, {}))
        return self.groups[-1]

    # Faces of bodies

    def add_cell_face(self, group, shape, cells, f):
        """Adds face f of some cells to a group of faces."""
        face = SHAPES[shape].face
        group.add(face, self.add_elements(face, self.elements[shape][cells][:, face_nodes(shape, f)]))

    def add_faces_of_nodes(self, group, nodes):
        """Adds to a group the outer faces of bodies all of whose nodes are among these."""
        marked = numpy.zeros(len(self.nodes), bool)
        marked[nodes] = True
        for shape, f, outer in self.outer_faces():
            chosen = outer[marked[self.elements[shape][outer][:, face_nodes(shape, f)]].all(axis=1)]
            if len(chosen):
                self.add_cell_face(group, shape, chosen, f)

    def outer_faces(self):
        """(shape of cells, number of the face, cells of which this face belongs to no other cell) for all."""
        if self._faces is None:
            kinds = [(shape, f) for shape in self.elements if SHAPES[shape].dim == self.dim
                     for f in range(len(SHAPES[shape].faces))]
            keys = []
            for shape, f in kinds:
                corners = self.elements[shape][:, SHAPES[shape].faces[f]]
                key = numpy.full((len(corners), 4), -1)
                key[:, :corners.shape[1]] = numpy.sort(corners, axis=1)
                keys.append(key)
            single = numpy.zeros(0, bool)
            if keys:
                _, inverse, count = numpy.unique(numpy.vstack(keys), axis=0, return_inverse=True, return_counts=True)
                single = count[inverse.ravel()] == 1
            ends = numpy.cumsum([0] + [len(key) for key in keys])
            self._faces = [(shape, f, numpy.flatnonzero(single[ends[k]:ends[k + 1]]))
                           for k, (shape, f) in enumerate(kinds)]
        return self._faces

    # Second order

    def _centres(self, corners, weights_corner, middles, weights_middle):
        """Appends one node for each different set of corners and returns the nodes' numbers."""
        _, first, inverse = numpy.unique(numpy.sort(corners, axis=1), axis=0, return_index=True, return_inverse=True)
        places = (weights_corner * self.nodes[corners[first]].sum(axis=1) +
                  weights_middle * self.nodes[middles[first]].sum(axis=1))
        start = len(self.nodes)
        self.nodes = numpy.vstack((self.nodes, places))
        return start + inverse.ravel()

    def complete(self):
        """Gives serendipity elements the nodes that they lack, at the places that their own shape functions give: a
        face's node is shared by all that have the face."""
        pending = {shape: self.elements[shape] for shape in COMPLETE if len(self.elements.get(shape, ()))}
        if not pending:
            return
        corners, middles = [], []  # of faces: of bricks, then of the quadrilaterals themselves
        for shape, cells in pending.items():
            for f in range(len(SHAPES[shape].faces) if shape == "hex20" else 1):
                nodes = face_nodes("hex20", f) if shape == "hex20" else range(8)
                corners.append(cells[:, list(nodes)[:4]])
                middles.append(cells[:, list(nodes)[4:8]])
        ends = numpy.cumsum([0] + [len(part) for part in corners])
        new = self._centres(numpy.vstack(corners), -0.25, numpy.vstack(middles), 0.5)
        parts = [new[ends[k]:ends[k + 1]] for k in range(len(corners))]
        for shape, cells in pending.items():
            columns = [parts.pop(0) for _ in range(6 if shape == "hex20" else 1)]
            if shape == "hex20":
                columns.append(self._centres(cells[:, :8], -0.25, cells[:, 8:20], 0.25))
            self._replace(shape, COMPLETE[shape], numpy.column_stack([cells, *columns]))
            self.notes.append(f"{len(cells)} elements with {SHAPES[shape].nodes} nodes were completed to "
                              f"{SHAPES[COMPLETE[shape]].nodes} nodes (serendipity elements are not available)")
        self._faces = None

    def _replace(self, old, new, connectivity):
        """Turns all elements of one shape into another shape, in all groups too."""
        del self.elements[old]
        indices = self.add_elements(new, connectivity)
        for group in self.groups:
            if old in group.members:
                group.add(new, indices[group.members.pop(old)])

    def merge_faces(self):
        """Keeps one of several surface elements on the same corners: a face may come with a set of faces, with labels of
        cells, and with a set of nodes."""
        for shape in [shape for shape in self.elements if SHAPES[shape].dim == self.dim - 1]:
            corners = numpy.sort(self.elements[shape][:, :SHAPES[shape].corners], axis=1)
            _, first, inverse = numpy.unique(corners, axis=0, return_index=True, return_inverse=True)
            keep = numpy.sort(first)
            row = numpy.searchsorted(keep, first)[inverse.ravel()]
            self.elements[shape] = self.elements[shape][keep]
            for group in self.groups:
                if shape in group.members:
                    group.members[shape] = numpy.unique(row[group.members[shape]])

    # Checks and the file

    def choose_bodies(self, names):
        """Gives each cell to one body, as the solver wants it: groups of these names come first, then the others in
        their order, each with the cells that are left. Cells without a group make the body `rest`."""
        bodies = [group for group in self.groups if group.dim == self.dim]
        taken = {shape: numpy.zeros(len(cells), bool) for shape, cells in self.elements.items()
                 if SHAPES[shape].dim == self.dim}
        named = [group for group in bodies if group.name in names]
        for group in named:
            for shape, indices in group.members.items():
                taken[shape][indices] = True
        for group in bodies:
            for shape, indices in group.members.items() if group.name not in names else ():
                group.members[shape] = indices[~taken[shape][indices]]
                taken[shape][indices] = True
        for shape, mask in taken.items():
            if not mask.all():
                self.group("rest", self.dim).add(shape, numpy.flatnonzero(~mask))

    def _volumes(self, shape, indices):
        """Determinants of the axes of cells, from centre to centre of opposite faces: below 0 where the nodes turn the
        wrong way round."""
        x = self.nodes[self.elements[shape][indices], :self.dim]
        if SHAPES[shape].corners == self.dim + 1:
            axes = [x[:, k + 1] - x[:, 0] for k in range(self.dim)]
        else:
            ends = (((1, 2, 5, 6), (0, 3, 4, 7)), ((2, 3, 6, 7), (0, 1, 4, 5)), ((4, 5, 6, 7), (0, 1, 2, 3)))
            axes = [x[:, [a for a in up if a < 2**self.dim]].mean(axis=1) -
                    x[:, [a for a in down if a < 2**self.dim]].mean(axis=1) for up, down in ends[:self.dim]]
        return numpy.linalg.det(numpy.stack(axes, axis=1))

    def turn_bodies(self):
        """Turns the cells of a body round whose nodes all turn the wrong way, as on a grid with left-handed axes. Where
        only some do, the mesh is folded, and the solver says so."""
        for group in self.groups:
            parts = {shape: indices for shape, indices in group.members.items() if group.dim == self.dim and len(indices)}
            if not parts or any((self._volumes(*part) >= 0).any() for part in parts.items()):
                continue
            for shape, indices in parts.items():
                self.elements[shape][indices] = self.elements[shape][indices][:, mirrored(shape)]
            self.notes.append(f"all elements of '{group.name}' have left-handed axes; their nodes were put in the other "
                              "order")

    def check(self):
        """Refuses what the solver cannot take."""
        cells = [shape for shape in self.elements if SHAPES[shape].dim == self.dim and len(self.elements[shape])]
        if not cells:
            found = sorted({SHAPES[shape].dim for shape in self.elements if len(self.elements[shape])})
            raise MeshError(f"no elements of dimension {self.dim}, which the scene's geometry asks for; there are "
                            f"elements of dimension {', '.join(map(str, found)) or 'none'}")
        orders = sorted({SHAPES[shape].order for shape in cells})
        if len(orders) > 1:
            raise MeshError(f"elements of first and of second order in one mesh ({', '.join(sorted(cells))}); allowed: "
                            "one order")

    def write(self, file):
        """Writes gmsh's format 4.1 as text. Elements of the same groups make one entity. Nodes that no element has, and
        points on them, are left out."""
        self._drop_nodes()
        groups = [group for group in self.groups if group.size]
        numbers = {(group.dim, group.name): k + 1 for k, group in enumerate(groups)}
        entities = {dim: [] for dim in range(4)}  # (groups, {shape: elements})
        for dim in range(4):
            entities[dim] = self._entities([group for group in groups if group.dim == dim])
        with open(file, "w") as out:
            out.write("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n")
            out.writelines(f"note: {note}\n" for note in self.notes)
            out.write("$EndComments\n")
            self._write_head(out, groups, numbers, entities)
            self._write_nodes(out)
            self._write_elements(out, entities)

    def _drop_nodes(self):
        used = numpy.zeros(len(self.nodes), bool)
        for shape, connectivity in self.elements.items():
            if SHAPES[shape].dim >= self.dim - 1:
                used[connectivity] = True
        for group in self.groups:
            for shape in group.members:
                kept = used[self.elements[shape][group.members[shape]]].all(axis=1)
                group.members[shape] = group.members[shape][kept]
        number = numpy.cumsum(used) - 1
        self.nodes = self.nodes[used]
        for shape, connectivity in self.elements.items():
            self.elements[shape] = number[connectivity]

    def _entities(self, groups):
        """Elements that belong to the same groups: a list of (groups, {shape: connectivity})."""
        found = {}
        for shape in sorted({shape for group in groups for shape in group.members}):
            member = numpy.zeros((len(self.elements[shape]), len(groups)), bool)
            for k, group in enumerate(groups):
                if shape in group.members:
                    member[group.members[shape], k] = True
            sets, inverse = numpy.unique(member, axis=0, return_inverse=True)
            for s, row in enumerate(sets):
                if row.any():
                    key = tuple(numpy.flatnonzero(row))
                    found.setdefault(key, {})[shape] = self.elements[shape][inverse.ravel() == s]
        return [([groups[k] for k in key], blocks) for key, blocks in sorted(found.items())]

    @staticmethod
    def _write_head(out, groups, numbers, entities):
        out.write("$PhysicalNames\n%d\n" % len(groups))
        for group in groups:
            out.write(f'{group.dim} {numbers[group.dim, group.name]} "{group.name}"\n')
        out.write("$EndPhysicalNames\n$Entities\n%s\n" % " ".join(str(len(entities[dim])) for dim in range(4)))
        for dim in range(4):
            for tag, (members, _) in enumerate(entities[dim], 1):
                physicals = " ".join(str(numbers[group.dim, group.name]) for group in members)
                box = "0 0 0" if dim == 0 else "0 0 0 0 0 0"
                out.write(f"{tag} {box} {len(members)} {physicals}{' 0' if dim else ''}\n")
        out.write("$EndEntities\n")

    def _write_nodes(self, out):
        n = len(self.nodes)
        out.write(f"$Nodes\n1 {n} 1 {n}\n{self.dim} 1 0 {n}\n")
        out.write("\n".join(map(str, range(1, n + 1))) + "\n")
        out.write("\n".join("%.17g %.17g %.17g" % tuple(place) for place in self.nodes.tolist()) + "\n$EndNodes\n")

    @staticmethod
    def _write_elements(out, entities):
        blocks = [(dim, tag, shape, connectivity) for dim in range(4)
                  for tag, (_, parts) in enumerate(entities[dim], 1) for shape, connectivity in sorted(parts.items())]
        n, element = sum(len(block[3]) for block in blocks), 0
        out.write(f"$Elements\n{len(blocks)} {n} 1 {n}\n")
        for dim, tag, shape, connectivity in blocks:
            out.write(f"{dim} {tag} {SHAPES[shape].number} {len(connectivity)}\n")
            for nodes in (connectivity + 1).tolist():
                element += 1
                out.write(f"{element} {' '.join(map(str, nodes))}\n")
        out.write("$EndElements\n")


def shape_of_number(number):
    """The shape for gmsh's number of a type, or a refusal that names it."""
    if number in BY_NUMBER:
        return BY_NUMBER[number]
    raise MeshError(f"elements of gmsh's type {number} are not available; there are triangles, quadrilaterals, "
                    "tetrahedra and bricks of order 1 and 2")
