"""Runs the ordinary jobs of jobs.py and compares their answers with the references there. A line for each answer; ends
with status 0 when every job is done within its bounds.
    run.py [--burnish BINARY] [--out DIR] [--job NAME ...] [--ranks N ...] [--set OVERRIDE ...] [--record FILE.csv]
    run.py --limit [--job NAME ...]      runs on refined meshes with a stiff penalty, and extrapolates the answers
    run.py --pictures DIR                draws what the last runs left in --out
    run.py --table BEFORE.csv AFTER.csv  prints two records side by side, in Markdown
In an OVERRIDE, `contact.*` stands for every contact pair of the scene. A job that is done neither within its bounds nor
within LIMIT has failed; the reason is the last message of the run."""
import argparse
import csv
import math
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(ROOT / "tests/scenes"), str(ROOT / "scripts")]
import harness  # noqa: E402
import jobs  # noqa: E402
import launch  # noqa: E402

LIMIT = 600  # s of one run
COLUMNS = ("job", "status", "steps", "failed", "iterations", "cpu_s", "probe", "answer", "reference", "error",
           "reference_error", "source", "as_expected", "reason")
STIFF = ("contact.*.smoother=diffuse", "contact.*.formulation=surface_to_surface", "contact.*.penalty={scale: 1000}",
         "output.every=0")


def overrides_of(job, texts):
    """The overrides with every pair's number in place of the star."""
    return [text.replace("*", str(i)) for text in texts for i in (range(job.pairs) if "*" in text else (0, ))]


def run(args, job, overrides, out, ranks=1):
    return harness.run(args, HERE / f"{job.name}.yaml", out=out, ranks=ranks, overrides=overrides_of(job, overrides),
                       must=None, limit=LIMIT)


def reason(finished):
    """Why a run has not ended well: its last message."""
    lines = [line.strip() for line in finished.text.splitlines() if line.strip()]
    said = [line for line in lines if line.startswith("burnish: ")] or lines[-1:] or [""]
    return "longer than the limit" if finished.status == 124 else said[-1]


def figures(job, finished):
    """What a run took, or as much as it left."""
    if not (finished.directory / "summary.json").exists():
        return {"status": f"exit {finished.status}"}, {}
    summary = finished.summary()
    return {
        "status": summary["status"],
        "steps": summary["steps"],
        "failed": summary["steps_failed"],
        "iterations": summary["newton_iterations"],
        "cpu_s": round(summary["cpu_s"], 2)
    }, summary["probes"] if finished.status == 0 else {}


def unlike(args, job, first):
    """On which of the further numbers of ranks a job does not end as on the first."""
    for ranks in args.ranks[1:]:
        finished = run(args, job, args.set, f"{job.name}-np{ranks}", ranks)
        if finished.status != first.status:
            yield f"{ranks} ranks: exit {finished.status}, {reason(finished)}"
            continue
        ours, theirs = (figures(job, each)[1] for each in (first, finished))
        for answer in job.answers:
            value, other = ours.get(answer.probe), theirs.get(answer.probe)
            if value is not None and (other is None or abs(other / value - 1) > job.ranks):
                yield f"{ranks} ranks: {answer.probe} {other} instead of {value}"


def rows(args, job):
    """Runs a job on every number of ranks: a row for each answer, of the first number."""
    finished = run(args, job, args.set, job.name, args.ranks[0])
    cost, probes = figures(job, finished)
    faults = [] if finished.status == 0 else [reason(finished)]
    if finished.status == 0:
        if cost["steps"] > job.steps:
            faults.append(f"{cost['steps']} steps, allowed {job.steps}")
        if cost["failed"] > jobs.FAILED * (cost["steps"] + cost["failed"]):
            faults.append(f"{cost['failed']} failed steps")
    faults += unlike(args, job, finished)
    for answer in job.answers:
        value = probes.get(answer.probe)
        error = None if value is None else 100 * (value / answer.reference - 1)
        wrong = faults + ([] if error is not None and abs(error) <= answer.tolerance else
                          [f"{answer.probe}: no answer" if error is None else f"{answer.probe}: {error:+.2f} %"])
        yield dict(cost, job=job.name, probe=answer.probe, answer=value, reference=answer.reference,
                   error=None if error is None else round(error, 3), reference_error=answer.error,
                   source=answer.source, as_expected="no" if wrong else "yes", reason="; ".join(wrong))


def extrapolated(values, ratio):
    """Limit of values on meshes that are each `ratio` times finer, and its error in per cent: of the last three by
    their own order, which is taken between 1/2 and 4."""
    first, second, third = values[-3:]
    steps = (second - first, third - second)
    falls = steps[0] / steps[1] if steps[1] else math.inf
    order = min(max(math.log(abs(falls), ratio), 0.5), 4) if falls else 0.5
    if falls < 0:  # no order: the values scatter about the limit
        return third, 100 * max(map(abs, steps)) / abs(third)
    correction = steps[1] / (ratio**order - 1)
    return third + correction, 100 * abs(correction) / abs(third)


def limit(args, job):
    """Answers on refined meshes with a stiff penalty, and their limit."""
    table = []
    for level in job.levels:
        finished = run(args, job, [*STIFF, *job.stiff, *args.set, f"mesh.parameters.refine={level}"],
                       f"{job.name}-limit-{level}")
        cost, probes = figures(job, finished)
        table.append(probes)
        print(f"{job.name} refine {level}: {cost} {probes or reason(finished)}", flush=True)
    for answer in job.answers:
        values = [probes.get(answer.probe) for probes in table]
        if len(values) > 2 and None not in values:
            value, error = extrapolated(values, job.levels[-1] / job.levels[-2])
            print(f"{job.name} {answer.probe}: limit {value:.6g}, error {error:.2g} %", flush=True)


def picture(args, job, directory):
    line = [sys.executable, ROOT / "scripts/render.py", pathlib.Path(args.out) / job.name, "--field", job.shown,
            "--width", "420", *job.picture, "-o", pathlib.Path(directory) / f"{job.name}.png"]
    return subprocess.run([str(part) for part in line]).returncode


def cells(rows):
    """What one record says of a job, for the table."""
    first = rows[0]
    if first["status"] != "done":
        return [first["steps"], first["failed"], first["iterations"], first["cpu_s"], first["status"], ""]
    answers = " / ".join(f"{float(row['answer']):.4g}" if row["answer"] else "none" for row in rows)
    errors = " / ".join(f"{float(row['error']):+.1f}" if row["error"] else "" for row in rows)
    return [first["steps"], first["failed"], first["iterations"], first["cpu_s"], answers, errors]


def table(before, after):
    """Two records as a table: a figure is before, after."""
    records = [list(csv.DictReader(open(path, newline=""))) for path in (before, after)]
    print("| job | steps | failed | iterations | CPU, s | answer | error, % | reference | its error, % | from |\n"
          f"|{' --- |' * 10}")
    for job in jobs.JOBS:
        mine = [[row for row in record if row["job"] == job.name] for record in records]
        both = [" → ".join(pair) for pair in zip(*(cells(rows) if rows else [""] * 6 for rows in mine))]
        references = [" / ".join(text) for text in zip(*((f"{answer.reference:.4g}", f"{answer.error:g}", answer.source)
                                                         for answer in job.answers))]
        print(f"| {job.what} | {' | '.join(both + references)} |")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burnish", default="build/burnish")
    parser.add_argument("--out", default="out/jobs")
    parser.add_argument("--job", nargs="+", choices=[job.name for job in jobs.JOBS])
    parser.add_argument("--ranks", type=int, nargs="+", default=[1])
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--record")
    parser.add_argument("--limit", action="store_true")
    parser.add_argument("--pictures")
    parser.add_argument("--table", nargs=2)
    args = parser.parse_args()
    chosen = [job for job in jobs.JOBS if not args.job or job.name in args.job]
    if args.table:
        table(*args.table)
        return 0
    if args.pictures:
        return any([picture(args, job, args.pictures) for job in chosen])
    os.environ.update(launch.environment(args.burnish))
    if args.limit:
        for job in chosen:
            limit(args, job)
        return 0
    lines = []
    for job in chosen:
        for row in rows(args, job):
            print(f"{'ok  ' if row['as_expected'] == 'yes' else 'FAIL'} {job.name}: {row['status']}, "
                  f"{row.get('steps')} steps, {row.get('failed')} failed, {row.get('iterations')} iterations, "
                  f"{row.get('cpu_s')} s, {row['probe']} {row['answer']}, error {row['error']} % "
                  f"{row['reason']}".rstrip(), flush=True)
            lines.append(row)
    if args.record:
        with open(args.record, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(lines)
    return any(row["as_expected"] != "yes" for row in lines) or not lines


if __name__ == "__main__":
    sys.exit(main())
