"""Meshes and fields of results.h5 as polygons for pictures."""
import dataclasses

import h5py
import numpy

# Cells in the node order of results.h5 (XDMF's): corners, then a middle node for each edge, then, where there are such
# nodes, one for each face and the centre. Faces by their corners, outward; cells of the plane are their own faces.
HEX_FACES = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]
HEX_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
TET_FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
QUAD, QUAD_EDGES = [(0, 1, 2, 3)], [(0, 1), (1, 2), (2, 3), (3, 0)]
TRI, TRI_EDGES = [(0, 1, 2)], [(0, 1), (1, 2), (2, 0)]
CELLS = {
    "hex8": (8, HEX_FACES, []),
    "hex27": (8, HEX_FACES, HEX_EDGES),
    "tet4": (4, TET_FACES, []),
    "tet10": (4, TET_FACES, TET_EDGES),
    "quad4": (4, QUAD, []),
    "quad9": (4, QUAD, QUAD_EDGES),
    "tri3": (3, TRI, []),
    "tri6": (3, TRI, TRI_EDGES),
}  # name -> corners, faces, edges with a middle node

# A face's nodes are its corners, the middle nodes of its sides, its centre: what it is drawn as, by their number
TRIANGLES = {
    3: [(0, 1, 2)],
    4: [(0, 1, 2), (0, 2, 3)],
    6: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    9: [(0, 4, 8), (4, 1, 8), (1, 5, 8), (5, 2, 8), (2, 6, 8), (6, 3, 8), (3, 7, 8), (7, 0, 8)],
}
SIDES = {
    3: [(0, 1), (1, 2), (2, 0)],
    4: [(0, 1), (1, 2), (2, 3), (3, 0)],
    6: [(0, 3), (3, 1), (1, 4), (4, 2), (2, 5), (5, 0)],
    9: [(0, 4), (4, 1), (1, 5), (5, 2), (2, 6), (6, 3), (3, 7), (7, 0)],
}
SHARP = 0.8  # cosine of the angle between faces beyond which their side is an edge of the body


@dataclasses.dataclass
class Skin:
    """The outer faces of all bodies: what a picture shows."""

    nodes: numpy.ndarray  # reference coordinates, N x 3
    triangles: numpy.ndarray  # n x 3 node ids
    triangle_body: numpy.ndarray  # n, index into the scene's bodies
    lines: numpy.ndarray  # the faces' sides, m x 2 node ids, each once
    line_body: numpy.ndarray
    line_outer: numpy.ndarray  # in the plane: the side is on the boundary
    plane: bool


@dataclasses.dataclass
class Tool:
    """A rigid tool: what a picture shows."""

    name: str
    nodes: numpy.ndarray  # at the start, n x 3
    parts: numpy.ndarray  # m x 2 nodes of lines in the plane, m x 3 of triangles in space


def face_nodes(kind):
    """All nodes of each face of a cell."""
    corners, faces, edges = CELLS[kind]
    middle = {frozenset(edge): corners + i for i, edge in enumerate(edges)}
    sides = [[middle[frozenset((face[i - 1], face[i]))]
              for i in (*range(1, len(face)), 0)] if edges else []
             for face in faces]
    centre = [[corners + len(edges) + i] if kind in ("hex27", "quad9") else [] for i in range(len(faces))]
    return [(*face, *sides[i], *centre[i]) for i, face in enumerate(faces)]


def skin(cells, body, faces):
    """Those of the faces (nodes of a cell, corners first, all of one kind) that belong to one cell only, with the body
    of each."""
    nodes = numpy.concatenate([cells[:, face] for face in faces])
    bodies = numpy.tile(body, len(faces))
    corners = {3: 3, 6: 3, 4: 4, 9: 4}[nodes.shape[1]]
    _, first, count = numpy.unique(numpy.sort(nodes[:, :corners], axis=1), axis=0, return_index=True,
                                   return_counts=True)
    return nodes[first[count == 1]], bodies[first[count == 1]]


def cells_of(file):
    """Element name, cells and bodies of each table of cells."""
    return [(kind, file[f"mesh/cells_{kind}"][()], file[f"mesh/cells_{kind}_body"][()])
            for kind in CELLS
            if f"cells_{kind}" in file["mesh"]]


def read_mesh(path):
    """Reference coordinates of the nodes and the corners of the outer faces of a run's results.h5, whose cells are all
    hexahedra or all quadrilaterals."""
    with h5py.File(path, "r") as file:
        (kind, cells, body), = cells_of(file)
        faces, _ = skin(cells, body, CELLS[kind][1])
        return file["mesh/nodes"][()], faces


def read_skin(path):
    """The outer faces of a run's results.h5, of any cells, second-order ones with all their nodes."""
    triangles, triangle_body, lines, line_body, plane = [], [], [], [], False
    with h5py.File(path, "r") as file:
        nodes = file["mesh/nodes"][()]
        for kind, cells, body in cells_of(file):
            plane = kind.startswith(("tri", "quad"))
            faces, bodies = skin(cells, body, face_nodes(kind))
            for table, bodies_of, parts in ((triangles, triangle_body, TRIANGLES), (lines, line_body, SIDES)):
                for part in parts[faces.shape[1]]:
                    table.append(faces[:, part])
                    bodies_of.append(bodies)
    lines, line_body = numpy.sort(numpy.concatenate(lines), axis=1), numpy.concatenate(line_body)
    lines, first, count = numpy.unique(lines, axis=0, return_index=True, return_counts=True)
    return Skin(nodes, numpy.concatenate(triangles), numpy.concatenate(triangle_body), lines, line_body[first],
                count == 1, plane)


def read_cells(path):
    """Element name, cells and bodies of each kind of element in a run's results.h5."""
    with h5py.File(path, "r") as file:
        return cells_of(file)


def outline(nodes, triangles, towards):
    """Sides of outer triangles at which a body has an edge, and those behind which a viewer in a direction sees no more
    of it."""
    a, b, c = (nodes[triangles[:, i]] for i in range(3))
    normal = numpy.cross(b - a, c - a)
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1, keepdims=True), numpy.finfo(float).tiny)
    sides = numpy.sort(numpy.concatenate([triangles[:, pair] for pair in ((0, 1), (1, 2), (2, 0))]), axis=1)
    owner = numpy.tile(numpy.arange(len(triangles)), 3)
    order = numpy.lexsort((sides[:, 1], sides[:, 0]))
    sides, owner = sides[order], owner[order]
    twice = numpy.flatnonzero((sides[1:] == sides[:-1]).all(axis=1))
    first, second = normal[owner[twice]], normal[owner[twice + 1]]
    bent = (first * second).sum(axis=1) < SHARP
    rim = (first @ towards > 0) != (second @ towards > 0)
    return sides[twice[bent | rim]]


def read_tools(path, plane):
    """The rigid tools of a run's results.h5: lines in the plane, triangles in space."""
    with h5py.File(path, "r") as file:
        found = [(name, tool["nodes"][()], tool["cells"][()]) for name, tool in file.get("tools", {}).items()]
    parts = {2: [(0, 1)], 3: [(0, 2), (2, 1)]} if plane else TRIANGLES
    return [Tool(name, nodes, numpy.concatenate([cells[:, part] for part in parts[cells.shape[1]]]))
            for name, nodes, cells in found]


def read_states(path, *fields):
    """Every written step: its load parameter and the fields, by their names below the step."""
    with h5py.File(path, "r") as file:
        return [(float(step.attrs["t"]), *(step[field][()]
                                           for field in fields))
                for _, step in sorted(file["steps"].items())]


def read_slave(path, pair):
    """Node ids of a contact pair's slave nodes, in the order of its fields."""
    with h5py.File(path, "r") as file:
        return file["contact"][pair]["nodes"][()]
