"""Hertz's line and point contact on series of meshes, node to surface and surface to surface: contact width and peak pressure against the closed form.
Runs the scenes, leaves one record per run and prints the table; --print tables an existing record.
    python scripts/hertz_table.py [--burnish BINARY] [--record FILE] [--jobs N] [--print] [line] [sphere]
The line's load is a fortieth of its scene's: half-width 1 on a radius of 50, where Hertz's parabola and half-spaces hold to 0.1 %. An edge falls somewhere in
an element; so each figure is the largest error over the last loads, in which the edge runs over one of them. Width: of the half-ellipse with the centre of
force that the nodal pressures have, which sees the whole zone and no single node; beside it the probe's edge, along a line of nodes."""
import csv
import json
import shutil
import subprocess

import h5py
import numpy

from launch import ROOT, environment, read_records, table_parser, write_records

WITHIN = 1.0  # per cent: what an engineer asks of a width and a peak
RATIO = 0.8  # of the two bodies' elements, as in the meshes
LINE_LOAD, LINE_ZONE = 350 / 6.215**2, 1.3  # half-width 1
SPHERE_ZONE = 1.5
SCENES = {
    # pair, probe of the edge, peak pressure, centre of force over the width, growth of width and peak with the load, first load that counts, step; series:
    # order, elements of the slave along the half-width or radius, jitters and seeds
    "line": ("line", "half_width", 3585.4 / 6.215, 4 / (3 * numpy.pi), 1 / 2, 0.8, 0.05, ((1, (4, 6, 8, 12, 16), ((0, 1), (0.25, 1), (0.25, 2))), (2, (2, 3, 4, 6, 8), ((0, 1),)))),
    "sphere": ("point", "radius", 734.6, 3 * numpy.pi / 16, 1 / 3, 0.5, 0.1, (
        (1, (2.5, 3.33, 4.17, 5, 6.67), ((0, 1),)), (1, (2.5, 3.33, 4.17, 5, 6.67, 8.33), ((0.25, 1), (0.25, 2))), (2, (1.67,), ((0, 1),)))),
}
# nodes of the bricks by their place along three directions
LATTICES = {"cells_hex8": numpy.reshape([0, 1, 3, 2, 4, 5, 7, 6], (2, 2, 2)),
            "cells_hex27": numpy.reshape([0, 8, 1, 11, 24, 9, 3, 10, 2, 16, 22, 17, 20, 26, 21, 19, 23, 18, 4, 12, 5, 15, 25, 13, 7, 14, 6], (3, 3, 3))}
FORMULATIONS = ("node_to_surface", "surface_to_surface")
COLUMNS = ("scene", "order", "faces", "jitter", "seed", "formulation", "status", "elements", "iterations", "wall_s", "width", "peak", "edge")


def overrides(scene, order, faces, jitter, seed):
    if scene == "line":
        mesh = {"h": 1 / (RATIO * faces), "zone": LINE_ZONE, "jitter": jitter, "seed": seed}
        rest = [f"loads.0.pressure={LINE_LOAD:.6g}", "contact.0.penalty.scale=100"]
    else:
        mesh, rest = {"n": round(SPHERE_ZONE * faces * RATIO), "jitter": jitter, "seed": seed}, [f"solver.type={'direct' if order > 1 else 'iterative'}"]  # what is faster
    return ["mesh.parameters={" + ", ".join(f"{k}: {v:.8g}" for k, v in mesh.items()) + "}", *rest]


def length_shares(x):
    """Of the lines between the coordinates x, by node."""
    order = numpy.argsort(x)
    half, found = numpy.diff(x[order]) / 2, numpy.empty(len(x))
    found[order] = numpy.append(half, 0) + numpy.insert(half, 0, 0)
    return found


def area_shares(file, rows, x):
    """Of the quadrilaterals that the nodes (rows) of a flat surface y = 0 make, by node: the integrals of the bilinear shape functions."""
    found = numpy.zeros(len(x))
    for name, lattice in LATTICES.items():
        if f"mesh/{name}" not in file:
            continue
        for face in (numpy.take(file[f"mesh/{name}"][()][:, lattice], end, axis) for axis in (1, 2, 3) for end in (0, -1)):
            face = face[numpy.isin(face, rows).all(axis=(1, 2))]
            corners = numpy.stack([c.ravel() for c in (face[:, :-1, :-1], face[:, 1:, :-1], face[:, 1:, 1:], face[:, :-1, 1:])])
            edges = x[numpy.roll(corners, -1, 0)] - x[corners]
            before = numpy.roll(edges, 1, 0)
            turned = numpy.abs(before[..., 0] * edges[..., 2] - before[..., 2] * edges[..., 0])  # twice the triangle at each corner
            numpy.add.at(found, corners, turned.sum(0) / 24 + turned / 12)
    return found[rows]


def centre_of_force(directory, pair):
    """By load: mean distance from the centre of the nodal pressures."""
    found = {}
    with h5py.File(directory / "results.h5", "r") as file:
        rows = file["contact"][pair]["nodes"][()]
        nodes = file["mesh/nodes"][()]
        area = area_shares(file, rows, nodes) if nodes[:, 2].any() else length_shares(nodes[rows, 0])
        for step in file["steps"].values():
            force = area * numpy.nan_to_num(step["contact"][pair]["pressure"][()])
            place = nodes[rows] + step["displacement"][()][rows]
            found[float(step.attrs["t"])] = numpy.sum(force * numpy.hypot(place[:, 0], place[:, 2])) / numpy.sum(force)
    return found


def solve(case, args):
    scene, order, faces, jitter, seed, formulation = case
    pair, probe, peak, centre, growth, first, step, *_ = SCENES[scene]
    directory = args.out / "-".join(str(v) for v in case)
    shutil.rmtree(directory, ignore_errors=True)
    command = [args.burnish, str(ROOT / "runs" / f"hertz_{scene}.yaml"), "-o", str(directory), "-quiet"]
    for override in (f"mesh.order={order}", f"contact.0.formulation={formulation}", f"stepping.initial={step}", "output.every=1", "output.fields=[displacement, contact]",
                     *overrides(scene, order, faces, jitter, seed)):
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    record = dict(zip(COLUMNS, (*case, finished.returncode)))
    if finished.returncode == 0:
        summary, centres = json.loads((directory / "summary.json").read_text()), centre_of_force(directory, pair)
        with open(directory / "steps.csv", newline="") as file:
            steps = [{k: v for k, v in row.items()} for row in csv.DictReader(file)]
        worst = {"width": 0, "peak": 0, "edge": 0}
        for t, row in ((float(row["t"]), row) for row in steps if float(row["t"]) >= first - 1e-9):
            nearest = min(centres, key=lambda other: abs(other - t))
            exact = t**growth
            for name, value in (("width", centres[nearest] / centre / exact), ("peak", float(row["peak_pressure"]) / peak / exact), ("edge", float(row[probe]) / exact)):
                worst[name] = max(worst[name], value - 1, key=abs)
        record.update(elements=summary["elements"], iterations=summary["newton_iterations"], wall_s=round(summary["wall_s"], 2), **{k: f"{100 * v:.3f}" for k, v in worst.items()})
    else:
        print(case, finished.stdout)
    shutil.rmtree(directory, ignore_errors=True)
    return record


def print_table(records):
    print("Largest error against Hertz over the last loads, per cent: width, peak pressure, (edge of the probe)\n")
    print("| scene | order | moved by | faces | elements | node to surface | surface to surface | iterations |\n|" + " --- |" * 8)
    needed = {}
    for key in dict.fromkeys((r["scene"], r["order"], r["jitter"], r["faces"]) for r in records):
        cells, same = [], [r for r in records if (r["scene"], r["order"], r["jitter"], r["faces"]) == key]
        for formulation in FORMULATIONS:
            runs = [r for r in same if r["formulation"] == formulation and r["status"] == "0"]
            if not runs:
                cells.append("-")
                continue
            width, peak, edge = (max((float(r[name]) for r in runs), key=abs) for name in ("width", "peak", "edge"))
            cells.append(f"{width:+.2f}, {peak:+.2f} ({edge:+.1f})")
            mine = needed.setdefault((*key[:3], formulation), [])
            mine.append((float(key[3]), int(runs[0]["elements"]), max(abs(width), abs(peak)) <= WITHIN))
        iterations = " / ".join(str(max((int(r["iterations"]) for r in same if r["formulation"] == f and r["status"] == "0"), default="-")) for f in FORMULATIONS)
        print(f"| {key[0]} | {key[1]} | {100 * float(key[2]):g} % | {key[3]} | {same[0]['elements'] or '-'} | {cells[0]} | {cells[1]} | {iterations} |")
    print(f"\nElements from which on width and peak are within {WITHIN:g} %:")
    for (scene, order, jitter, formulation), meshes in needed.items():
        meshes.sort()
        missed = max((i for i, (*_, good) in enumerate(meshes) if not good), default=-1)
        print(f"  {scene}, order {order}, moved by {100 * float(jitter):g} %, {formulation}: {meshes[missed + 1][1] if missed + 1 < len(meshes) else f'more than {meshes[-1][1]}'}")


def main():
    parser = table_parser(__doc__, "hertz")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of {', '.join(SCENES)}; default: both")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    args = parser.parse_args()
    cases = [(scene, order, faces, *moves, formulation) for scene in args.scenes or SCENES for order, meshes, moved in SCENES[scene][7] for moves in moved
             for faces in meshes for formulation in FORMULATIONS]
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda case: [solve(case, args)], cases, args.jobs)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()
