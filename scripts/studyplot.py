"""The plots of study.py: the error against CPU seconds, or against the values of the last axis with the iterations."""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter

from studyline import enough, front, number

COLOURS = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#aa4499",
    "#b8860b",
    "#555555",
)  # told apart by the colour-blind too; by the first axis
STYLES = ((0, ()), (0, (5, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5)))  # by the second
MARKERS = "osD^v"  # by the third
WIDTH, HEIGHT, DPI = 5.6, 4.4, 72  # of a panel
FEW = 100  # largest value over the smallest of an axis whose ticks between decades are labelled
LABEL_HEIGHT = 0.043  # of a direct label, in heights of a panel


def style(study, row):
    """Colour, dashes and marker of a row's line."""
    place = [list(study.axes[name]).index(row["case"][name]) for name in study.lines] + [0, 0, 0]
    return {
        "color": COLOURS[place[0] % len(COLOURS)],
        "linestyle": STYLES[place[1] % len(STYLES)],
        "marker": MARKERS[place[2] % len(MARKERS)],
    }


def label_ends(axes, ends):
    """Names lines at their last points; labels that would overlap move apart, with a thin line back."""
    axes.figure.canvas.draw()
    to_axes = axes.transData + axes.transAxes.inverted()
    placed = sorted(((*to_axes.transform((x, y)), text, colour) for x, y, text, colour in ends), key=lambda end: end[1])
    heights, top = [], -math.inf
    for _, y, *_ in placed:
        top = max(y, top + LABEL_HEIGHT)
        heights.append(top)
    over = max(0, heights[-1] - 1) if heights else 0
    for k in reversed(range(len(heights))):  # those pushed out at the top push back
        heights[k] = min(heights[k], 1 - (len(heights) - 1 - k) * LABEL_HEIGHT) if over else heights[k]
    for (x, y, text, colour), height in zip(placed, heights):
        axes.annotate(
            text,
            (x, y),
            (1.02, height),
            xycoords="axes fraction",
            textcoords="axes fraction",
            color=colour,
            fontsize=8,
            va="center",
            arrowprops={"arrowstyle": "-", "color": colour, "lw": 0.5, "alpha": 0.5, "shrinkA": 0, "shrinkB": 3},
        )


def plain(value, _):
    return f"{value:g}"


def between(axis):
    """Labels between the decades: 2 and 5 where there are few."""
    low, high = axis.get_view_interval()
    few = low > 0 and high / low < FEW
    return lambda value, _: f"{value:g}" if few and f"{value:e}"[0] in "25" else ""


def draw_front(axes, rows, measure):
    best = front(rows, measure)
    x, y = [row["cpu_s"] for row in best], [row["errors"][measure] for row in best]
    axes.step(x, y, where="post", color="#cccccc", lw=5, zorder=0, solid_joinstyle="round")
    axes.plot(x, y, "o", ms=10, mfc="none", mec="black", mew=0.9, zorder=4)


def draw_lines(axes, study, rows, abscissa, ordinate):
    """Lines of one panel; returns their ends, with names: to be labelled once the panels' limits are settled."""
    ends = []
    for (_, line), series in study.series(rows).items():
        points = [(abscissa(row), ordinate(row), row) for row in series if ordinate(row) and abscissa(row)]
        if points:
            look = style(study, points[0][2])
            axes.plot([p[0] for p in points], [p[1] for p in points], lw=1.5, ms=4, **look)
            ends.append((*points[-1][:2], line, look["color"]))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, which="major", color="#e6e6e6", lw=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(plain))
        axis.set_minor_formatter(FuncFormatter(between(axis)))
    if ends and len(points) > 1 and points[0][0] > points[-1][0] and study.options.against:
        axes.invert_xaxis()  # lines run to the right, where their names are
    return axes, ends


def draw_cost(study, rows, grid):
    """A row of panels for each measure, a column for each label of the panels' axis."""
    for across, measure in zip(grid, study.measures):
        for axes, panel in zip(across, study.axes.get(study.options.panels, {"": None})):
            own = [row for row in rows if row["case"].get(study.options.panels, "") == panel]
            for target in study.options.targets:
                axes.axhline(target, color="#999999", lw=0.8, ls=":", zorder=0)
            draw_front(axes, own, measure.name)
            yield draw_lines(axes, study, own, lambda row: row["cpu_s"], lambda row: row["errors"].get(measure.name))
            axes.set(xlabel="CPU seconds", ylabel=f"error in {measure.name}, %")
            axes.set_title(panel, fontsize=10)


def draw_against(study, rows, grid):
    """Over the values of the last axis: the errors, then the iterations. The value beyond which nothing is gained is
    marked."""

    def abscissa(row):
        return next((v for v in (number(word) for word in row["case"][study.along].split()) if not math.isnan(v)), None)

    for measure, axes in zip(study.measures, grid[0]):
        for series in study.series(rows).values():
            row, _ = enough(series, measure.name)
            if row:
                axes.plot(
                    abscissa(row), row["errors"][measure.name], "o", ms=12, mfc="none", mec="black", mew=1.2, zorder=4
                )
        yield draw_lines(axes, study, rows, abscissa, lambda row: row["errors"].get(measure.name))
        axes.set_ylabel(f"error in {measure.name}, %")
    for axes, name, text in zip(grid.flat[-2:], ("newton_iterations", "cpu_s"), ("Newton iterations", "CPU seconds")):
        yield draw_lines(axes, study, [row for row in rows if row["status"] == "done"], abscissa, lambda row: row[name])
        axes.set_ylabel(text)
    for axes in grid.flat:
        axes.set_xlabel(study.along)


def draw(study, rows, path):
    """The plot of a study into a file."""
    against = study.options.against
    measures = len(study.measures)
    down, across = (2, max(2, measures)) if against else (measures, len(study.axes.get(study.options.panels, [0])))
    figure, grid = plt.subplots(
        down, across, figsize=(WIDTH * 1.35 * across, HEIGHT * down), squeeze=False, sharey="none" if against else "row"
    )
    figure.subplots_adjust(wspace=0.62, hspace=0.32)
    for ends in list((draw_against if against else draw_cost)(study, rows, grid)):
        label_ends(*ends)
    note = (
        "ringed: beyond it the error that stays dominates"
        if against
        else "ringed on grey: cheapest for its error (Pareto front)"
    )
    figure.suptitle(f"{study.options.title or study.name}  ({note})", fontsize=11, y=0.97 if down > 1 else 1.02)
    figure.savefig(path, dpi=DPI, bbox_inches="tight")
    plt.close(figure)
