"""Contact patch test about the axis (runs/discs.yaml): by how much the slave nodes' pressure and the stress at the
interface's nodes differ from the load, which is exact everywhere. Runs inner radii, orders, mesh pairs, roles and
formulations, leaves one record per run and prints the table; --print tables an existing record.
    python scripts/axis_table.py [--burnish BINARY] [--jobs N] [--record FILE]
Stress is the one along the axis in results.h5, at the nodes of the interface, on either side."""
import h5py
import numpy

from launch import ROOT, fill_table, run_case, table_parser

SCENE = ROOT / "runs/discs.yaml"
RADII = (0, 4)
PAIRS = ((13, 10), (52, 40), (10, 13), (40, 52))  # elements along the radius, master/slave
SIDES = ("lower_top", "upper_bottom")
FORMULATIONS = ("node_to_surface", "surface_to_surface")
COLUMNS = ("radius", "order", "master", "slave", "slave_body", "formulation", "status", "iterations", "pressure_axis",
           "pressure_max", "stress_master", "stress_slave")


def overrides(radius, order, pair, slave, formulation):
    master = SIDES[1 - SIDES.index(slave)]
    lower, upper = pair if slave == SIDES[1] else pair[::-1]
    return [
        f"mesh.order={order}", f"mesh.parameters={{n_lower: {lower}, n_upper: {upper}, r_in: {radius}}}",
        f"contact.0.slave={slave}", f"contact.0.master={master}", f"contact.0.formulation={formulation}"
    ]


def deviations(directory):
    """Deviations from the load in per cent: pressure at the innermost slave node, largest one of the pressure, and of
    the stress along the axis at the interface on both sides."""
    with h5py.File(directory / "results.h5", "r") as file:
        step = file["steps"][sorted(file["steps"])[-1]]
        nodes, slaves = file["mesh/nodes"][()], file["contact/joint/nodes"][()]
        pressure, stress = 100 * (step["contact/joint/pressure"][()] - 1), 100 * (step["stress"][()][:, 1] + 1)
    slave = numpy.zeros(len(nodes), dtype=bool)
    slave[slaves] = True
    master = (numpy.abs(nodes[:, 1]) < 1e-9) & ~slave
    known = ~numpy.isnan(pressure)  # nodes without area have no pressure
    return {
        "pressure_axis": pressure[known][numpy.argmin(nodes[slaves[known], 0])],
        "pressure_max": numpy.max(numpy.abs(pressure[known])),
        "stress_master": numpy.max(numpy.abs(stress[master])),
        "stress_slave": numpy.max(numpy.abs(stress[slave]))
    }


def solve(case, args):
    radius, order, pair, slave, formulation = case
    return run_case((radius, order, *pair, slave.split("_")[0], formulation), COLUMNS, SCENE, overrides(*case),
                    deviations, args)


def print_table(records):
    print("Largest deviation from the load, per cent: pressure of the slave nodes; stress at the interface, master / "
          "slave\n")
    print("| inner radius | order | master/slave | slave | node to surface | surface to surface |\n|" + " --- |" * 6)
    for key in dict.fromkeys(tuple(r[name] for name in COLUMNS[:5]) for r in records):
        found = {r["formulation"]: r for r in records if tuple(r[name] for name in COLUMNS[:5]) == key}
        cells = [
            "{:.2f}; {:.2f} / {:.2f}".format(*(float(found[name][figure])
                                                for figure in ("pressure_max", "stress_master", "stress_slave")))
            if name in found and found[name]["pressure_max"] else "-" for name in FORMULATIONS
        ]
        print(f"| {key[0]} | {key[1]} | {key[2]}/{key[3]} | {key[4]} | {cells[0]} | {cells[1]} |")


def main():
    parser = table_parser(__doc__, "axis")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    cases = [(radius, order, pair, slave, formulation)
             for radius in RADII
             for order in (1, 2)
             for pair in PAIRS
             for slave in SIDES
             for formulation in FORMULATIONS]
    fill_table(parser.parse_args(), COLUMNS, solve, cases, print_table)


if __name__ == "__main__":
    main()
