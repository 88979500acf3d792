"""A quarter of the O-ring in space (runs/rubber/o_ring_3d_pressure.yaml) that is squeezed and then pressed on by a
fluid of 10 MPa, at default settings: how far each element comes, in how many steps and iterations. `reached` is the
pressure of the fluid where the run has ended or was stopped (MPa); `motions` are the soft motions of the ring that
were held at once, and `friction` the largest coefficient of friction that would have held as much. A run is stopped
after --limit seconds, which leaves rows that depend on the machine. --print tables an existing record.

    build/venv/bin/python scripts/o_ring_3d_table.py --record runs/records/o_ring_3d_pressure.csv
"""
import subprocess

from launch import ROOT, command, environment, fill_table, read_summary, table_parser

SCENE = ROOT / "runs/rubber/o_ring_3d_pressure.yaml"
ELEMENTS = {  # name -> order, tetrahedra, elements along a quarter of the cord, around, size at the mouth of the gap
    "tet4": (1, 1, 6, 12, 0.1),
    "tet10": (2, 1, 4, 12, 0),
    "hex8": (1, 0, 8, 8, 0),
    "hex27": (2, 0, 4, 6, 0)
}
SQUEEZES = {"20 %": -0.706, "30 %": -1.059}
PRESSURE, BEGINS = 10, 0.5  # of the fluid at t = 1, and where it begins
COLUMNS = ("squeeze", "element", "n", "arc", "gap", "nu", "limit_s", "status", "reached", "steps", "failed",
           "iterations", "motions", "friction", "tight_to")


def solve(case, args):
    """The row of one run."""
    squeeze, element = case
    order, triangles, n, arc, gap = ELEMENTS[element]
    motion = f"[{{uy: {SQUEEZES[squeeze]}, history: [[0, 0], [{BEGINS}, 1], [1, 1]]}}]"
    directory = args.out / f"{squeeze.split()[0]}-{element}"
    overrides = (f"mesh.order={order}", f"mesh.parameters.triangles={triangles}", f"mesh.parameters.n={n}",
                 f"mesh.parameters.arc={arc}", f"mesh.parameters.gap={gap}",
                 f"bodies.0.material.nu={args.nu}", "output.every=0",
                 f"bodies.2.rigid.motion={motion}")
    line = command(args.burnish, 1, SCENE, directory, overrides, "-quiet", "-overwrite", "-time_limit", str(args.limit))
    subprocess.run(line, env=environment(args.burnish), capture_output=True, check=False)
    summary = read_summary(directory)
    held = summary["stabilisation"]
    reached = PRESSURE * max(0, summary["t"] - BEGINS) / (1 - BEGINS)
    return dict(zip(COLUMNS, (squeeze, element, n, arc, gap, args.nu, args.limit, summary["status"], f"{reached:.3g}",
                              summary["steps"], summary["steps_failed"], summary["newton_iterations"],
                              held["held_soft_motions"], f"{held['held_soft_friction']:.2g}",
                              f"{summary['probes']['tight_to']:.4g}")))


def print_table(records):
    print("| squeeze | element, along a quarter of the cord, around, at the gap | stopped after | at | "
          "steps / failed / iterations | motions held |\n|" + " --- |" * 6)
    for row in records:
        ended = f"{row['limit_s']} s" if row["status"] == "stopped" else row["status"]
        print(f"| {row['squeeze']} | {row['element']}, {row['n']}, {row['arc']}, {row['gap']} | {ended} | "
              f"{row['reached']} MPa | {row['steps']}/{row['failed']}/{row['iterations']} | {row['motions']} |")


parser = table_parser(__doc__, "o_ring_3d_table", "o_ring_3d_pressure")
parser.add_argument("--nu", type=float, default=0.499)
parser.add_argument("--limit", type=int, default=3600, help="seconds of one run")
parser.add_argument("--squeeze", nargs="*", choices=list(SQUEEZES), default=list(SQUEEZES))
parser.add_argument("--only", nargs="*", choices=list(ELEMENTS), default=list(ELEMENTS))
args = parser.parse_args()
args.jobs = 1
fill_table(args, COLUMNS, solve, [(squeeze, element) for squeeze in args.squeeze for element in args.only], print_table)
