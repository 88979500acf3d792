"""Draws triangles and lines in space into an image: parallel projection, hidden surfaces by depth for each pixel,
fields interpolated over the triangles."""
import dataclasses

import numpy

AMBIENT = 0.65  # brightness of a face that the light does not reach
LIGHT = numpy.array([-0.3, 0.4, 0.87])  # towards the lamp: right, up, to the viewer
EDGE = 0.25  # brightness that lines leave
NEARER = 4e-3  # of the picture's depth: by so much lines are in front of the faces that they lie on
BATCH = 2_000_000  # pixels looked at together: bounds the memory


@dataclasses.dataclass
class View:
    """Where the viewer is (degrees: azimuth about the upward axis from its neighbour, elevation), and the part of his
    plane in the picture."""

    azimuth: float
    elevation: float
    up: str = "y"

    def __post_init__(self):
        a, e = numpy.radians([self.azimuth, self.elevation])
        axes = numpy.array([[numpy.cos(a), 0, -numpy.sin(a)],
                            [-numpy.sin(e) * numpy.sin(a), numpy.cos(e), -numpy.sin(e) * numpy.cos(a)],
                            [numpy.cos(e) * numpy.sin(a), numpy.sin(e), numpy.cos(e) * numpy.cos(a)]])
        self.axes = axes if self.up == "y" else axes[:, [2, 0, 1]]  # rows: right, up, to the viewer

    def project(self, x):
        return x @ self.axes.T


class Canvas:
    """An image of the rectangle lower..upper of the viewer's plane, with the depth of every pixel; drawn twice as fine
    as it is handed out."""

    def __init__(self, view, lower, upper, width):
        self.view, self.lower, self.upper = view, numpy.asarray(lower[:2]), numpy.asarray(upper[:2])
        self.fine = 2 * width / (self.upper[0] - self.lower[0])
        self.size = 2 * numpy.ceil((self.upper - self.lower) * self.fine / 2).astype(int)  # columns, rows
        self.near = NEARER * max(upper[2] - lower[2], *(self.upper - self.lower))
        self.colour = numpy.ones((self.size[1], self.size[0], 3))
        self.depth = numpy.full((self.size[1], self.size[0]), -numpy.inf)

    def pixels(self, x):
        """Columns and rows as reals, and depths, of points in space."""
        seen = self.view.project(x)
        return numpy.concatenate([(seen[..., :2] - self.lower) * self.fine - 0.5, seen[..., 2:]], axis=-1)

    def put(self, row, column, depth, colour):
        """Of the points that meet at a pixel the nearest one stays: written last, as numpy keeps the last of several
        values."""
        inside = (row >= 0) & (row < self.size[1]) & (column >= 0) & (column < self.size[0])
        inside[inside] &= depth[inside] > self.depth[row[inside], column[inside]]
        order = numpy.flatnonzero(inside)[numpy.argsort(depth[inside], kind="stable")]
        self.depth[row[order], column[order]] = depth[order]
        self.colour[row[order], column[order]] = colour[order]

    def triangles(self, x, triangles, paint, values):
        """x: points; paint: function from interpolated values[points] to colours."""
        seen = self.view.project(x)[triangles]
        normal = numpy.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
        length = numpy.linalg.norm(normal, axis=1)
        facing = numpy.sign(normal[:, 2:])
        brightness = AMBIENT + (1 - AMBIENT) * numpy.clip(
            (normal * facing) @ LIGHT / numpy.linalg.norm(LIGHT) / numpy.where(length > 0, length, 1), 0, 1)
        corners = self.pixels(x)[triangles]
        first = numpy.maximum(numpy.ceil(corners[:, :, :2].min(axis=1)).astype(int), 0)
        extent = numpy.maximum(
            numpy.minimum(numpy.floor(corners[:, :, :2].max(axis=1)).astype(int), self.size - 1) - first + 1, 0)
        count = extent.prod(axis=1)
        for batch in numpy.split(numpy.arange(len(triangles)),
                                 numpy.flatnonzero(numpy.diff(numpy.cumsum(count) // BATCH)) + 1):
            self.fill(corners[batch], first[batch], extent[batch], brightness[batch], values[triangles[batch]], paint)

    def fill(self, corners, first, extent, brightness, values, paint):
        """The pixels of each triangle's bounding box whose centres are inside the triangle."""
        count = extent.prod(axis=1)
        owner = numpy.repeat(numpy.arange(len(count)), count)
        place = numpy.arange(len(owner)) - numpy.repeat(numpy.cumsum(count) - count, count)
        column, row = first[owner, 0] + place % extent[owner, 0], first[owner, 1] + place // extent[owner, 0]
        a, b, c = (corners[owner, i] for i in range(3))
        with numpy.errstate(divide="ignore", invalid="ignore"):  # a triangle seen from its side has no pixel inside
            area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
            wb = ((column - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (row - a[:, 1])) / area
            wc = ((b[:, 0] - a[:, 0]) * (row - a[:, 1]) - (column - a[:, 0]) * (b[:, 1] - a[:, 1])) / area
            wa = 1 - wb - wc
            inside = (wa >= -1e-9) & (wb >= -1e-9) & (wc >= -1e-9)
        owner, weights = owner[inside], numpy.stack([wa, wb, wc], axis=1)[inside]
        depth = (weights * corners[owner, :, 2]).sum(axis=1)
        self.put(row[inside], column[inside], depth,
                 paint((weights * values[owner]).sum(axis=1)) * brightness[owner, None])

    def lines(self, x, lines):
        """Darkens the pixels along the lines where nothing is in front."""
        ends = self.pixels(x)[lines]
        steps = numpy.maximum(numpy.ceil(numpy.abs(ends[:, 1, :2] - ends[:, 0, :2]).max(axis=1)).astype(int), 1)
        owner = numpy.repeat(numpy.arange(len(lines)), steps)
        s = (numpy.arange(len(owner)) - numpy.repeat(numpy.cumsum(steps) - steps, steps) + 0.5) / steps[owner]
        points = ends[owner, 0] + s[:, None] * (ends[owner, 1] - ends[owner, 0])
        column, row = numpy.rint(points[:, 0]).astype(int), numpy.rint(points[:, 1]).astype(int)
        inside = (row >= 0) & (row < self.size[1]) & (column >= 0) & (column < self.size[0])
        row, column, depth = row[inside], column[inside], points[inside, 2]
        visible = depth + self.near > self.depth[row, column]
        touched = numpy.zeros(self.depth.shape, dtype=bool)
        touched[row[visible], column[visible]] = True
        self.colour[touched] *= EDGE

    def sees(self, x):
        """Whether nothing that is drawn hides points."""
        places = self.pixels(x)
        column, row = (numpy.clip(numpy.rint(places[:, k]).astype(int), 0, self.size[k] - 1) for k in (0, 1))
        return places[:, 2] + self.near > self.depth[row, column]

    def image(self):
        """The picture, first row below."""
        rows, columns = self.size[1] // 2, self.size[0] // 2
        return numpy.clip(self.colour.reshape(rows, 2, columns, 2, 3).mean(axis=(1, 3)), 0, 1)
