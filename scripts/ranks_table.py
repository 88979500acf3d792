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

from launch import ROOT, command, environment, read_records, read_summary, table_parser

RANKS, FITTED, CHECKED = (1, 2, 4, 8, 16, 32), (2, 4, 8), (16, 32)
SIZE, LARGE = 48, 100  # faces around the inner ring: 1.2e5 and 1e6 unknowns
SUPPORT = 40  # master nodes to which a slave node is coupled with a smooth surface of degree 4
PARTS = ROOT / "runs/records/ranks_parts.csv"
OVERRIDES = ("kinematics=small", "stepping.initial=1", "output.every=0", "solver.type=iterative",
             "solver.tolerance=1e-10")
COLUMNS = ("program", "ranks", "dofs", "status", "newton", "krylov", "applied", "tangents", "cpu_s", "wall_s", "setup_s",
           "krylov_s", "tangent_s", "imbalance_cells", "imbalance_contact", "slave_points", "fits", "messages",
           "most_messages", "bytes", "most_bytes", "reductions", "sweep_messages", "newton_messages",
           "newton_bytes", "newton_reductions", "mean_pressure", "noise_rms")
# The network of the model
LATENCY, BANDWIDTH = 2e-6, 1e9  # seconds of a message; bytes a second of each rank
WEAK = 30000  # unknowns of each rank where the mesh grows with the ranks
LAST = 4096
HALVES, TURNS = 8, 4  # half sweeps of the finest level in an iteration; exchanges of a coarse level


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
    row = {"applied": applied, "tangents": tangents, "krylov_s": log.of(step, "KSPSolve", "Time")[1],
           "tangent_s": log.of(step, "PCSetUp", "Time")[1]}
    for name, column in (("messages", "Num Messages"), ("bytes", "Message Length"), ("reductions", "Num Reductions")):
        mean, most = log.of(step, "KSPSolve", column)
        whole = log.of(step, "summary", column)[0] + log.of("MG Apply", "summary", column)[0]
        row[name], row[f"newton_{name}"] = mean / applied, (whole - mean) / tangents
        if name != "reductions":
            row[f"most_{name}"] = most / applied
    row["sweep_messages"] = log.of("MG Apply", finest(log), "Num Messages")[0] / applied
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
           "krylov": summary["krylov_iterations"], "setup_s": summary["seconds"]["setup"]}
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
        rows = [old for old in read_records(args.record) if (old["program"], int(old["ranks"])) != (args.program, ranks)]
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
