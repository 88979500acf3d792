"""doc/pages/scene.md lists every key of a scene as the program has it, and doc/pages/results.md lists every key, column
and dataset that a run leaves."""
import csv
import re
import subprocess
import sys

import h5py

from harness import Check, arguments, run, SCENES

ROOT = SCENES.parent.parent
PARTS = ("/steps/0000/contact/joint/", "/steps/0000/", "/contact/joint/")  # left out or named otherwise in the tables
FILES = ("summary.json", "steps.csv", "results.h5, results.vtkhdf and results.xdmf")

args = arguments()
check = Check()
line = [sys.executable, str(ROOT / "scripts" / "reference.py"), "--check", "--burnish", args.burnish]
finished = subprocess.run(line, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
check.holds("scene keys", finished.returncode == 0, finished.stdout)

text = (ROOT / "doc/pages/results.md").read_text()
told = [set(re.findall(r"`([^`]+)`", text.split(f"\n## {name}")[1].split("\n## ")[0])) for name in FILES]
plane = ["geometry=plane_strain", "mesh.parameters.solid=0",
         "supports=[{surface: lower_bottom, uy: 0}, {surface: symmetry_x, ux: 0}]",
         "contact.0.penalty={adjust: true, g_min: 1e-4, g_max: 1e-2, unit: length}"]
finished = run(args, SCENES / "contact_patch.yaml", "-quiet", overrides=plane)


def keys(value):
    """Of all maps, but those that the user names."""
    for key, inner in value.items():
        yield key
        for entry in inner if isinstance(inner, list) else [inner]:
            if isinstance(entry, dict) and key not in ("probes", "options"):
                yield from keys(entry)


untold = set(keys(finished.summary())) - told[0]
check.holds("summary.json", not untold, f"not told: {sorted(untold)}")
with open(finished.directory / "steps.csv", newline="") as file:
    columns = set(next(csv.reader(file))) - set(finished.summary()["probes"])
extra = told[1] - columns
known = columns <= told[1] and extra <= {
    "control: contact", "law: von_mises", "g_min", "g_max", "during", "stepping.steps"
}
check.holds("steps.csv", known, f"{sorted(columns ^ told[1])}")
datasets = set()
with h5py.File(finished.directory / "results.h5", "r") as file:
    file.visititems(lambda name, item: isinstance(item, h5py.Dataset) and datasets.add("/" + name) or None)
for dataset in sorted(name for name in datasets if not name.startswith(("/VTKHDF/", "/by_field/"))):
    name = next((dataset.removeprefix(part) for part in PARTS if dataset.startswith(part)), dataset)
    name = {"nodes": "/contact/PAIR/nodes"}.get(name, re.sub(r"cells_[a-z]+\d+", "cells_TYPE", name))
    check.holds(f"results.h5: {dataset}", name in told[2] or re.sub(r"\d+$", "0", name) in told[2])
check.finish()
