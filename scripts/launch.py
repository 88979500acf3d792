"""Runs of Burnish for the scripts here: records of cases and their tables. The package burnish beside this file has what
any user needs: it starts runs and reads them."""
import argparse
import csv
import os
import pathlib
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

from burnish.runs import command, environment, read_steps, read_summary  # noqa: F401: other scripts take them from here

ROOT = pathlib.Path(__file__).resolve().parent.parent
def table_parser(description, name, record=None):
    """Options of a script that runs cases into a record and prints a table of it; its runs go to out/NAME."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build/burnish")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out" / name)
    parser.add_argument("--record", type=pathlib.Path, default=ROOT / "out" / f"{record or name}.csv")
    parser.add_argument("--print", dest="only_print", action="store_true",
                        help="of the record that is there; runs nothing")
    return parser


def write_records(path, columns, solve, cases, jobs):
    """Solves cases, `jobs` at a time, into a CSV file that grows as they end; solve gives a list of records."""
    with open(path, "w", newline="") as file, ThreadPoolExecutor(jobs) as pool:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        for records in pool.map(solve, cases):
            writer.writerows(records)
            file.flush()


def run_case(case, columns, scene, overrides, figures, args):
    """The record of one run: its case, exit status and iterations, and the values that figures() finds in its folder,
    which then is removed. args are those of table_parser()."""
    directory = args.out / "-".join(str(v) for v in case)
    shutil.rmtree(directory, ignore_errors=True)
    line = [args.burnish, str(scene), "-o", str(directory), "-quiet"]
    for override in overrides:
        line += ["-set", override]
    finished = subprocess.run(line, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    record = dict(zip(columns, (*case, finished.returncode)))
    if finished.returncode == 0:
        record.update(iterations=read_summary(directory)["newton_iterations"],
                      **{name: f"{value:.4g}" for name, value in figures(directory).items()})
    else:
        print(case, finished.stdout)
    shutil.rmtree(directory, ignore_errors=True)
    return record


def timed(line, **options):
    """Exit status and CPU seconds of one process from its start to its end; options are those of subprocess.Popen."""
    process = subprocess.Popen([str(word) for word in line], **options)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_utime + usage.ru_stime


def fill_table(args, columns, solve, cases, print_table):
    """Runs the cases into the record, unless it is only to be printed, and prints its table."""
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, columns, lambda case: [solve(case, args)], cases, args.jobs)
    print_table(read_records(args.record))


def fill_scenes(description, name, columns, solve, scenes, print_table, draw=None):
    """A script that runs scenes into a record and prints its table; solve gives the list of records of a scene, and draw
    makes the picture beside the record."""
    parser = table_parser(description, name)
    parser.add_argument("--only", nargs="*", default=list(scenes), metavar="NAME", help="of these scenes")
    args = parser.parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, columns, lambda scene: solve(args, scene), args.only, 1)
    print_table(read_records(args.record))
    if draw:
        draw(read_records(args.record), args.record.with_suffix(".png"))


def fill_row(row, columns, summary):
    """Adds to a row the columns that it lacks: seconds_*, probes and other values of summary.json."""
    for name in columns:
        if name.startswith("seconds_"):
            row[name] = summary["seconds"][name.removeprefix("seconds_")]
        elif name not in row:
            row[name] = summary["probes"][name] if name in summary["probes"] else summary[name]
    return row


def read_records(path):
    """The records of a CSV file; none where there is no file yet."""
    if not pathlib.Path(path).exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def replace_records(path, columns, case, records):
    """Puts the records of a case (column `case`) in the place of those a CSV file has of it."""
    rows = [row for row in read_records(path) if row["case"] != case] + records
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
