"""The section of doc/pages/performance.md on what accuracy costs shows the committed records: each row of its tables is
one of theirs, each number of its text stands there or in the studies' own files, and the tables beside the records are
made of them."""
import re
import sys

from harness import Check, arguments, SCENES

ROOT = SCENES.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import study  # noqa: E402

RECORDS, STUDIES = ROOT / "runs/records/study", sorted((ROOT / "runs/studies").glob("*.args"))
NUMBER = r"\d+(?:\.\d+)?(?:e-?\d+)?"


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def is_part(row, line):
    """Does the line have all cells of the row, in their order?"""
    rest = iter(cells(line))
    return all(any(cell == other for other in rest) for cell in row)


def section(title):
    text = (ROOT / "doc/pages/performance.md").read_text()
    return text[text.index(f"\n## {title}") + 1 :].split("\n## ")[0].splitlines()


arguments()
check, told = Check(), []
for path in STUDIES:
    one = study.Study(study.arguments([f"@{path}", "--print", "--out", str(RECORDS)]))
    records = study.read_records(one)
    told.append(study.tell(one, study.tabulate(one, records)))
    runs = len(one.cases) * one.options.repeats
    complete = len(records) == runs and all(record["case"] in one.cases for record in records)
    check.holds(f"{path.name}: a record of each run", complete, f"{len(records)} of {runs}")
    check.holds(f"{path.name}: the tables beside it are its own", (RECORDS / f"{one.name}.md").read_text() == told[-1])
text = "\n".join([*told, *(path.read_text() for path in STUDIES)])
rows, numbers = [line for line in text.splitlines() if line.startswith("|")], set(re.findall(NUMBER, text))
for line in section("What accuracy costs"):
    if line.startswith("| "):
        check.holds(f"a row of the records: {line}", "![" in line or any(is_part(cells(line), row) for row in rows))
    else:
        words = re.sub(r"`[^`]*`|\]\([^)]*\)|\(runs[^)]*\)", "", line)
        missing = [number for number in re.findall(NUMBER, words) if number not in numbers]
        check.holds(f"numbers of the records: {line[:80]}", not missing, ", ".join(missing))
check.finish()
