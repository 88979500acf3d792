"""pipe_pinch with facets and with the diffuse smoother: same mesh, same steps, three meshes. Raw records of every run
go to a CSV file, the table (iterations, failed steps, CPU seconds) is printed from there:
    smoother_table.py --burnish BINARY [--ranks N] [--repeats N] [--out DIR]     runs and prints smoother_table.py
    --table FILE                                               prints only
Runs of the smoothers alternate, so that whatever else the machine does meets all of them; CPU seconds are medians."""
import argparse
import itertools
import pathlib
import shutil
import statistics
import subprocess
import sys

from launch import ROOT, command, environment, fill_row, read_records, read_summary, write_records

SCENE = ROOT / "runs" / "pipe_pinch.yaml"
MESHES = ((12, 5), (18, 8), (24, 10))  # elements around the quarter, along the length
SMOOTHERS = {
    "facet": ["contact.0.smoother=facet"],
    "diffuse 4": ["contact.0.smoother=diffuse", "contact.0.degree=4"],
    "diffuse 2": ["contact.0.smoother=diffuse", "contact.0.degree=2"],
}
COLUMNS = ("mesh", "smoother", "repeat", "ranks", "dofs", "status", "steps", "steps_failed", "newton_iterations",
           "newton_accepted", "cpu_s", "wall_s", "seconds_search", "seconds_fit", "seconds_assembly_contact",
           "fall_backs", "plate_force", "contact_inner", "crown_gap")
CONTACT_SECONDS = ("seconds_search", "seconds_fit", "seconds_assembly_contact")


def record(args, mesh, repeat, smoother):
    """One run, as a row of the CSV file."""
    n_arc, n_len = mesh
    directory = args.out / f"{n_arc}x{n_len}_{smoother.replace(' ', '_')}"
    shutil.rmtree(directory, ignore_errors=True)
    overrides = (f"mesh.parameters.n_arc={n_arc}", f"mesh.parameters.n_len={n_len}", "output.every=0",
                 *SMOOTHERS[smoother])
    line = command(args.burnish, args.ranks, SCENE, directory, overrides, "-quiet")
    finished = subprocess.run(line, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    if finished.returncode not in (0, 2):  # 2: did not converge; the summary says how far it came
        sys.exit(f"{' '.join(line)}\n{finished.stdout}")
    summary = read_summary(directory)
    return fill_row({"mesh": f"{n_arc}x{n_len}", "smoother": smoother, "repeat": repeat,
                     "fall_backs": summary["contact"][0]["fall_backs"]}, COLUMNS, summary)


def measure(args):
    """All runs; returns the CSV file."""
    args.out.mkdir(parents=True, exist_ok=True)
    path = args.out / "smoothers.csv"
    cases = itertools.product(MESHES, range(args.repeats), SMOOTHERS)
    write_records(path, COLUMNS, lambda case: [record(args, *case)], cases, 1)
    return path


def table(path):
    rows = read_records(path)
    print(
        f"{'mesh':>8} {'dofs':>7} {'smoother':<10} {'steps':>5} {'failed':>6} {'iterations':>10} {'CPU s':>7} "
        f"{'to facet':>8} {'contact':>7} {'wall s':>7} {'plate force':>11}"
    )
    for mesh in dict.fromkeys(row["mesh"] for row in rows):
        base = None
        for smoother in SMOOTHERS:
            runs = [row for row in rows if (row["mesh"], row["smoother"]) == (mesh, smoother)]
            if not runs:
                continue
            cpu, wall = (statistics.median(float(row[name]) for row in runs) for name in ("cpu_s", "wall_s"))
            share = statistics.median(
                sum(float(row[name]) for name in CONTACT_SECONDS) / float(row["wall_s"]) for row in runs)
            base = base or cpu
            first = runs[0]
            print(
                f"{mesh:>8} {first['dofs']:>7} {smoother:<10} {first['steps']:>5} {first['steps_failed']:>6} "
                f"{first['newton_iterations']:>10} {cpu:7.2f} {100 * (cpu / base - 1):+7.1f}% {100 * share:6.1f}% "
                f"{wall:7.2f} {float(first['plate_force']):11.1f}"
            )


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--burnish", type=pathlib.Path, default=pathlib.Path("build/burnish"))
parser.add_argument("--ranks", type=int, default=1)
parser.add_argument("--repeats", type=int, default=5)
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/smoothers"))
parser.add_argument("--table", type=pathlib.Path, help="raw records to print, nothing is run")
args = parser.parse_args()
table(args.table or measure(args))
