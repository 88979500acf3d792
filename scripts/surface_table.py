"""What surface to surface costs beside node to surface, both with the diffuse smoother: same meshes, same steps. Raw
records of every run go to a CSV file, the table (iterations, CPU seconds, ratio) is printed from there:
    surface_table.py [--burnish BINARY ...] [--names NAME ...] [--scenes SCENE ...] [--repeats N] [--out DIR]
    surface_table.py --table FILE     prints only
With several binaries, such as one before a change and one after it, each has its rows. Runs of formulations and
binaries alternate, so that whatever else the machine does meets all of them; CPU seconds are medians."""
import argparse
import itertools
import pathlib
import shutil
import statistics
import subprocess
import sys

from launch import ROOT, command, environment, fill_row, read_records, read_summary, write_records

SCENES = {  # scene in runs, with what is set besides
    "pipe 24x10": ("pipe_pinch.yaml", []),
    "pipe 24x10, friction 0.2": ("pipe_pinch.yaml", ["contact.0.friction={mu: 0.2}"]),
    "plate on a meshed cylinder": ("plate_cylinder_meshed.yaml", [
        "mesh.order=1", "loads.0.pressure=2", "contact.0.penalty.adjust=false",
        "mesh.parameters={h_contact: 0.25, h_far: 3, n_thick: 4, n_width: 8, cylinder: 1, facet: 2, n_cylinder_z: 6}"
    ]),
    "rings": ("ring_in_ring.yaml", []),
    "rings in space": ("ring_in_ring_3d.yaml", []),
    "blocks": ("patch_blocks.yaml", ["mesh.parameters={n_lower: 12, n_upper: 15, jitter: 0}"]),
}
FORMULATIONS = ("node_to_surface", "surface_to_surface")
COLUMNS = ("scene", "binary", "formulation", "repeat", "dofs", "status", "steps", "newton_iterations", "cpu_s",
           "seconds_search", "seconds_fit", "seconds_assembly_contact", "lists_made_anew")


def record(args, scene, repeat, binary, formulation):
    """One run, as a row of the CSV file."""
    file, settings = SCENES[scene]
    directory = args.out / f"{scene}_{formulation}".replace(" ", "_")
    shutil.rmtree(directory, ignore_errors=True)
    overrides = ("output.every=0", "contact.0.smoother=diffuse", f"contact.0.formulation={formulation}", *settings)
    line = command(args.burnish[binary], 1, ROOT / "runs" / file, directory, overrides, "-quiet")
    finished = subprocess.run(line, env=environment(args.burnish[binary]), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
    if finished.returncode not in (0, 2):  # 2: did not converge; the summary says how far it came
        sys.exit(f"{' '.join(line)}\n{finished.stdout}")
    summary = read_summary(directory)
    return fill_row({"scene": scene, "binary": args.names[binary], "formulation": formulation, "repeat": repeat,
                     "lists_made_anew": summary["guards"]["lists_made_anew"]}, COLUMNS, summary)


def measure(args):
    """All runs; returns the CSV file."""
    args.out.mkdir(parents=True, exist_ok=True)
    path = args.out / "surface.csv"
    cases = itertools.product(args.scenes, range(args.repeats), range(len(args.burnish)), FORMULATIONS)
    write_records(path, COLUMNS, lambda case: [record(args, *case)], cases, 1)
    return path


def table(path):
    rows = read_records(path)
    print("| scene | binary | dofs | iterations, node | iterations, surface | CPU s, node | CPU s, surface | ratio |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for scene, binary in dict.fromkeys((row["scene"], row["binary"]) for row in rows):
        runs = [[row for row in rows if (row["scene"], row["binary"], row["formulation"]) == (scene, binary, one)]
                for one in FORMULATIONS]
        if not all(runs):
            continue
        cpu = [statistics.median(float(row["cpu_s"]) for row in some) for some in runs]
        count = [some[0]["newton_iterations"] for some in runs]
        print(f"| {scene} | {binary} | {runs[0][0]['dofs']} | {count[0]} | {count[1]} | {cpu[0]:.2f} | {cpu[1]:.2f} | "
              f"{cpu[1] / cpu[0]:.2f} |")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--burnish", type=pathlib.Path, nargs="+", default=[pathlib.Path("build/burnish")])
parser.add_argument("--names", nargs="+", help="of the binaries, in the table")
parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
parser.add_argument("--repeats", type=int, default=3)
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/surface"))
parser.add_argument("--table", type=pathlib.Path, help="raw records to print, nothing is run")
args = parser.parse_args()
args.names = args.names or [str(path) for path in args.burnish]
if len(args.names) != len(args.burnish):
    parser.error("as many names as binaries")
table(args.table or measure(args))
