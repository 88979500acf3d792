"""Pictures of the shrink-fitted rings (runs/ring_in_ring.yaml) on a mesh that does not match, interface nodes moved by
up to a quarter of a face: the stress along the radius with facets and with surface to surface diffuse contact, and the
contact pressure around for the three formulations.
    python scripts/ring_pictures.py [--burnish BINARY] [--out DIR]
leaves rings.png, formulations.png and the curves in ring_pressure.csv."""
import argparse
import csv
import pathlib
import shutil
import subprocess

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.collections import PolyCollection

import ring_table
from launch import environment

LAME = ring_table.LAME["ring_in_ring"]
MESH = ["mesh.parameters.n_inner=24", "mesh.parameters.n_outer=30", "mesh.parameters.jitter=0.25"]
COLOURS = {"facets": "tab:red", "degree 4": "tab:orange", "surface to surface": "tab:blue"}
LABELS = {
    "facets": "facets",
    "degree 4": "diffuse, node to surface",
    "surface to surface": "diffuse, surface to surface"
}


def solve(args, method):
    directory = args.out / method.replace(" ", "_")
    shutil.rmtree(directory, ignore_errors=True)
    command = [args.burnish, str(ring_table.ROOT / "runs/ring_in_ring.yaml"), "-o", str(directory), "-quiet"]
    for override in MESH + ring_table.METHODS[method]:
        command += ["-set", override]
    subprocess.run(command, env=environment(args.burnish), check=True)
    with h5py.File(directory / "results.h5", "r") as file:
        step = file["steps"][sorted(file["steps"])[-1]]
        nodes, cells = file["mesh/nodes"][()], file["mesh/cells_quad4"][()]
        slave, pressure = file["contact/fit/nodes"][()], step["contact/fit/pressure"][()]
        stress = step["stress"][()]
    shutil.rmtree(directory)
    angle = numpy.degrees(numpy.arctan2(nodes[slave, 1], nodes[slave, 0]))
    order = numpy.argsort(angle)
    return {"nodes": nodes, "cells": cells, "stress": stress, "angle": angle[order], "pressure": pressure[order]}


def rings(results, path):
    """Radial stress in the two rings, in units of the exact contact pressure, with facets and with the smooth
    formulation."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 5.4), layout="constrained")
    for axis, method in zip(axes, ("facets", "surface to surface")):
        nodes, cells, stress = (results[method][name] for name in ("nodes", "cells", "stress"))
        radial = (stress[:, 0] * nodes[:, 0]**2 + stress[:, 1] * nodes[:, 1]**2 +
                  2 * stress[:, 3] * nodes[:, 0] * nodes[:, 1]) / (nodes[:, 0]**2 + nodes[:, 1]**2)
        drawn = axis.add_collection(
            PolyCollection(nodes[cells, :2], array=radial[cells].mean(axis=1) / LAME, cmap="RdBu_r", clim=(-2, 2),
                           edgecolors="0.4", linewidths=0.15))
        axis.set(xlim=(-0.5, 30.5), ylim=(-0.5, 30.5), aspect="equal", title=LABELS[method], xlabel="mm")
    figure.colorbar(drawn, ax=axes, extend="both",
                    label="stress along the radius over the exact contact pressure (exact: 0 to -1)")
    figure.savefig(path, dpi=110)


def pressure(results, path):
    """Contact pressure of the slave nodes around the quarter: all of it, and what is near the exact one."""
    figure, axes = plt.subplots(2, 1, figsize=(9, 6), sharex=True, layout="constrained")
    for axis, methods in zip(axes, (list(LABELS), list(LABELS)[1:])):
        for method in methods:
            axis.plot(results[method]["angle"], results[method]["pressure"] / LAME, "o-", ms=3, color=COLOURS[method],
                      label=LABELS[method])
        axis.axhline(1, color="black", lw=0.7)
        axis.set_ylabel("pressure over the exact one")
    axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=3)
    axes[1].set(xlabel="angle around the rings, degrees", xlim=(0, 90))
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--burnish", default=str(ring_table.ROOT / "build/burnish"))
    parser.add_argument("--out", type=pathlib.Path, default=ring_table.ROOT / "out")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    results = {method: solve(args, method) for method in LABELS}
    with open(args.out / "ring_pressure.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("formulation", "angle", "pressure"))
        for method, result in results.items():
            writer.writerows(
                (LABELS[method], f"{a:.4f}", f"{p:.5g}") for a, p in zip(result["angle"], result["pressure"]))
    rings(results, args.out / "rings.png")
    pressure(results, args.out / "formulations.png")


main()
