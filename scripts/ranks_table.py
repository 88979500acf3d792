"""What decides how the iterative solver scales, counted on 2 to 32 ranks, and a model of it for up to 4096 ranks. Rings
in space (runs/ring_in_ring_3d.yaml) are run with PETSc's log; messages, bytes and reductions go into the record, with
how the work is shared and what comes out. Ranks may be more than the machine has cores: counts do not mind. The model
takes the parts of the mesh from METIS (scripts/rankscosts.py), fits its few factors on 2 to 8 ranks, and is checked on
16 and 32.
    ranks_table.py [--burnish BINARY] [--record FILE] [--program NAME] [--only RANKS ...]    runs, prints, plots
    ranks_table.py --parts                       the parts of the mesh, and of one with a million unknowns
    ranks_table.py --print                       prints and plots only
--program names what is run (`now`, or `before` for an older binary); rows of other programs and ranks are kept."""
import csv
import re
import shutil
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

import ranksmodel as model
from launch import ROOT, command, environment, read_records, read_summary, table_parser

RANKS, FITTED, CHECKED = (1, 2, 4, 8, 16, 32), (2, 4, 8), (16, 32)
SIZE, LARGE = 48, 100  # faces around the inner ring: 1.2e5 and 1e6 unknowns
SUPPORT = 40  # master nodes to which a slave node is coupled with a smooth surface of degree 4
PARTS = ROOT / "runs/records/ranks_parts.csv"
OVERRIDES = ("kinematics=small", "stepping.initial=1", "output.every=0", "solver.type=iterative",
             "solver.tolerance=1e-10")
COLUMNS = ("program", "ranks", "dofs", "status", "newton", "krylov", "applied", "tangents", "cpu_s", "wall_s",
           "setup_s", "steps_s", "contact_s", "krylov_s", "sweep_s", "interface_s", "imbalance_cells",
           "imbalance_contact", "slave_points", "fits", "messages", "most_messages", "bytes", "most_bytes",
           "reductions", "sweep_messages", "newton_messages", "newton_bytes", "newton_reductions", "mean_pressure",
           "noise_rms")

def mesh(n):
    return f"mesh.parameters={{n_inner: {n}, n_outer: {5 * n // 4}, n_len: {n // 3}}}"


# Runs


class Log:
    """PETSc's log of a run: sums over the ranks and the largest of them. PETSc counts a message where it is sent and
    where it arrives."""

    def __init__(self, path):
        self.events = {}
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                key = row["Stage Name"], row["Event Name"].strip()
                if float(row["Count"]):
                    self.events.setdefault(key, []).append(row)

    def of(self, stage, event, column):
        """Mean over the ranks, and the largest."""
        values = [float(row[column]) for row in self.events.get((stage, event), [])] or [0]
        half = 2 if column in ("Num Messages", "Message Length") else 1
        return sum(values) / len(values) / half, max(values) / half


def finest(log):
    """Name of the smoother's event on the finest level."""
    names = [event for _, event in log.events if event.startswith("MGSmooth Level")]
    return max(names, key=lambda name: int(name.split()[-1]), default="")


def counts(log):
    """Of a Krylov iteration (one application of the preconditioner) and of a Newton iteration beside these."""
    step = "Load steps"
    applied, tangents = (int(log.of(step, event, "Count")[1]) for event in ("PCApply", "KSPSolve"))
    grid = "MG Apply"
    seconds = {name: log.of(stage, event, "Time")[1] for name, stage, event in (
        ("steps", step, "summary"), ("grid", grid, "summary"), ("apply", step, "PCApply"),
        ("krylov", step, "KSPSolve"), ("sweep", grid, finest(log)))}
    row = {"applied": applied, "tangents": tangents, "krylov_s": seconds["krylov"], "sweep_s": seconds["sweep"],
           "steps_s": seconds["steps"] + seconds["grid"], "interface_s": seconds["apply"] - seconds["grid"]}
    for name, column in (("messages", "Num Messages"), ("bytes", "Message Length"), ("reductions", "Num Reductions")):
        mean, most = log.of(step, "KSPSolve", column)
        whole = log.of(step, "summary", column)[0] + log.of(grid, "summary", column)[0]
        row[name], row[f"newton_{name}"] = mean / applied, (whole - mean) / tangents
        if name != "reductions":
            row[f"most_{name}"] = most / applied
    row["sweep_messages"] = log.of(grid, finest(log), "Num Messages")[0] / applied
    return row


def shares(folder, ranks):
    """Largest over mean of the slave points and of the fits, from the first lists of each rank."""
    found = []
    for rank in range(ranks):
        text = (folder / f"info.{rank}").read_text() if (folder / f"info.{rank}").exists() else ""
        match = re.search(r"(\d+) slave points, (\d+) fits", text)
        if not match:
            return {}
        found.append([int(number) for number in match.groups()])
    of = numpy.array(found)
    return dict(zip(("slave_points", "fits"), of.max(axis=0) / of.mean(axis=0)))


def solve(args, ranks):
    folder = args.out / f"{args.program}-{ranks}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    line = command(args.burnish, ranks, ROOT / "runs/ring_in_ring_3d.yaml", folder / "run", (*OVERRIDES, mesh(SIZE)),
                   "-quiet", "-log_view", f":{folder}/log.csv:ascii_csv", "-bodies_pc_mg_log", "-info",
                   f"{folder}/info:sys")
    subprocess.run(line, env=environment(args.burnish), capture_output=True, check=True)
    summary = read_summary(folder / "run")
    row = {"program": args.program, "ranks": ranks, "newton": summary["newton_iterations"],
           "krylov": summary["krylov_iterations"], "setup_s": summary["seconds"]["setup"],
           "contact_s": sum(summary["seconds"][name] for name in ("search", "fit", "assembly_contact"))}
    row.update(counts(Log(folder / "log.csv")), **shares(folder, ranks))
    for name in COLUMNS:
        for part in (summary, summary["partition"], summary["probes"]):
            if name not in row and name in part:
                row[name] = part[name]
    return {name: f"{value:.10g}" if isinstance(value, float) else value for name, value in row.items()}


def run(args):
    """Runs the ranks asked for; other rows of the record stay."""
    for ranks in args.only:
        row = solve(args, ranks)
        here = args.program, str(ranks)
        rows = [old for old in read_records(args.record) if (old["program"], old["ranks"]) != here]
        with open(args.record, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(sorted([*rows, row], key=lambda r: (r["program"], int(r["ranks"]))))
        print(args.program, ranks, row["status"], flush=True)


def write_parts(args):
    """The features of all numbers of ranks, of the mesh that is run and of the large one."""
    from rankscosts import Mesh, costs
    rows = []
    for size in (SIZE, LARGE):
        folder = args.out / f"parts-{size}"
        folder.mkdir(parents=True, exist_ok=True)
        bench = args.burnish.resolve().parent / "bench/partition"
        subprocess.run([bench, "-write", folder, "runs/ring_in_ring_3d.yaml", "kinematics=small", mesh(size)], cwd=ROOT,
                       env=environment(args.burnish), check=True, capture_output=True)
        found = Mesh(folder, SUPPORT)
        for ranks in found.parts:
            features = costs(found, ranks)
            rows.append({"size": size, "ranks": ranks, "nodes": found.n,
                         **{name: f"{value:.5g}" for name, value in features.items()}})
            print(size, ranks, flush=True)
    with open(PARTS, "w", newline="") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(name for row in rows for name in row)), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


# Tables and plot

NAMES = {"messages": "messages of an iteration", "most_messages": "the same, the rank with the most",
         "bytes": "bytes of an iteration", "most_bytes": "the same, the rank with the most",
         "reductions": "reductions of an iteration", "newton_messages": "messages of a tangent",
         "newton_bytes": "bytes of a tangent", "newton_reductions": "reductions of a tangent",
         "imbalance_cells": "cells, largest over mean", "imbalance_contact": "cells in contact, largest over mean",
         "slave_points": "slave points, largest over mean", "fits": "fits, largest over mean"}


def head(*names):
    print("| " + " | ".join(names) + " |\n|" + " --- |" * len(names))


def load(record):
    """{(program, ranks): run}, {(size, ranks): part}."""
    runs = {(row["program"], int(row["ranks"])): model.numbers(row) for row in read_records(record)}
    parts = {(int(row["size"]), int(row["ranks"])): model.numbers(row) for row in read_records(PARTS)}
    return runs, parts


def fitted(runs, parts):
    return {name: model.fit(name, [runs["now", p] for p in FITTED], [parts[SIZE, p] for p in FITTED])
            for name in NAMES}


def table_runs(runs):
    head("program", "ranks", "Newton iterations", "Krylov iterations", "messages of one", "in sweeps", "kB of one",
         "mean pressure", "its noise, %")
    for (program, ranks), run in runs.items():
        print(f"| {program} | {ranks} | {run['newton']:.0f} | {run['krylov']:.0f} | {run['messages']:.1f} | "
              f"{run['sweep_messages']:.1f} | {run['bytes'] / 1e3:.1f} | {run['mean_pressure']:.8f} | "
              f"{run['noise_rms']:.6f} |")


def table_waiting(parts):
    """What a rank waits in a sweep for its turn."""
    print()
    head("ranks", "colours", "nodes at borders", "nodes with a turn", "waiting in a sweep before", "now")
    for (size, ranks), part in parts.items():
        if size == SIZE and ranks in RANKS:
            print(f"| {ranks} | {part['colours']:.0f} | {100 * part['border']:.0f} % | {100 * part['turn']:.0f} % | "
                  f"{model.waiting(part, True):.2f} | {model.waiting(part):.2f} |")


def table_checks(runs, parts, factors):
    print()
    head("of a rank", *(f"{p} ranks" for p in FITTED), *(f"{p} ranks: model" for p in CHECKED))
    for name, title in NAMES.items():
        cells = [f"{runs['now', p][name]:.4g}" for p in FITTED]
        for p in CHECKED:
            is_, said = runs["now", p][name], model.predict(name, factors, parts[SIZE, p])
            cells.append(f"{is_:.4g}: {said:.4g} ({100 * (said / is_ - 1):+.1f} %)")
        print(f"| {title} | {' | '.join(cells)} |")


def cases(parts):
    """(kind, ranks, features, features of one rank, how many times fewer work one rank has)."""
    large = {ranks: part for (size, ranks), part in parts.items() if size == LARGE}
    unknowns = {ranks: model.FINE * part["nodes"] / ranks for ranks, part in large.items()}
    most = max(ranks for ranks in large if unknowns[ranks] >= model.WEAK)
    for ranks, part in large.items():
        yield "strong", ranks, part, model.alone(part, ranks), ranks
    for ranks in large:
        here = min(ranks, most)
        part = model.scaled(large[here], model.WEAK / unknowns[here])
        one = model.scaled(model.alone(large[here], here), model.WEAK / unknowns[here] / here)
        yield "weak", ranks, model.repeated(part, ranks // here), one, 1


def times(runs, parts, factors):
    """{kind: [(ranks, seconds by cause, efficiency of the whole run, of the steps)]}."""
    rate = model.rates(runs["now", 1])
    interface = parts[SIZE, 2]["own_interface"] * 2
    serial = "first rank alone"
    found = {"strong": [], "weak": []}
    for kind, ranks, part, one, gain in cases(parts):
        first, then = (model.seconds(*case, factors, rate, interface) for case in ((one, 1), (part, ranks)))
        whole = sum(first.values()) / gain / sum(then.values())
        steps = first["work"] / gain / (sum(then.values()) - then[serial])
        found[kind].append((ranks, then, whole, steps))
    return found


def table_times(found):
    for kind, rows in found.items():
        print()
        head(f"ranks, {kind}", "s without the first rank's", "efficiency", "lost most by", "then by",
             "s of the first rank alone", "efficiency of the whole run")
        for ranks, causes, whole, steps in rows:
            lost = sorted((cause for cause in causes if cause not in ("work", "first rank alone")),
                          key=causes.get, reverse=True)[:2]
            rest = sum(causes.values()) - causes["first rank alone"]
            print(f"| {ranks} | {rest:.3g} | {100 * steps:.0f} % | " +
                  " | ".join(f"{cause}, {100 * causes[cause] / rest:.0f} %" for cause in lost) +
                  f" | {causes['first rank alone']:.2g} | {100 * whole:.0f} % |")


def draw(runs, parts, factors, found, path):
    figure, axes = plt.subplots(1, 3, figsize=(13, 4))
    for program, mark in (("before", "s"), ("now", "o")):
        rows = [(p, run) for (name, p), run in runs.items() if name == program and p > 1]
        axes[0].loglog([p for p, _ in rows], [run["messages"] * run["applied"] for _, run in rows], mark,
                       label=f"{program}, counted")
    iterations = runs["now", 1]["applied"]
    for size, line in ((SIZE, "-"), (LARGE, "--")):
        some = sorted(p for s, p in parts if s == size)
        unknowns = model.FINE * parts[size, some[0]]["nodes"]
        axes[0].loglog(some, [iterations * model.predict("messages", factors, parts[size, p]) for p in some], line,
                       label=f"model, {unknowns:.1g} unknowns")
    axes[0].set(title="messages of a rank in all iterations", xlabel="ranks")
    for axis, kind in zip(axes[1:], found):
        ranks = [row[0] for row in found[kind]]
        axis.semilogx(ranks, [100 * row[3] for row in found[kind]], "o-", label="steps")
        axis.semilogx(ranks, [100 * row[2] for row in found[kind]], "s--", label="with the first rank's own work")
        axis.set(title=f"{kind} scaling, model", xlabel="ranks", ylabel="efficiency, %", ylim=(0, 105))
    for axis in axes:
        axis.legend()
        axis.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=80)


def show(record):
    runs, parts = load(record)
    table_runs(runs)
    table_waiting(parts)
    factors = fitted(runs, parts)
    table_checks(runs, parts, factors)
    found = times(runs, parts, factors)
    table_times(found)
    draw(runs, parts, factors, found, record.with_suffix(".png"))


if __name__ == "__main__":
    parser = table_parser(__doc__, "ranks")
    parser.add_argument("--parts", action="store_true", help="finds the parts of the meshes, for the model")
    parser.add_argument("--program", default="now")
    parser.add_argument("--only", type=int, nargs="*", default=RANKS, metavar="RANKS")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    if args.parts:
        write_parts(args)
    elif not args.only_print:
        run(args)
    if not args.parts and read_records(PARTS):
        show(args.record)
