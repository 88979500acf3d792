"""The paper's scenes with node to surface and with surface to surface: same mesh, same steps. Raw records of every run
go to a CSV file, the table (iterations, failed steps, CPU seconds, results) is printed from there:
    formulation_table.py [--burnish BINARY] [--record FILE] [CASE...]     runs (these cases are added to the record, or
    replaced there) and prints formulation_table.py --print [--record FILE]                          prints only
With --offsets it is surface to surface with held and with live offsets, on the pipes."""
import json
import shutil
import subprocess
import sys

from launch import ROOT, environment, read_records, replace_records, table_parser

FORMULATIONS = ("node_to_surface", "surface_to_surface")
OFFSETS = ("held", "live")
FINE = "h_contact: 0.25, h_far: 3, n_thick: 4, n_width: 6"  # first-order plate: as many nodes over the patch
FREE = "contact.0.penalty.adjust=false"
SMOOTH = "contact.0.smoother=diffuse"


def pipe(order, n_arc, n_len):
    return "pipe_pinch", [
        f"mesh.order={order}", f"mesh.parameters.n_arc={n_arc}", f"mesh.parameters.n_len={n_len}", SMOOTH
    ]


CASES = {
    "plate, window, order 2": ("plate_cylinder", ["mesh.order=2"]),
    "plate, window from 1e-4, order 2": ("plate_cylinder", ["mesh.order=2", "contact.0.penalty.scale=1e-4"]),
    "plate, window from 1e4, order 2": ("plate_cylinder", ["mesh.order=2", "contact.0.penalty.scale=1e4"]),
    "plate, order 2": ("plate_cylinder", ["mesh.order=2", FREE]),
    "plate, meshed cylinder, order 2": ("plate_cylinder_meshed", ["mesh.order=2", SMOOTH, FREE]),
    "plate, window, order 1": ("plate_cylinder", ["mesh.order=1", f"mesh.parameters={{{FINE}}}"]),
    "plate, order 1": ("plate_cylinder", ["mesh.order=1", f"mesh.parameters={{{FINE}}}", FREE]),
    "plate, meshed cylinder, order 1":
    ("plate_cylinder_meshed", ["mesh.order=1", f"mesh.parameters={{{FINE}, cylinder: 1}}", SMOOTH, FREE]),
    "cup, 40 steps, order 2": ("cup_flattening", ["mesh.order=2", "stepping.control=fixed"]),
    "cup, N_c = 5, order 2": ("cup_flattening", ["mesh.order=2"]),
    "cup, 40 steps, order 1":
    ("cup_flattening", ["mesh.order=1", "mesh.parameters.n_arc=120", "stepping.control=fixed"]),
    "cup, N_c = 5, order 1": ("cup_flattening", ["mesh.order=1", "mesh.parameters.n_arc=120"]),
    "pipe 12x5, order 2":
    pipe(2, 12, 5),
    "pipe 18x8, order 2":
    pipe(2, 18, 8),
    "pipe 24x10, order 2":
    pipe(2, 24, 10),
    "pipe 24x10, order 1":
    pipe(1, 24, 10),
}
# what a scene shows, with the digits it is worth
SHOWN = {
    "plate_cylinder": ("tip_uy", "cylinder_fx", "peak_pressure"),
    "plate_cylinder_meshed": ("tip_uy", "cylinder_fx", "peak_pressure"),
    "cup_flattening": ("plane_force", "contact_radius"),
    "pipe_pinch": ("plate_force", "crown_gap")
}
COLUMNS = ("case", "formulation", "status", "steps", "steps_failed", "newton_iterations", "cpu_s", "contact_s",
           "outside_window", "penetration_over_max", "results")


def record(args, case, formulation):
    """One run, as a row of the CSV file. formulation: of FORMULATIONS or OFFSETS."""
    scene, overrides = CASES[case]
    directory = args.out / formulation
    shutil.rmtree(directory, ignore_errors=True)
    command = [str(args.burnish), str(ROOT / "runs" / f"{scene}.yaml"), "-quiet", "-o", str(directory)]
    chosen = [f"contact.0.formulation={formulation}"] if formulation in FORMULATIONS else [
        "contact.0.formulation=surface_to_surface", f"contact.0.offset={formulation}"
    ]
    for override in (*overrides, "output.every=0", *chosen):
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    if finished.returncode not in (0, 2):  # 2: did not converge; the summary says how far it came
        sys.exit(f"{' '.join(command)}\n{finished.stdout}")
    summary = json.loads((directory / "summary.json").read_text())
    window, seconds = summary["contact"][0]["penalty"], summary["seconds"]
    row = {
        "case": case,
        "formulation": formulation,
        "results": " ".join(f"{summary['probes'][name]:.6g}" for name in SHOWN[scene]),
        "cpu_s": round(summary["cpu_s"], 2),
        "contact_s": round(seconds["search"] + seconds["fit"] + seconds["assembly_contact"], 2)
    }
    if FREE not in overrides and scene.startswith("plate"):
        row.update(outside_window=window["outside_window"], penetration_over_max=f"{window['largest_excess']:.4g}")
    return row | {name: summary[name] for name in ("status", "steps", "steps_failed", "newton_iterations")}


def table(rows, formulations):
    print(
        "| scene | iterations (steps, failed) | CPU s | outside the window | results: "
        f"{' | '.join(name.replace('_', ' ') for name in formulations)} |\n|"
        + " --- |" * 6)
    for case in dict.fromkeys(row["case"] for row in rows):
        pair = [
            next((row for row in rows if (row["case"], row["formulation"]) == (case, formulation)),
                 None) for formulation in formulations
        ]
        if None in pair:
            continue
        counts = " / ".join(f"{row['newton_iterations']} ({row['steps']}, {row['steps_failed']})" +
                            ("" if row["status"] == "done" else " stopped") for row in pair)
        more = 100 * (int(pair[1]["newton_iterations"]) / int(pair[0]["newton_iterations"]) - 1)
        print(
            f"| {case} | {counts}: {more:+.0f} % | {float(pair[0]['cpu_s']):.1f} / {float(pair[1]['cpu_s']):.1f} | "
            f"{' / '.join(row['outside_window'] or '-' for row in pair)} | "
            f"{pair[0]['results']} | {pair[1]['results']} |")


def main():
    parser = table_parser(__doc__, "formulations", "paper_formulations")
    parser.add_argument("cases", nargs="*", metavar="CASE", help=f"beginnings of: {'; '.join(CASES)}. Default: all")
    parser.add_argument("--offsets", action="store_true", help="held against live offsets instead")
    args = parser.parse_args()
    formulations = OFFSETS if args.offsets else FORMULATIONS
    wanted = [
        case for case in CASES if not args.only_print and (not args.offsets or case.startswith("pipe")) and (
            not args.cases or case.startswith(tuple(args.cases)))
    ]
    for case in wanted:
        replace_records(args.record, COLUMNS, case, [record(args, case, formulation) for formulation in formulations])
    table(read_records(args.record), formulations)


if __name__ == "__main__":
    main()
