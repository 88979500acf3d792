"""make demo: runs pipe_pinch on 2 ranks, prints its probes beside the reference and leaves pictures in out/."""
import argparse
import csv
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from launch import command, environment, read_steps, read_summary
from burnish.meshview import read_mesh, read_states

SCENE, RANKS, OUT = "runs/pipe_pinch.yaml", 2, pathlib.Path("out")
RUNS = {"facet": ["contact.0.smoother=facet"], "diffuse": ["contact.0.smoother=diffuse"]}  # name -> overrides

# Probe, unit, reference at t = 1 and its estimated error: CalculiX 2.20, extrapolated over meshes, elements and
# penalties
REFERENCE = [
    ("plate_force", "N", 123920, 124),
    ("diameter_h_mid", "mm", 61.05, 0.02),
    ("diameter_h_end", "mm", 62.06, 0.06),
    ("diameter_v_end", "mm", -103.8, 0.08),
    ("contact_inner", "mm", 32.0, 0.8),
    ("contact_outer", "mm", 57.8, 0.8),
    ("crown_gap", "mm", 0.0125, 0.002),
]
FORCE_HALFWAY = 52390  # plate_force at t = 0.5, N
STROKE = 50  # of the plate at t = 1, mm


def directory(name):
    return OUT / f"pipe_pinch-{name}"


def solve(burnish, name):
    line = command(burnish, RANKS, SCENE, directory(name), RUNS[name], "-overwrite")
    print(" ".join(line), flush=True)
    status = subprocess.run(line, env=environment(burnish)).returncode
    if status:
        sys.exit(status)


def table(name):
    """The probes at the end against the reference, the force halfway, and what it took."""
    summary, steps = read_summary(directory(name)), read_steps(directory(name))
    halfway = steps["plate_force"][numpy.argmin(numpy.abs(steps["t"] - 0.5))]
    rows = [("plate_force, t=0.5", "N", halfway, FORCE_HALFWAY, 52)]
    rows += [(probe, unit, summary["probes"][probe], reference, error) for probe, unit, reference, error in REFERENCE]
    print(
        f"\npipe_pinch, {name}{'':{max(0, 12 - len(name))}}{'computed':>12}{'reference':>12}{'+-':>8}{'difference':>12}"
    )
    for probe, unit, value, reference, error in rows:
        computed = "no value" if value is None else f"{value:.6g}"
        difference = "" if value is None else f"{value - reference:+.3g}"
        print(f"  {probe:<19}{unit:<3}{computed:>12}{reference:>12g}{error:>8g}{difference:>12}")
    print(
        f"  {summary['steps']} steps, {summary['newton_iterations']} iterations, {summary['wall_s']:.1f} s on "
        f"{summary['ranks']} ranks, "
        f"largest penetration {summary['max_penetration']:.2e} mm\n")


def record(path):
    """The runs side by side as CSV, which doc/pages/running.md shows."""
    summaries, steps = {
        name: read_summary(directory(name))
        for name in RUNS
    }, {
        name: read_steps(directory(name))
        for name in RUNS
    }
    rows = [("plate_force_halfway", "N", FORCE_HALFWAY, 52,
             *(steps[name]["plate_force"][numpy.argmin(numpy.abs(steps[name]["t"] - 0.5))] for name in RUNS))]
    rows += [(probe, unit, reference, error, *(summaries[name]["probes"][probe]
                                               for name in RUNS))
             for probe, unit, reference, error in REFERENCE]
    rows += [(key, unit, "", "", *(summaries[name][key]
                                   for name in RUNS))
             for key, unit in (("steps", ""), ("steps_failed", ""), ("newton_iterations", ""), ("max_penetration",
                                                                                                "mm"))]
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("value", "unit", "reference", "error", *RUNS))
        writer.writerows([f"{cell:.6g}" if isinstance(cell, float) else cell for cell in row] for row in rows)


def picture(name):
    """The deformed mesh with von Mises stress, its mirror image in x beside it, halfway and at the end."""
    nodes, faces = read_mesh(directory(name) / "results.h5")
    written = read_states(directory(name) / "results.h5", "displacement", "von_mises")
    states = [(t, nodes + u, stress)
              for t, u, stress in (min(written, key=lambda state: abs(state[0] - wanted)) for wanted in (0.5, 1))]
    largest = max(stress.max() for _, _, stress in states)
    figure = plt.figure(figsize=(14, 5))
    for place, (t, x, stress) in enumerate(states):
        axes = figure.add_subplot(1, 2, 1 + place, projection="3d")
        colours = plt.cm.viridis(stress[faces].mean(axis=1) / largest)
        for mirror in (1, -1):
            corners = (x * [mirror, 1, 1])[faces][:, :, [0, 2, 1]]  # y upwards
            axes.add_collection3d(
                Poly3DCollection(corners, facecolors=colours, edgecolors=(0, 0, 0, 0.25), linewidths=0.3))
        axes.set(xlim=(-140, 140), ylim=(0, 200), zlim=(0, 125), xlabel="x (mm)", ylabel="z (mm)",
                 title=f"t = {t:g}, y upwards")
        axes.set(xticks=(-100, 0, 100), yticks=(0, 100, 200), zticks=(0, 50, 100))
        axes.set_box_aspect((280, 200, 125), zoom=1.05)
        axes.view_init(elev=18, azim=-65)
    bar = plt.cm.ScalarMappable(plt.Normalize(0, largest), "viridis")
    figure.colorbar(bar, ax=figure.axes, shrink=0.7, pad=0.1, label="von Mises stress (MPa)")
    figure.savefig(OUT / f"pipe_pinch-{name}.png", dpi=130, bbox_inches="tight")


def curve():
    """Plate force over the plate's stroke, every run, with the reference."""
    figure, axes = plt.subplots(figsize=(7, 5))
    for name in RUNS:
        steps = read_steps(directory(name))
        axes.plot(STROKE * steps["t"], steps["plate_force"] / 1000, marker=".", label=name)
    axes.plot([STROKE / 2, STROKE], [FORCE_HALFWAY / 1000, REFERENCE[0][2] / 1000], "k+", markersize=12,
              label="reference")
    axes.set(xlabel="stroke of the plate (mm)", ylabel="plate force (kN)", title="pipe_pinch")
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(OUT / "pipe_pinch-force.png", dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--burnish", default="build/burnish")
    parser.add_argument("--record", type=pathlib.Path, default=OUT / "pipe_pinch.csv", help="where the table goes")
    arguments = parser.parse_args()
    burnish = arguments.burnish
    OUT.mkdir(exist_ok=True)
    for name in RUNS:
        solve(burnish, name)
    for name in RUNS:
        table(name)
        picture(name)
    curve()
    record(arguments.record)
    print("pictures: " + ", ".join(str(path) for path in sorted(OUT.glob("pipe_pinch*.png"))))
    print("ParaView: " + ", ".join(str(directory(name) / "results.vtkhdf") for name in RUNS))


main()
