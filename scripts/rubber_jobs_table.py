"""Jobs of tests/jobs with rubber, at default settings with Poisson's ratios of 0.45 and 0.499: steps, failed steps and
iterations. Rubber is each body with a hyperelastic law and a ratio of at least 0.45; the other bodies keep theirs.
`times` is the ratio of the steps. Runs go one after the other, on one rank.
    python scripts/rubber_jobs_table.py [--burnish BINARY] [--record FILE] [--only JOB ...]
--print tables an existing record."""
import subprocess

import yaml

from launch import ROOT, environment, fill_scenes, read_summary

JOBS = ROOT / "tests/jobs"
RATIOS = (0.45, 0.499)
RUBBER = 0.45  # smallest ratio of what is called rubber here
LAWS = ("neo_hookean", "isochoric_neo_hookean", "mooney_rivlin", "yeoh", "ogden", "arruda_boyce")
LIMIT = 600  # s of one run
COLUMNS = ("job", "nu", "status", "steps", "failed", "iterations", "times")


def rubbers(job):
    """Numbers of the bodies of a job that are rubber."""
    bodies = yaml.safe_load((JOBS / f"{job}.yaml").read_text())["bodies"]
    materials = [body.get("material", {}) for body in bodies]
    return [i for i, material in enumerate(materials) if material.get("law") in LAWS and
            material.get("nu", 0) >= RUBBER]


def run(args, job, nu):
    """The record of one run."""
    directory = args.out / f"{job}-{nu}"
    line = [args.burnish, JOBS / f"{job}.yaml", "-o", directory, "-overwrite", "-quiet", "-time_limit", str(LIMIT)]
    for override in ("output.every=0", *(f"bodies.{i}.material.nu={nu}" for i in rubbers(job))):
        line += ["-set", override]
    finished = subprocess.run(line, env=environment(args.burnish), capture_output=True, text=True)
    if finished.returncode not in (0, 2, 3):
        raise SystemExit(f"{job}, nu {nu}:\n{finished.stderr}")
    summary = read_summary(directory)
    return {"job": job, "nu": nu, "status": summary["status"], "steps": summary["steps"],
            "failed": summary["steps_failed"], "iterations": summary["newton_iterations"]}


def solve(args, job):
    """Records of a job with each ratio."""
    low, high = (run(args, job, nu) for nu in RATIOS)
    if low["status"] == high["status"] == "done":
        high["times"] = f"{high['steps'] / low['steps']:.2f}"
    return [low, high]


def print_table(rows):
    """Steps / failed steps / iterations with each ratio, one line for a job."""
    print("| job | nu = 0.45 | 0.499 | times the steps |\n| --- | --- | --- | --- |")
    for low, high in zip(rows[::2], rows[1::2]):
        figures = [f"{row['steps']}/{row['failed']}/{row['iterations']}" +
                   ("" if row["status"] == "done" else f" ({row['status']})") for row in (low, high)]
        print(f"| {low['job']} | {figures[0]} | {figures[1]} | {high['times']} |")


if __name__ == "__main__":
    fill_scenes(__doc__, "rubber_jobs", COLUMNS, solve, sorted(
        path.stem for path in JOBS.glob("*.yaml") if rubbers(path.stem)), print_table)
