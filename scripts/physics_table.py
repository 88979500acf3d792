"""What a run takes with friction, yielding, rubber and contact of all surfaces, on one rank: CPU seconds, iterations and
memory, and beside it the same scene without, where there is one. Raw records go to a CSV file, the table (medians) is
printed from there (make bench):
    physics_table.py [--burnish BINARY] [--only NAME ...] [--repeats N] [--record FILE] [--print]
Runs of all scenes alternate, so that whatever else the machine does meets all of them. CPU seconds are without those of
meshing, which only the first run of a mesh does."""
import shutil
import statistics
import subprocess
import sys

from launch import ROOT, command, environment, fill_row, read_records, read_summary, table_parser, write_records

PIPE = "runs/pipe_pinch.yaml"
YIELDS = "{law: von_mises, E: 20000, nu: 0.3, yield: 200, hardening: {linear: 200}}"
# name: scene, what is set besides, the scene without the effect
SCENES = {
    "pipe": (PIPE, ["loads.0.uy=-10"], None),
    "pipe, friction 0.3": (PIPE, ["loads.0.uy=-10", "contact.0.friction={mu: 0.3}"], "pipe"),
    "pipe, yielding": (PIPE, ["loads.0.uy=-10", f"bodies.0.material={YIELDS}"], "pipe"),
    "shallow ironing, no friction": ("runs/friction/shallow_ironing.yaml", ["contact.0.friction.mu=0"], None),
    "shallow ironing": ("runs/friction/shallow_ironing.yaml", [], "shallow ironing, no friction"),
    "rings with torque": ("runs/friction/press_fit.yaml", [], None),
    "half rings, yielding, friction 0.3": ("tests/scenes/curved_beams.yaml", [], None),
    "O-ring": ("runs/o_ring.yaml", [], None),
    "comb, all surfaces": ("tests/jobs/comb_fingers.yaml", [], None),
}
COLUMNS = ("scene", "repeat", "dofs", "status", "steps", "steps_failed", "newton_iterations", "krylov_iterations",
           "cpu_s", "peak_rss_mb", "seconds_search", "seconds_fit", "seconds_assembly_elastic",
           "seconds_assembly_contact", "seconds_solve")


def solve(args, case):
    """One run, as a list with a row of the CSV file."""
    repeat, scene = case
    file, overrides, _ = SCENES[scene]
    directory = args.out / "run"
    shutil.rmtree(directory, ignore_errors=True)
    line = command(args.burnish, 1, ROOT / file, directory, ("output.every=0", *overrides), "-quiet")
    finished = subprocess.run(line, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    if finished.returncode not in (0, 2):  # 2: did not converge; the summary says how far it came
        sys.exit(f"{' '.join(line)}\n{finished.stdout}")
    print(f"{scene}, {repeat}: exit status {finished.returncode}", file=sys.stderr)
    return [fill_row({"scene": scene, "repeat": repeat}, COLUMNS, read_summary(directory))]


def print_table(rows):
    cpu = {
        scene: statistics.median(float(row["cpu_s"]) for row in rows if row["scene"] == scene)
        for scene in dict.fromkeys(row["scene"] for row in rows)
    }
    first = {row["scene"]: row for row in reversed(rows)}
    print("| scene | unknowns | status | steps (failed) | iterations | CPU s | times that without | memory MB |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for scene, seconds in cpu.items():
        row, without = first[scene], SCENES[scene][2]
        times = f"{seconds / cpu[without]:.2f}" if without in cpu else ""
        print(f"| {scene} | {row['dofs']} | {row['status']} | {row['steps']} ({row['steps_failed']}) | "
              f"{row['newton_iterations']} | {seconds:.2f} | {times} | {float(row['peak_rss_mb']):.0f} |")


parser = table_parser(__doc__, "physics")
parser.add_argument("--only", nargs="+", choices=SCENES, default=list(SCENES), metavar="NAME", help="of these scenes")
parser.add_argument("--repeats", type=int, default=3)
args = parser.parse_args()
if not args.only_print:
    args.out.mkdir(parents=True, exist_ok=True)
    write_records(args.record, COLUMNS, lambda case: solve(args, case),
                  [(repeat, scene) for repeat in range(args.repeats) for scene in args.only], 1)
print_table(read_records(args.record))
