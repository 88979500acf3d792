"""Cuts bodies by a plane: what is left of the outer faces and of their sides, and the section."""
import itertools

import numpy

from burnish.meshview import CELLS

HEX_CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
HEX_TETS = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]  # about one diagonal
TET10_TETS = [(0, 4, 6, 7), (1, 5, 4, 8), (2, 6, 5, 9), (3, 7, 9, 8),  # at the corners, then what is between them
              (6, 8, 4, 5), (6, 8, 5, 9), (6, 8, 9, 7), (6, 8, 7, 4)]


def _hex27_tets():
    """Eight bricks of six tetrahedra; nodes are known by their places in a lattice of 3 x 3 x 3."""
    corners, faces, edges = CELLS["hex27"]
    places = [numpy.array(place) for place in HEX_CORNERS]
    means = [*edges, *faces, tuple(range(corners))]
    places += [sum(places[node] for node in nodes) // len(nodes) for nodes in means]
    node = {tuple(place): number for number, place in enumerate(places)}
    return [tuple(node[tuple(numpy.add(numpy.array(HEX_CORNERS[corner]) // 2, low))] for corner in tet)
            for low in itertools.product((0, 1), repeat=3) for tet in HEX_TETS]


TETS = {"tet4": [(0, 1, 2, 3)], "tet10": TET10_TETS, "hex8": HEX_TETS, "hex27": _hex27_tets()}


class Cut:
    """Points with values, some of them new, of bodies of which the half with side > 0 is taken away; side: signed
    distances of the points from the plane."""

    def __init__(self, points, values, side):
        self.points, self.values, self.side = points, values, side
        self._new_points, self._new_values, self._count = [points], [values], len(points)

    def _crossings(self, inner, outer):
        """Numbers of new points on the plane between points on both sides of it."""
        inner, outer = numpy.broadcast_arrays(inner, outer)
        share = (self.side[inner] / (self.side[inner] - self.side[outer]))[..., None]
        first = self._count
        self._count += inner.size
        at = self.points[inner] + share * (self.points[outer] - self.points[inner])
        value = self.values[inner] + share[..., 0] * (self.values[outer] - self.values[inner])
        self._new_points.append(at.reshape(-1, 3))
        self._new_values.append(value.ravel())
        return numpy.arange(first, self._count).reshape(inner.shape)

    def _sorted(self, parts):
        """Corners of each part, those that stay first, and how many these are."""
        inside = self.side[parts] <= 0
        order = numpy.argsort(~inside, axis=1, kind="stable")
        return numpy.take_along_axis(parts, order, axis=1), inside.sum(axis=1)

    def lines(self, lines):
        """What is left of lines."""
        ends, kept = self._sorted(lines)
        crossed = ends[kept == 1]
        cut = numpy.stack([crossed[:, 0], self._crossings(crossed[:, 0], crossed[:, 1])], axis=1)
        return numpy.concatenate([lines[kept == 2], cut])

    def triangles(self, triangles):
        """What is left of triangles, the triangle that each was, and the lines along which the plane cuts them."""
        corners, kept = self._sorted(triangles)
        whole, one, two = (numpy.flatnonzero(kept == k) for k in (3, 1, 2))
        a, b, c = corners[one].T
        tip = numpy.stack([a, self._crossings(a, b), self._crossings(a, c)], axis=1)
        a, b, c = corners[two].T
        on_a, on_b = self._crossings(a, c), self._crossings(b, c)
        left = [triangles[whole], tip, numpy.stack([a, b, on_b], axis=1), numpy.stack([a, on_b, on_a], axis=1)]
        edge = numpy.concatenate([tip[:, 1:], numpy.stack([on_a, on_b], axis=1)])
        return numpy.concatenate(left), numpy.concatenate([whole, one, two, two]), edge

    def section(self, kind, cells):
        """Triangles in the plane that the cells of a kind leave."""
        side = self.side[cells]
        crossed = cells[(side <= 0).any(axis=1) & (side > 0).any(axis=1)]
        tets = numpy.concatenate([crossed[:, tet] for tet in TETS[kind]])
        corners, kept = self._sorted(tets)
        a, b, c, d = corners[kept == 1].T
        found = [self._crossings(a[:, None], numpy.stack([b, c, d], axis=1))]
        a, b, c, d = corners[kept == 3].T
        found.append(self._crossings(numpy.stack([a, b, c], axis=1), d[:, None]))
        a, b, c, d = corners[kept == 2].T
        ac, ad, bc, bd = (self._crossings(i, j) for i, j in ((a, c), (a, d), (b, c), (b, d)))
        found += [numpy.stack([ac, ad, bd], axis=1), numpy.stack([ac, bd, bc], axis=1)]
        return numpy.concatenate(found)

    def all(self):
        """All points and their values, the new ones behind the old ones."""
        return numpy.concatenate(self._new_points), numpy.concatenate(self._new_values)
