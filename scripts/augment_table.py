"""Penalties as they are and augmented: same mesh, same steps. Raw records of every run go to a CSV file, the table
(iterations, updates, penetration, results) is printed from there:
    augment_table.py [--burnish BINARY] [--record FILE] [CASE...]     runs (these cases are added to the record, or
    replaced there) and prints augment_table.py --print [--record FILE]                          prints only"""
import shutil
import subprocess
import sys

from launch import ROOT, environment, read_records, read_summary, replace_records, table_parser

ITERATIVE = "solver.type=iterative"
# scene, overrides, bound of the penetration (length), times the automatic penalty: as it is, augmented, probes shown
CASES = {
    "pipe 12x5": (
        "pipe_pinch",
        ["mesh.parameters.n_arc=12", "mesh.parameters.n_len=5"],
        1e-2,
        (100, 1, 0.1, 0.01),
        (1, 0.1, 0.01),
        ("plate_force", "crown_gap"),
    ),
    "rings": ("ring_in_ring", [], 2e-6, (100, 1, 0.01), (1, 0.01), ("mean_pressure", "noise_max")),
    "rings, surface to surface": (
        "ring_in_ring",
        ["contact.0.formulation=surface_to_surface"],
        2e-6,
        (100, 1, 0.01),
        (1, 0.01),
        ("mean_pressure", "noise_max"),
    ),
    "rings in space, iterative": (
        "ring_in_ring_3d",
        [ITERATIVE, "mesh.parameters={n_inner: 20, n_outer: 25, n_len: 9, " "jitter: 0}"],
        5e-8,
        (1, 100, 1000),
        (10, 1, 0.1),
        ("mean_pressure", "noise_rms"),
    ),
    "blocks, iterative": (
        "patch_blocks",
        [ITERATIVE, "mesh.parameters={n_lower: 16, n_upper: 20, jitter: 0.25}"],
        1e-5,
        (1, 100, 1000),
        (10, 1),
        ("force", "pressure_max_deviation"),
    ),
}
COLUMNS = ("case", "penalty", "g_max", "status", "dofs", "steps", "steps_failed", "newton_iterations",
           "krylov_iterations", "updates", "missed", "max_penetration", "results", "cpu_s", "solve_s")


def record(args, case, scale, g_max):
    """One run, as a row of the CSV file; g_max empty: not augmented."""
    scene, overrides, _, _, _, shown = CASES[case]
    shutil.rmtree(args.out, ignore_errors=True)
    augment = f", augment: true, g_max: {g_max}, unit: length, max_updates: 50" if g_max else ""
    command = [str(args.burnish), str(ROOT / "runs" / f"{scene}.yaml"), "-quiet", "-o", str(args.out)]
    for override in (*overrides, "output.every=0", f"contact.0.penalty={{initial: auto, scale: {scale}{augment}}}"):
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    if finished.returncode not in (0, 2):  # 2: did not converge; the summary says how far it came
        sys.exit(f"{' '.join(command)}\n{finished.stdout}")
    summary = read_summary(args.out)
    penalty = summary["contact"][0]["penalty"]
    row = {
        "case": case,
        "penalty": scale,
        "g_max": g_max,
        "updates": penalty["augmented"],
        "missed": penalty["missed"],
        "cpu_s": round(summary["cpu_s"], 2),
        "solve_s": round(summary["seconds"]["solve"], 2),
        "results":
        " ".join("-" if summary["probes"][name] is None else f"{summary['probes'][name]:.6g}" for name in shown)
    }
    return row | {
        name: summary[name]
        for name in ("status", "dofs", "steps", "steps_failed", "newton_iterations", "krylov_iterations")
    } | {
        "max_penetration": f"{summary['max_penetration'] or 0:.3g}"
    }


def table(rows):
    print(
        "| scene | penalty, times automatic | penetration | results | iterations (updates) | Krylov iterations each | "
        "CPU s |\n|"
        + " --- |" * 7)
    for row in rows:
        bound = f", augmented to {float(row['g_max']):g}" + (f", missed in {row['missed']} of {row['steps']} steps"
                                                             if int(row["missed"]) else "") if row["g_max"] else ""
        failed = f", {row['steps_failed']} steps failed" if int(row["steps_failed"]) else ""
        print(
            f"| {row['case']} | {row['penalty']}{bound} | {row['max_penetration']} | {row['results']} | "
            f"{row['newton_iterations']} ({row['updates']}){failed}{'' if row['status'] == 'done' else ', stopped'} | "
            f"{int(row['krylov_iterations']) / max(1, int(row['newton_iterations'])):.1f} | {row['cpu_s']} |")


def main():
    parser = table_parser(__doc__, "augment")
    parser.add_argument("cases", nargs="*", metavar="CASE", help=f"beginnings of: {'; '.join(CASES)}. Default: all")
    args = parser.parse_args()
    for case in [
            case for case in CASES if not args.only_print and (not args.cases or case.startswith(tuple(args.cases)))
    ]:
        _, _, bound, plain, augmented, _ = CASES[case]
        replace_records(args.record, COLUMNS, case, [
            record(args, case, *run)
            for run in [*((scale, "") for scale in plain), *((scale, bound) for scale in augmented)]
        ])
    table(read_records(args.record))


if __name__ == "__main__":
    main()
