"""Runs the hard cases of cases.py: each with facets and diffuse, node to surface and surface to surface, on 1 and 3
ranks, and compares with the outcome written down there. A row for each case; ends with status 0 when every one is as
expected.
    run.py [--burnish BINARY] [--out DIR] [--group GROUP] [--case TEXT] [--ranks 1 3] [--record FILE.csv] run.py --table
    FILE.csv    prints a record as doc/pages/hardcases.md has it
No run may take longer than LIMIT: an endless loop is a failure like any other."""
import argparse
import csv
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tests/scenes"), str(ROOT / "scripts")]
import cases  # noqa: E402
import expect  # noqa: E402
import harness  # noqa: E402
import launch  # noqa: E402

LIMIT = 120  # s of one run
COLUMNS = ("group", "case", "hard", "smoother", "formulation", "outcome", "as_expected", "steps", "failed",
           "iterations")


def same_probes(one, other, bound):
    """Whether two runs end with the same probes, relative to the largest."""
    ours, theirs = (run.summary()["probes"] for run in (one, other))
    scale = max((abs(value) for value in ours.values() if value is not None), default=1)
    differ = max(((value is None) != (theirs[probe] is None) or abs((value or 0) - (theirs[probe] or 0)) / scale
                  for probe, value in ours.items()), default=0)
    return differ <= bound, f"probes differ by {differ:.1e}"


class Driver:
    def __init__(self, args):
        self.args = args

    def run(self, case, variant, ranks, overrides=(), name="run"):
        smoother, formulation = expect.VARIANTS[variant]
        pair = [
            override for i in range(case.pairs)
            for override in (f"contact.{i}.smoother={smoother}", f"contact.{i}.formulation={formulation}")
        ]
        out = "-".join((case.name.replace(" ", "_").replace("/", "_"), smoother, formulation, f"np{ranks}", name))
        return harness.run(self.args, case.scene, out=out, ranks=ranks, overrides=[*case.overrides, *pair, *overrides],
                           must=None, limit=LIMIT)

    def judge(self, case, variant):
        """Runs a variant on every number of ranks: (as expected, text, first run). Beyond the first number only probes
        and messages are compared."""
        expected = expect.of_variant(case.expected, variant)
        first = text = None
        for ranks in self.args.ranks:
            finished = self.run(case, variant, ranks)
            if finished.status != expected.status:
                lines = finished.text.splitlines()
                said = " ".join([line for line in lines if line.startswith("burnish: ")] or lines[-5:])[:300]
                text = f"exit status {finished.status} instead of {expected.status} on {ranks} ranks: {said}"
                return False, text, first or finished
            if first is None or expected.status != 0:
                holds, said = expected.judge(
                    finished, variant, lambda overrides, ranks=ranks: self.run(case, variant, ranks, overrides, "easy"))
                text = text or said
            else:
                holds, said = same_probes(first, finished, case.ranks)
            if not holds:
                return False, f"{text} on {ranks} ranks: {said}", first or finished
            first = first or finished
        return True, text, first

    def rows(self, case):
        if case.scene is None:  # a kernel test elsewhere
            yield dict(group=case.group, case=case.name, hard=case.hard, smoother="both", formulation="both",
                       outcome=case.expected, as_expected="yes")
            return
        for variant, (smoother, formulation) in enumerate(expect.VARIANTS):
            holds, text, finished = self.judge(case, variant)
            summary = finished.summary() if (finished.directory / "summary.json").exists() else {}
            print(f"{'ok  ' if holds else 'FAIL'} {case.name}: {smoother}, {formulation}: {text}", flush=True)
            yield dict(group=case.group, case=case.name, hard=case.hard, smoother=smoother, formulation=formulation,
                       outcome=text, as_expected="yes" if holds else "no", steps=summary.get("steps"),
                       failed=summary.get("steps_failed"), iterations=summary.get("newton_iterations"))


def pair(texts):
    """Two figures as one text: what comes before them once, and the figure once if alike."""
    if texts[0] == texts[1]:
        return texts[0]
    name = os.path.commonprefix([text.split(" ") for text in texts])
    figures = [" ".join(text.split(" ")[len(name):]) for text in texts]
    return " ".join([*name, " / ".join(figures)]).strip()


def cell(rows):
    """What a smoother did, node to surface then surface to surface."""
    texts = [row["outcome"] + ("" if row["as_expected"] == "yes" else " (not as expected)") for row in rows]
    parts = [text.split(", ") for text in texts]
    return texts[0] if len(set(texts)) == 1 else ", ".join(map(pair, zip(
        *parts))) if len(parts[0]) == len(parts[1]) else " / ".join(texts)


def table(rows):
    """The record as a table of doc/pages/hardcases.md: a figure is node to surface / surface to surface."""
    print("| case | what makes it hard | facet | diffuse |\n| --- | --- | --- | --- |")
    for name in dict.fromkeys(row["case"] for row in rows):
        mine = [row for row in rows if row["case"] == name]
        smoothers = [[row
                      for row in mine
                      if row["smoother"] in (smoother, "both")]
                     for smoother in ("facet", "diffuse")]
        print(f"| {name} | {mine[0]['hard']} | {cell(smoothers[0])} | {cell(smoothers[1])} |")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burnish", default="build/burnish")
    parser.add_argument("--out", default="out/hard")
    parser.add_argument("--group", choices=cases.GROUPS)
    parser.add_argument("--case", help="only cases whose name holds this")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 3])
    parser.add_argument("--record")
    parser.add_argument("--table")
    args = parser.parse_args()
    if args.table:
        table(list(csv.DictReader(open(args.table, newline=""))))
        return 0
    os.environ.update(launch.environment(args.burnish))
    driver = Driver(args)
    rows = [
        row for case in cases.CASES if args.group in (None, case.group) and (not args.case or args.case in case.name)
        for row in driver.rows(case)
    ]
    if args.record:
        with open(args.record, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    return any(row["as_expected"] != "yes" for row in rows) or not rows


if __name__ == "__main__":
    sys.exit(main())
