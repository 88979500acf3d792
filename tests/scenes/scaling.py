"""scripts/scaling.py (make bench): runs are recorded, and the tables and the plot come from the record."""
import csv
import pathlib
import shutil
import subprocess
import sys

from harness import Check, arguments, SCENES

ROOT = SCENES.parent.parent
args, check = arguments(), Check()
out = pathlib.Path(args.out)
shutil.rmtree(out, ignore_errors=True)
line = [sys.executable, ROOT / "scripts/scaling.py", "--burnish", args.burnish, "--out", out]
finished = subprocess.run([*line, "patch_blocks 14 iterative"], cwd=ROOT, capture_output=True, text=True)
rows = list(csv.DictReader(open(out / "scaling.csv", newline="")))
check.holds("1 and 2 ranks, both done",
            [(row["ranks"], row["status"]) for row in rows] == [("1", "done"), ("2", "done")], finished.stderr)
check.holds("the mesh does not depend on the ranks", len({row["dofs"] for row in rows}) == 1)
check.holds("a plot", (out / "scaling.png").stat().st_size > 5000)
again = subprocess.run([*line, "--table", out / "scaling.csv"], cwd=ROOT, capture_output=True, text=True)
check.holds("the record gives the same tables", again.stdout == finished.stdout, again.stdout)
check.finish()
