"""Figures of speed that no other table has: CPU seconds that the start of the program takes, as user and system time of
whole runs of small scenes whose meshes are in the cache, and iterations of GMRES for each linear solve with friction
and without, by the iterative solver. One rank.
    figures_table.py [--burnish BINARY] [--repeats N] [--record FILE] [--print]"""
import shutil
import statistics
import subprocess

from launch import ROOT, command, environment, read_records, read_summary, table_parser, timed, write_records

COLUMNS = ("figure", "scene", "mu", "repeat", "dofs", "newton_iterations", "solves", "krylov_iterations", "cpu_s")
SMALL = ("ring_in_ring", "discs", "hertz_line", "cook")
SOLVES = ("ring_in_ring_3d", "friction/pad", "pipe_pinch")
COARSE = {"pipe_pinch": ["mesh.parameters={n_arc: 12, n_wall: 1, n_len: 5}", "loads.0.uy=-10"]}
FRICTION = (0, 0.3)
ITERATIVE = ["solver.type=iterative", "output.every=0"]


def solve(args, figure, scene, mu, repeat):
    directory = args.out / "run"
    shutil.rmtree(directory, ignore_errors=True)
    overrides = [f"contact.0.friction.mu={mu}", *ITERATIVE, *COARSE.get(scene, [])] if figure == "gmres" else []
    line = command(args.burnish, 1, ROOT / f"runs/{scene}.yaml", directory, overrides, "-quiet")[3:]  # mpirun apart
    _, cpu = timed(line, env=environment(args.burnish), stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT)
    summary = read_summary(directory)
    return [{"figure": figure, "scene": scene, "mu": mu, "repeat": repeat, "dofs": summary["dofs"],
             "newton_iterations": summary["newton_iterations"], "solves": summary["linear"]["solves"],
             "krylov_iterations": summary["krylov_iterations"], "cpu_s": f"{cpu:.3f}"}]


def print_table(rows):
    print("| scene | unknowns | iterations | CPU s, whole run: least | median |\n| --- | --- | --- | --- | --- |")
    for scene in SMALL:
        runs = [row for row in rows if row["scene"] == scene and row["figure"] == "start"]
        cpu = [float(row["cpu_s"]) for row in runs]
        print(f"| {scene} | {runs[0]['dofs']} | {runs[0]['newton_iterations']} | {min(cpu):.3f} | "
              f"{statistics.median(cpu):.3f} |")
    print("\n| scene | unknowns | GMRES a solve, mu 0 | mu 0.3 | ratio |\n| --- | --- | --- | --- | --- |")
    for scene in SOLVES:
        runs = {float(row["mu"]): row for row in rows if row["scene"] == scene and row["figure"] == "gmres"}
        each = [int(runs[mu]["krylov_iterations"]) / int(runs[mu]["solves"]) for mu in FRICTION]
        print(f"| {scene} | {runs[0]['dofs']} | {each[0]:.1f} | {each[1]:.1f} | {each[1] / each[0]:.2f} |")


def main():
    parser = table_parser(__doc__, "figures")
    parser.add_argument("--repeats", type=int, default=5)
    args = parser.parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        cases = [("start", scene, "", repeat) for repeat in range(args.repeats + 1) for scene in SMALL]
        cases += [("gmres", scene, mu, 0) for scene in SOLVES for mu in FRICTION]
        write_records(args.record, COLUMNS,
                      lambda case: [row for row in solve(args, *case) if row["figure"] == "gmres" or row["repeat"]],
                      cases, 1)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()
