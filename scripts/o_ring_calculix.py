"""The O-ring of runs/o_ring.yaml in Burnish and in CalculiX (ccx, Debian's package calculix-ccx) side by side, on one
mesh of second-order quadrilaterals: mixed quad9, which has an inner node more, and CAX8R, reduced integration.
CalculiX has no mixed elements. Both laws are neo-Hooke's of the shape, with K/2 (ln J)^2 in Burnish (in space the law
of the scene) and K/2 (J - 1)^2 in CalculiX. Its contact is surface to surface, penalty, on a row of fixed elements
along the groove and one that comes down as the lid. Prints a table and writes runs/records/o_ring_calculix.csv. CPU
seconds are of the process that solves.
    build/venv/bin/python scripts/o_ring_calculix.py [--burnish build/burnish] [--ccx ccx] [--stiffness 200]
The stiffness of CalculiX's contact is that many times Young's modulus over 1 mm. With 20 the force is some per cent
lower. A run of CalculiX is stopped after --limit CPU seconds.
    build/venv/bin/python scripts/o_ring_calculix.py --solid
does the same for a quarter of the ring in space (runs/rubber/o_ring_3d.yaml): mixed hex27, tet10 and tet4, and C3D20R
on the coarser mesh of hex27, without the inner nodes. `axisymmetric` is the force over that of the axisymmetric ring,
whose mesh is the cross-section. It writes runs/records/o_ring_3d.csv. All forces are over 360 degrees."""
import argparse
import csv
import math
import pathlib
import resource
import subprocess
import tempfile

import h5py
import numpy

from launch import environment, read_summary, timed

ROOT = pathlib.Path(__file__).resolve().parents[1]
YOUNG, CORD, MEAN, WAY = 5.5, 3.53, 53.53, 0.706
DEPTH, WIDTH, FOOT, EDGE = 2.8, 4.7, 0.4, 0.2  # of the groove, as in meshes/o_ring.geo
NUS = (0.45, 0.49, 0.499, 0.4999, 0.5)
COLUMNS = ("code", "element", "n", "arc", "nu", "increment", "status", "steps", "failed", "iterations", "cpu_s",
           "force", "axisymmetric")
# Quarters in space: element, order, tetrahedra, elements along a quarter of the cord, elements around, Poisson's ratios
SOLIDS = (("hex27", 2, 0, 4, 6, (0.499, 0.5)), ("hex27", 2, 0, 6, 8, (0.499, )), ("tet10", 2, 1, 4, 12, (0.499, 0.5)),
          ("tet4", 1, 1, 6, 12, (0.499, 0.5)), ("tet4", 1, 1, 8, 24, (0.499, )))
SOLID_NUS = (0.499, 0.5)
TOOLS = 4  # elements of groove and lid around the axis for one of the ring, which follow the circle closely enough
TOOL = 100000  # from this number on nodes and elements are those of groove, lid and spring
WEDGE = 180  # CalculiX expands axisymmetric elements to wedges of 2 degrees


def groove():
    """Points of the groove from its left edge to its right one, with normals into the solid, and behind them."""
    a, b = (MEAN - WIDTH) / 2, (MEAN + WIDTH) / 2

    def arc(x, y, radius, start, end, n):
        angles = [start + (end - start) * i / n for i in range(n + 1)]
        return [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in angles]

    points = [(a - 1, DEPTH)] + arc(a - EDGE, DEPTH - EDGE, EDGE, math.pi / 2, 0, 4)
    points += arc(a + FOOT, FOOT, FOOT, math.pi, 1.5 * math.pi, 6)
    points += arc(b - FOOT, FOOT, FOOT, -0.5 * math.pi, 0, 6)
    points += arc(b + EDGE, DEPTH - EDGE, EDGE, math.pi, math.pi / 2, 4) + [(b + 1, DEPTH)]
    fine = [points[0]]
    for point in points[1:]:
        n = max(1, math.ceil(math.dist(fine[-1], point) / 0.15))
        start = fine[-1]
        fine += [tuple(p + (q - p) * (i + 1) / n for p, q in zip(start, point)) for i in range(n)]
    behind = []
    for i, (x, y) in enumerate(fine):
        before, after = fine[max(i - 1, 0)], fine[min(i + 1, len(fine) - 1)]
        along = numpy.subtract(after, before) / math.dist(before, after)
        behind.append((x + 0.1 * along[1], y - 0.1 * along[0]))  # the solid is to the right
    return fine, behind


def row(name, face, behind, node, element):
    """A row of CAX4 with `face` as its side S3; all of its nodes are NAME_nodes."""
    n = len(face)
    lines = ["*NODE", *(f"{node + i}, {x:.12g}, {y:.12g}, 0" for i, (x, y) in enumerate([*behind, *face]))]
    lines.append(f"*ELEMENT, TYPE=CAX4, ELSET={name}")
    lines += [f"{element + i}, {node + i}, {node + i + 1}, {node + n + i + 1}, {node + n + i}" for i in range(n - 1)]
    return lines + [f"*NSET, NSET={name}_nodes, GENERATE", f"{node}, {node + 2 * n - 1}", f"*SURFACE, NAME={name}_side",
                    *(f"{element + i}, S3" for i in range(n - 1)), f"*SOLID SECTION, ELSET={name}, MATERIAL=stiff"]


def mesh_of(results):
    """Nodes and cells of a run, without the inner nodes."""
    with h5py.File(results / "results.h5", "r") as file:
        return file["mesh/nodes"][()], file["mesh/cells_quad9"][()][:, :8]


def deck(nodes, cells, nu, increment, stiffness):
    used = sorted(set(cells.ravel()))
    lines = ["*NODE", *(f"{k + 1}, {', '.join(f'{x:.12g}' for x in nodes[k])}" for k in used),
             "*ELEMENT, TYPE=CAX8R, ELSET=ring",
             *(f"{n + 1}, {', '.join(str(k + 1) for k in cell)}" for n, cell in enumerate(cells)),
             "*SURFACE, NAME=skin"]
    radius = numpy.hypot(nodes[:, 0] - MEAN / 2, nodes[:, 1] - CORD / 2)
    for number, cell in enumerate(cells):
        for side, ends in enumerate(((0, 1), (1, 2), (2, 3), (3, 0))):
            if all(abs(radius[cell[end]] - CORD / 2) < 1e-6 for end in ends):
                lines.append(f"{number + 1}, S{side + 1}")
    shear = YOUNG / (2 * (1 + nu))
    bulk = YOUNG / (3 * (1 - 2 * nu))
    lines += ["*MATERIAL, NAME=rubber", "*HYPERELASTIC, NEO HOOKE", f"{shear / 2!r}, {2 / bulk!r}",
              "*SOLID SECTION, ELSET=ring, MATERIAL=rubber", "*MATERIAL, NAME=stiff", "*ELASTIC",
              f"{1000 * YOUNG}, 0.3"]
    face, behind = groove()
    lines += row("groove", face, behind, 100001, 100001)
    x = numpy.linspace((MEAN - WIDTH) / 2 - 1, (MEAN + WIDTH) / 2 + 1, 61)[::-1]
    lines += row("lid", [(float(v), CORD) for v in x], [(float(v), CORD + 0.1) for v in x], 200001, 200001)
    for master in ("groove", "lid"):
        lines += [f"*SURFACE INTERACTION, NAME=law_{master}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
                  repr(stiffness * YOUNG), f"*CONTACT PAIR, INTERACTION=law_{master}, TYPE=SURFACE TO SURFACE",
                  f"skin, {master}_side"]
    middle = min(used, key=lambda k: abs(nodes[k, 0] - MEAN / 2) + abs(nodes[k, 1] - CORD / 2)) + 1
    lines += ["*ELEMENT, TYPE=SPRING1, ELSET=hold", f"300001, {middle}", "*SPRING, ELSET=hold", "2", "0.0001",
              "*BOUNDARY", "groove_nodes, 1, 2", "lid_nodes, 1, 1", "*STEP, NLGEOM, INC=2000", "*STATIC",
              f"{increment}, 1, 1e-6, {increment}", "*BOUNDARY", f"lid_nodes, 2, 2, {-WAY}",
              "*NODE PRINT, NSET=lid_nodes, FREQUENCY=1, TOTALS=ONLY", "RF", "*END STEP"]
    return lines


class Numbers(dict):
    """Numbers without holes, in the order of their first use; CalculiX takes memory for each number up to the last."""

    def __missing__(self, key):
        self[key] = len(self) + 1
        return self[key]


def brick(nodes, k):
    """The k-th C3D20R around the axis that an element CAX8R sweeps, nodes by number and plane."""
    corner, middle = nodes[:4], nodes[4:]
    outer = [(node, plane) for part in (corner, middle) for plane in (2 * k, 2 * k + 2) for node in part]
    return outer + [(node, 2 * k + 1) for node in corner]


def swept(lines, arc):
    """The deck of axisymmetric elements as a quarter of the ring between two planes of symmetry: `arc` C3D20R around
    the axis, and TOOLS times as many C3D8 for groove and lid."""
    out, kind, ends, known = [], "", ([], []), False
    node, element = Numbers(), Numbers()
    for line in lines:
        words = [word.strip() for word in line.split(",")]
        numbers = [int(word) for word in words if word.isdigit()]
        if line.startswith("*"):
            kind = words[0]
            if kind == "*BOUNDARY" and not known:
                for name, nodes in zip(("start", "end"), ends):
                    out += [f"*NSET, NSET={name}", *(str(number) for number in sorted(set(nodes)))]
                out += ["*BOUNDARY", "start, 3, 3", "end, 1, 1"]
                known = True
            out.append(line.replace("CAX8R", "C3D20R").replace("CAX4", "C3D8").replace(", GENERATE", ""))
            generated = "GENERATE" in line
        elif kind == "*NODE":
            planes = TOOLS * arc if numbers[0] > TOOL else 2 * arc
            x, y = float(words[1]), float(words[2])
            for plane in range(planes + 1):
                angle = math.pi / 2 * plane / planes
                out.append(f"{node[numbers[0], plane]}, {x * math.cos(angle):.12g}, {y:.12g}, "
                           f"{x * math.sin(angle):.12g}")
        elif kind == "*ELEMENT" and len(words) == 9:
            for k in range(arc):
                nodes = [str(node[pair]) for pair in brick(numbers[1:], k)]
                out += [f"{element[numbers[0], k]}, {', '.join(nodes[:10])},", ", ".join(nodes[10:])]
            for end, plane in zip(ends, (0, 2 * arc)):
                end += [node[number, plane] for number in numbers[1:]]
        elif kind == "*ELEMENT" and len(words) == 5:
            for k in range(TOOLS * arc):
                nodes = [str(node[number, plane]) for plane in (k, k + 1) for number in numbers[1:]]
                out.append(f"{element[numbers[0], k]}, {', '.join(nodes)}")
        elif kind == "*ELEMENT":
            out.append(f"{element[numbers[0], 0]}, {node[numbers[1], 0]}")
        elif kind == "*SURFACE" and words[1].startswith("S"):
            count = TOOLS * arc if numbers[0] > TOOL else arc
            out += [f"{element[numbers[0], k]}, S{int(words[1][1:]) + 2}" for k in range(count)]
        elif kind == "*NSET" and generated:
            out += [str(node[number, plane]) for plane in range(TOOLS * arc + 1)
                    for number in range(numbers[0], numbers[1] + 1)]
        elif kind == "*BOUNDARY" and words[0] in ("groove_nodes", "lid_nodes") and words[1] == "1":
            out += [line, f"{words[0]}, 3, 3"]
        else:
            out.append(line)
    return out


def rows_of(path):
    if not path.exists():
        return []
    return [line.split() for line in path.read_text().splitlines() if line.split() and line.split()[0].isdigit()]


def timed_in(args, command, directory, log, limit=resource.RLIM_INFINITY):
    def stop():
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))

    with open(log, "w") as output:
        return timed(command, cwd=directory, stdout=output, stderr=subprocess.STDOUT, env=environment(args.burnish),
                     preexec_fn=stop)


def burnish(args, element, scene, overrides, law, nu, directory):
    """Directory and row of a run; the force is None where it has not ended."""
    results = pathlib.Path(tempfile.mkdtemp(dir=directory)) / "run"
    material = f"{{law: {law}, E: {YOUNG}, nu: {nu}}}"
    command = [args.burnish, ROOT / scene, "-o", results]
    for override in (*overrides, f"bodies.0.material={material}"):
        command += ["-set", override]
    code, cpu = timed_in(args, command, directory, directory / "burnish.log")
    summary = read_summary(results)
    return results, {"code": "Burnish", "element": f"{element} mixed", "nu": nu, "steps": summary["steps"],
                     "status": "done" if code == 0 else "not converged", "failed": summary["steps_failed"],
                     "iterations": summary["newton_iterations"], "cpu_s": f"{cpu:.2f}",
                     "force": summary["probes"]["force"] if code == 0 else None}


def calculix(args, lines, element, nu, increment, parts, directory):
    """Row of a run of a deck for one of `parts` of the ring."""
    for old in directory.glob("ring.*"):
        old.unlink()
    (directory / "ring.inp").write_text("\n".join(lines) + "\n")
    _, cpu = timed_in(args, [args.ccx, "-i", "ring"], directory, directory / "ccx.log", args.limit)
    accepted, iterations = rows_of(directory / "ring.sta"), rows_of(directory / "ring.cvg")
    done = bool(accepted) and abs(float(accepted[-1][4]) - 1) < 1e-9
    steps = len({line[1] for line in accepted})
    totals = [line.split() for line in (directory / "ring.dat").read_text().splitlines() if len(line.split()) == 3]
    return {"code": "CalculiX", "element": element, "nu": nu, "increment": increment, "steps": steps,
            "status": "done" if done else f"stops at {float(accepted[-1][4]) if accepted else 0:.3g} of the way",
            "failed": len({tuple(line[:3]) for line in iterations}) - steps, "iterations": len(iterations),
            "cpu_s": f"{cpu:.2f}", "force": parts * abs(float(totals[-1][1])) if done else None}


def plane(order, triangles, n):
    return f"mesh.order={order}", f"mesh.parameters.n={n}", f"mesh.parameters.triangles={triangles}"


def rings(args, directory):
    """Rows of the axisymmetric ring."""
    for nu in NUS:
        mesh, row = burnish(args, "quad9", "runs/o_ring.yaml", plane(2, 0, args.n), "isochoric_neo_hookean", nu,
                            directory)
        yield {**row, "n": args.n}
        for step in args.increments if nu <= 0.499 else ():
            lines = deck(*mesh_of(mesh), nu, step, args.stiffness)
            yield {**calculix(args, lines, "CAX8R", nu, step, WEDGE, directory), "n": args.n}


def solids(args, directory):
    """Rows of the quarter in space."""
    for nu in SOLID_NUS:
        for element, order, simplex, n, arc in (case[:5] for case in SOLIDS if nu in case[5]):
            flat = {"hex27": "quad9", "tet10": "tri6", "tet4": "tri3"}[element]
            mesh, row = burnish(args, flat, "runs/o_ring.yaml", plane(order, simplex, n), "neo_hookean", nu, directory)
            force = row["force"]
            overrides = (*plane(order, simplex, n), f"mesh.parameters.arc={arc}", "output.every=0")
            found = [burnish(args, element, "runs/rubber/o_ring_3d.yaml", overrides, "neo_hookean", nu, directory)[1]]
            found[0]["force"] = found[0]["force"] and 4 * found[0]["force"]
            for step in args.increments if (element, n) == ("hex27", 4) and nu <= 0.499 else ():
                lines = swept(deck(*mesh_of(mesh), nu, step, args.stiffness), arc)
                found.append(calculix(args, lines, "C3D20R", nu, step, 4, directory))
            for row in found:
                yield {**row, "n": n, "arc": arc,
                       "axisymmetric": f"{row['force'] / force:.5f}" if row["force"] and force else ""}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build/burnish")
    parser.add_argument("--ccx", default="ccx")
    parser.add_argument("--stiffness", type=float, default=200)
    parser.add_argument("--increments", type=float, nargs="+", default=(0.1,))
    parser.add_argument("--n", type=int, default=8, help="elements along a quarter of the axisymmetric ring's cord")
    parser.add_argument("--solid", action="store_true", help="a quarter of the ring in space")
    parser.add_argument("--limit", type=int, help="default 40, and 1000 in space")
    parser.add_argument("--record", type=pathlib.Path)
    args = parser.parse_args()
    args.burnish = args.burnish.resolve()
    args.limit = args.limit or (1000 if args.solid else 40)
    args.record = args.record or ROOT / f"runs/records/{'o_ring_3d' if args.solid else 'o_ring_calculix'}.csv"
    with open(args.record, "w", newline="") as record, tempfile.TemporaryDirectory() as temporary:
        table = csv.DictWriter(record, COLUMNS, restval="", lineterminator="\n")
        table.writeheader()
        print(f"| {' | '.join(COLUMNS)} |\n|{' --- |' * len(COLUMNS)}")
        for line in (solids if args.solid else rings)(args, pathlib.Path(temporary)):
            line["force"] = f"{line['force']:.2f}" if line["force"] else ""
            table.writerow(line)
            record.flush()
            print("| " + " | ".join(str(line.get(name, "")) for name in COLUMNS) + " |", flush=True)


if __name__ == "__main__":
    main()
