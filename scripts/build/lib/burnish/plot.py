"""Curves of a run from its steps.csv, without a display: what the probes say, iterations, penetration and penalty, the
load step.

    build/venv/bin/python scripts/plot.py out/pipe_pinch              # steps.png in that folder
    build/venv/bin/python scripts/plot.py out/pipe_pinch out/other    # several runs in one picture, in the first folder
    build/venv/bin/python scripts/plot.py out/pipe_pinch --x crown_uy  # over a probe, such as a displacement
"""
import argparse
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.ticker import LogFormatterSciNotation

from burnish.runs import read_steps, read_summary

MARKERS = "os^Dv<>*"


def curve(axes, run, column, label=None, place=0, **style):
    """A column over the load parameter or the probe of --x, where it has values."""
    steps = run["steps"]
    values = steps.get(column, numpy.full(len(steps["t"]), numpy.nan))
    if numpy.isfinite(values).any():
        axes.plot(steps[run["x"]], values, marker=MARKERS[place % len(MARKERS)], markersize=3.5, linewidth=1.2, label=label
                  or column.replace("_", " "), **style)


def finish(axes, title, log=False, x="t", unit=""):
    """An empty panel says so instead of showing axes without meaning."""
    if not axes.lines:
        axes.text(0.5, 0.5, "no values", ha="center", va="center", transform=axes.transAxes, color="0.5")
    elif len(axes.lines) > 1:
        axes.legend(fontsize=7)
    if log and any(numpy.nanmax(line.get_ydata()) > 0 for line in axes.lines):
        axes.set_yscale("log", nonpositive="mask")
        for each in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):  # narrow ranges need digits
            each(LogFormatterSciNotation(minor_thresholds=(1, 0.5), labelOnlyBase=False))
    axes.set_title(title, fontsize=10)
    axes.set_xlabel("load parameter t" if x == "t" else x, fontsize=8)
    axes.set_ylabel(unit, fontsize=8)
    axes.tick_params(labelsize=8)
    axes.grid(alpha=0.3)


def contact_panels(panels, run, name, place):
    """Nodes, force, penetration and penalty; the columns are empty without contact."""
    nodes, force, penetration, penalty = panels
    curve(nodes, run, "contact_nodes", name("in contact"), place)
    curve(force, run, "contact_force", name("contact force"), place)
    for column in ("max_penetration", "min_penetration"):
        curve(penetration, run, column,
              name(column.replace("_penetration", "imum" if column.startswith("max") else "imum, loaded nodes")), place)
    for column in ("penalty_min", "penalty_max"):
        curve(penalty, run, column, name(column.replace("penalty_", "") + "imum"), place)


def read(directory):
    """Steps, probes and name of a run, which need not have ended."""
    path = pathlib.Path(directory)
    if not (path / "steps.csv").exists():
        sys.exit(f"plot.py: {path}/steps.csv is not there; allowed: the folder of a run")
    steps = read_steps(path)
    if not steps:
        sys.exit(f"plot.py: {path}/steps.csv has no accepted step")
    columns = list(steps)
    summary = read_summary(path) if (path / "summary.json").exists() else {"name": path.name}
    named = summary.get("units", {}) if summary.get("units", {}).get("named") else {}
    probes = [column for column in columns[columns.index("wall_s") + 1 :] if column != "during"]
    return {"steps": steps, "probes": probes, "name": path.name, "title": summary["name"], "units": named}


def draw(directories, x="t", file=None):
    """Draws the curves of runs into a file, steps.png in the first folder by default, and returns its name."""
    runs = [read(directory) for directory in directories]
    for run in runs:
        run["x"] = x
        if x not in run["steps"]:
            sys.exit(f"plot.py: {run['name']} has no column '{x}'; allowed: {', '.join(run['steps'])}")
    probes = list(dict.fromkeys(probe for run in runs for probe in run["probes"]))
    columns = 3
    rows = -(-(6 + len(probes)) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(4 * columns, 2.7 * rows), layout="constrained", squeeze=False)
    panels = list(grid.flat)
    for place, run in enumerate(runs):
        name = (lambda text, run=run: f"{run['name']}: {text}") if len(runs) > 1 else (lambda text: text)
        for axes, probe in zip(panels, probes):
            curve(axes, run, probe, run["name"] if len(runs) > 1 else None, place)
        newton, step, *contact = panels[len(probes) : len(probes) + 6]
        curve(newton, run, "newton", name("iterations"), place)
        curve(step, run, "dt", name("step"), place)
        contact_panels(contact, run, name, place)
    units = runs[0]["units"]
    names = units.get("probes", {})
    across = x + (f" ({names[x]})" if names.get(x) else "")
    titles = [(probe, False) for probe in probes]
    labels = [names.get(probe, "") for probe in probes] + ["", "", ""]
    per = f"/{units['length']}" if units.get("forces", "").startswith("per ") else ""
    labels += [units["force"] + per if units else "", units.get("length", ""), ""]
    titles += [("Newton iterations of the step", False), ("load step", True), ("nodes in contact", False),
               ("contact force", False)]
    titles += [("penetration", True), ("penalty", True)]
    for axes, (title, log), label in zip(panels, titles, labels):
        finish(axes, title, log, across, label)
    for axes in panels[len(titles) :]:
        axes.remove()
    figure.suptitle(", ".join(dict.fromkeys(run["title"] for run in runs)))
    file = file or pathlib.Path(directories[0]) / "steps.png"
    figure.savefig(file, dpi=100)
    plt.close(figure)
    return file


def main():
    parser = argparse.ArgumentParser(prog="plot.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directories", nargs="+", help="results of runs")
    parser.add_argument("--x", default="t", metavar="COLUMN", help="of steps.csv, such as a probe; default: t")
    parser.add_argument("-o", dest="file", type=pathlib.Path,
                        help="file to write; default: steps.png in the first folder")
    options = parser.parse_args()
    print(draw(options.directories, options.x, options.file))
