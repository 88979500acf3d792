"""Noise of the forces on a cylinder that is drawn over a block with coarse elements (runs/drawn_cylinder.yaml): what is
left of them after a polynomial of degree 5 in the way, root mean square over the mean of the force across. Runs depths
of penetration with either body as slave, both orders; leaves one record per run and prints the table; --print tables an
existing record.
    python scripts/drawn_table.py [--burnish BINARY] [--record FILE]"""
import shutil
import subprocess

import numpy

from launch import ROOT, command, environment, read_records, read_steps, read_summary, table_parser, write_records

SCENE = ROOT / "runs/drawn_cylinder.yaml"
DEPTHS = {1: (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8), 2: (0.2, 0.5, 0.8)}  # by order
ROLES = {"block": (), "cylinder": ("contact.0.slave=arc", "contact.0.master=block_top")}
# At t = 1 the default penalty is made stiffer where it leaves more than its error: a jump, which is no noise. So the
# penalty is given, at the default.
PENALTY = "contact.0.penalty.scale=30"
BEGIN, DEGREE = 0.2, 5  # of the way that counts; of the polynomial
COLUMNS = ("order", "slave", "depth", "status", "iterations", "nodes", "force", "noise_across", "noise_along")


def overrides(order, slave, depth):
    return (f"mesh.order={order}", f"loads.0.uy={-depth}", PENALTY, *ROLES[slave])


def noise(directory):
    """Mean force across, and the noise of the forces across and along, in per cent of it."""
    steps = read_steps(directory)
    t, fx, fy = (steps[key][steps["t"] > BEGIN] for key in ("t", "fx", "fy"))
    mean = abs(numpy.mean(fy))
    rest = [f - numpy.polyval(numpy.polyfit(t - 0.6, f, DEGREE), t - 0.6) for f in (fy, fx)]
    return (mean, *(100 * numpy.sqrt(numpy.mean(r**2)) / mean for r in rest))


def solve(args, case):
    out = args.out / "-".join(str(part) for part in case)
    shutil.rmtree(out, ignore_errors=True)
    line = command(args.burnish, 1, SCENE, out, overrides(*case), "-quiet")
    subprocess.run(line, env=environment(args.burnish), capture_output=True, check=False)
    summary = read_summary(out)
    nodes = numpy.median(read_steps(out)["contact_nodes"])
    figures = [f"{figure:.4g}" for figure in noise(out)]
    return dict(zip(COLUMNS, (*case, summary["status"], summary["newton_iterations"], int(nodes), *figures)))


def median(rows, order, slave, key):
    return numpy.median([float(r[key]) for r in rows if (int(r["order"]), r["slave"]) == (order, slave)])


def table(rows):
    print("| order | depth | block as slave: nodes in contact | across, along (%) | cylinder as slave: across, along (%) |")
    print("| --- " * 5 + "|")
    for order in DEPTHS:
        for depth in DEPTHS[order]:
            block, cylinder = (next(r for r in rows if (int(r["order"]), r["slave"], float(r["depth"])) == (order, s, depth))
                               for s in ROLES)
            cells = [f"{float(r['noise_across']):.2g}, {float(r['noise_along']):.2g}" for r in (block, cylinder)]
            print(f"| {order} | {depth} | {block['nodes']} | {cells[0]} | {cells[1]} |")
        cells = [", ".join(f"{median(rows, order, slave, key):.2g}" for key in COLUMNS[-2:]) for slave in ROLES]
        print(f"| {order} | median | | {cells[0]} | {cells[1]} |")


def main():
    args = table_parser(__doc__, "drawn").parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        args.record.parent.mkdir(parents=True, exist_ok=True)
        cases = [(order, slave, depth) for order in DEPTHS for slave in ROLES for depth in DEPTHS[order]]
        write_records(args.record, COLUMNS, lambda case: [solve(args, case)], cases, 1)
    table(read_records(args.record))


if __name__ == "__main__":
    main()
