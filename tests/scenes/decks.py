"""scripts/deck_table.py: the tables of doc/pages/verification.md are those of the committed record; a missing ccx is
one message; where ccx is there, a deck of two blocks over two steps, as it is and on the refined mesh, and decks of Debian's
package calculix-ccx-test, where that is there too, have CalculiX's displacements and contact forces within 1 %."""
import csv
import pathlib
import shutil
import subprocess
import sys

from harness import Check, arguments, SCENES

ROOT = SCENES.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
from deck_table import FOLDER  # noqa: E402


def call(*options):
    line = [sys.executable, ROOT / "scripts/deck_table.py", "--burnish", args.burnish, "--out", out, *options]
    return subprocess.run([str(word) for word in line], capture_output=True, text=True)


def compare(decks, *names):
    record = out.parent / f"{out.name}.csv"
    finished = call("--decks", decks, "--record", record, *(word for name in names for word in ("--deck", name)))
    rows = list(csv.DictReader(open(record, newline=""))) if finished.returncode == 0 else []
    check.holds(f"{' '.join(names)}: compared", {row["deck"] for row in rows} == set(names), finished.stderr[-500:])
    for row in rows:
        if row["comparison"] in ("same mesh", "both refined"):
            check.holds(f"{row['deck']}, {row['comparison']}: within 1 %", row["status"] == "done" and
                        all(float(row[key]) < 1 for key in ("displacement", "force")), f"{row}")


args, check = arguments(), Check()
out = pathlib.Path(args.out).resolve()
shutil.rmtree(out, ignore_errors=True)
printed = set(call("--print", "--record", ROOT / "runs/records/decks.csv").stdout.splitlines())
page = (ROOT / "doc/pages/verification.md").read_text().splitlines()
lacking = [line for line in printed if line.startswith("| `") and line not in page]
check.holds(f"{len(printed)} lines of the record's tables are the page's", printed and not lacking, "\n".join(lacking))
missing = call("--ccx", "no-such-program", "--decks", SCENES, "--deck", "deck_blocks", "--record", out / "none.csv")
check.holds("a missing ccx: exit 1, one message", missing.returncode == 1 and "calculix-ccx" in missing.stderr,
            missing.stderr)
if shutil.which("ccx"):
    compare(SCENES, "deck_blocks")
    if pathlib.Path(FOLDER).exists():
        compare(FOLDER, "cubespring", "friction1", "changefric")
check.finish()
