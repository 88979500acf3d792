"""Leak pressure of the gasket of tests/jobs/seal_leak.yaml over its squeeze, on three meshes with Richardson's limit, and
what presses on its seat while the oil advances.
    python scripts/seal_pictures.py [--burnish BINARY] [--out DIR]
leaves seal_leak.csv and seal_leak.png."""
import argparse
import csv
import json
import math
import pathlib
import shutil
import subprocess

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

from launch import environment

ROOT = pathlib.Path(__file__).resolve().parents[1]
SQUEEZES = (0.15, 0.3, 0.45, 0.6)  # mm
REFINE = (1, 1.5, 2.25)
MESHES = {"first order": ["mesh.order=1"], "second order": ["mesh.order=2"],
          "second order, on faces": ["mesh.order=2", "contact.0.formulation=surface_to_surface"]}
COLUMNS = ("mesh", "squeeze", "refine", "leak_pressure", "steps", "iterations", "cpu_s")
AT = (0.5, 0.6, 0.68)  # load parameters of the pressures that are drawn


def solve(args, overrides):
    shutil.rmtree(args.out / "run", ignore_errors=True)
    command = [args.burnish, str(ROOT / "tests/jobs/seal_leak.yaml"), "-o", str(args.out / "run"), "-quiet"]
    for override in overrides:
        command += ["-set", override]
    subprocess.run(command, env=environment(args.burnish), check=True, stderr=subprocess.DEVNULL)
    return json.loads((args.out / "run/summary.json").read_text())


def leak(args, mesh, squeeze, refine):
    summary = solve(args, [*MESHES[mesh], f"loads.0.uy={-squeeze}", f"mesh.parameters.refine={refine}"])
    row = dict(zip(COLUMNS, (mesh, squeeze, refine, summary["fluids"][0]["leak_pressure"], summary["steps"],
                             summary["newton_iterations"], round(summary["cpu_s"], 2))))
    print(row, flush=True)
    return row


def limit(values):
    """Richardson's limit of the three meshes, by their own order between 1/2 and 4."""
    first, last = values[1] - values[0], values[2] - values[1]
    if first * last <= 0:
        return values[2]
    order = min(max(math.log(first / last, REFINE[1] / REFINE[0]), 0.5), 4)
    return values[2] + last / ((REFINE[1] / REFINE[0])**order - 1)


def profiles(args, axis):
    """Contact pressure, and the oil's, along the seat at some load parameters."""
    solve(args, ["mesh.parameters.refine=3", f"stepping.at={list(AT)}", "output.every=1"])
    with h5py.File(args.out / "run/results.h5", "r") as file:
        steps = [file["steps"][name] for name in sorted(file["steps"])]
        slave, nodes = file["contact/seat/nodes"][()], file["mesh/nodes"][()]
        for at, colour in zip(AT, ("tab:gray", "tab:orange", "tab:blue")):
            step = min(steps, key=lambda each: abs(each.attrs["t"] - at))
            x = (nodes + step["displacement"][()])[slave, 0]
            order = numpy.argsort(x)
            oil = 6 * max(0, 2 * step.attrs["t"] - 1)
            axis.plot(x[order], step["contact/seat/pressure"][()][order], "o-", ms=2, color=colour,
                      label=f"contact, oil {oil:.2f} MPa")
            axis.axhline(oil, color=colour, lw=0.7, ls="--")
    axis.set(xlim=(-1.2, 1.2), xlabel="mm along the seat", ylabel="contact pressure, MPa (dashed: the oil's)")
    axis.legend(fontsize=8)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burnish", default=str(ROOT / "build/burnish"))
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/seal")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    rows = [leak(args, mesh, squeeze, refine) for mesh in MESHES for squeeze in SQUEEZES for refine in REFINE]
    with open(args.out / "seal_leak.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    profiles(args, axes[0])
    for mesh, colour in zip(MESHES, ("tab:red", "tab:blue", "tab:green")):
        found = [[row["leak_pressure"] for row in rows if row["mesh"] == mesh and row["squeeze"] == squeeze]
                 for squeeze in SQUEEZES]
        for k, marker in enumerate("os^"):
            axes[1].plot(SQUEEZES, [values[k] for values in found], marker, mfc="none", color=colour, ms=6,
                         label=f"{mesh}, refine {REFINE[k]}")
        axes[1].plot(SQUEEZES, [limit(values) for values in found], "-", color=colour, lw=1, label=f"{mesh}, limit")
        print(mesh, [round(limit(values), 4) for values in found])
    axes[1].set(xlabel="squeeze, mm", ylabel="leak pressure, MPa", ylim=(0, None))
    axes[1].legend(fontsize=7)
    figure.savefig(args.out / "seal_leak.png", dpi=110)
    shutil.rmtree(args.out / "run")


if __name__ == "__main__":
    main()
