"""What the elastic scenes cost beside an older version of the program: paired runs of the same scene, one after the other
in changing order, and the median of their ratios of CPU time. The older version is a checkout of its own with its program
built; each program runs its own file of the scene. One process at a time.
    python scripts/version_table.py --before CHECKOUT [--burnish BINARY] [--runs 10] [--record FILE]"""
import pathlib
import statistics
import subprocess

from launch import ROOT, environment, fill_table, read_summary, table_parser, timed

SCENES = ("pipe_pinch", "plate_cylinder", "cup_flattening", "hertz_line", "ring_in_ring", "spheres", "slide_cylinder",
          "patch_blocks", "ball_in_cone", "discs", "cantilever", "cook", "ring_pinch")
COLUMNS = ("scene", "iterations_before", "iterations", "cpu_before_s", "cpu_s", "ratio")


def run(burnish, checkout, scene, out):
    """CPU seconds of one run, and its iterations. What summary.json calls CPU time is not the same in all versions."""
    line = [burnish, checkout / "runs" / f"{scene}.yaml", "-o", out, "-overwrite", "-quiet"]
    status, cpu = timed(line, env=environment(burnish), stdout=subprocess.DEVNULL)
    if status:
        raise SystemExit(f"{burnish}: {scene} ended with status {status}")
    return cpu, read_summary(out)["newton_iterations"]


def solve(scene, args):
    pairs = []  # before, now
    for k in range(args.runs):
        versions = [(args.before / "build/burnish", args.before, scene, args.out / "before" / scene),
                    (args.burnish, ROOT, scene, args.out / "now" / scene)]
        order = 1 if k % 2 else -1
        pairs.append([run(*version) for version in versions[::order]][::order])
    cpu = [[one[0] for one in runs] for runs in zip(*pairs)]
    ratio = statistics.median(now / before for before, now in zip(*cpu))
    return dict(zip(COLUMNS, (scene, *(one[1] for one in pairs[0]), *(f"{statistics.median(one):.3g}" for one in cpu),
                              f"{ratio:.3f}")))


def table(rows):
    print("| scene | iterations: before, now | CPU s: before, now | now over before |")
    print("| --- " * 4 + "|")
    for row in rows:
        print(f"| {row['scene']} | {row['iterations_before']}, {row['iterations']} | {row['cpu_before_s']}, "
              f"{row['cpu_s']} | {float(row['ratio']):.3f} |")


def main():
    parser = table_parser(__doc__, "versions")
    parser.add_argument("--before", type=pathlib.Path, help="checkout of the older version, with its program built")
    parser.add_argument("--runs", type=int, default=10, help="pairs of runs of each scene")
    args = parser.parse_args()
    args.jobs = 1  # side by side, runs would disturb each other
    if not args.only_print and not args.before:
        parser.error("--before: the checkout of the older version is needed")
    fill_table(args, COLUMNS, solve, SCENES, table)


if __name__ == "__main__":
    main()
