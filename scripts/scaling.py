"""How time and memory grow: scenes with contact, meshes from 1e4 unknowns on, 1 and 2 ranks, direct and iterative
solver. Raw records of every run go to a CSV file; tables and a plot are made from there (make bench).
    scaling.py [--burnish BINARY] [--large] [--largest] [--out DIR] [--record FILE [--add]] [CASE ...]
                                                                                     runs, prints and plots
    scaling.py --table FILE                                                          prints and plots only
--large adds 3e5 unknowns, and 1e6 iterative; --largest the rings with 4e6 unknowns too, which take 16 GB and some 20
minutes. A CASE is a part of a run's name: "ring_in_ring_3d 30 iterative"; --add
keeps the record's other runs. CPU seconds are summed over the ranks, meshing apart. Those of a phase are its share of
the wall time: on a busy machine wall times mean little. Bandwidth: what as many processes as ranks together read and
write in one array's sum of two others, just before the run."""
import argparse
import csv
import math
import pathlib
import shlex
import shutil
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

from launch import command, environment, read_summary

ROOT = pathlib.Path(__file__).resolve().parent.parent
PHASES = ("setup", "search", "fit", "assembly_elastic", "assembly_contact", "solve", "output")
CONTACT = ("search", "fit", "assembly_contact")
COLUMNS = ("scene", "size", "solver", "ranks", "dofs", "status", "newton_iterations", "krylov_iterations", "cpu_s",
           "wall_s", "peak_rss_mb", "contact_nodes", "imbalance_cells", "imbalance_contact",
           *(f"seconds_{phase}" for phase in PHASES), "bandwidth_gb_s")
SMALL, LARGE, LARGEST = 3, 5, 6  # sizes run without and with --large and --largest: 1e4 to 1e5 unknowns, 1e6, 4e6
SOLVERS = ("direct", "iterative")
RANKS = (1, 2)
DIRECT_SIZES = 4  # of the sizes: a factor of 1e6 unknowns takes 20 GB and half an hour
FROM = 9e4  # unknowns from which on exponents are told once more
STREAM_DOUBLES, STREAM_SECONDS = 8_000_000, 0.5  # arrays far above any cache
COMMON = ("output.every=0", "kinematics=small", "stepping.initial=1")


def ring(n):
    """Faces around the inner ring; the outer ring's elements are smaller."""
    return f"mesh.parameters={{n_inner: {n}, n_outer: {5 * n // 4}, n_len: {n // 3}}}"


def blocks(n):
    """As high as there are faces along a side, so that all elements are cubes."""
    return f"mesh.parameters={{n_lower: {n}, n_upper: {5 * n // 4}, n_height: {n // 2}, jitter: 0.25}}"


def sphere(n):
    return f"mesh.parameters={{n_inner: {n}, n_outer: {5 * n // 4}, jitter: 0}}"


# Scene, values that it is run with, mesh and its sizes. Contact along an axis (blocks) and across all of them; node to
# surface, and surface to surface (blocks, and the rings once more).
RINGS = (ring, (20, 30, 48, 70, 100, 160))
SCENES = {
    "ring_in_ring_3d": ("ring_in_ring_3d", (), *RINGS),
    "ring_in_ring_3d_surface": ("ring_in_ring_3d", ("contact.0.formulation=surface_to_surface",), *RINGS),
    "spheres": ("spheres", (), sphere, (8, 12, 18, 26, 38)),
    "patch_blocks": ("patch_blocks", (), blocks, (14, 20, 30, 44, 64)),
}


def stream(_):
    """Bytes a second that this process reads and writes."""
    a, b, c = (numpy.ones(STREAM_DOUBLES) for _ in range(3))
    times, begin = 0, time.perf_counter()
    while time.perf_counter() - begin < STREAM_SECONDS:
        numpy.add(b, c, out=a)
        times += 1
    return times * 3 * a.nbytes / (time.perf_counter() - begin)


def bandwidth(processes):
    """Of so many at a time, together, GB/s."""
    with ProcessPoolExecutor(processes) as pool:
        return round(sum(pool.map(stream, range(processes))) / 1e9, 2)


def solve(args, scene, size, solver, ranks):
    """One run, as a row of the CSV file."""
    file, values, mesh, _ = SCENES[scene]
    speed = bandwidth(ranks)
    directory = args.out / "run"
    shutil.rmtree(directory, ignore_errors=True)
    line = command(args.burnish, ranks, ROOT / "runs" / f"{file}.yaml", directory,
                   (*COMMON, *values, mesh(size), f"solver.type={solver}"), "-quiet")
    finished = subprocess.run([*args.launcher, *line], cwd=ROOT, env=environment(args.burnish), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
    if finished.returncode not in (0, 2):  # 2: did not converge; the summary says so
        print(f"{' '.join(line)}\n{finished.stdout}", file=sys.stderr)
        return {"scene": scene, "size": size, "solver": solver, "ranks": ranks, "status": f"exit {finished.returncode}"}
    summary = read_summary(directory)
    row = {"scene": scene, "size": size, "solver": solver, "bandwidth_gb_s": speed}
    for name in COLUMNS:
        if name.startswith("seconds_"):
            row[name] = summary["seconds"][name.removeprefix("seconds_")]
        elif name.startswith("imbalance_"):
            row[name] = summary["partition"][name]
        elif name not in row:
            row[name] = summary[name]
    return row


def cases(args):
    """(scene, size, solver, ranks) of the runs asked for, small ones first."""
    for i in range(LARGEST if args.largest else LARGE if args.large else SMALL):
        for scene, (*_, sizes) in ((scene, case) for scene, case in SCENES.items() if i < len(case[-1])):
            for solver in SOLVERS:
                for ranks in RANKS:
                    name = f"{scene} {sizes[i]} {solver} {ranks}"
                    asked = not args.case or any(case in name for case in args.case)
                    if asked and (solver == "iterative" or i < DIRECT_SIZES):
                        yield scene, sizes[i], solver, ranks


def measure(args):
    """Runs into the CSV file, which grows as they end; returns it."""
    path, asked, kept = args.record or args.out / "scaling.csv", list(cases(args)), []
    if args.add and path.exists():
        with open(path, newline="") as file:
            kept = [
                row for row in csv.DictReader(file)
                if (row["scene"], int(row["size"]), row["solver"], int(row["ranks"])) not in asked
            ]
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(kept)
        for case in asked:
            row = solve(args, *case)
            writer.writerow(row)
            file.flush()
            print(f"{' '.join(map(str, case))}: {row['status']}, {row.get('dofs')} dofs, {row.get('cpu_s')} s",
                  file=sys.stderr)
    return path


# Tables and plot


def wall(row):
    """Wall seconds without meshing, which only the first run of a mesh does: those of all phases."""
    return sum(row[f"seconds_{phase}"] for phase in PHASES)


def seconds(row, *phases):
    """CPU seconds of phases, over all ranks."""
    return sum(row[f"seconds_{phase}"] for phase in phases) * row["cpu_s"] / wall(row)


def read(path):
    """{(scene, solver, ranks): rows that ended, by size}."""
    lines = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if row["status"] == "done":
                row.update({name: float(row[name]) for name in COLUMNS if name not in ("scene", "solver", "status")})
                lines.setdefault((row["scene"], row["solver"], int(row["ranks"])), []).append(row)
    return {key: sorted(rows, key=lambda row: row["dofs"]) for key, rows in lines.items()}


def exponent(rows, cost):
    """Slope of log cost over log dofs, least squares."""
    x, y = [math.log(row["dofs"]) for row in rows], [math.log(cost(row)) for row in rows]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def print_row(*cells):
    print(f"| {' | '.join(str(cell) for cell in cells)} |")


def head(*names):
    print_row(*names)
    print_row(*("---" for _ in names))


def contact_share(row):
    return 100 * seconds(row, *CONTACT) / row["cpu_s"]


def krylov(row):
    """Iterations of a linear solve."""
    return row["krylov_iterations"] / row["newton_iterations"]


def runs_table(lines):
    head("scene", "solver", "ranks", "dofs", "Newton", "Krylov a solve", "CPU s", "wall s",
         *(f"{phase}, %" for phase in ("set-up", "elastic", "contact", "solve", "output")),
         "MB a rank", "imbalance: cells, contact", "bandwidth, GB/s", "speed-up")
    for (scene, solver, ranks), rows in lines.items():
        for row in rows:
            alone = [other for other in lines.get((scene, solver, 1), []) if other["dofs"] == row["dofs"]]
            speed = f"{wall(alone[0]) / wall(row):.2f}" if alone and ranks > 1 else ""
            shares = (100 * seconds(row, *phases) / row["cpu_s"]
                      for phases in (("setup",), ("assembly_elastic",), CONTACT, ("solve",), ("output",)))
            print_row(scene, solver, ranks, f"{row['dofs']:.0f}", f"{row['newton_iterations']:.0f}",
                      f"{krylov(row):.1f}", f"{row['cpu_s']:.1f}", f"{wall(row):.1f}",
                      *(f"{share:.1f}" for share in shares), f"{row['peak_rss_mb']:.0f}",
                      f"{row['imbalance_cells']:.2f}, {row['imbalance_contact']:.2f}", f"{row['bandwidth_gb_s']:.1f}",
                      speed)


def exponents_table(lines):
    print(
        f"\nGrowth exponents of CPU seconds and memory over dofs, of all sizes and of those from {FROM:.0e} on; growth "
        "of contact's share (points) and of "
        "the Krylov iterations of a solve from the first to the last\n")
    head("scene", "solver", "ranks", "dofs", "whole run", "solver part", "set-up", "contact", "elastic",
         "all but the solver", "memory", "contact's share", "Krylov")
    costs = (lambda row: row["cpu_s"], lambda row: seconds(row, "solve"), lambda row: seconds(row, "setup"),
             lambda row: seconds(row, *CONTACT), lambda row: seconds(row, "assembly_elastic"),
             lambda row: row["cpu_s"] - seconds(row, "solve"), lambda row: row["peak_rss_mb"])
    for (scene, solver, ranks), rows in lines.items():
        large = [row for row in rows if row["dofs"] >= FROM]
        for some in (rows, large) if len(large) < len(rows) else (rows,):
            if len(some) > 1:
                print_row(scene, solver, ranks, f"{some[0]['dofs']:.0f} to {some[-1]['dofs']:.0f}",
                          *(f"{exponent(some, cost):.2f}" for cost in costs),
                          *(f"{of(some[-1]) - of(some[0]):+.1f}" for of in (contact_share, krylov)))


def speed_table(lines):
    """Phases that gain from ranks: their CPU seconds over all ranks stay; those that grow are done by each rank, or
    wait."""
    print(
        "\nSpeed-up of the phases on several ranks (wall seconds of 1 rank over those of all: on an idle machine "
        "only), and of the memory's bandwidth\n"
    )
    head("scene", "solver", "ranks", "dofs", *PHASES, "whole run", "bandwidth")
    for (scene, solver, ranks), rows in lines.items():
        for row in rows if ranks > 1 else ():
            for alone in (other for other in lines.get((scene, solver, 1), []) if other["dofs"] == row["dofs"]):
                gains = (alone[f"seconds_{phase}"] / row[f"seconds_{phase}"] if row[f"seconds_{phase}"] else 1
                         for phase in PHASES)
                print_row(scene, solver, ranks, f"{row['dofs']:.0f}", *(f"{gain:.2f}" for gain in gains),
                          f"{wall(alone) / wall(row):.2f}", f"{row['bandwidth_gb_s'] / alone['bandwidth_gb_s']:.2f}")


def plot(lines, path):
    """Phases against dofs, one rank: a picture for each scene and solver."""
    kept = {(scene, solver): rows for (scene, solver, ranks), rows in lines.items() if ranks == 1}
    figure, axes = plt.subplots(1, len(kept), figsize=(4 * len(kept), 4), sharey=True, squeeze=False)
    groups = {
        "solve": ("solve",),
        "contact": CONTACT,
        "elastic": ("assembly_elastic",),
        "setup": ("setup",),
        "output": ("output",)
    }
    for axis, ((scene, solver), rows) in zip(axes[0], kept.items()):
        dofs = [row["dofs"] for row in rows]
        axis.loglog(dofs, [row["cpu_s"] for row in rows], "k-", label="whole run")
        for name, phases in groups.items():
            axis.loglog(dofs, [seconds(row, *phases) for row in rows], "o-", label=name)
        axis.loglog(dofs, [rows[0]["cpu_s"] * n / dofs[0] for n in dofs], ":", color="grey", label="linear")
        axis.set(title=f"{scene}, {solver}", xlabel="dofs")
    axes[0][0].set_ylabel("CPU seconds, 1 rank")
    axes[0][0].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=80)


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("case", nargs="*", metavar="CASE")
parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build" / "burnish")
parser.add_argument("--large", action="store_true")
parser.add_argument("--largest", action="store_true")
parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "bench" / "scaling")
parser.add_argument("--record", type=pathlib.Path, help="raw records (default: scaling.csv in --out)")
parser.add_argument("--add", action="store_true", help="keep what else is in the record")
parser.add_argument("--launcher", type=shlex.split, default=[],
                    help="command put before each run: a queue, taskset, nice")
parser.add_argument("--table", type=pathlib.Path, help="raw records to print, nothing is run")
args = parser.parse_args()
args.burnish, args.out = args.burnish.resolve(), args.out.resolve()
args.out.mkdir(parents=True, exist_ok=True)
found = read(args.table or measure(args))
runs_table(found)
exponents_table(found)
if any(ranks > 1 for _, _, ranks in found):
    speed_table(found)
if any(ranks == 1 for _, _, ranks in found):
    plot(found, (args.table or args.record or args.out / "scaling.csv").with_suffix(".png"))
