"""Runs Burnish for the scene tests and compares what it leaves: every script here is called as
    NAME.py --burnish BINARY --ranks N --out DIR [its own arguments]
and ends with status 0 when every Check held."""
import argparse
import csv
import json
import pathlib
import shutil
import subprocess
import sys

import numpy

SCENES = pathlib.Path(__file__).resolve().parent


class Run:
    """One finished run: exit status, terminal text and the files in its directory."""

    def __init__(self, status, text, directory):
        self.status, self.text, self.directory = status, text, pathlib.Path(directory)

    def summary(self):
        return json.loads((self.directory / "summary.json").read_text())

    def steps(self):
        """steps.csv as a list of rows: column -> float, None where empty, the name of the step as a text."""
        with open(self.directory / "steps.csv", newline="") as file:
            return [{
                key: (value if key == "during" else float(value)) if value.strip() else None
                for key, value in row.items()
            }
                    for row in csv.DictReader(file, skipinitialspace=True)]

    def fields(self):
        """Node coordinates and every field of the last written step but components of tensors, contact fields as
        contact/PAIR/NAME."""
        import h5py  # here: most tests need no field, and it takes longer to load than many runs take

        fields = {}
        with h5py.File(self.directory / "results.h5", "r") as file:
            last = file["steps"][sorted(file["steps"])[-1]]
            last.visititems(lambda name, item: fields.update({name: item[()]})
                            if isinstance(item, h5py.Dataset) and not item.is_virtual else None)
            fields["nodes"] = file["mesh/nodes"][()]
            for pair in file.get("contact", {}):
                fields[f"contact/{pair}/nodes"] = file["contact"][pair]["nodes"][()]
        return fields


class Check:
    """Collects comparisons, prints each with its figure, ends the script."""

    def __init__(self):
        self.failed = 0

    def holds(self, what, condition, note=""):
        print(f"{'ok  ' if condition else 'FAIL'} {what} {note}".rstrip())
        self.failed += not condition

    def near(self, what, value, reference, tolerance):
        """|value - reference| <= tolerance, arrays by their largest difference; a value that is not there fails."""
        missing = value is None or numpy.any(numpy.isnan(numpy.asarray(value, dtype=float)))
        error = numpy.inf if missing else float(numpy.max(numpy.abs(numpy.asarray(value, dtype=float) - reference)))
        self.holds(what, error <= tolerance, f"error {error:.3e}, allowed {tolerance:.3e}")

    def effort(self, summary, steps, failed, iterations):
        """A run took at most so many steps, failed ones and iterations."""
        self.holds("steps", summary["steps"] <= steps and summary["steps_failed"] <= failed,
                   f"{summary['steps']}, {summary['steps_failed']} failed")
        self.holds("iterations", summary["newton_iterations"] <= iterations, str(summary["newton_iterations"]))

    def finish(self):
        sys.exit(1 if self.failed else 0)


def arguments(*own):
    """The common arguments and the script's own: (name, help) pairs, or (name, help, choices)."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--burnish", required=True)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--out", required=True)
    for name, text, *choices in own:
        parser.add_argument("--" + name, help=text, required=True, choices=choices[0] if choices else None)
    return parser.parse_args()


def run(args, scene, *options, out="run", ranks=None, overrides=(), keep=False, must=0, limit=None):
    """Runs a scene on the ranks asked for, a single one without mpirun, which would take as long as a small run. must:
    the exit status without which the script ends at once, None: any. limit: seconds, then status 124."""
    directory = pathlib.Path(args.out) / out
    if not keep:
        shutil.rmtree(directory, ignore_errors=True)
    directory.parent.mkdir(parents=True, exist_ok=True)
    ranks = ranks or args.ranks
    command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    command += [args.burnish, str(scene), "-o", str(directory), *options]
    for override in overrides:
        command += ["-set", override]
    if limit:
        command = ["timeout", str(limit), *command]
    finished = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if must is not None and finished.returncode != must:
        sys.exit(f"{' '.join(command)}\n{finished.stdout}\nexit status {finished.returncode} instead of {must}")
    return Run(finished.returncode, finished.stdout, directory)


def run_in_parts(args, scene, out, overrides=(), most=200):
    """Runs a scene one step at a time, each from the checkpoint of the one before."""
    part = run(args, scene, "-quiet", "-time_limit", "1e-9", out=out, overrides=overrides, must=3)
    launcher = ["mpirun", "-n", str(args.ranks)] if args.ranks > 1 else []
    again = [*launcher, args.burnish, "-restart", str(part.directory), "-quiet", "-time_limit", "1e-9"]
    for _ in range(most):
        if part.status != 3:
            break
        finished = subprocess.run(again, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        part = Run(finished.returncode, finished.stdout, part.directory)
    if part.status != 0:
        sys.exit(f"{scene} in parts\n{part.text}\nexit status {part.status} instead of 0")
    return part
