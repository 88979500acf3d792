"""Pictures of a run, without a display: the deformed bodies coloured by a field, and the contact pressure on the slave
surfaces.

    build/venv/bin/python scripts/render.py out/pipe_pinch                      # von_mises.png and pressure.png in that
    folder
    build/venv/bin/python scripts/render.py out/pipe_pinch --animate            # the same as GIF over all written steps
    build/venv/bin/python scripts/render.py out/pipe_pinch --field uy --step 10 --view 40,10 --mirror xz
    build/venv/bin/python scripts/render.py out/pipe_pinch --cut z=10           # bodies cut by a plane
    build/venv/bin/python scripts/render.py out/pipe_pinch --undeformed --arrows    # outline at the start, tractions
"""
import argparse
import dataclasses
import pathlib
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.collections import LineCollection, PolyCollection

from burnish.meshview import outline, read_cells, read_skin, read_tools
from burnish.raster import Canvas, View
from burnish.runs import read_units
from burnish.section import Cut

DISPLACEMENT = {"ux": 0, "uy": 1, "uz": 2}
STRESS = {"stress_" + name: i for i, name in enumerate(("xx", "yy", "zz", "xy", "yz", "xz"))}
CONTACT = ("gap", "penetration", "penalty", "pressure", "status")  # on the slave surfaces only
FIELDS = ("von_mises", "plastic_strain", "energy_density", *STRESS, "displacement", *DISPLACEMENT, *CONTACT)
GREY = numpy.array([0.80, 0.82, 0.85])
TOOL = numpy.array([0.62, 0.64, 0.68])
ISOMETRIC = (-35, 22)  # azimuth, elevation in degrees
MARGIN = 0.04  # around the bodies, of their extent
TRIAD = 85  # pixels across
RIDGE = 0.12  # height of the largest pressure in the plane, of the bodies' extent
ARROW = 0.12  # length of the largest traction, of the picture's extent
ARROWS = 40  # at most so many in a row or column of the picture, the largest ones
SIDEWAYS = 0.05  # cosine between a plane and the view from which a cut is not seen any more


@dataclasses.dataclass
class State:
    """A written step."""

    t: float
    points: numpy.ndarray  # deformed nodes, N x 3
    values: numpy.ndarray  # of the field, N
    slave: numpy.ndarray  # N: the node is on a slave surface
    normal: numpy.ndarray  # of contact, N x 3, or None
    traction: numpy.ndarray  # of contact on the slave, N x 3, or None
    tools: list  # of rigid tools: points, parts


class Run:
    """What the pictures need of results.h5."""

    def __init__(self, directory):
        self.path = pathlib.Path(directory) / "results.h5"
        if not self.path.exists():
            sys.exit(f"render.py: {self.path} is not there; allowed: the folder of a run that has written a step")
        self.skin = read_skin(self.path)
        self.tools = read_tools(self.path, self.skin.plane)
        with h5py.File(self.path, "r") as file:
            self.steps = sorted(file["steps"])
            self.fields = set(file["steps"][self.steps[-1]])

    def has(self, field):
        source = "stress" if field in STRESS else "displacement" if field in DISPLACEMENT else field
        return source in self.fields and "displacement" in self.fields

    def state(self, step, field):
        """The State of a step, with the values of a field."""
        with h5py.File(self.path, "r") as file:
            group = file["steps"][self.steps[step]]
            u = group["displacement"][()]
            if field in STRESS:
                values = group["stress"][:, STRESS[field]]
            elif field in DISPLACEMENT or field == "displacement":
                values = u[:, DISPLACEMENT[field]] if field in DISPLACEMENT else numpy.linalg.norm(u, axis=1)
            else:
                values = group[field][()]
            contact = {name: group[name][()] for name in ("gap", "normal", "contact_traction") if name in group}
            slave = numpy.isfinite(contact["gap"]) if "gap" in contact else numpy.zeros(len(u), dtype=bool)
            tools = [(tool.nodes + group[f"tools/{tool.name}/displacement"][()], tool.parts)
                     for tool in self.tools
                     if f"tools/{tool.name}" in group]
            return State(float(group.attrs["t"]), self.skin.nodes + u, values, slave, contact.get("normal"),
                         contact.get("contact_traction"), tools)


def mirrored(x, axes):
    """The points, and their mirror images in the coordinate planes across the axes."""
    copies = [x]
    for axis in axes:
        sign = numpy.ones(3)
        sign["xyz".index(axis)] = -1
        copies += [copy * sign for copy in copies]
    return copies


class Picture:
    """One field of a run: the view, the scale and the frame are the same at all steps."""

    def __init__(self, run, field, steps, options):
        self.run, self.field, self.options = run, field, options
        self.contact = field in CONTACT
        states = [run.state(step, field) for step in steps]
        self.bodies = self.shown_bodies(states[-1].slave)
        self.triangles = run.skin.triangles[numpy.isin(run.skin.triangle_body, self.bodies)]
        self.lines = run.skin.lines[numpy.isin(run.skin.line_body, self.bodies)]
        self.coloured = numpy.zeros(len(run.skin.nodes), dtype=bool)
        self.coloured[self.triangles] = True
        self.view = View(0, 0) if run.skin.plane else View(*(options.view or self.facing(states[-1])), options.up)
        self.cells = [(kind, cells[numpy.isin(body, self.bodies)])
                      for kind, cells, body in (read_cells(run.path) if self.cuts() else [])]
        self.norm = self.scale(states)
        self.map = plt.get_cmap("YlOrRd" if self.contact else "viridis")
        self.lower, self.upper = self.frame(states)
        if options.arrows:
            self.largest = self.largest_traction(states)

    def scale(self, states):
        """Colours of the values that are seen at any step."""
        inked = numpy.concatenate([self.seen_values(state) for state in states])
        inked = inked[numpy.isfinite(inked)]
        if not inked.size:
            raise ValueError(f"render.py: {self.field} has no value in {self.run.path}: no slave surface met anything")
        low, high = inked.min(), inked.max()
        low = min(low, 0) if self.contact or self.field in ("von_mises", "plastic_strain") else low
        return plt.Normalize(low, high if high > low else low + 1)

    def seen_values(self, state):
        if self.contact or not self.cuts():
            return state.values[self.coloured & (state.slave | (not self.contact))]
        found = []
        for copy in mirrored(state.points, self.options.mirror):
            _, values, triangles, _, _ = self.drawn(copy, state.values)
            found.append(values[triangles].ravel())
        return numpy.concatenate(found)

    def frame(self, states):
        """Lower and upper corner of what is drawn at any step, with a margin."""
        shown = [state.points for state in states] + ([self.run.skin.nodes] if self.options.undeformed else [])
        corners = numpy.concatenate(
            [self.view.project(copy[self.coloured]) for x in shown for copy in mirrored(x, self.options.mirror)])
        lower, upper = corners.min(axis=0), corners.max(axis=0)
        margin = MARGIN * (upper - lower)[:2].max() * numpy.array([1, 1, 0])
        if self.run.skin.plane and self.contact:
            margin = margin * (1 + RIDGE / MARGIN)
        return lower - margin, upper + margin

    def largest_traction(self, states):
        largest = max((numpy.linalg.norm(state.traction, axis=1).max() for state in states
                       if state.traction is not None), default=0)
        if largest == 0:
            raise ValueError(f"render.py: --arrows: {self.run.path} has no contact tractions")
        return largest

    def shown_bodies(self, slave):
        """All; those with a slave surface where in space the others would hide it."""
        skin = self.run.skin
        bodies = numpy.unique(skin.triangle_body)
        if not self.contact or skin.plane:
            return bodies
        return numpy.unique(skin.triangle_body[slave[skin.triangles].all(axis=1)])

    def facing(self, state):
        """Azimuth and elevation from which a contact field is seen: against the masters' normals, a little from the
        side."""
        out = -state.normal[state.slave].mean(axis=0) if self.contact else numpy.zeros(3)
        if numpy.linalg.norm(out) < 0.3:  # the surface goes around the body
            return ISOMETRIC
        out = out / numpy.linalg.norm(out)
        up = {"y": [0, 1, 2], "z": [1, 2, 0]}[self.options.up]  # sideways, upward, towards
        azimuth = numpy.degrees(numpy.arctan2(out[up[0]], out[up[2]])) if abs(out[up[1]]) < 0.9 else 0
        return azimuth + ISOMETRIC[0], numpy.clip(numpy.degrees(numpy.arcsin(out[up[1]])), -50, 50) or ISOMETRIC[1]

    def unit(self, field=None):
        """The unit of a field in brackets, where --units names it: of a length or a stress."""
        field = field or self.field
        if not self.options.units or field in ("plastic_strain", "penalty", "status", "friction", "strain"):
            return ""
        return f" ({self.options.units[field not in ('displacement', *DISPLACEMENT, 'gap', 'penetration')]})"

    def cuts(self):
        """Whether --cut says so and it can be; ValueError where it cannot."""
        if not self.options.cut:
            return False
        if self.run.skin.plane:
            raise ValueError("render.py: --cut: a model in the plane has no section; allowed: models in space")
        if abs(self.view.axes[2]["xyz".index(self.options.cut[0])]) < SIDEWAYS:
            raise ValueError("render.py: --cut: the plane {} = {:g} is seen from its side; another --view shows "
                             "it".format(*self.options.cut))
        return True

    def beyond(self, points):
        """Distances from the plane of --cut on the side of the viewer."""
        axis = "xyz".index(self.options.cut[0])
        return numpy.sign(self.view.axes[2][axis]) * (points[:, axis] - self.options.cut[1])

    def drawn(self, points, values):
        """Points and values, triangles and lines of the bodies as they are drawn, and of each triangle that of the skin
        that it belongs to, -1 for the section of a cut."""
        if not self.options.cut:
            return points, values, self.triangles, self.lines, numpy.arange(len(self.triangles))
        cut = Cut(points, values, self.beyond(points))
        triangles, parents, edges = cut.triangles(self.triangles)
        parts = [cut.section(kind, cells) for kind, cells in self.cells]
        lines = numpy.concatenate([cut.lines(self.lines), edges])
        parents = numpy.concatenate([parents, *(numpy.full(len(part), -1) for part in parts)])
        return *cut.all(), numpy.concatenate([triangles, *parts]), lines, parents

    def canvas(self, state, width):
        canvas = Canvas(self.view, self.lower, self.upper, width)
        hot = state.slave[self.triangles].all(
            axis=1) if self.contact and not self.run.skin.plane else numpy.full(len(self.triangles), not self.contact)
        hot = numpy.append(hot, not self.contact)  # last: the section of a cut
        for copy in mirrored(state.points, self.options.mirror):
            points, values, triangles, lines, parents = self.drawn(copy, state.values)
            coloured = hot[parents]
            canvas.triangles(points, triangles[coloured], lambda v: self.map(self.norm(v))[:, :3],
                             numpy.nan_to_num(values))
            canvas.triangles(points, triangles[~coloured], lambda v: numpy.broadcast_to(GREY, (len(v), 3)),
                             numpy.zeros(len(points)))
            canvas.lines(points, lines)
        if not self.run.skin.plane and not self.contact:
            self.tools(canvas, state)
        return canvas

    def tools(self, canvas, state):
        for points, triangles in state.tools:
            if self.options.cut:
                cut = Cut(points, numpy.zeros(len(points)), self.beyond(points))
                triangles = cut.triangles(triangles)[0]
                points = cut.all()[0]
            canvas.triangles(points, triangles, lambda v: numpy.broadcast_to(TOOL, (len(v), 3)),
                             numpy.zeros(len(points)))

    def ridge(self, axes, state):
        """In the plane: the slave lines in the field's colours, and its height along them."""
        skin = self.run.skin
        lines = skin.lines[skin.line_outer & state.slave[skin.lines].all(axis=1)]
        height = RIDGE * numpy.ptp(self.run.skin.nodes, axis=0).max() / max(abs(self.norm.vmin), abs(self.norm.vmax))
        colours = self.map(self.norm(state.values[lines].mean(axis=1)))
        mirror = self.options.mirror
        for copy, flip in zip(mirrored(state.points, mirror), mirrored(state.normal, mirror)):
            crest = copy - height * state.values[:, None] * flip
            walls = numpy.concatenate([copy[lines], crest[lines][:, ::-1]], axis=1)[:, :, :2]
            axes.add_collection(
                PolyCollection(walls, facecolors=colours, edgecolors=colours, linewidths=0.4, alpha=0.85))
            axes.add_collection(LineCollection(copy[lines][:, :, :2], colors="k", linewidths=1.2))

    def start(self, axes):
        """The outline of the undeformed bodies, over what is in front of it, too."""
        skin, axis = self.run.skin, self.view.axes[2]
        for copy in mirrored(skin.nodes, self.options.mirror):
            lines = skin.lines[skin.line_outer & numpy.isin(skin.line_body, self.bodies)] if skin.plane else \
                outline(copy, self.triangles, axis)
            axes.add_collection(LineCollection(self.view.project(copy[lines])[:, :, :2], colors="0.35",
                                               linewidths=0.9, linestyles="dashed"))

    def arrows(self, axes, state, canvas):
        """Contact tractions on the slave where nothing hides it: arrows that end on the surface."""
        loaded = numpy.flatnonzero(numpy.linalg.norm(numpy.nan_to_num(state.traction), axis=1) > 0)
        extent = (self.upper - self.lower)[:2].max()
        mirror = self.options.mirror
        for copy, flip in zip(mirrored(state.points, mirror), mirrored(state.traction, mirror)):
            shown = loaded[self.remains(copy[loaded]) & (self.run.skin.plane or canvas.sees(copy[loaded]))]
            size = numpy.linalg.norm(flip[shown], axis=1)
            kept = shown[largest_of_squares(self.view.project(copy[shown])[:, :2], size, extent / ARROWS)]
            tips = self.view.project(copy[kept])[:, :2]
            ways = self.view.project(flip[kept])[:, :2] * ARROW * extent / self.largest
            axes.quiver(*tips.T, *ways.T, pivot="tip", angles="xy", scale_units="xy", scale=1, width=0.0025,
                        color="crimson", zorder=3)

    def remains(self, points):
        """Whether a cut leaves the points."""
        return self.beyond(points) <= 0 if self.options.cut else numpy.ones(len(points), dtype=bool)

    def draw(self, figure, step, width):
        state = self.run.state(step, self.field)
        frame = (self.lower[0], self.upper[0], self.lower[1], self.upper[1])
        figure.clear()
        axes = figure.add_axes((0.13, 0.14, 0.70, 0.78) if self.run.skin.plane else (0.01, 0.02, 0.84, 0.90))
        canvas = self.canvas(state, width)
        axes.imshow(canvas.image(), origin="lower", extent=frame, interpolation="antialiased")
        arrows = f"; tractions to {self.largest:.3g}{self.unit('pressure')}" if self.options.arrows else ""
        axes.set_title(f"{label(self.field)}{self.unit()}, t = {state.t:.4g}{arrows}", fontsize=11)
        if self.run.skin.plane:
            for points, lines in state.tools:
                for copy in mirrored(points, self.options.mirror):
                    axes.add_collection(LineCollection(copy[lines][:, :, :2], colors="k", linewidths=1.5))
            if self.contact:
                self.ridge(axes, state)
            axes.set(xlabel=f"x{self.unit('ux')}", ylabel=f"y{self.unit('uy')}")
        if self.options.undeformed:
            self.start(axes)
        if self.options.arrows and state.traction is not None:
            self.arrows(axes, state, canvas)
        axes.set(xlim=frame[:2], ylim=frame[2:])
        if not self.run.skin.plane:
            axes.set_axis_off()
            triad(figure, self.view)
        self.bar(figure, axes)

    def bar(self, figure, axes):
        """The scale of the colours."""
        figure.canvas.draw()  # settles where the axes are
        place = axes.get_position()
        low = 0.02 + TRIAD / figure.dpi / figure.get_size_inches()[1]
        if self.run.skin.plane:
            low = place.y0 + 0.05 * place.height
        bar = figure.add_axes((place.x1 + 0.02, low, 0.02, place.y1 - 0.05 * place.height - low))
        figure.colorbar(plt.cm.ScalarMappable(self.norm, self.map), cax=bar)

    def figure(self, width):
        wide, high = (self.upper - self.lower)[:2]
        return plt.figure(figsize=(width / 100, max(0.35, min(1.2, 0.78 * high / wide + 0.12)) * width / 100), dpi=100)


def largest_of_squares(places, sizes, side):
    """Numbers of the places that have the largest size in each square of a grid."""
    order = numpy.argsort(-sizes, kind="stable")
    _, first = numpy.unique(numpy.floor(places[order] / side), axis=0, return_index=True)
    return order[first]


def label(field):
    words = {"von_mises": "von Mises stress", "plastic_strain": "equivalent plastic strain",
             "pressure": "contact pressure", "displacement": "displacement, norm"}
    return words.get(field, field.replace("_", " "))


def triad(figure, view):
    """The directions of the coordinates, in the lower right corner."""
    side = TRIAD / figure.dpi / figure.get_size_inches()
    axes = figure.add_axes((0.99 - side[0], 0.01, *side))
    axes.set(xlim=(-1.5, 1.5), ylim=(-1.5, 1.5))
    axes.set_axis_off()
    for i, name in enumerate("xyz"):
        along = view.project(numpy.eye(3)[i])[:2]
        axes.annotate("", along, (0, 0), arrowprops={"arrowstyle": "->", "linewidth": 1})
        axes.text(*(1.35 * along), name, ha="center", va="center", fontsize=9)


def plane(text):
    """Axis and value of a plane."""
    axis, _, value = text.partition("=")
    if axis not in ("x", "y", "z"):
        raise argparse.ArgumentTypeError(f"'{text}' is no plane; allowed: x, y or z, = and a number, such as z=10")
    try:
        return axis, float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{value}' is no number; allowed: a plane such as z=10") from None


def parser():
    parser = argparse.ArgumentParser(prog="render.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="results of a run")
    parser.add_argument("--field", choices=FIELDS,
                        help="default: von_mises, and pressure where there is contact; with -o the former alone")
    parser.add_argument("--step", type=int, help="written step, from 0; negative: from the end; default: the last one")
    parser.add_argument("--view", type=lambda text: tuple(float(word) for word in text.split(",")),
                        metavar="AZIMUTH,ELEVATION", help="degrees; write --view=-35,20 if the first is negative")
    parser.add_argument("--up", choices=("y", "z"), default="y", help="axis that points upwards")
    parser.add_argument("--mirror", default="", metavar="AXES",
                        help="adds the mirror images across these axes, such as xz")
    parser.add_argument("--units", type=lambda text: text.split(","), metavar="LENGTH,STRESS",
                        help="units to be written into the picture, such as mm,MPa; default: those of the scene")
    parser.add_argument("--cut", type=plane, metavar="AXIS=VALUE",
                        help="takes away what lies between viewer and plane, such as z=10, and shows the section")
    parser.add_argument("--undeformed", action="store_true", help="adds the outline of the undeformed bodies, dashed")
    parser.add_argument("--arrows", action="store_true", help="adds contact tractions on the slave surfaces as arrows")
    parser.add_argument("--animate", action="store_true", help="all written steps as a GIF")
    parser.add_argument("--width", type=int, default=900, help="of the picture, in pixels")
    parser.add_argument("-o", dest="file", type=pathlib.Path,
                        help="file to write; default: FIELD.png or FIELD.gif in the run's folder")
    return parser


def options():
    arguments = parser()
    chosen = arguments.parse_args()
    if set(chosen.mirror) - set("xyz"):
        arguments.error("--mirror: allowed are x, y and z")
    if chosen.units and len(chosen.units) != 2:
        arguments.error("--units: allowed are two words apart by a comma, such as --units mm,MPa")
    if chosen.view and len(chosen.view) != 2:
        arguments.error("--view: allowed are two angles apart by a comma, such as --view=-35,20")
    return chosen


def draw(directory, **chosen):
    """Draws the pictures of a run's folder into files and returns their names; chosen: options of the command line by
    their names, with its defaults."""
    return pictures(parser().parse_args([str(directory)], argparse.Namespace(**chosen)))


def pictures(chosen):
    """Draws what the options of the command line ask for. It ends the program where that is not there."""
    files = []
    run = Run(chosen.directory)
    chosen.units = chosen.units or read_units(chosen.directory)
    fields = [chosen.field] if chosen.field else [field for field in ("von_mises", "pressure") if run.has(field)]
    if chosen.file:  # holds one picture
        fields = fields[:1]
    for field in fields or ["displacement"]:
        if not run.has(field):
            sys.exit(
                f"render.py: {run.path} has no {field}; it has {', '.join(sorted(run.fields)) or 'nothing'} (the "
                "scene's output.fields)"
            )
        step = len(run.steps) - 1 if chosen.step is None else chosen.step
        if not -len(run.steps) <= step < len(run.steps):
            sys.exit(f"render.py: --step {step}: {run.path} has steps 0 to {len(run.steps) - 1}")
        steps = range(len(run.steps)) if chosen.animate else [step]
        try:
            picture = Picture(run, field, steps, chosen)
        except ValueError as error:
            if chosen.field or not files:
                sys.exit(str(error))
            continue
        figure = picture.figure(chosen.width)
        file = chosen.file or pathlib.Path(chosen.directory) / f"{field}.{'gif' if chosen.animate else 'png'}"
        if chosen.animate:
            FuncAnimation(figure, lambda frame: picture.draw(figure, frame, chosen.width),
                          frames=steps).save(file, PillowWriter(fps=5))
        else:
            picture.draw(figure, step, chosen.width)
            figure.savefig(file)
        plt.close(figure)
        files.append(file)
    return files


def main():
    for file in pictures(options()):
        print(file)
