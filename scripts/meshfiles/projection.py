"""Nodes of one surface put onto another, for decks that adjust contact without strain."""
import numpy

# Triangles or lines by nodes that stand for the faces of each shape
PARTS = {
    "edge2": ((0, 1),),
    "edge3": ((0, 2), (2, 1)),
    "tri3": ((0, 1, 2),),
    "tri6": ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    "quad4": ((0, 1, 2), (0, 2, 3)),
    "quad8": ((0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)),
    "quad9": ((0, 4, 8), (4, 1, 8), (1, 5, 8), (5, 2, 8), (2, 6, 8), (6, 3, 8), (3, 7, 8), (7, 0, 8)),
}


def _surface(mesh, name):
    return next(group for group in mesh.groups if group.name == name and group.dim == mesh.dim - 1)


def _nearest_on_lines(x, a, b):
    d = b - a
    s = numpy.clip(((x - a) * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
    return a + s[:, None] * d


def _nearest_on_triangles(x, a, b, c):
    """The nearest points on triangles to one point x: inside by the foot of the normal, else on the sides."""
    u, v, w = b - a, c - a, x - a
    uu, uv, vv = (u * u).sum(1), (u * v).sum(1), (v * v).sum(1)
    wu, wv, det = (w * u).sum(1), (w * v).sum(1), uu * vv - uv * uv
    s, t = (vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det
    foot = a + s[:, None] * u + t[:, None] * v
    inside = (s >= 0) & (t >= 0) & (s + t <= 1)
    best, distance = foot, numpy.where(inside, ((x - foot)**2).sum(1), numpy.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        y = _nearest_on_lines(x, p, q)
        d = ((x - y)**2).sum(1)
        best, distance = numpy.where((d < distance)[:, None], y, best), numpy.minimum(d, distance)
    return best


def put_on_surface(mesh, slave, master, tolerance, chosen=None):
    """Moves the nodes of `slave` that are nearer than `tolerance` to `master` onto it, of `chosen` ones if these are
    given. Returns their number and the longest way."""
    parts = []
    for shape, indices in _surface(mesh, master).members.items():
        faces = mesh.elements[shape][indices]
        parts += [mesh.nodes[faces[:, list(part)]] for part in PARTS[shape]]
    corners = numpy.vstack(parts)
    rows = numpy.unique(numpy.concatenate([mesh.elements[shape][indices].ravel()
                                           for shape, indices in _surface(mesh, slave).members.items()]))
    if chosen is not None:
        rows = numpy.intersect1d(rows, chosen)
    moved, most = 0, 0.0
    for row in rows:
        x = mesh.nodes[row]
        feet = (_nearest_on_triangles if corners.shape[1] == 3 else _nearest_on_lines)(x, *corners.transpose(1, 0, 2))
        foot = feet[((feet - x)**2).sum(1).argmin()]
        way = float(numpy.linalg.norm(foot - x))
        if 0 < way <= tolerance:
            mesh.nodes[row] = foot
            moved, most = moved + 1, max(most, way)
    return moved, most
