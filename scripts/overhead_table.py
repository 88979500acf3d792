"""What contact without naming pairs (`surfaces: all`) costs over a named pair: Krylov iterations, CPU time of the search
and of the whole run, memory. Runs runs/ring_in_ring_3d.yaml with 1e5 and 1e6 unknowns by the iterative solver, the whole
load in one step; leaves one record per run and prints the table; --print tables an existing record.
    python scripts/overhead_table.py [--burnish BINARY] [--record FILE]"""
import shutil
import subprocess

from launch import ROOT, command, environment, fill_table, read_summary, table_parser

SCENE = ROOT / "runs" / "ring_in_ring_3d.yaml"
SIZES = (48, 100)  # faces around the inner ring
FORMULATIONS = ("node_to_surface", "surface_to_surface")
WAYS = {"named": "slave: inner_contact, master: outer_contact", "all": "surfaces: all"}
HOW = ("contact=[{{name: fit, {}, formulation: {}, symmetry: [symmetry_x, symmetry_y, symmetry_z], "
       "initial_overlap: resolve, penalty: {{initial: auto, scale: 100}}}}]")
COMMON = ("output.every=0", "kinematics=small", "stepping.initial=1", "solver.type=iterative")
PROBE = "probes=[{name: rim, displacement: [30, 0, 0], component: x}]"
COLUMNS = ("dofs", "formulation", "way", "status", "iterations", "krylov", "rim", "search_s", "cpu_s", "peak_mb")


def cases():
    return [(size, formulation, way) for size in SIZES for formulation in FORMULATIONS for way in WAYS]


def solve(case, args):
    size, formulation, way = case
    out = args.out / "-".join(map(str, case))
    shutil.rmtree(out, ignore_errors=True)
    mesh = f"mesh.parameters={{n_inner: {size}, n_outer: {5 * size // 4}, n_len: {size // 3}}}"
    overrides = (mesh, *COMMON, HOW.format(WAYS[way], formulation), PROBE)
    line = command(args.burnish, 1, SCENE, out, overrides, "-quiet")
    subprocess.run(line, env=environment(args.burnish), capture_output=True, check=False)
    summary = read_summary(out)
    # CPU seconds of the search are its share of the wall time
    share = summary["seconds"]["search"] / summary["wall_s"]
    return dict(zip(COLUMNS, (summary["dofs"], formulation, way, summary["status"], summary["newton_iterations"],
                              summary["krylov_iterations"], f"{summary['probes']['rim']:.8g}",
                              f"{share * summary['cpu_s']:.3g}", f"{summary['cpu_s']:.1f}",
                              f"{summary['peak_rss_mb']:.0f}")))


def table(rows):
    print("| unknowns | formulation | iterations: named, all | Krylov iterations | search, CPU s | run, CPU s | memory, MB | "
          "all over named: time, memory |")
    print("| --- " * 8 + "|")
    found = {(row["dofs"], row["formulation"], row["way"]): row for row in rows}
    for dofs in dict.fromkeys(row["dofs"] for row in rows):
        for formulation in FORMULATIONS:
            ways = [found[dofs, formulation, way] for way in WAYS]

            def cells(key):
                return ", ".join(way[key] for way in ways)

            time, memory = (float(ways[1][key]) / float(ways[0][key]) for key in ("cpu_s", "peak_mb"))
            print(f"| {int(dofs):,} | {formulation.replace('_', ' ')} | {cells('iterations')} | {cells('krylov')} | "
                  f"{cells('search_s')} | {cells('cpu_s')} | {cells('peak_mb')} | {time:.2f}, {memory:.2f} |")


def main():
    parser = table_parser(__doc__, "all_overhead")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    fill_table(parser.parse_args(), COLUMNS, solve, cases(), table)


if __name__ == "__main__":
    main()
