"""scripts/compare_calculix.py: the rows of doc/pages/performance.md are those of the committed record, a missing ccx is
one message, and where ccx is there it solves the input."""
import csv
import pathlib
import shutil
import subprocess
import sys

from harness import Check, arguments, SCENES

ROOT = SCENES.parent.parent
RECORD = ROOT / "runs" / "records" / "calculix.csv"


def call(*options):
    line = [sys.executable, ROOT / "scripts/compare_calculix.py", "--burnish", args.burnish, *options]
    return subprocess.run(line, cwd=ROOT, capture_output=True, text=True)


args, check = arguments(), Check()
out = pathlib.Path(args.out)
shutil.rmtree(out, ignore_errors=True)
printed = set(call("--table", RECORD).stdout.splitlines())
page = (ROOT / "doc/pages/performance.md").read_text().splitlines()
rows = [line for line in page if "| calculix |" in line or "| burnish |" in line]
wrong = [line for line in rows if line not in printed]
check.holds(f"{len(rows)} rows of the page are the record's", rows and not wrong, "\n".join(wrong))
missing = call("--ccx", "no-such-program", "--out", out)
check.holds("a missing ccx: exit 1, one message", missing.returncode == 1 and len(missing.stderr.splitlines()) == 1
            and "calculix-ccx" in missing.stderr, missing.stderr)
if shutil.which("ccx"):
    solved = call("--repeats", "1", "--out", out, "--record", out.parent / f"{out.name}.csv", "calculix CAX4, 10 steps",
                  "burnish enhanced, steps by contact, 120x3")
    check.holds("both codes solve the cup", solved.returncode == 0, solved.stderr)
    for row in csv.DictReader(open(out.parent / f"{out.name}.csv", newline="")):
        check.holds(f"{row['code']}: within 0.2 % of the reference", row["status"] == "done"
                    and abs(float(row["error"])) < 0.2, row["error"])
check.finish()
