"""What the elastic scenes cost beside an older version of the program: paired runs of the same scene, one after the other
in changing order, and the median of their ratios of CPU time. The older version is a checkout of its own with its program
built; each program runs its own file of the scene. One process at a time.
    python scripts/version_table.py --before CHECKOUT [--runs 10] [--record FILE]"""
import os
import pathlib
import statistics
import subprocess

from launch import ROOT, environment, fill_table, read_summary, table_parser

SCENES = ("pipe_pinch", "plate_cylinder", "cup_flattening", "hertz_line", "spheres", "slide_cylinder", "patch_blocks",
          "ball_in_cone", "cook", "ring_pinch")
COLUMNS = ("scene", "iterations_before", "iterations", "cpu_before_s", "cpu_s", "ratio")


def spent(checkout, scene, out):
    """CPU seconds of one run and its iterations."""
    line = [checkout / "build/burnish", f"runs/{scene}.yaml", "-o", out, "-overwrite", "-quiet"]
    process = subprocess.Popen([str(word) for word in line], cwd=checkout, env=environment(line[0]),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{checkout}: {scene} ended with status {process.returncode}")
    return usage.ru_utime + usage.ru_stime, read_summary(out)["newton_iterations"]


def solve(args, scene):
    pairs = []
    for k in range(args.runs):
        pair = {}
        for way in ("before", "now")[::1 if k % 2 else -1]:
            pair[way] = spent(args.before if way == "before" else ROOT, scene, args.out / way / scene)
        pairs.append(pair)
    cpu = {way: statistics.median(pair[way][0] for pair in pairs) for way in ("before", "now")}
    ratio = statistics.median(pair["now"][0] / pair["before"][0] for pair in pairs)
    return dict(zip(COLUMNS, (scene, pairs[0]["before"][1], pairs[0]["now"][1], f"{cpu['before']:.3g}",
                              f"{cpu['now']:.3g}", f"{ratio:.3f}")))


def table(rows):
    print("| scene | iterations: before, now | CPU s: before, now | now over before |")
    print("| --- " * 4 + "|")
    for row in rows:
        print(f"| {row['scene']} | {row['iterations_before']}, {row['iterations']} | {row['cpu_before_s']}, "
              f"{row['cpu_s']} | {float(row['ratio']):.2f} |")


def main():
    parser = table_parser(__doc__, "versions")
    parser.add_argument("--before", type=pathlib.Path, help="checkout of the older version, with its program built")
    parser.add_argument("--runs", type=int, default=10, help="pairs of runs of each scene")
    args = parser.parse_args()
    args.jobs = 1  # side by side, runs would disturb each other
    if not args.only_print and not args.before:
        parser.error("--before: the checkout of the older version is needed")
    fill_table(args, COLUMNS, lambda scene, args: solve(args, scene), SCENES, table)


if __name__ == "__main__":
    main()
