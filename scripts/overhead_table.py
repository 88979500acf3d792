"""What contact without naming pairs (`surfaces: all`) costs over a named pair: Krylov iterations, CPU time of the search
and of the whole run, memory. Runs runs/ring_in_ring_3d.yaml with 1e5 and 1e6 unknowns by the iterative solver, the whole
load in one step, and once more in four steps: the search of each of the later three finds nothing new, and its share of
one of their iterations is tabled. Leaves one record per case and prints the table; --print tables an existing record.
    python scripts/overhead_table.py [--burnish BINARY] [--record FILE]"""
import shutil
import subprocess

from launch import ROOT, command, environment, fill_table, read_records, read_summary, table_parser

SCENE = ROOT / "runs" / "ring_in_ring_3d.yaml"
SIZES = (48, 100)  # faces around the inner ring
FORMULATIONS = ("node_to_surface", "surface_to_surface")
WAYS = {"named": "slave: inner_contact, master: outer_contact", "all": "surfaces: all"}
HOW = ("contact=[{{name: fit, {}, formulation: {}, symmetry: [symmetry_x, symmetry_y, symmetry_z], "
       "initial_overlap: resolve, penalty: {{initial: auto, scale: 100}}}}]")
COMMON = ("output.every=0", "kinematics=small", "solver.type=iterative")
STEPS = 4  # of the second run
PROBE = "probes=[{name: rim, displacement: [30, 0, 0], component: x}]"
COLUMNS = ("dofs", "formulation", "way", "status", "iterations", "krylov", "rim", "search_s", "cpu_s", "peak_mb",
           "later_share")


def cases(sizes):
    return [(size, formulation, way) for size in sizes for formulation in FORMULATIONS for way in WAYS]


def run(case, args, steps):
    """The summary and the records of the steps of a run in so many steps."""
    size, formulation, way = case
    out = args.out / "-".join(map(str, (*case, steps)))
    shutil.rmtree(out, ignore_errors=True)
    mesh = f"mesh.parameters={{n_inner: {size}, n_outer: {5 * size // 4}, n_len: {size // 3}}}"
    overrides = (mesh, *COMMON, f"stepping.initial={1 / steps}", HOW.format(WAYS[way], formulation), PROBE)
    line = command(args.burnish, 1, SCENE, out, overrides, "-quiet")
    subprocess.run(line, env=environment(args.burnish), capture_output=True, check=False)
    return read_summary(out), read_records(out / "steps.csv")


def search_seconds(summary):
    """CPU seconds of the search: its share of the wall time."""
    return summary["seconds"]["search"] / summary["wall_s"] * summary["cpu_s"]


def later_share(one, many, steps):
    """Share of a search in an iteration, in the steps after the first one, from the runs in one and in many steps."""
    iterations = sum(int(step["newton"]) for step in steps[1:])
    wall = float(steps[-1]["wall_s"]) - float(steps[0]["wall_s"])
    iteration = wall / iterations * many["cpu_s"] / many["wall_s"]
    return (search_seconds(many) - search_seconds(one)) / (len(steps) - 1) / iteration


def solve(case, args):
    _, formulation, way = case
    summary, _ = run(case, args, 1)
    share = f"{later_share(summary, *run(case, args, STEPS)):.4f}" if case[0] <= args.later else ""
    return dict(zip(COLUMNS, (summary["dofs"], formulation, way, summary["status"], summary["newton_iterations"],
                              summary["krylov_iterations"], f"{summary['probes']['rim']:.8g}",
                              f"{search_seconds(summary):.3g}", f"{summary['cpu_s']:.1f}",
                              f"{summary['peak_rss_mb']:.0f}", share)))


def table(rows):
    print("| unknowns | formulation | iterations: named, all | Krylov iterations | search, CPU s | run, CPU s | memory, MB | "
          "all over named: time, memory | later search, % of an iteration |")
    print("| --- " * 9 + "|")
    found = {(row["dofs"], row["formulation"], row["way"]): row for row in rows}
    for dofs in dict.fromkeys(row["dofs"] for row in rows):
        for formulation in FORMULATIONS:
            ways = [found[dofs, formulation, way] for way in WAYS]

            def cells(key):
                return ", ".join(way[key] for way in ways)

            later = ", ".join(f"{100 * float(way['later_share']):.2g}" if way["later_share"] else "-" for way in ways)
            time, memory = (float(ways[1][key]) / float(ways[0][key]) for key in ("cpu_s", "peak_mb"))
            print(f"| {int(dofs):,} | {formulation.replace('_', ' ')} | {cells('iterations')} | {cells('krylov')} | "
                  f"{cells('search_s')} | {cells('cpu_s')} | {cells('peak_mb')} | {time:.2f}, {memory:.2f} | {later} |")


def main():
    parser = table_parser(__doc__, "all_overhead")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES, help="faces around the inner ring")
    parser.add_argument("--later", type=int, default=SIZES[-1], help="largest size that is run in four steps as well")
    args = parser.parse_args()
    fill_table(args, COLUMNS, solve, cases(args.sizes), table)


if __name__ == "__main__":
    main()
