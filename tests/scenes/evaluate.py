"""burnish -evaluate: probes of a finished run from its results have the values that the run itself has found, and those
of closed forms; points off the nodes are told; what results cannot tell is refused."""
import csv
import pathlib
import subprocess

import yaml
from harness import SCENES, Check, arguments, run

KINDS = ("displacement", "distance", "gap", "pressure_max")
SCENE = SCENES / "probes.yaml"
args = arguments()
check = Check()
out = pathlib.Path(args.out).resolve()
own = [probe for probe in yaml.safe_load(SCENE.read_text())["probes"] if any(kind in probe for kind in KINDS)]
finished = run(args, SCENE)


def evaluated(probes):
    (out / "probes.yaml").write_text(yaml.safe_dump({"probes": probes}))
    line = [args.burnish, "-evaluate", finished.directory, out / "probes.yaml"]
    return subprocess.run([str(word) for word in line], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def table(name):
    with open(finished.directory / name, newline="") as file:
        return list(csv.DictReader(file))


MORE = [{"name": "stress", "field": "stress_yy", "at": [1, 0.5]},
        {"name": "near", "field": "displacement", "component": "y", "at": [1.97, 1.99], "body": "upper"},
        {"name": "least", "field": "stress_yy", "over": "min", "body": "lower"},
        {"name": "column", "field": "stress_yy", "line": [[1, 0], [1, 2]], "points": 5, "factor": -1}]
said = evaluated(own + MORE)
check.holds("done", said.returncode == 0, said.stdout)
check.holds("the nearest node is told", "nearest node, 0.0316 away" in said.stdout, said.stdout)
rows, steps = table("evaluated.csv"), finished.steps()
check.holds("a row for each written step", [float(row["t"]) for row in rows] == [step["t"] for step in steps])
for probe in own:
    for row, step in zip(rows, steps):
        check.near(f"{probe['name']} at t = {row['t']}", float(row[probe["name"]]), step[probe["name"]], 1e-12)
# Cauchy's stress of a bar under a dead pressure, Poisson's ratio 0
check.near("stress", float(rows[-1]["stress"]), -10, 1e-6)
check.near("least stress of the lower block", float(rows[-1]["least"]), -10, 1e-6)
check.near("the node near the corner", float(rows[-1]["near"]), steps[-1]["top_uy"], 1e-12)
column = table("column.csv")
check.holds("a line: five places in each step", len(column) == 5 * len(steps))
check.near("and its values", max(abs(float(row["column"]) - 10) for row in column[-5:]), 0, 1e-6)
for what, probes, words in (
    ("a force", [{"name": "f", "reaction": "upper_top", "component": "y"}], "forces need the solver"),
    ("a field that is not there", [{"name": "f", "field": "heat", "at": [0, 0]}], "von_mises"),
    ("a body that is not there", [{"name": "f", "field": "von_mises", "over": "max", "body": "middle"}], "lower, upper"),
    ("a pair that is not there", [{"name": "f", "gap": "other", "at": [0, 0]}], "allowed: joint"),
    ("a key without a place", [{"name": "f", "gap": "joint", "at": [0, 0], "over": "max"}], "probes.0.over: has no place"),
):
    refused = evaluated(probes)
    check.holds(f"{what} is refused", refused.returncode == 1 and words in refused.stdout and
                refused.stdout.rstrip().endswith("[B100]"), refused.stdout[-300:])
check.finish()
