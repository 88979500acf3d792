"""What the elements themselves leave of a uniform pressure: the two rings of runs/ring_in_ring.yaml on meshes whose
nodes face each other, tied along the radius with the interference as jump, by dense linear algebra and independent of
Burnish's contact.
    floor(directory): directory of a finished run with mesh.parameters.matching=1"""
import functools
import itertools
import pathlib

import h5py
import numpy

E, NU, RADIUS, INTERFERENCE = 200000, 0.3, 20, 0.0025
CORNERS = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=float)


@functools.cache
def shapes(order):
    """Nodes of the square in XDMF's order, powers of the monomials and the coefficients of the shape functions in
    them."""
    nodes = CORNERS if order == 1 else numpy.vstack(
        [CORNERS, (CORNERS + numpy.roll(CORNERS, -1, axis=0)) / 2, [[0, 0]]])
    powers = list(itertools.product(range(order + 1), repeat=2))
    return powers, numpy.linalg.inv([[x[0] ** p * x[1] ** q for p, q in powers] for x in nodes])


def derivatives(order, x, y):
    powers, coefficients = shapes(order)
    slopes = [[p * x ** max(p - 1, 0) * y**q for p, q in powers], [q * x**p * y ** max(q - 1, 0) for p, q in powers]]
    return numpy.array(slopes) @ coefficients


def stiffness(nodes, cells, order):
    """Plane strain, dense."""
    points, weights = numpy.polynomial.legendre.leggauss(order + 1)
    elastic = E / ((1 + NU) * (1 - 2 * NU)) * numpy.array([[1 - NU, NU, 0], [NU, 1 - NU, 0], [0, 0, (1 - 2 * NU) / 2]])
    K = numpy.zeros((2 * len(nodes), 2 * len(nodes)))
    for cell in cells:
        k, dofs = 0, numpy.ravel([[2 * n, 2 * n + 1] for n in cell])
        for (x, a), (y, b) in itertools.product(zip(points, weights), repeat=2):
            slopes = derivatives(order, x, y)
            jacobian = slopes @ nodes[cell, :2]
            gradient = numpy.linalg.solve(jacobian, slopes)
            B = numpy.zeros((3, len(dofs)))
            B[0, ::2] = B[2, 1::2] = gradient[0]
            B[1, 1::2] = B[2, ::2] = gradient[1]
            k = k + a * b * numpy.linalg.det(jacobian) * B.T @ elastic @ B
        K[numpy.ix_(dofs, dofs)] += k
    return K


def lengths(nodes, order, angle):
    """int N ds of the interface's nodes, in the order of their angles."""
    share = [1 / 2, 1 / 2] if order == 1 else [1 / 6, 2 / 3, 1 / 6]
    length = numpy.zeros(len(angle))
    for first in range(0, len(angle) - 1, order):
        length[first:first + order + 1] += RADIUS * (angle[first + order] - angle[first]) * numpy.array(share)
    return length


def floor(directory):
    """Pressure of the tied nodes: mean, largest and rms deviation in per cent."""
    with h5py.File(pathlib.Path(directory) / "results.h5", "r") as file:
        nodes = file["mesh/nodes"][()]
        name = next(n for n in file["mesh"] if n.startswith("cells_quad") and not n.endswith("body"))
        cells, order = file["mesh"][name][()], 1 if name == "cells_quad4" else 2
        body = file["mesh"][name + "_body"][()]
    K = stiffness(nodes, cells, order)
    radius, angle = numpy.hypot(nodes[:, 0], nodes[:, 1]), numpy.arctan2(nodes[:, 1], nodes[:, 0])
    sides = []
    for b in (0, 1):
        own = numpy.unique(cells[body == b])
        own = own[numpy.abs(radius[own] - RADIUS) < 2 * INTERFERENCE]
        sides.append(own[numpy.argsort(angle[own])])
    inner, outer = sides
    held = numpy.concatenate([
        2 * numpy.flatnonzero(numpy.abs(nodes[:, 0]) < 1e-9), 2 * numpy.flatnonzero(numpy.abs(nodes[:, 1]) < 1e-9) + 1
    ])
    m, n = len(inner), len(K)
    jump = numpy.zeros((m, n))
    for side, sign in ((outer, 1), (inner, -1)):
        jump[numpy.arange(m), 2 * side] = sign * numpy.cos(angle[inner])
        jump[numpy.arange(m), 2 * side + 1] = sign * numpy.sin(angle[inner])
    free = numpy.setdiff1d(numpy.arange(n), held)
    system = numpy.block([[K[numpy.ix_(free, free)], jump[:, free].T], [jump[:, free], numpy.zeros((m, m))]])
    force = -numpy.linalg.solve(system, numpy.concatenate([numpy.zeros(len(free)),
                                                           numpy.full(m, INTERFERENCE)]))[len(free):]
    length = lengths(nodes, order, angle[inner])
    pressure = force / length
    mean = numpy.sum(length * pressure) / numpy.sum(length)
    error = 100 * (pressure / mean - 1)
    return {
        "mean_pressure": mean,
        "noise_max": numpy.max(numpy.abs(error)),
        "noise_rms": numpy.sqrt(numpy.sum(length * error**2) / numpy.sum(length))
    }
