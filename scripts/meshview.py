"""Meshes and fields of results.h5 as polygons for matplotlib."""
import h5py
import numpy

# Corner nodes of the faces, outward, in the order of results.h5; second-order cells begin with their corners
HEX_FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
CELLS = {"cells_hex8": HEX_FACES, "cells_hex27": HEX_FACES, "cells_quad4": [(0, 1, 2, 3)], "cells_quad9": [(0, 1, 2, 3)]}


def skin(cells, body, faces=HEX_FACES):
    """Outer faces of cells by their corners, with the body of each; cells of the plane are their own faces."""
    corners = numpy.concatenate([cells[:, face] for face in faces])
    bodies = numpy.tile(body, len(faces))
    _, first, count = numpy.unique(numpy.sort(corners, axis=1), axis=0, return_index=True, return_counts=True)
    return corners[first[count == 1]], bodies[first[count == 1]]


def read_mesh(path):
    """Reference coordinates of the nodes and the outer faces of a run's results.h5."""
    with h5py.File(path, "r") as file:
        kind = next(name for name in CELLS if name in file["mesh"])
        faces, _ = skin(file["mesh"][kind][()], file["mesh"][kind + "_body"][()], CELLS[kind])
        return file["mesh/nodes"][()], faces


def read_states(path, *fields):
    """Every written step: its load parameter and the fields, by their names below the step."""
    with h5py.File(path, "r") as file:
        return [(float(step.attrs["t"]), *(step[field][()] for field in fields)) for _, step in sorted(file["steps"].items())]


def read_slave(path, pair):
    """Node ids of a contact pair's slave nodes, in the order of its fields."""
    with h5py.File(path, "r") as file:
        return file["contact"][pair]["nodes"][()]
