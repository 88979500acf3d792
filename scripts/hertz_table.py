"""Hertz's line and point contact on series of meshes, node to surface and surface to surface: contact width and peak
pressure against the closed form. Runs the scenes, leaves one record per run and prints the table; --print tables an
existing record.
    python scripts/hertz_table.py [--burnish BINARY] [--record FILE] [--jobs N] [--print] [line] [sphere] [far]
The line's load is a fortieth of its scene's: half-width 1 on a radius of 50, where Hertz's parabola and half-spaces
hold to 0.1 %. An edge falls somewhere in an element; so each figure is the largest error over the last loads, in which
the edge runs over one of them. Width: of the half-ellipse with the centre of force that the nodal forces have, which
sees the whole zone and no single node; beside it the probe's edge, along a line of nodes. Meshes: `rows` of bricks,
their interface nodes moved or not, and `free` ones, as a mesher lays quadrilaterals; several draws of what is random.
They are even within 1.3 (line) and 1.5 half-widths (sphere) and grow from there on as fast as the answers allow,
GROWTH; `far` tells what slower growth changes."""
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
EVEN, MOVED, FREE = ("rows", 0, 1), tuple(("rows", 0.25, seed) for seed in (1, 2, 3)), tuple(
    ("free", 0, seed) for seed in (1, 2, 3))
MOVED_5, FREE_MOVED = tuple(("rows", 0.25, seed) for seed in (1, 2, 3, 4, 5)), tuple(
    ("free", 0.25, seed) for seed in (1, 2, 3))
SCENES = {
    # pair, probe of the edge, peak pressure, centre of force over the width, growth of width and peak with the load,
    # first load that counts, step; series: order, elements of the slave along the half-width or radius, meshes: kind,
    # largest move of an interface node in elements, draw; growth if not GROWTH
    "line": ("line", "half_width", 3585.4 / 6.215, 4 / (3 * numpy.pi), 1 / 2, 0.8, 0.05,
             ((1, (4, 5, 6, 8, 10, 12, 16), (EVEN, *MOVED_5, ("free", 0, 1), *FREE_MOVED)),
              (2, (2, 3, 4, 5, 6, 8, 12), (EVEN, *MOVED_5, ("free", 0, 1), *FREE_MOVED)))),
    "sphere":
    ("point", "radius", 734.6, 3 * numpy.pi / 16, 1 / 3, 0.5, 0.1,
     ((1, (2.5, 3.33, 4.17, 5, 6.67), (EVEN, *MOVED)), (1, (8.33,), MOVED[:2]), (1, (3.33, 4.17, 5, 6.67), FREE),
      (1, (8.33,), FREE[:2]), (2, (1.67, 2.5, 3.33, 4.17, 5), (EVEN, *MOVED)), (2, (2.5, 3.33, 4.17), FREE),
      (1, (2.5, 3.33, 4.17, 5, 6.67), (EVEN, *MOVED[:2]), SLOWER["sphere"][0]), (1, (8.33,), MOVED[:2],
                                                                                 SLOWER["sphere"][0]))),
}
FAR = (("line", 1, 6, *EVEN), ("line", 2, 3, *EVEN), ("sphere", 1, 5, *EVEN))
# nodes of the bricks by their place along three directions
LATTICES = {
    "cells_hex8":
    numpy.reshape([0, 1, 3, 2, 4, 5, 7, 6], (2, 2, 2)),
    "cells_hex27":
    numpy.reshape([0, 8, 1, 11, 24, 9, 3, 10, 2, 16, 22, 17, 20, 26, 21, 19, 23, 18, 4, 12, 5, 15, 25, 13, 7, 14, 6],
                  (3, 3, 3))
}
FORMULATIONS = ("node_to_surface", "surface_to_surface")
COLUMNS = ("scene", "order", "faces", "mesh", "jitter", "seed", "growth", "formulation", "status", "elements",
           "iterations", "wall_s", "width", "peak", "edge")


def growth_of(scene, mesh):
    """Key of GROWTH and SLOWER."""
    return "sphere free" if (scene, mesh) == ("sphere", "free") else scene


def overrides(scene, order, faces, mesh, jitter, seed, growth):
    if scene == "line":  # the penalty's softness shall not count: at 100 it is 0.4 % of the width
        values = {
            "h": 1 / (RATIO * faces),
            "zone": LINE_ZONE,
            "core": LINE_ZONE,
            "rows": int(mesh == "rows"),
            "jitter": jitter
        }
        rest = [f"loads.0.pressure={LINE_LOAD:.6g}", "contact.0.penalty.scale=1000"]
    else:
        values = {"n": round(SPHERE_ZONE * faces * RATIO), **({"jitter": jitter} if mesh == "rows" else {})}
        rest = [f"solver.type={'direct' if order > 1 else 'iterative'}"]  # what is faster
        rest += ["mesh.file=../meshes/hertz_sphere_free.geo"] if mesh == "free" else []
    values.update(seed=seed, growth=growth)
    return [*rest, "mesh.parameters={" + ", ".join(f"{k}: {v:.8g}" for k, v in values.items()) + "}"]


def lagrange(n, at):
    """Values and derivatives at points of the polynomials that are 1 at one of n places even in [-1, 1] and 0 at the
    others: (n, points) each."""
    every = [numpy.poly1d(numpy.linalg.solve(numpy.vander(numpy.linspace(-1, 1, n)), unit)) for unit in numpy.eye(n)]
    return numpy.array([p(at) for p in every]), numpy.array([p.deriv()(at) for p in every])


def shares(faces, x):
    """Integrals of the shape functions of faces in a flat surface, by node. faces: nodes as a line (k, n) or a lattice
    (k, n, n); x: in the surface's directions."""
    at, weights = numpy.polynomial.legendre.leggauss(3)
    value, slope = lagrange(faces.shape[1], at)
    found = numpy.zeros(len(x))
    if faces.ndim == 2:
        parts = numpy.einsum("g,ag,kg->ka", weights, value, numpy.abs(numpy.einsum("ag,ka->kg", slope, x[faces, 0])))
    else:
        (xu, yu), (xv, yv) = (numpy.einsum("ag,bh,kabd->dkgh", first, second, x[faces])
                              for first, second in ((slope, value), (value, slope)))
        parts = numpy.einsum("g,h,ag,bh,kgh->kab", weights, weights, value, value, numpy.abs(xu * yv - yu * xv))
    numpy.add.at(found, faces, parts)
    return found


def faces_of(file, rows, nodes):
    """The nodes of the faces that the slave nodes (rows) of a flat surface y = 0 make: lines (k, n) along x, or
    lattices (k, n, n)."""
    if not nodes[:, 2].any():
        line, n = rows[numpy.argsort(nodes[rows, 0])], 3 if "mesh/cells_quad9" in file else 2
        return line[numpy.arange(0, len(line) - 1, n - 1)[:, None] + numpy.arange(n)]
    name = next(name for name in LATTICES if f"mesh/{name}" in file)
    faces = [
        numpy.take(file[f"mesh/{name}"][()][:, LATTICES[name]], end, axis) for axis in (1, 2, 3) for end in (0, -1)
    ]
    return numpy.concatenate([face[numpy.isin(face, rows).all(axis=(1, 2))] for face in faces])


def halves(faces):
    """Second-order faces as the first-order ones between their nodes, on which surface to surface has its hat
    functions."""
    if faces.ndim == 2:
        return numpy.concatenate([faces[:, i : i + 2] for i in range(faces.shape[1] - 1)])
    return numpy.concatenate(
        [faces[:, i:i + 2, j:j + 2] for i in range(faces.shape[1] - 1) for j in range(faces.shape[1] - 1)])


def centre_of_force(directory, pair, formulation):
    """By load: mean distance from the centre of the nodal forces."""
    found = {}
    with h5py.File(directory / "results.h5", "r") as file:
        rows = file["contact"][pair]["nodes"][()]
        nodes = file["mesh/nodes"][()]
        faces = faces_of(file, rows, nodes)
        area = shares(halves(faces) if formulation == "surface_to_surface" else faces, nodes[:, [0, 2]])[rows]
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
    for override in (f"mesh.order={order}", f"contact.0.formulation={formulation}", f"stepping.initial={step}",
                     "output.every=1", "output.fields=[displacement, contact]",
                     *overrides(scene, order, faces, mesh, jitter, seed, slope)):
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    record = dict(zip(COLUMNS, (*case, finished.returncode)))
    if finished.returncode == 0:
        summary, centres = json.loads(
            (directory / "summary.json").read_text()), centre_of_force(directory, pair, formulation)
        with open(directory / "steps.csv", newline="") as file:
            steps = [{k: v for k, v in row.items()} for row in csv.DictReader(file)]
        worst = {"width": 0, "peak": 0, "edge": 0}
        for t, row in ((float(row["t"]), row) for row in steps if float(row["t"]) >= first - 1e-9):
            nearest = min(centres, key=lambda other: abs(other - t))
            exact = t**growth
            for name, value in (("width", centres[nearest] / centre / exact),
                                ("peak", float(row["peak_pressure"]) / peak / exact), ("edge",
                                                                                       float(row[probe]) / exact)):
                worst[name] = max(worst[name], value - 1, key=abs)
        record.update(elements=summary["elements"], iterations=summary["newton_iterations"],
                      wall_s=round(summary["wall_s"], 2), **{
                          k: f"{100 * v:.3f}"
                          for k, v in worst.items()
                      })
    else:
        print(case, finished.stdout)
    shutil.rmtree(directory, ignore_errors=True)
    return record


def largest(runs, names=("width", "peak", "edge")):
    return [max((float(r[name]) for r in runs if r[name]), key=abs, default=numpy.nan) for name in names]


def print_table(records):
    series, solved = ("scene", "order", "mesh", "jitter", "growth"), [r for r in records if r["status"] == "0"]
    print(
        "Largest error against Hertz over the last loads and all draws, per cent: width, peak pressure, (edge of the "
        "probe)\n"
    )
    print(
        "| scene | order | mesh | moved by | growth | faces | draws | elements | node to surface | surface to surface "
        "| iterations |\n|"
        + " --- |" * 11)
    needed = {}
    for key in dict.fromkeys(tuple(r[name] for name in (*series, "faces")) for r in records):
        cells, iterations, elements, draws = [], [], "-", 0
        for formulation in FORMULATIONS:
            runs = [
                r for r in solved
                if tuple(r[name] for name in (*series, "faces")) == key and r["formulation"] == formulation
            ]
            iterations.append(str(max((int(r["iterations"]) for r in runs), default="-")))
            if not runs:
                cells.append("-")
                continue
            width, peak, edge = largest(runs)
            elements, draws = max(int(r["elements"]) for r in runs), max(draws, len(runs))
            cells.append(f"{width:+.2f}, {peak:+.2f} ({edge:+.1f})")
            needed.setdefault((*key[:5], formulation), []).append((float(key[5]), elements, max(abs(width), abs(peak))
                                                                   <= WITHIN))
        print(
            f"| {key[0]} | {key[1]} | {key[2]} | {100 * float(key[3]):g} % | {key[4]} | {key[5]} | {draws} | "
            f"{elements} | {cells[0]} | {cells[1]} | {' / '.join(iterations)} |"
        )
    print(f"\nElements from which on width and peak of all draws are within {WITHIN:g} %:\n")
    print("| scene | order | mesh | moved by | growth | node to surface | surface to surface | ratio |\n|" +
          " --- |" * 8)
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
        print(
            f"| {key[0]} | {key[1]} | {key[2]} | {100 * float(key[3]):g} % | {key[4]} | {cells[0]} | {cells[1]} | "
            f"{ratio} |"
        )


def print_far(records):
    """What the growth of the elements beyond the contact changes."""
    print(
        "\nThe same against the growth of the elements beyond\n\n| scene | order | mesh | faces | growth | elements | "
        "node to surface | surface to surface |\n|"
        + " --- |" * 8)
    for scene, order, faces, mesh, jitter, seed in FAR:
        for growth in (*SLOWER[growth_of(scene, mesh)], GROWTH[growth_of(scene, mesh)]):
            key = tuple(str(v) for v in (scene, order, faces, mesh, jitter, seed, growth))
            runs = [r for r in records if tuple(r[name] for name in COLUMNS[:7]) == key and r["status"] == "0"]
            cells = [
                "{:+.2f}, {:+.2f} ({:+.1f})".format(*largest([r]))
                for f in FORMULATIONS
                for r in runs
                if r["formulation"] == f
            ]
            if len(cells) == 2:
                print(
                    f"| {scene} | {order} | {mesh} | {faces} | {growth} | {runs[0]['elements']} | {cells[0]} | "
                    f"{cells[1]} |"
                )


def cases_of(names):
    cases = [(scene, order, faces, *moves, *(growth or [GROWTH[growth_of(scene, moves[0])]]), formulation)
             for scene in SCENES if scene in names
             for order, meshes, moved, *growth in SCENES[scene][7]
             for moves in moved
             for faces in meshes
             for formulation in FORMULATIONS]
    if "far" in names:
        cases += [(*case, growth, formulation)
                  for case in FAR
                  for growth in SLOWER[growth_of(case[0], case[3])]
                  for formulation in FORMULATIONS]
    return list(dict.fromkeys(cases))


def main():
    parser = table_parser(__doc__, "hertz")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of {', '.join(SCENES)}, far; default: all")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    args = parser.parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda case: [solve(case, args)], cases_of(args.scenes or (*SCENES, "far")),
                      args.jobs)
    print_table(read_records(args.record))
    print_far(read_records(args.record))


if __name__ == "__main__":
    main()
