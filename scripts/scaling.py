"""How time and memory grow: scenes with contact, meshes from 1e4 unknowns on, 1 and 2 ranks, direct and iterative solver. Raw records of every run go to
a CSV file; tables and a plot are made from there (make bench).
    scaling.py [--burnish BINARY] [--large] [--out DIR] [--record FILE] [CASE ...]     runs, prints, plots
    scaling.py --table FILE                                                          prints and plots only
--large adds 3e5 and 1e6 unknowns. A CASE is a part of a run's name: "ring_in_ring_3d 30 iterative". CPU seconds are summed over the ranks, meshing apart.
Those of a phase are its share of the wall time: on a busy machine wall times mean little."""
import argparse
import csv
import math
import pathlib
import shlex
import shutil
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from launch import command, environment, read_summary

ROOT = pathlib.Path(__file__).resolve().parent.parent
PHASES = ("setup", "search", "fit", "assembly_elastic", "assembly_contact", "solve", "output")
CONTACT = ("search", "fit", "assembly_contact")
COLUMNS = ("scene", "size", "solver", "ranks", "dofs", "status", "newton_iterations", "krylov_iterations", "cpu_s", "wall_s", "peak_rss_mb", "contact_nodes",
           "imbalance_cells", "imbalance_contact", *(f"seconds_{phase}" for phase in PHASES))
SMALL, LARGE = 3, 5  # sizes run without and with --large: 1e4, 3e4 and 1e5 unknowns, 3e5 and 1e6
SOLVERS = ("direct", "iterative")
RANKS = (1, 2)
COMMON = ("output.every=0", "kinematics=small", "stepping.initial=1")


def ring(n):
    """Faces around the inner ring; the outer ring's elements are smaller."""
    return f"mesh.parameters={{n_inner: {n}, n_outer: {5 * n // 4}, n_len: {n // 3}}}"


def blocks(n):
    """As high as there are faces along a side, so that all elements are cubes."""
    return f"mesh.parameters={{n_lower: {n}, n_upper: {5 * n // 4}, n_height: {n // 2}, jitter: 0.25}}"


SCENES = {"ring_in_ring_3d": (ring, (20, 30, 48, 70, 100)), "patch_blocks": (blocks, (14, 20, 30, 44, 64))}


def solve(args, scene, size, solver, ranks):
    """One run, as a row of the CSV file."""
    mesh, _ = SCENES[scene]
    directory = args.out / "run"
    shutil.rmtree(directory, ignore_errors=True)
    line = command(args.burnish, ranks, ROOT / "runs" / f"{scene}.yaml", directory, (*COMMON, mesh(size), f"solver.type={solver}"), "-quiet")
    finished = subprocess.run([*args.launcher, *line], cwd=ROOT, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if finished.returncode not in (0, 2):  # 2: did not converge; the summary says so
        print(f"{' '.join(line)}\n{finished.stdout}", file=sys.stderr)
        return {"scene": scene, "size": size, "solver": solver, "ranks": ranks, "status": f"exit {finished.returncode}"}
    summary = read_summary(directory)
    row = {"scene": scene, "size": size, "solver": solver}
    for name in COLUMNS:
        if name.startswith("seconds_"):
            row[name] = summary["seconds"][name.removeprefix("seconds_")]
        elif name.startswith("imbalance_"):
            row[name] = summary["partition"][name]
        elif name not in row:
            row[name] = summary[name]
    return row


def measure(args):
    """All runs, small ones first; returns the CSV file."""
    path = args.record or args.out / "scaling.csv"
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        for i in range(LARGE if args.large else SMALL):
            for scene, (_, sizes) in SCENES.items():
                for solver in SOLVERS:
                    for ranks in RANKS:
                        name = f"{scene} {sizes[i]} {solver} {ranks}"
                        if args.case and not any(case in name for case in args.case):
                            continue
                        row = solve(args, scene, sizes[i], solver, ranks)
                        writer.writerow(row)
                        file.flush()
                        print(f"{name}: {row['status']}, {row.get('dofs')} dofs, {row.get('cpu_s')} s", file=sys.stderr)
    return path


# Tables and plot


def seconds(row, *phases):
    """CPU seconds of phases, over all ranks."""
    return sum(row[f"seconds_{phase}"] for phase in phases) * row["cpu_s"] / row["wall_s"]


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


def runs_table(lines):
    head("scene", "solver", "ranks", "dofs", "Newton", "Krylov a solve", "CPU s", "wall s", "contact, %", "MB a rank", "imbalance: cells, contact",
         "speed-up")
    for (scene, solver, ranks), rows in lines.items():
        for row in rows:
            alone = [other for other in lines.get((scene, solver, 1), []) if other["dofs"] == row["dofs"]]
            speed = f"{alone[0]['wall_s'] / row['wall_s']:.2f}" if alone and ranks > 1 else ""
            share = 100 * seconds(row, *CONTACT) / row["cpu_s"]
            krylov = row["krylov_iterations"] / row["newton_iterations"]
            print_row(scene, solver, ranks, f"{row['dofs']:.0f}", f"{row['newton_iterations']:.0f}", f"{krylov:.1f}", f"{row['cpu_s']:.1f}",
                      f"{row['wall_s']:.1f}", f"{share:.1f}", f"{row['peak_rss_mb']:.0f}",
                      f"{row['imbalance_cells']:.2f}, {row['imbalance_contact']:.2f}", speed)



def exponents_table(lines):
    print("\nGrowth exponents of CPU seconds over dofs, and of the Krylov iterations of a solve\n")
    head("scene", "solver", "ranks", "dofs", "whole run", "solver part", "contact", "all but the solver", "Krylov")
    rest = [phase for phase in PHASES if phase not in ("solve", "output")]
    costs = (lambda row: row["cpu_s"], lambda row: seconds(row, "solve"), lambda row: seconds(row, *CONTACT), lambda row: seconds(row, *rest),
             lambda row: row["krylov_iterations"] / row["newton_iterations"])
    for (scene, solver, ranks), rows in lines.items():
        if len(rows) > 1:
            print_row(scene, solver, ranks, f"{rows[0]['dofs']:.0f} to {rows[-1]['dofs']:.0f}", *(f"{exponent(rows, cost):.2f}" for cost in costs))


def plot(lines, path):
    """Phases against dofs, one rank: a picture for each scene and solver."""
    kept = {(scene, solver): rows for (scene, solver, ranks), rows in lines.items() if ranks == 1}
    figure, axes = plt.subplots(1, len(kept), figsize=(4 * len(kept), 4), sharey=True, squeeze=False)
    groups = {"solve": ("solve",), "contact": CONTACT, "elastic": ("assembly_elastic",), "setup": ("setup",)}
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
parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / "bench" / "scaling")
parser.add_argument("--record", type=pathlib.Path, help="raw records (default: scaling.csv in --out)")
parser.add_argument("--launcher", type=shlex.split, default=[], help="command put before each run: a queue, taskset, nice")
parser.add_argument("--table", type=pathlib.Path, help="raw records to print, nothing is run")
args = parser.parse_args()
args.burnish, args.out = args.burnish.resolve(), args.out.resolve()
args.out.mkdir(parents=True, exist_ok=True)
found = read(args.table or measure(args))
runs_table(found)
exponents_table(found)
if any(ranks == 1 for _, _, ranks in found):
    plot(found, (args.table or args.record or args.out / "scaling.csv").with_suffix(".png"))
