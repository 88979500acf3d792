"""Hertz's line and point contact on series of meshes, node to surface and surface to surface: contact width and peak pressure against the closed form.
Runs the scenes, leaves one record per run and prints the table; --print tables an existing record.
    python scripts/hertz_table.py [--burnish BINARY] [--record FILE] [--jobs N] [--print] [line] [sphere] [far]
The line's load is a fortieth of its scene's: half-width 1 on a radius of 50, where Hertz's parabola and half-spaces hold to 0.1 %. An edge falls somewhere in
an element; so each figure is the largest error over the last loads, in which the edge runs over one of them. Width: of the half-ellipse with the centre of
force that the nodal pressures have, which sees the whole zone and no single node; beside it the probe's edge, along a line of nodes.
Meshes: `rows` of bricks, their interface nodes moved or not, and `free` ones, as a mesher lays quadrilaterals; several draws of what is random. They are even
within 1.3 (line) and 1.5 half-widths (sphere) and grow from there on as fast as the answers allow, GROWTH; `far` tells what slower growth changes."""
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
GROWTH = {"line": 0.5, "sphere": 3, "sphere free": 1}  # of the scenes' meshes, beyond the zone
SLOWER = {"line": (0.05, 0.15), "sphere": (1.4,)}  # to see what that changes
EVEN, MOVED, FREE = ("rows", 0, 1), tuple(("rows", 0.25, seed) for seed in (1, 2, 3)), tuple(("free", 0, seed) for seed in (1, 2, 3))
MOVED_5, FREE_MOVED = tuple(("rows", 0.25, seed) for seed in (1, 2, 3, 4, 5)), tuple(("free", 0.25, seed) for seed in (1, 2, 3))
SCENES = {
    # pair, probe of the edge, peak pressure, centre of force over the width, growth of width and peak with the load, first load that counts, step; series:
    # order, elements of the slave along the half-width or radius, meshes: kind, largest move of an interface node in elements, draw; growth if not GROWTH
    "line": ("line", "half_width", 3585.4 / 6.215, 4 / (3 * numpy.pi), 1 / 2, 0.8, 0.05, (
        (1, (4, 5, 6, 8, 10, 12, 16), (EVEN, *MOVED_5, ("free", 0, 1), *FREE_MOVED)),
        (2, (2, 3, 4, 5, 6, 8, 12), (EVEN, *MOVED_5, ("free", 0, 1), *FREE_MOVED)))),
    "sphere": ("point", "radius", 734.6, 3 * numpy.pi / 16, 1 / 3, 0.5, 0.1, (
        (1, (2.5, 3.33, 4.17, 5, 6.67), (EVEN, *MOVED)), (1, (8.33,), MOVED[:2]),
        (1, (3.33, 4.17, 5, 6.67), FREE), (1, (8.33,), FREE[:2]), (2, (1.67, 2.5), (EVEN,)),
        (1, (2.5, 3.33, 4.17, 5, 6.67), (EVEN, *MOVED[:2]), SLOWER["sphere"][0]), (1, (8.33,), MOVED[:2], SLOWER["sphere"][0]))),
}
FAR = (("line", 1, 6, *EVEN), ("line", 2, 3, *EVEN), ("sphere", 1, 5, *EVEN))
# nodes of the bricks by their place along three directions
LATTICES = {"cells_hex8": numpy.reshape([0, 1, 3, 2, 4, 5, 7, 6], (2, 2, 2)),
            "cells_hex27": numpy.reshape([0, 8, 1, 11, 24, 9, 3, 10, 2, 16, 22, 17, 20, 26, 21, 19, 23, 18, 4, 12, 5, 15, 25, 13, 7, 14, 6], (3, 3, 3))}
FORMULATIONS = ("node_to_surface", "surface_to_surface")
COLUMNS = ("scene", "order", "faces", "mesh", "jitter", "seed", "growth", "formulation", "status", "elements", "iterations", "wall_s", "width", "peak", "edge")


def growth_of(scene, mesh):
    """Key of GROWTH and SLOWER."""
    return "sphere free" if (scene, mesh) == ("sphere", "free") else scene


def overrides(scene, order, faces, mesh, jitter, seed, growth):
    if scene == "line":  # the penalty's softness shall not count: at 100 it is 0.4 % of the width
        values = {"h": 1 / (RATIO * faces), "zone": LINE_ZONE, "core": LINE_ZONE, "rows": int(mesh == "rows"), "jitter": jitter}
        rest = [f"loads.0.pressure={LINE_LOAD:.6g}", "contact.0.penalty.scale=1000"]
    else:
        values = {"n": round(SPHERE_ZONE * faces * RATIO), **({"jitter": jitter} if mesh == "rows" else {})}
        rest = [f"solver.type={'direct' if order > 1 else 'iterative'}"]  # what is faster
        rest += ["mesh.file=../meshes/hertz_sphere_free.geo"] if mesh == "free" else []
    values.update(seed=seed, growth=growth)
    return [*rest, "mesh.parameters={" + ", ".join(f"{k}: {v:.8g}" for k, v in values.items()) + "}"]


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
    scene, order, faces, mesh, jitter, seed, slope, formulation = case
    pair, probe, peak, centre, growth, first, step, *_ = SCENES[scene]
    directory = args.out / "-".join(str(v) for v in case)
    shutil.rmtree(directory, ignore_errors=True)
    command = [args.burnish, str(ROOT / "runs" / f"hertz_{scene}.yaml"), "-o", str(directory), "-quiet"]
    for override in (f"mesh.order={order}", f"contact.0.formulation={formulation}", f"stepping.initial={step}", "output.every=1", "output.fields=[displacement, contact]",
                     *overrides(scene, order, faces, mesh, jitter, seed, slope)):
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


def largest(runs, names=("width", "peak", "edge")):
    return [max((float(r[name]) for r in runs), key=abs) for name in names]


def print_table(records):
    series, solved = ("scene", "order", "mesh", "jitter", "growth"), [r for r in records if r["status"] == "0"]
    print("Largest error against Hertz over the last loads and all draws, per cent: width, peak pressure, (edge of the probe)\n")
    print("| scene | order | mesh | moved by | growth | faces | draws | elements | node to surface | surface to surface | iterations |\n|" + " --- |" * 11)
    needed = {}
    for key in dict.fromkeys(tuple(r[name] for name in (*series, "faces")) for r in records):
        cells, iterations, elements, draws = [], [], "-", 0
        for formulation in FORMULATIONS:
            runs = [r for r in solved if tuple(r[name] for name in (*series, "faces")) == key and r["formulation"] == formulation]
            iterations.append(str(max((int(r["iterations"]) for r in runs), default="-")))
            if not runs:
                cells.append("-")
                continue
            width, peak, edge = largest(runs)
            elements, draws = max(int(r["elements"]) for r in runs), max(draws, len(runs))
            cells.append(f"{width:+.2f}, {peak:+.2f} ({edge:+.1f})")
            needed.setdefault((*key[:5], formulation), []).append((float(key[5]), elements, max(abs(width), abs(peak)) <= WITHIN))
        print(f"| {key[0]} | {key[1]} | {key[2]} | {100 * float(key[3]):g} % | {key[4]} | {key[5]} | {draws} | {elements} | {cells[0]} | {cells[1]} | {' / '.join(iterations)} |")
    print(f"\nElements from which on width and peak of all draws are within {WITHIN:g} %:\n")
    print("| scene | order | mesh | moved by | growth | node to surface | surface to surface | ratio |\n|" + " --- |" * 8)
    for key in dict.fromkeys(key[:5] for key in needed if len(needed[key]) > 1):
        cells, counts = [], []
        for formulation in FORMULATIONS:
            meshes = sorted(needed.get((*key, formulation), []))
            missed = max((i for i, (*_, good) in enumerate(meshes) if not good), default=-1)
            beyond = missed + 1 >= len(meshes)
            counts.append((meshes[missed if beyond else missed + 1][1], beyond))
            cells.append(f"{'more than ' if beyond else ''}{counts[-1][0]}")
        (node, node_beyond), (surface, surface_beyond) = counts
        ratio = "-" if surface_beyond else f"{'more than ' if node_beyond else ''}{node / surface:.2g}"
        print(f"| {key[0]} | {key[1]} | {key[2]} | {100 * float(key[3]):g} % | {key[4]} | {cells[0]} | {cells[1]} | {ratio} |")


def print_far(records):
    """What the growth of the elements beyond the contact changes."""
    print("\nThe same against the growth of the elements beyond\n\n| scene | order | mesh | faces | growth | elements | node to surface | surface to surface |\n|" + " --- |" * 8)
    for scene, order, faces, mesh, jitter, seed in FAR:
        for growth in (*SLOWER[growth_of(scene, mesh)], GROWTH[growth_of(scene, mesh)]):
            key = tuple(str(v) for v in (scene, order, faces, mesh, jitter, seed, growth))
            runs = [r for r in records if tuple(r[name] for name in COLUMNS[:7]) == key and r["status"] == "0"]
            cells = ["{:+.2f}, {:+.2f} ({:+.1f})".format(*largest([r])) for f in FORMULATIONS for r in runs if r["formulation"] == f]
            if len(cells) == 2:
                print(f"| {scene} | {order} | {mesh} | {faces} | {growth} | {runs[0]['elements']} | {cells[0]} | {cells[1]} |")


def cases_of(names):
    cases = [(scene, order, faces, *moves, *(growth or [GROWTH[growth_of(scene, moves[0])]]), formulation) for scene in SCENES if scene in names
             for order, meshes, moved, *growth in SCENES[scene][7] for moves in moved for faces in meshes for formulation in FORMULATIONS]
    if "far" in names:
        cases += [(*case, growth, formulation) for case in FAR for growth in SLOWER[growth_of(case[0], case[3])] for formulation in FORMULATIONS]
    return list(dict.fromkeys(cases))


def main():
    parser = table_parser(__doc__, "hertz")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of {', '.join(SCENES)}, far; default: all")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    args = parser.parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda case: [solve(case, args)], cases_of(args.scenes or (*SCENES, "far")), args.jobs)
    print_table(read_records(args.record))
    print_far(read_records(args.record))


if __name__ == "__main__":
    main()
