"""Finds numbers of scenes so that curves of their probes come near measured ones, and says how certain each number is.
    python scripts/calibrate.py CALIBRATION.yaml [--burnish BINARY] [--out DIR]
The file names the numbers, each with the value to start from and what it may be, and the curves: a scene, its probe, a csv with the columns t
and value, and the standard deviation of a measurement:
    numbers: {E: {start: 4, within: [1, 100]}, nu: {start: 0.3, within: [0, 0.49]}}
    curves:
      - {scene: a.yaml, probe: force, csv: a.csv, deviation: 0.5, keys: {E: bodies.0.material.E, nu: bodies.0.material.nu}}
SciPy's least squares (trust region, Branch, Coleman and Li 1999) chooses the numbers. Derivatives of the curves are
forward differences of whole runs by 1e-4 of a number, as curves need them at all load parameters; where only t = 1
counts, one run with -sensitivity gives them. The standard deviation of a number is that of linear regression: the root
of the diagonal of (J^T J)^-1, J the derivatives of the residuals over their deviations; it is multiplied by the root of
chi2 over the degrees of freedom where the curves do not say their deviation."""
import argparse
import csv
import pathlib
import subprocess

import numpy
import yaml
from scipy.optimize import least_squares

from launch import ROOT, command, environment, read_steps

STEP = 1e-4  # of a number, for derivatives


class Curve:
    """A measured curve and the run that is to follow it."""

    def __init__(self, folder, entry, out):
        with open(folder / entry["csv"], newline="") as file:
            rows = [(float(row["t"]), float(row["value"])) for row in csv.DictReader(file)]
        self.t, self.value = numpy.array(rows).T
        self.scene, self.probe, self.keys = folder / entry["scene"], entry["probe"], entry["keys"]
        self.deviation, self.out = entry.get("deviation"), out

    def residuals(self, burnish, numbers):
        """Of the measured points, over their deviation; the run is made to end a step at each."""
        edits = [f"{key}={numbers[name]!r}" for name, key in self.keys.items()]
        edits.append("stepping.at=[" + ", ".join(f"{t:.17g}" for t in self.t if 0 < t < 1) + "]")
        line = command(burnish, 1, self.scene, self.out, edits, "-quiet", "-overwrite")
        done = subprocess.run(line, env=environment(burnish), capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"{self.scene} with {numbers}: {done.stderr[-600:]}")
        steps = read_steps(self.out)
        found = numpy.interp(self.t, [0, *steps["t"]], [0, *steps[self.probe]])
        return (found - self.value) / (self.deviation or 1)


def calibrate(burnish, file, out):
    """Names, values, standard deviations, correlation and chi2 per degree of freedom."""
    text = yaml.safe_load(file.read_text())
    curves = [Curve(file.parent, entry, out / str(i)) for i, entry in enumerate(text["curves"])]
    names = list(text["numbers"])
    start = numpy.array([text["numbers"][name]["start"] for name in names], dtype=float)
    bounds = numpy.array([text["numbers"][name].get("within", (-numpy.inf, numpy.inf)) for name in names])
    scaled = numpy.sort(bounds / start[:, None], axis=1).T

    def residuals(parts):
        numbers = dict(zip(names, (parts * start).tolist()))
        return numpy.concatenate([curve.residuals(burnish, numbers) for curve in curves])

    best = least_squares(residuals, numpy.ones(len(names)), bounds=scaled, diff_step=STEP, xtol=1e-6)
    freedom = len(best.fun) - len(names)
    chi2 = 2 * best.cost / freedom
    covariance = numpy.linalg.inv(best.jac.T @ best.jac) * (1 if all(curve.deviation for curve in curves) else chi2)
    deviation = numpy.sqrt(numpy.diag(covariance))
    return names, best.x * start, deviation * abs(start), covariance / numpy.outer(deviation, deviation), chi2, best.nfev


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build/burnish")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/calibrate")
    args = parser.parse_args()
    names, values, deviations, correlation, chi2, trials = calibrate(args.burnish, args.file, args.out)
    for name, value, deviation in zip(names, values, deviations):
        print(f"{name} = {value:.6g} +- {deviation:.2g} ({100 * deviation / abs(value):.2g} %)")
    for i, first in enumerate(names):
        for j, second in enumerate(names[:i]):
            print(f"correlation of {second} and {first}: {correlation[i, j]:+.3f}")
    print(f"chi2 per degree of freedom {chi2:.3g}, {trials} trials")


if __name__ == "__main__":
    main()
