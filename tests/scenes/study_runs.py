"""scripts/study.py on a small scene: a run that fails is a row with its cause, jobs of an array gather to the same
table, nothing is run twice."""
import csv
import pathlib
import shutil
import subprocess
import sys

from harness import Check, arguments, SCENES

ROOT = SCENES.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import study  # noqa: E402

SMALL = [
    "runs/ring_in_ring.yaml", "--name", "small", "--vary", "contact.0.smoother=facet,diffuse", "--vary",
    "mesh.parameters.n_inner=8,16", "--set", "mesh.parameters.n_outer=10", "--measure", "mean_pressure/noise_max",
    "--reference", "6.4388", "--repeats", "1"
]
FAILING = [
    "--case", "kind", "good", "solver.max_iterations=30", "--case", "kind", "diverging",
    "solver={type: iterative, max_iterations: 1}", "stepping={dt_min: 0.5, damping: none}", "--case", "kind", "wrong",
    "contact.0.degree=3"
]


def call(name, *more):
    """A study from the command line: its rows of CSV and its text."""
    out = pathlib.Path(args.out) / name
    line = [sys.executable, ROOT / "scripts/study.py", *SMALL, "--burnish", args.burnish, "--out", out, *more]
    finished = subprocess.run(line, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    table = out / "small.csv"
    rows = list(csv.DictReader(open(table, newline=""))) if table.exists() else []
    return finished, rows


def figures(rows):
    """What of the rows does not depend on the clock."""
    return [{name: value for name, value in row.items() if not name.startswith(("CPU", "memory"))} for row in rows]


args, check = arguments(), Check()
shutil.rmtree(args.out, ignore_errors=True)
whole, rows = call("whole")
check.holds("four combinations, all done",
            len(rows) == 4 and all(row["status"] == "done" for row in rows),
            whole.stdout[-300:] if len(rows) != 4 else "")
check.holds("facets are worse",
            float(rows[0]["error, mean_pressure, %"]) > 10 * float(rows[2]["error, mean_pressure, %"]))
check.holds("a plot", (pathlib.Path(args.out) / "whole" / "small.png").stat().st_size > 10000)
again, same = call("whole")
check.holds("nothing is run twice", "[1/" not in again.stdout and same == rows)

for job in ("0,2", "1,2"):
    share, none = call("array", "--job-array", job)
    check.holds(f"job {job}: its half, no tables", share.stdout.count("done") == 2 and not none, share.stdout)
gathered, parts = call("array")
check.holds("jobs gather to the same table", "[1/" not in gathered.stdout and figures(parts) == figures(rows))

failing, rows = call("failing", *FAILING, "--set", "contact.0.smoother=facet")
found = {
    row["kind"]: row
    for row in rows
    if row["smoother"] == "facet" and row["n_inner"] == "n_inner 8"
} if rows else {}
check.holds("a study with runs that fail ends well", failing.returncode == 0,
            failing.stdout[-300:] if failing.returncode else "")
check.holds("one that diverges is a row with its cause",
            found["diverging"]["status"].startswith("not converged: no equilibrium"), found["diverging"]["status"])
check.holds("one that is refused is a row with its cause", "contact.0.degree" in found["wrong"]["status"],
            found["wrong"]["status"])
check.holds("the others are there", found["good"]["status"] == "done")
check.near("richardson: limit of 3 + 2^-k", study.richardson([4, 3.5, 3.25]), 3, 1e-12)
check.holds("richardson: none where values diverge", study.richardson([1, 2, 4]) is None)
series = [{
    "cpu_s": 1.0,
    "errors": {
        "e": 8.0
    }
}, {
    "cpu_s": 10.0,
    "errors": {
        "e": 2.0
    }
}, {
    "cpu_s": 100.0,
    "errors": {
        "e": 0.5
    }
}]
check.near("cost by interpolation in log-log", study.cost(series, "e", 4)[0], 10**0.5, 1e-9)
check.holds(
    "cost beyond the last point",
    study.cost(series, "e", 0.125)[1] == "~" and study.cost(series[:1], "e", 1)[1] == ">"
    and study.cost(series, "e", 9) == (1.0, "<="))
check.finish()
