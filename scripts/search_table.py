"""What the search costs alone where nearly all faces are on rigid tools: a pad of a few bricks between two sheets of up to
a million faces (tests/scenes/pad_between_tools.yaml), by `surfaces: all`. CPU time comes from the event of the search in
the program's own log, with its fits and offsets: its part of the wall time, of the CPU time of all ranks. The first
search is that of the set-up; it sorts the faces of the tools into blocks. Leaves one record per run and prints the table;
--print tables an existing record.
    python scripts/search_table.py [--burnish BINARY] [--record FILE]"""
import csv
import shutil
import subprocess

from launch import ROOT, command, environment, fill_table, read_summary, table_parser

SCENE = ROOT / "tests" / "scenes" / "pad_between_tools.yaml"
SIZES = (70, 224, 707)  # faces along a side of either sheet
RANKS = (1, 2)
PAD = 6 * 6 * 2 + 4 * 6 * 3  # faces of the pad
SETUP, STEPS = "Main Stage", "Load steps"
COLUMNS = ("tool_faces", "faces", "ranks", "status", "iterations", "first_s", "searches", "each_s", "share", "cpu_s",
           "peak_mb")


def cases():
    return [(size, ranks) for size in SIZES for ranks in RANKS]


def search_events(path, stage):
    """Number and wall seconds, on the slowest rank, of the searches of a stage."""
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if (row["Stage Name"], row["Event Name"]) == (stage, "ContactSearch")]
    return int(rows[0]["Count"]), max(float(row["Time"]) for row in rows)


def solve(case, args):
    size, ranks = case
    out = args.out / "-".join(map(str, case))
    shutil.rmtree(out, ignore_errors=True)
    log = args.out / f"{out.name}.csv"
    line = command(args.burnish, ranks, SCENE, out, (f"mesh.parameters={{n: {size}}}", "output.every=0"), "-quiet")
    line += ["-log_view", f":{log}:ascii_csv"]
    subprocess.run(line, env=environment(args.burnish), capture_output=True, check=False)
    summary = read_summary(out)
    cpu = summary["cpu_s"] / summary["wall_s"]
    (_, first), (count, later) = search_events(log, SETUP), search_events(log, STEPS)
    return dict(zip(COLUMNS, (2 * size**2, PAD, ranks, summary["status"], summary["newton_iterations"],
                              f"{first * cpu:.3g}", count, f"{later * cpu / count:.3g}",
                              f"{(first + later) / summary['wall_s']:.3g}", f"{summary['cpu_s']:.1f}",
                              f"{summary['peak_rss_mb']:.0f}")))


def table(rows):
    print("| faces on tools, of the pad | ranks | iterations | first search, CPU s | later searches | each, CPU s | "
          "run, CPU s | searches, % of it | memory of a rank, MB |")
    print("| --- " * 9 + "|")
    for row in rows:
        print(f"| {int(row['tool_faces']):,}, {row['faces']} | {row['ranks']} | {row['iterations']} | {row['first_s']} | "
              f"{row['searches']} | {row['each_s']} | {row['cpu_s']} | {100 * float(row['share']):.0f} | "
              f"{row['peak_mb']} |")


def main():
    parser = table_parser(__doc__, "search")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    fill_table(parser.parse_args(), COLUMNS, solve, cases(), table)


if __name__ == "__main__":
    main()
