"""Two balls that touch on the axis (runs/two_balls.yaml): the pressure at the centre of the contact, and by how much of
its error the elements alone are off. Against its limit, which is that of second-order elements on the finest mesh. Runs
orders, mesh pairs and roles, leaves one record per run and prints the table; --print tables an existing record.
    python scripts/ball_table.py [--burnish BINARY] [--jobs N] [--record FILE]
Two alike balls meet on a plane. So the upper ball alone, pressed on a rigid plane, has the same pressure; without fits,
and with the gap of its nodes, its error is that of its elements."""
import h5py
import numpy

from launch import ROOT, fill_table, run_case, table_parser

SCENE = ROOT / "runs/two_balls.yaml"
# elements over two contact radii, lower/upper ball; 0: the upper ball alone on a plane
MESHES = {1: (14, 18, 28, 36, 56, 72), 2: (14, 18, 28, 36, 56)}
PAIRS = {1: ((14, 18), (28, 36), (56, 72)), 2: ((14, 18), (28, 36))}
SIDES = ("lower", "upper")
LIMIT = (2, 56)  # order, elements
COLUMNS = ("order", "lower", "upper", "slave", "status", "iterations", "pressure", "second")
ALONE = [
    "bodies=[{volume: upper, material: {law: svk, E: 1000, nu: 0.3}}]", "supports=[{surface: upper_axis, ux: 0}]",
    "contact.0.master={plane: {point: [0, 0], normal: [0, 1]}}", "contact.0.formulation=node_to_surface"
]


def overrides(order, lower, upper, slave):
    changed = [f"mesh.order={order}", f"mesh.parameters={{n_lower: {lower}, n_upper: {upper}}}"]
    if not lower:
        return changed + ALONE
    return changed + [f"contact.0.slave={slave}_skin", f"contact.0.master={SIDES[1 - SIDES.index(slave)]}_skin"]


def pressures(directory):
    """At the slave's node on the axis, or the innermost one that has a pressure, and at the next one."""
    with h5py.File(directory / "results.h5", "r") as file:
        step = file["steps"][sorted(file["steps"])[-1]]
        radius = file["mesh/nodes"][()][file["contact/touch/nodes"][()], 0]
        pressure = step["contact/touch/pressure"][()]
    known = numpy.flatnonzero(~numpy.isnan(pressure))
    centre, second = pressure[known[numpy.argsort(radius[known])[:2]]]
    return {"pressure": centre, "second": second}


def solve(case, args):
    return run_case(case, COLUMNS, SCENE, overrides(*case), pressures, args)


def print_table(records):
    found = {tuple(r[name] for name in COLUMNS[:4]): r for r in records}
    limit = float(found[str(LIMIT[0]), "0", str(LIMIT[1]), "upper"]["pressure"])
    print(f"Limit of the pressure at the centre: {limit:.4g} MPa\n\n| order | faces over the contact radius, "
          "master/slave | slave | error at the centre, % | the elements' own: slave, master | mean |\n|" + " --- |" * 6)
    for (order, lower, upper, slave), record in found.items():
        if lower == "0":
            continue
        sizes = (upper, lower) if slave == "lower" else (lower, upper)
        own = [100 * (float(found[order, "0", n, "upper"]["pressure"]) / limit - 1) for n in reversed(sizes)]
        error = 100 * (float(record["pressure"]) / limit - 1)
        print(f"| {order} | {int(sizes[0]) // 2}/{int(sizes[1]) // 2} | {slave} | {error:.2f} | "
              f"{own[0]:.2f}, {own[1]:.2f} | {sum(own) / 2:.2f} |")


def main():
    parser = table_parser(__doc__, "ball")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    cases = [(order, 0, n, "upper") for order in MESHES for n in MESHES[order]]
    cases += [(order, *pair, slave) for order in PAIRS for pair in PAIRS[order] for slave in SIDES]
    fill_table(parser.parse_args(), COLUMNS, solve, cases, print_table)


if __name__ == "__main__":
    main()
