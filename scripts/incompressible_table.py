"""Cook's membrane and a punch on a block with mixed elements of every kind, at nu = 0.3, 0.4999 and 0.5: the tip's
displacement and the punch's force against the limit of second-order quadrilaterals of the same nu, which is
extrapolated from three meshes by their own order. Solids are slices in plane strain. Punches that are narrower and
wider tell how strongly the force depends on the place of the edge. Beside even meshes there are graded ones, finer
towards the singular corner and the loaded end, or towards the edge of the punch, the floor and the free side. Writes
runs/records/incompressible.csv.

    build/venv/bin/python scripts/incompressible_table.py --burnish build/burnish [--graded]

--graded keeps the rows of even meshes that are in the record and makes those of graded ones.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
MU = 80.1938  # of Cook's membrane
ELEMENTS = {  # name -> (order, simplex, solid)
    "quad4": (1, 0, 0),
    "quad9": (2, 0, 0),
    "tri3": (1, 1, 0),
    "tri6": (2, 1, 0),
    "hex8": (1, 0, 1),
    "hex27": (2, 0, 1),
    "tet4": (1, 1, 1),
    "tet10": (2, 1, 1)
}
# case -> (probe, length of a side, elements of second order along it; of first order there are twice as many)
CASES = {"cook": ("tip_uy", 48, (4, 8, 16)), "punch": ("force", 0.5, (4, 8, 16))}
# Elements that need one mesh more until every nu is within 1 %, with its elements along a side.
FINER = {("punch", "tri3"): (96, ), ("punch", "tet4"): (96, )}
FINE = {"cook": (16, 32, 64), "punch": (12, 24, 48)}
EDGES = (0.48, 0.52)  # half of the punch's width, instead of 0.5
EDGES_N = 16
# case -> (parameter `grade` of the mesh, elements of second order along a side, of first order)
GRADED = {"cook": (16, (4, 6, 8), (12, 16, 24, 32)), "punch": (16, (3, 4), (8, 12))}
NUS = (0.3, 0.4999, 0.5)
COLUMNS = ("case", "element", "nu", "n", "grade", "value", "error", "steps", "failed", "iterations", "cpu_s")
EMPTY = ("", ) * 5  # of rows without an error


def settings(case, element, nu, n):
    order, simplex, solid = ELEMENTS[element]
    side = CASES[case][1]
    values = [
        f"mesh.order={order}", f"mesh.parameters.simplex={simplex}", f"mesh.parameters.n={n}",
        "bodies.0.formulation=mixed", f"bodies.0.material.nu={nu}"
    ]
    if case == "cook":
        values += [f"bodies.0.material.E={2 * MU * (1 + nu):.12g}"]
    if solid:
        values += ["geometry=solid", "mesh.parameters.layers=1", f"mesh.parameters.thick={side / n:.12g}"]
    if solid and case == "cook":
        values += ["supports.1={surface: faces, uz: 0}", "loads.0.traction=[0, 6.25, 0]",
                   "probes.0.displacement=[48, 60, 0]"]
    if solid and case == "punch":
        values += ["supports.2={surface: faces, uz: 0}"]
    return values


def run(burnish, case, element, nu, n, *overrides):
    """Value, steps, failed steps, iterations and CPU time; the force of a slice is that of thickness 1."""
    probe, side, _ = CASES[case]
    with tempfile.TemporaryDirectory() as directory:
        command = [burnish, str(ROOT / f"runs/{case}.yaml"), "-o", directory + "/run"]
        for value in (*settings(case, element, nu, n), *overrides):
            command += ["-set", value]
        finished = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if finished.returncode:
            print(f"{case} {element} nu {nu} n {n}:\n{finished.stdout}", file=sys.stderr)
            return None
        summary = json.loads((pathlib.Path(directory) / "run/summary.json").read_text())
    value = summary["probes"][probe]
    if case == "punch" and ELEMENTS[element][2]:
        value *= n / side
    return value, summary["steps"], summary["steps_failed"], summary["newton_iterations"], summary["cpu_s"]


def limit_of(values):
    """The limit of values on three meshes, each twice as fine as the one before, by their own order."""
    first, second, third = values
    return third + (third - second) / ((second - first) / (third - second) - 1)


def row(args, case, element, nu, n, grade, limit):
    """A row of the record: the error against the limit."""
    figures = run(args.burnish, case, element, nu, n, f"mesh.parameters.grade={grade}")
    if figures is None:
        return case, element, nu, n, grade, "failed", *EMPTY
    error = figures[0] / limit - 1
    print(f"{case:6} {element:6} nu {nu:<7} n {n:3} grade {grade:3} {figures[0]:.6g} {100 * error:+.2f} %, steps "
          f"{figures[1]} + {figures[2]} failed, {figures[3]} iterations, {figures[4]:.1f} s", flush=True)
    return case, element, nu, n, grade, f"{figures[0]:.7g}", f"{error:.5f}", *figures[1:4], f"{figures[4]:.2f}"


def even(args):
    """Rows of the limits and of even meshes."""
    for case, (_, _, sizes) in CASES.items():
        for nu in NUS:
            limit = limit_of([run(args.burnish, case, "quad9", nu, n)[0] for n in FINE[case]])
            yield case, "limit: quad9", nu, FINE[case][-1], 1, f"{limit:.7g}", *EMPTY
            for edge in EDGES if case == "punch" else ():
                force = run(args.burnish, case, "quad9", nu, EDGES_N, f"mesh.parameters.edge={edge}")[0]
                yield case, f"edge {edge}: quad9", nu, EDGES_N, 1, f"{force:.7g}", *EMPTY
            for element, (order, _, _) in ELEMENTS.items():
                for n in (*(size * (3 - order) for size in sizes), *FINER.get((case, element), ())):
                    yield row(args, case, element, nu, n, 1, limit)


def graded(args, limits):
    """Rows of graded meshes, against the limits of even ones."""
    for case, (grade, *sizes) in GRADED.items():
        for element, (order, _, _) in ELEMENTS.items():
            for n in sizes[2 - order]:
                for nu in NUS:
                    yield row(args, case, element, nu, n, grade, limits[case, str(nu)])


def record_of(path):
    """Rows of even meshes in a record."""
    with open(path, newline="") as file:
        rows = [dict({"grade": "1"}, **each) for each in csv.DictReader(file)]
    return [[each[name] for name in COLUMNS] for each in rows if each["grade"] == "1"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--burnish", default="build/burnish")
    parser.add_argument("--record", default=str(ROOT / "runs/records/incompressible.csv"))
    parser.add_argument("--graded", action="store_true")
    args = parser.parse_args()
    known = record_of(args.record) if args.graded else []
    limits = {}
    with open(args.record, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for line in known or even(args):
            table.writerow(line)
            if str(line[1]).startswith("limit"):
                limits[line[0], str(line[2])] = float(line[5])
            file.flush()
        for line in graded(args, limits):
            table.writerow(line)
            file.flush()


if __name__ == "__main__":
    main()
