"""Shapes of elements by name: gmsh's number, corners, edges with a middle node, faces by corners. The order of nodes is
gmsh's."""
import dataclasses

TRI_EDGES = ((0, 1), (1, 2), (2, 0))
QUAD_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))
TET_EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1))
HEX_EDGES = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7))
TET_FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (3, 1, 2))
HEX_FACES = ((0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7))


@dataclasses.dataclass(frozen=True)
class Shape:
    number: int  # gmsh's
    dim: int
    nodes: int
    corners: int
    edges: tuple = ()  # each has a middle node behind the corners, where the shape is of second order
    faces: tuple = ()  # by corners, outward; behind the edges each has a middle node, where the shape is complete
    face: str = ""  # shape of the faces

    @property
    def order(self):
        return 1 if self.nodes == self.corners else 2


SHAPES = {
    "point": Shape(15, 0, 1, 1),
    "edge2": Shape(1, 1, 2, 2),
    "edge3": Shape(8, 1, 3, 2, ((0, 1),)),
    "tri3": Shape(2, 2, 3, 3, TRI_EDGES, TRI_EDGES, "edge2"),
    "tri6": Shape(9, 2, 6, 3, TRI_EDGES, TRI_EDGES, "edge3"),
    "quad4": Shape(3, 2, 4, 4, QUAD_EDGES, QUAD_EDGES, "edge2"),
    "quad8": Shape(16, 2, 8, 4, QUAD_EDGES, QUAD_EDGES, "edge3"),
    "quad9": Shape(10, 2, 9, 4, QUAD_EDGES, QUAD_EDGES, "edge3"),
    "tet4": Shape(4, 3, 4, 4, TET_EDGES, TET_FACES, "tri3"),
    "tet10": Shape(11, 3, 10, 4, TET_EDGES, TET_FACES, "tri6"),
    "hex8": Shape(5, 3, 8, 8, HEX_EDGES, HEX_FACES, "quad4"),
    "hex20": Shape(17, 3, 20, 8, HEX_EDGES, HEX_FACES, "quad8"),
    "hex27": Shape(12, 3, 27, 8, HEX_EDGES, HEX_FACES, "quad9"),
}
BY_NUMBER = {shape.number: name for name, shape in SHAPES.items()}
COMPLETE = {"quad8": "quad9", "hex20": "hex27"}  # serendipity shapes and what they become


def middle(shape, a, b):
    """Index of the middle node of the edge between corners a and b."""
    for k, edge in enumerate(shape.edges):
        if set(edge) == {a, b}:
            return shape.corners + k
    raise KeyError((a, b))


def face_nodes(name, f):
    """Indices of the nodes of face f of a shape, in the order of the face's shape."""
    shape, corners = SHAPES[name], SHAPES[name].faces[f]
    face = SHAPES[shape.face]
    nodes = list(corners)
    if face.order == 2:
        nodes += [middle(shape, corners[a], corners[b]) for a, b in face.edges]
    if shape.face == "quad9":
        nodes.append(shape.corners + len(shape.edges) + f)
    return nodes


MIRRORED_CORNERS = {3: (0, 2, 1), 4: (0, 3, 2, 1), 8: (4, 5, 6, 7, 0, 1, 2, 3)}


def mirrored(name):
    """For each node of a shape, its place in the same element with the other sense of turning."""
    shape = SHAPES[name]
    corners = (0, 2, 1, 3) if name in ("tet4", "tet10") else MIRRORED_CORNERS[shape.corners]
    nodes = list(corners)
    if shape.order == 2:
        nodes += [middle(shape, corners[a], corners[b]) for a, b in shape.edges]
    if name == "hex27":
        sides = [set(face) for face in shape.faces]
        nodes += [20 + sides.index({corners[a] for a in face}) for face in shape.faces]
    return nodes + list(range(len(nodes), shape.nodes))  # the centre stays
