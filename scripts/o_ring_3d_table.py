"""A quarter of the O-ring in space (runs/rubber/o_ring_3d_pressure.yaml) that is squeezed and then pressed on by a
fluid of 10 MPa, at default settings: how far each element comes, in how many steps and iterations. `reached` is the
pressure of the fluid where the run has ended or was stopped (MPa); `motions` are the soft motions of the ring that
were held at once, and `friction` the largest coefficient of friction that would have held as much. A run is stopped after --limit
seconds, which leaves rows that depend on the machine. Writes runs/records/o_ring_3d_pressure.csv.

    build/venv/bin/python scripts/o_ring_3d_table.py --burnish build/burnish
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

from launch import ROOT, environment

ELEMENTS = {  # name -> order, tetrahedra, elements along a quarter of the cord, around
    "tet4": (1, 1, 6, 12),
    "tet10": (2, 1, 4, 12),
    "hex8": (1, 0, 8, 8),
    "hex27": (2, 0, 4, 6)
}
SQUEEZES = {"20 %": -0.706, "30 %": -1.059}
PRESSURE, BEGINS = 10, 0.5  # of the fluid at t = 1, and where it begins
COLUMNS = ("squeeze", "element", "n", "arc", "nu", "limit_s", "status", "reached", "steps", "failed", "iterations",
           "motions", "friction", "tight_to")


def run(squeeze, element):
    """The row of one run."""
    order, triangles, n, arc = ELEMENTS[element]
    motion = f"[{{uy: {SQUEEZES[squeeze]}, history: [[0, 0], [{BEGINS}, 1], [1, 1]]}}]"
    with tempfile.TemporaryDirectory() as directory:
        command = [args.burnish, str(ROOT / "runs/rubber/o_ring_3d_pressure.yaml"), "-o", directory + "/run", "-quiet",
                   "-time_limit", str(args.limit)]
        for value in (f"mesh.order={order}", f"mesh.parameters.triangles={triangles}", f"mesh.parameters.n={n}",
                      f"mesh.parameters.arc={arc}", f"bodies.0.material.nu={args.nu}", "output.every=0",
                      f"bodies.2.rigid.motion={motion}"):
            command += ["-set", value]
        finished = subprocess.run(command, env=environment(args.burnish), capture_output=True, text=True, check=False)
        if finished.returncode not in (0, 2, 3):
            sys.exit(f"{' '.join(command)}\n{finished.stderr}")
        summary = json.loads((pathlib.Path(directory) / "run/summary.json").read_text())
    held = summary["stabilisation"]
    return {
        "squeeze": squeeze, "element": element, "n": n, "arc": arc, "nu": args.nu, "limit_s": args.limit,
        "status": summary["status"],
        "reached": f"{PRESSURE * max(0, summary['t'] - BEGINS) / (1 - BEGINS):.3g}",
        "steps": summary["steps"], "failed": summary["steps_failed"], "iterations": summary["newton_iterations"],
        "motions": held["held_soft_motions"], "friction": f"{held['held_soft_friction']:.2g}",
        "tight_to": f"{summary['probes']['tight_to']:.4g}"
    }


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--burnish", default=str(ROOT / "build/burnish"))
parser.add_argument("--record", type=pathlib.Path, default=ROOT / "runs/records/o_ring_3d_pressure.csv")
parser.add_argument("--nu", type=float, default=0.499)
parser.add_argument("--limit", type=int, default=3600, help="seconds of one run")
parser.add_argument("--squeeze", nargs="*", choices=list(SQUEEZES), default=list(SQUEEZES))
parser.add_argument("--only", nargs="*", choices=list(ELEMENTS), default=list(ELEMENTS))
args = parser.parse_args()
with open(args.record, "w", newline="") as record:
    table = csv.DictWriter(record, COLUMNS, lineterminator="\n")
    table.writeheader()
    for way in args.squeeze:
        for name in args.only:
            line = run(way, name)
            table.writerow(line)
            record.flush()
            print(", ".join(f"{key} {value}" for key, value in line.items()), flush=True)
