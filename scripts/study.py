"""What accuracy costs, for any scene. It runs every combination of the values to vary, keeps one raw record for each
run, and makes of them a table and a plot of the error against CPU seconds.
    study.py SCENE --vary KEY=V,V,... [--vary ...] --measure PROBE --reference VALUE|finest|richardson
    study.py @runs/studies/rings.args    the same from a file with one option a line
    study.py ... --print                 only makes the table and the plot of the records that are there
The last --vary (or --case) runs along a line of the plot, usually the mesh from coarse to fine. The others make one
line for each combination.
In DIR (--out): NAME.jsonl raw records, one JSON line per run; NAME.csv, NAME.md tables; NAME.png plot. A run whose
scene, keys, ranks and program are those of a record is not made again, so that an interrupted study goes on where it
was. On a cluster, jobs 0 to N-1 of an array each take --job-array $INDEX,N; the same line without it gathers them. A
run that fails is a row with its cause."""

import argparse
import csv
import hashlib
import itertools
import json
import math
import os
import pathlib
import re
import shlex
import shutil
import statistics
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor

from launch import command, environment, read_summary
from studyline import cost, enough, number

ROOT = pathlib.Path(__file__).resolve().parent.parent
STATUS = {0: "done", 1: "refused", 2: "not converged", 3: "stopped", 4: "failed"}
KEPT = (
    "dofs",
    "steps",
    "steps_failed",
    "newton_iterations",
    "cpu_s",
    "wall_s",
    "peak_rss_mb",
    "probes",
)  # of summary.json
COST = {
    "": "{}",
    "<=": "at most {}",
    ">": "not reached at {}",
    "~": "not reached; extrapolated {}",
    None: "{}",
}  # how cost() found it
VALUE_DIGITS = 6  # of a measured value in the tables
QUICK = 2  # values of the last --vary with --quick


# What to run


def split(text):
    """Values between commas; those within brackets stay together."""
    parts, depth = [""], 0
    for c in text:
        depth += (c in "[{") - (c in "]}")
        if c == "," and not depth:
            parts.append("")
        else:
            parts[-1] += c
    return [part.strip() for part in parts]


def axes(options):
    """{axis: {label: overrides}} of the --vary (texts) and --case (lists) options, in the order in which they stand."""
    found = {}
    for option in options:
        if isinstance(option, str):
            key, _, values = option.partition("=")
            name = key.split(".")[-1]
            found[name if name not in found else key] = {
                value if math.isnan(number(value)) else f"{name} {value}": [f"{key}={value}"] for value in split(values)
            }
        else:
            name, label, *overrides = option
            found.setdefault(name, {})[label] = overrides
    return found


class Measure:
    """What --measure and its --reference say. With MEAN/SPREAD the error of the mean and the deviation from it, both in
    per cent, add up to a bound of the error in any norm."""

    def __init__(self, text, reference):
        *label, probes = text.split(": ")
        self.probe, _, self.spread = probes.partition("/")
        self.name, self.reference = label[0] if label else self.probe, reference


class Study:
    """The options, and what follows from them: axes, measures, combinations, which runs make up a row."""

    def __init__(self, options):
        self.options, self.axes = options, axes(options.axes)
        self.measures = [
            Measure(*pair)
            for pair in zip(
                options.measure,
                itertools.cycle(options.reference) if len(options.reference) == 1 else options.reference,
            )
        ]
        self.along = list(self.axes)[-1]
        if options.quick:
            self.axes[self.along] = dict(list(self.axes[self.along].items())[:QUICK])
            self.axes.update({name: dict(list(self.axes[name].items())[:1]) for name in options.worst})
        self.lines = [name for name in self.axes if name not in (self.along, options.panels, *options.worst)]
        self.name = options.name or options.scene.stem
        cases = (dict(zip(self.axes, labels)) for labels in itertools.product(*self.axes.values()))
        self.cases = [case for case in cases if not any(set(labels) <= set(case.values()) for labels in options.skip)]

    def overrides(self, case):
        return [*self.options.set, *(override for name, label in case.items() for override in self.axes[name][label])]

    def rows(self):
        """Combinations without those that only make up the worst of a row."""
        return list(
            dict.fromkeys(
                tuple((name, label) for name, label in case.items() if name not in self.options.worst)
                for case in self.cases
            )
        )

    def series(self, rows):
        """{(panel, line): rows along it}"""
        found = {}
        for row in rows:
            found.setdefault(
                (row["case"].get(self.options.panels, ""), ", ".join(row["case"][name] for name in self.lines)), []
            ).append(row)
        return found


# Running


def digest(*parts):
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:16]


def stamp(study):
    """What the runs of a study have in common: scene, geometry and program. A record with others serves no run."""
    scene = study.options.scene.read_text()
    meshes = [study.options.scene.parent / name for name in re.findall(r"[\w./-]+\.(?:geo|msh)\b", scene)]
    contents = [
        hashlib.sha256(path.read_bytes()).hexdigest() for path in (*meshes, study.options.burnish) if path.exists()
    ]
    return digest(scene, contents, study.options.ranks)


def outcome(status, directory, text):
    """What a run left, for its record."""
    if status in (0, 2, 3) and (directory / "summary.json").exists():
        summary = read_summary(directory)
        return {"status": STATUS[status], "cause": summary["message"], **{name: summary[name] for name in KEPT}}
    log = directory / "error.log"
    told = [line.strip() for line in (log.read_text() if log.exists() else text).splitlines() if re.search(r"\w", line)]
    own = [line for line in told if line.startswith("burnish: ")]  # among the banners of mpirun
    ended = "failed" if status == 0 else STATUS.get(status, f"ended by signal {-status}")
    return {"status": ended, "cause": (own or told or ["no message, no summary.json"])[-1]}


def solve(study, case, repeat, key):
    """One run as a record; whatever happens to it."""
    options, start = study.options, time.monotonic()
    directory = options.out / "runs" / f"{study.name}-{key}-{os.getpid()}"
    shutil.rmtree(directory, ignore_errors=True)
    line = command(options.burnish, options.ranks, options.scene, directory, study.overrides(case), "-quiet")
    line = line[3:] if options.ranks == 1 else line  # without mpirun: two at a time are then not bound to one core
    try:
        finished = subprocess.run(
            line,
            env=environment(options.burnish),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=options.time_limit,
        )
        result = outcome(finished.returncode, directory, finished.stdout)
    except subprocess.TimeoutExpired:
        result = {"status": "time limit", "cause": f"not done after {options.time_limit:g} s"}
    except OSError as error:
        result = {"status": "failed", "cause": str(error)}
    shutil.rmtree(directory, ignore_errors=True)
    return {
        "key": key,
        "case": case,
        "repeat": repeat,
        "ranks": options.ranks,
        **result,
        "elapsed_s": round(time.monotonic() - start, 2),
    }


def read_records(study):
    """Of all jobs; of two records of one run the later one."""
    found = {}
    for path in sorted(study.options.out.glob(f"{study.name}*.jsonl")):
        if re.fullmatch(rf"{re.escape(study.name)}(-job\d+)?", path.stem):
            for line in path.read_text().splitlines():
                record = json.loads(line)
                found[json.dumps(record["case"]), record["repeat"], record["key"]] = record
    return list(found.values())


class Progress:
    """Prints a line for each run that is done, with the time left. That is the mean time of the runs of the same
    combination, or of all runs where there is none of it yet."""

    def __init__(self, study, work):
        self.study, self.left, self.total, self.took = study, [case for _, case, _ in work], len(work), {}

    def done(self, record):
        self.left.remove(record["case"])
        self.took.setdefault(json.dumps(record["case"]), []).append(record["elapsed_s"])
        mean = statistics.mean(itertools.chain(*self.took.values()))
        left = (
            sum(statistics.mean(self.took.get(json.dumps(case), [mean])) for case in self.left)
            / self.study.options.jobs
        )
        cost = f"{record['cpu_s']:.2f} s CPU" if "cpu_s" in record else record["cause"]
        print(
            f"[{self.total - len(self.left)}/{self.total}] {self.study.name}: {', '.join(record['case'].values())}: "
            f"{record['status']}, {cost}; {left / 60:.1f} min left",
            flush=True,
        )


def run(study):
    """Makes the runs that no record has, and returns the records of the study. The repeats are the outer loop, so that
    other work of the machine disturbs all combinations alike."""
    options = study.options
    options.out.mkdir(parents=True, exist_ok=True)
    common, lock = stamp(study), threading.Lock()
    wanted = [
        (repeat, case, digest(common, study.overrides(case), repeat))
        for repeat in range(options.repeats)
        for case in study.cases
    ]
    there = {record["key"] for record in read_records(study) if record["status"] == "done" or not options.again}
    job, jobs = options.job_array or (0, 1)
    work = [entry for entry in wanted[job::jobs] if entry[2] not in there]
    progress = Progress(study, work)
    with open(options.out / f"{study.name}{f'-job{job}' if options.job_array else ''}.jsonl", "a") as file:

        def make(entry):
            repeat, case, key = entry
            record = solve(study, case, repeat, key)
            with lock:
                file.write(json.dumps(record) + "\n")
                file.flush()
                progress.done(record)

        with ThreadPoolExecutor(options.jobs) as pool:
            list(pool.map(make, work))
    keys = {key for _, _, key in wanted}
    return [record for record in read_records(study) if record["key"] in keys]


# Of records: values, errors, tables


def richardson(values):
    """Limit of a series from its last three values, on meshes that are refined by one factor (Aitken's method). None
    where these values do not converge."""
    if len(values) < 3 or None in values[-3:]:
        return None
    first, second = values[-2] - values[-3], values[-1] - values[-2]
    return values[-1] + second**2 / (first - second) if first and 0 < second / first < 1 else None


def summarise(study, records):
    """One row for each point of the plot: medians of the timings, values of the measures, None where a run failed."""
    rows = []
    for row in study.rows():
        case = dict(row)
        own = [r for r in records if case.items() <= r["case"].items()]
        if not own:
            continue
        failed = next((r for r in own if r["status"] != "done"), None)
        rows.append(
            {
                "case": case,
                "runs": len(own),
                "status": failed["status"] if failed else "done",
                "cause": failed["cause"] if failed else "",
                **{
                    name: statistics.median(r[name] for r in own) if all(name in r for r in own) else None
                    for name in KEPT
                    if name != "probes"
                },
                "samples": [] if failed else [r["probes"] for r in own],
                "errors": {},
                "values": {},
            }
        )
    return rows


def add_errors(study, rows):
    """Values and errors in per cent of the rows, by the name of the measure; errors of a row's worst sample."""
    for measure in study.measures:
        for series in study.series(rows).values():
            for row in series:
                found = [sample[measure.probe] for sample in row["samples"]]
                row["values"][measure.name] = statistics.median(found) if found and None not in found else None
            values, wanted = [row["values"][measure.name] for row in series], measure.reference
            reference = (
                values[-1] if wanted == "finest" else richardson(values) if wanted == "richardson" else float(wanted)
            )
            for row in series[:-1] if wanted == "finest" else series:
                if reference is not None and row["values"][measure.name] is not None:
                    row["errors"][measure.name] = max(
                        sample_error(measure, sample, reference) for sample in row["samples"]
                    )


def sample_error(measure, sample, reference):
    """Per cent of the reference, or of 1 where that is 0."""
    scale, value = 100 / abs(reference or 1), sample[measure.probe]
    return scale * (abs(value - reference) + (abs(value * sample[measure.spread]) / 100 if measure.spread else 0))


def text(value, digits=3):
    """A cell: integers as they are, reals with some digits, no exponent where it can be avoided."""
    if value is None or value == "":
        return "-"
    if isinstance(value, str):
        return value
    if value == int(value) and abs(value) < 1e7:
        return str(int(value))
    shown = f"{value:.{digits}g}"
    return str(int(float(shown))) if "e+" in shown and abs(value) < 1e7 else shown


def markdown(header, rows):
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (header, ["---"] * len(header), *rows)) + "\n"


def point_table(study, rows):
    names = [name for name in study.axes if name not in study.options.worst]
    header = [*names, "status", "runs", "dofs", "steps", "failed", "iterations", "CPU s", "CPU s a step", "memory MB"]
    probes = list(dict.fromkeys(measure.probe for measure in study.measures))
    header += [*probes, *(f"error, {measure.name}, %" for measure in study.measures)]
    cells = []
    for row in rows:
        status = row["status"] if row["status"] == "done" else f"{row['status']}: {row['cause']}"
        step = row["cpu_s"] / row["steps"] if row["steps"] else None
        counts = [row[name] for name in ("dofs", "steps", "steps_failed", "newton_iterations", "cpu_s")]
        values = {measure.probe: row["values"].get(measure.name) for measure in study.measures}
        errors = [row["errors"].get(measure.name) for measure in study.measures]
        cells.append(
            [
                *(row["case"][name] for name in names),
                status,
                row["runs"],
                *counts,
                step,
                row["peak_rss_mb"],
                *values.values(),
                *errors,
            ]
        )
    return header, cells


def target_table(study, rows, measure):
    """CPU seconds at the errors asked for, by line."""
    header, cells = ["", *(f"{target:g} %" for target in study.options.targets)], []
    for (panel, line), series in study.series(rows).items():
        found = [cost(series, measure, target) for target in study.options.targets]
        shown = [COST[how].format(text(seconds, 2)) for seconds, how in found]
        cells.append([", ".join(filter(None, (line, panel))), *shown])
    return header, cells


def cheapest(study, own, measure, target):
    """The cheapest of some lines at an error: (seconds, words). The words say from which value of the last axis on the
    error is reached. Where no line reaches it: (seconds spent, None)."""
    reached = [(*cost(series, measure, target), series) for series in own]
    seconds, _, series = min(
        (entry for entry in reached if entry[1] in ("", "<=")), key=lambda entry: entry[0], default=(None, None, None)
    )
    if series is None:
        return max((row["cpu_s"] for series in own for row in series if row["errors"].get(measure)), default=None), None
    start = next(
        k for k in range(len(series)) if all((row["errors"].get(measure) or 0) <= target for row in series[k:])
    )
    return seconds, ", ".join(series[start]["case"][name] for name in (*study.lines[1:], study.along))


def best_table(study, rows, measure):
    """By label of the first axis: the cheapest of its lines at the errors asked for. A last row has the cost of the
    first label over that of the cheapest other one."""
    labels, columns = study.axes[study.lines[0]], list(
        itertools.product(study.axes.get(study.options.panels, [""]), study.options.targets)
    )
    cells, ratios = {label: [] for label in labels}, []
    for panel, target in columns:
        found = {}
        for label in labels:
            own = [
                series
                for (p, _), series in study.series(rows).items()
                if p == panel and series[0]["case"][study.lines[0]] == label
            ]
            seconds, words = found[label] = cheapest(study, own, measure, target)
            least = min(
                (row["errors"][measure] for series in own for row in series if row["errors"].get(measure)), default=None
            )
            cells[label].append(
                f"{text(seconds, 2)} ({words})"
                if words
                else f"not reached in {text(seconds, 2)}, at best {text(least, 2)} %"
            )
        (seconds, words), others = next(iter(found.values())), [
            cpu for cpu, reached in list(found.values())[1:] if reached
        ]
        ratios.append(
            f"{'' if words else 'more than '}{text(seconds / min(others), 2)} times" if others and seconds else "-"
        )
    header = ["", *(", ".join(filter(None, (f"{target:g} %", panel))) for panel, target in columns)]
    told = [[label, *row] for label, row in cells.items()]
    return header, told if set(ratios) == {"-"} else [*told, [f"{next(iter(labels))} over the cheapest", *ratios]]


def tell(study, rows):
    """NAME.md: the tables, and what follows from them."""
    header, cells = point_table(study, rows)
    digits = [VALUE_DIGITS if name in {measure.probe for measure in study.measures} else 3 for name in header]
    parts = [
        f"# {study.options.title or study.name}\n",
        markdown(header, [[text(*cell) for cell in zip(row, digits)] for row in cells]),
    ]
    for measure in study.measures if study.options.targets else []:
        parts.append(
            f"{measure.name}: CPU seconds from which on a line stays below an error\n\n"
            + markdown(*target_table(study, rows, measure.name))
        )
        parts.append(
            f"{measure.name}: the cheapest of each, CPU seconds\n\n" + markdown(*best_table(study, rows, measure.name))
        )
    for measure in study.measures if study.options.against else []:
        for (panel, line), series in study.series(rows).items():
            row, error = enough(series, measure.name)
            parts.append(
                f"{measure.name}, {', '.join(filter(None, (line, panel)))}: "
                + (
                    f"beyond {row['case'][study.along]} the error of {text(error)} % stays\n"
                    if row
                    else "every value changes the answer\n"
                )
            )
    return "\n".join(parts)


def write_tables(study, rows):
    """NAME.csv and NAME.md; returns the latter's text."""
    header, cells = point_table(study, rows)
    with open(study.options.out / f"{study.name}.csv", "w", newline="") as file:
        csv.writer(file).writerows(
            [
                header,
                *[
                    ["" if cell is None else f"{cell:.8g}" if isinstance(cell, float) else cell for cell in row]
                    for row in cells
                ],
            ]
        )
    told = tell(study, rows)
    (study.options.out / f"{study.name}.md").write_text(told)
    return told


def arguments(line=None):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, fromfile_prefix_chars="@"
    )
    parser.convert_arg_line_to_args = lambda text: shlex.split(text, comments=True)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument(
        "--vary", dest="axes", action="append", metavar="KEY=V,V", help="values of one key of the scene"
    )
    parser.add_argument(
        "--case",
        dest="axes",
        action="append",
        nargs="+",
        metavar="WORD",
        help="AXIS LABEL KEY=VALUE...: one value of an axis, by several keys together",
    )
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="the same in all runs")
    parser.add_argument(
        "--skip",
        action="append",
        nargs="+",
        default=[],
        metavar="LABEL",
        help="leaves out combinations that have all of these labels",
    )
    parser.add_argument(
        "--measure",
        action="append",
        default=[],
        metavar="[NAME: ]PROBE[/SPREAD]",
        help="SPREAD: a probe of the deviation in per cent, which is added to the error",
    )
    parser.add_argument(
        "--reference",
        action="append",
        default=[],
        metavar="VALUE|finest|richardson",
        help="one for each measure or one for all; finest: the last value of each line",
    )
    parser.add_argument(
        "--worst",
        action="append",
        default=[],
        metavar="AXIS",
        help="the runs of this axis make one point: its error is the largest",
    )
    parser.add_argument("--panels", metavar="AXIS", help="a panel for each label of this axis")
    parser.add_argument(
        "--targets",
        type=lambda t: [float(v) for v in t.split(",")],
        default=[],
        metavar="E,E",
        help="errors in per cent whose cost is told",
    )
    parser.add_argument(
        "--against",
        action="store_true",
        help="the plot is over the last --vary, with the iterations beside; told is from where on it buys nothing",
    )
    parser.add_argument("--name", help="of the files; default: the scene's")
    parser.add_argument("--title")
    parser.add_argument("--repeats", type=int, default=3, help="of each run; timings are medians")
    parser.add_argument("--ranks", type=int, default=1, help="of each run")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument(
        "--job-array",
        type=lambda t: tuple(int(v) for v in t.split(",")),
        metavar="INDEX,COUNT",
        help="only this job's share, INDEX from 0; no tables",
    )
    parser.add_argument("--time-limit", type=float, default=3600, metavar="S", help="for one run")
    parser.add_argument("--again", action="store_true", help="repeats runs that failed")
    parser.add_argument(
        "--quick",
        action="store_true",
        help="one repeat, two values along each line: shows that everything runs, its figures mean nothing",
    )
    parser.add_argument(
        "--print", dest="only_print", action="store_true", help="tables and plot of the records that are there"
    )
    parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build/burnish")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/study")
    options = parser.parse_args(line)
    if not options.axes:
        parser.error("nothing to vary: give --vary or --case")
    if not options.scene.exists() and (ROOT / options.scene).exists():
        options.scene = ROOT / options.scene  # a study's file names it from here, wherever one stands
    if not options.scene.exists():
        parser.error(f"no scene {options.scene}")
    if len(options.reference) not in {min(1, len(options.measure)), len(options.measure)} or any(
        math.isnan(number(r)) and r not in ("finest", "richardson") for r in options.reference
    ):
        parser.error("--reference: a number, finest or richardson, one for each --measure or one for all")
    unknown = {*options.worst, *filter(None, [options.panels])} - set(axes(options.axes))
    if unknown:
        parser.error(f"no axis {unknown.pop()}; there are {', '.join(axes(options.axes))}")
    if options.job_array and (len(options.job_array) != 2 or not 0 <= options.job_array[0] < options.job_array[1]):
        parser.error("--job-array INDEX,COUNT: INDEX from 0 to COUNT - 1")
    options.repeats = 1 if options.quick else options.repeats
    return options


def tabulate(study, records):
    """Rows with errors."""
    rows = summarise(study, records)
    add_errors(study, rows)
    return rows


def main():
    study = Study(arguments())
    records = read_records(study) if study.options.only_print else run(study)
    if study.options.job_array:
        return
    rows = tabulate(study, records)
    print(write_tables(study, rows))
    if study.options.measure and any(row["errors"] for row in rows):
        from studyplot import draw  # a plot needs matplotlib, which takes a second

        draw(study, rows, study.options.out / f"{study.name}.png")


if __name__ == "__main__":
    main()
