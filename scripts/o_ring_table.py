"""The rubber O-ring of runs/o_ring.yaml at default settings: squeezed by 20 % and 30 % of its cord, and by 20 % in
one single step, for elements of both orders and Poisson's ratios from 0.49 to 0.5. Forces are compared with those of
a finer mesh of second-order quadrilaterals of the same ratio. Then the ring of runs/o_ring_pressure.yaml, squeezed
and pressed on by a fluid; tight_to is the pressure that its contact would hold. After 20 % a gap is left beside the
groove's edge; `gap` is the size of the elements there. Writes runs/records/o_ring.csv, one row for each run; t is
where a run has ended that is not done.

    build/venv/bin/python scripts/o_ring_table.py --burnish build/burnish
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

from launch import ROOT, environment

ELEMENTS = {  # name -> order, triangles, elements along a quarter of the cord
    "quad4": (1, 0, (16, 24)),
    "quad9": (2, 0, (8, 12)),
    "tri3": (1, 1, (16, 24)),
    "tri6": (2, 1, (8, 10, 12, 14))
}
FINE = ("quad9", 24)
WAYS = {  # name -> overrides, whose force is compared with that of the first way of the same squeeze
    "20 %": (),
    "30 %": ("bodies.2.rigid.motion=[{uy: -1.059}]", ),
    "20 % in one step": ("stepping={control: fixed, initial: 1}", )
}
PRESSED = {  # name -> overrides; only a squeeze by 30 % leaves no gap between lid and groove
    "30 %, then 10 MPa": ("bodies.2.rigid.motion=[{uy: -1.059, history: [[0, 0], [0.5, 1], [1, 1]]}]", ),
    "20 %, then 10 MPa, gap 0.05": ("mesh.parameters.gap=0.05", ),
    "20 %, then 10 MPa, gap 0.025": ("mesh.parameters.gap=0.025", )
}
PRESSED_SIZES = {"quad4": (24, ), "quad9": (12, ), "tri3": (24, ), "tri6": (12, )}
WAYS |= PRESSED
LIMITS = {"20 %": "20 %", "30 %": "30 %", "20 % in one step": "20 %"} | dict.fromkeys(PRESSED)
NUS = (0.49, 0.499, 0.4999, 0.5)
LIMIT = 600  # s of one run
COLUMNS = ("squeeze", "element", "n", "nu", "status", "t", "steps", "failed", "iterations", "cuts", "turned", "force",
           "error", "tight_to")


def run(burnish, way, element, n, nu):
    """The summary of one run."""
    order, triangles, _ = ELEMENTS[element]
    scene = ROOT / ("runs/o_ring_pressure.yaml" if way in PRESSED else "runs/o_ring.yaml")
    with tempfile.TemporaryDirectory() as directory:
        command = [burnish, str(scene), "-o", directory + "/run", "-quiet", "-time_limit", str(LIMIT)]
        for value in (f"mesh.order={order}", f"mesh.parameters.triangles={triangles}", f"mesh.parameters.n={n}",
                      f"bodies.0.material.nu={nu}", "output.every=0", *WAYS[way]):
            command += ["-set", value]
        finished = subprocess.run(command, env=environment(burnish), capture_output=True, text=True, check=False)
        if finished.returncode not in (0, 2, 3):
            sys.exit(f"{' '.join(command)}\n{finished.stderr}")
        return json.loads((pathlib.Path(directory) / "run/summary.json").read_text())


def figures(summary):
    """What the record keeps of a run, but for the error."""
    done = summary["status"] == "done"
    guards = summary["guards"]
    return {
        "status": summary["status"],
        "t": f"{summary['t']:.4g}",
        "steps": summary["steps"],
        "failed": summary["steps_failed"],
        "iterations": summary["newton_iterations"],
        "cuts": guards["line_search_cuts"],
        "turned": guards["line_search_turned"],
        "force": f"{summary['probes']['force']:.7g}" if done else "",
        "tight_to": f"{summary['probes']['tight_to']:.5g}" if "tight_to" in summary["probes"] else ""
    }


def cases(nus):
    """Way, element, n and nu of every run, the fine meshes first."""
    for way in WAYS:
        for nu in nus:
            if LIMITS[way] == way:
                yield way, *FINE, nu
            for element, (_, _, sizes) in ELEMENTS.items():
                for n in sizes if way not in PRESSED else PRESSED_SIZES[element]:
                    yield way, element, n, nu


def error(rows, row):
    """Of the force against that of the finest mesh of the same squeeze and ratio."""
    for other in rows:
        if (other["squeeze"] == LIMITS[row["squeeze"]] and (other["element"], int(other["n"])) == FINE
                and float(other["nu"]) == float(row["nu"]) and other["force"] and row["force"]):
            return f"{float(row['force']) / float(other['force']) - 1:+.5f}"
    return ""


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--burnish", default=str(ROOT / "build/burnish"))
parser.add_argument("--record", default=str(ROOT / "runs/records/o_ring.csv"))
parser.add_argument("--nu", nargs="*", type=float, default=NUS)
parser.add_argument("--on", action="store_true", help="goes on with a record: runs that it has are not made again")
parser.add_argument("--again", nargs="*", choices=list(WAYS), default=(), help="with --on, makes these again")
args = parser.parse_args()
known = {}
if args.on:
    with open(args.record) as file:
        for row in csv.DictReader(file):
            if row["status"] != "stopped" and row["squeeze"] not in args.again:
                known[row["squeeze"], row["element"], int(row["n"]), float(row["nu"])] = row
rows = []
for case in cases(args.nu):
    row = dict(zip(COLUMNS, case))
    row.update(known.get(case) or figures(run(args.burnish, *case)))
    rows.append(row)
    row.setdefault("tight_to", "")
    row["error"] = error(rows, row)
    if case not in known:
        print(", ".join(f"{key} {value}" for key, value in row.items()), flush=True)
    with open(args.record + ".part", "w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
pathlib.Path(args.record + ".part").replace(args.record)
