"""Fits the laws of rubber to tests: uniaxial, equibiaxial and planar tension or compression of an incompressible solid.
    fit_rubber.py --uniaxial FILE.csv [--equibiaxial FILE.csv] [--planar FILE.csv] [--law LAW] [--terms N]
    fit_rubber.py PREFIX ...    takes those of PREFIX_uniaxial.csv, PREFIX_equibiaxial.csv, PREFIX_planar.csv that exist
A file has two columns, stretch and nominal stress (force per undeformed area); lines with # and a head are skipped. The
unit of the stress is that of the constants. For each law it prints the error and the material line of a scene, and it
draws all fits beside the data into OUT/fit.png.
Each test counts the same, however many points it has. The sum of the squares of the errors is least, each over the
largest stress of its test, or with --relative over the stress itself. The constants of mooney_rivlin and the products
mu alpha of ogden are held above 0, which keeps these laws stable at all stretches; --free lifts that. yeoh is free."""
import argparse
import csv
import itertools
import pathlib

import numpy

TESTS = ("uniaxial", "equibiaxial", "planar")
# The series of Arruda and Boyce, as in src/kernels/arrudaboycelaw.c
SERIES = (1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750)
# Exponents and limiting stretches from which the search starts
EXPONENTS = (-6, -3, -1.5, 1.2, 2.5, 5, 9)
LIMITS = (1.5, 2.5, 4, 6, 10)
# Told apart by the colour-blind, too
COLOURS = ("#0072b2", "#d55e00", "#009e73")
# The search ends when a step changes the parameters by less than this part of them, or after so many steps
STEP_END, MOST_STEPS = 1e-12, 200


def stretches(test, l):
    """The principal stretches. The second stress is 0 in uniaxial tests, and the third one is 0 in all."""
    return {"uniaxial": (l, l**-0.5, l**-0.5), "equibiaxial": (l, l, l**-2.0), "planar": (l, 1 + 0 * l, 1 / l)}[test]


def invariant(test, l):
    return sum(value**2 for value in stretches(test, l))


def first(test, l):
    """Nominal stress of the energy I1"""
    one, _, three = stretches(test, l)
    return 2 * (one**2 - three**2) / one


def second(test, l):
    """Nominal stress of the energy I2"""
    one, _, three = stretches(test, l)
    return 2 * (three**-2 - one**-2) / one


def power(test, l, alpha):
    """Nominal stress of the energy sum l^alpha / alpha"""
    one, _, three = stretches(test, l)
    return (one**alpha - three**alpha) / one


def chains(test, l, limit):
    """Nominal stress of Arruda and Boyce's law with mu = 1"""
    one = invariant(test, l)
    return first(test, l) * sum(c * k * one**(k - 1) / limit**(2 * k - 2) for k, c in enumerate(SERIES, 1))


class Law:
    """A law whose stress is a sum of columns times constants. The columns may have parameters of their own."""

    def __init__(self, columns, signs, starts, line):
        self.columns = columns  # (test, stretch, parameters) -> list of arrays
        self.signs = signs  # parameters -> sign of each constant, 0: any
        self.starts = starts  # lists of parameters to start from
        self.line = line  # (constants, parameters) -> words of the material


def ogden(terms):
    def line(constants, exponents):
        pairs = sorted(zip(constants, exponents), key=lambda pair: -abs(pair[0] * pair[1]))
        return "law: ogden, terms: [" + ", ".join(f"[{mu:.6g}, {alpha:.6g}]" for mu, alpha in pairs if mu) + "]"

    return Law(lambda test, l, exponents: [power(test, l, alpha) for alpha in exponents],
               lambda exponents: numpy.sign(exponents), list(itertools.combinations(EXPONENTS, terms)), line)


def laws(terms):
    return {
        "neo_hookean": Law(lambda test, l, _: [first(test, l) / 2], lambda _: [1], [()],
                           lambda c, _: f"law: neo_hookean, mu: {c[0]:.6g}"),
        "mooney_rivlin": Law(lambda test, l, _: [first(test, l), second(test, l)], lambda _: [1, 1], [()],
                             lambda c, _: f"law: mooney_rivlin, c10: {c[0]:.6g}, c01: {c[1]:.6g}"),
        "yeoh": Law(lambda test, l, _: [first(test, l) * k * (invariant(test, l) - 3)**(k - 1) for k in (1, 2, 3)],
                    lambda _: [0, 0, 0], [()],
                    lambda c, _: f"law: yeoh, c10: {c[0]:.6g}, c20: {c[1]:.6g}, c30: {c[2]:.6g}"),
        "arruda_boyce": Law(lambda test, l, p: [chains(test, l, numpy.exp(p[0]))], lambda _: [1],
                            [(numpy.log(limit),) for limit in LIMITS],
                            lambda c, p: f"law: arruda_boyce, mu: {c[0]:.6g}, lambda_m: {numpy.exp(p[0]):.6g}"),
        "ogden": ogden(terms),
    }


def matrix(law, data, parameters):
    return numpy.concatenate([numpy.array(law.columns(test, l, parameters)).T for test, (l, _) in data.items()])


def bounded(A, b, signs):
    """The constants with the signs that are asked for and the least error: all choices of constants that are 0."""
    best = None
    for kept in itertools.product((True, False), repeat=len(signs)):
        if not any(kept) or any(sign == 0 and not keep for sign, keep in zip(signs, kept)):
            continue
        constants = numpy.zeros(len(signs))
        constants[list(kept)] = numpy.linalg.lstsq(A[:, list(kept)], b, rcond=None)[0]
        error = numpy.linalg.norm(A @ constants - b)
        if all(constant * sign >= 0 for constant, sign in zip(constants, signs)) and (not best or error < best[0]):
            best = error, constants
    return best[1] if best else numpy.zeros(len(signs))


def solve(law, data, scale, free, parameters):
    """The constants for parameters, and the errors that they leave."""
    with numpy.errstate(all="ignore"):
        A = scale[:, None] * matrix(law, data, parameters)
        finite = numpy.all(numpy.isfinite(A * A))
    if not finite:  # the search does not take this step
        return numpy.zeros(A.shape[1]), numpy.full(len(A), numpy.inf)
    b = scale * numpy.concatenate([stress for _, stress in data.values()])
    signs = numpy.zeros(A.shape[1]) if free else law.signs(parameters)
    size = numpy.maximum(numpy.linalg.norm(A, axis=0), numpy.finfo(float).tiny)
    constants = bounded(A / size, b, signs) / size
    return constants, A @ constants - b


def search(errors, start):
    """Levenberg's and Marquardt's method for the parameters."""
    x, damping = numpy.array(start, dtype=float), 1e-2
    r = errors(x)
    for _ in range(MOST_STEPS):
        J = numpy.empty((len(r), len(x)))
        for k in range(len(x)):
            h = 1e-6 * max(1, abs(x[k]))
            J[:, k] = (errors(x + h * (numpy.arange(len(x)) == k)) - errors(x - h *
                                                                            (numpy.arange(len(x)) == k))) / (2 * h)
        H, g = J.T @ J, J.T @ r
        while damping < 1e12:
            step = numpy.linalg.solve(H + damping * numpy.diag(numpy.diag(H) + 1e-30), -g)
            moved = errors(x + step)
            if numpy.all(numpy.isfinite(moved)) and moved @ moved <= r @ r:
                break
            damping *= 4
        else:
            return x, r
        x, r, damping = x + step, moved, max(damping / 10, 1e-15)
        if numpy.linalg.norm(step) <= STEP_END * numpy.linalg.norm(x):
            break
    return x, r


def fit(law, data, relative=False, free=False):
    """Constants, parameters and errors (root of the mean square) of the best fit from all starts."""
    scale = numpy.concatenate([
        1 / (numpy.abs(stress) if relative else numpy.max(numpy.abs(stress))) / numpy.sqrt(len(stress) * len(data)) *
        numpy.ones(len(stress)) for _, stress in data.values()
    ])
    best = None
    for start in law.starts:
        parameters = numpy.array(start, dtype=float)
        if len(start):
            parameters, _ = search(lambda x: solve(law, data, scale, free, x)[1], start)
        constants, errors = solve(law, data, scale, free, parameters)
        error = numpy.linalg.norm(errors)
        if numpy.isfinite(error) and (best is None or error < best[2]):
            best = constants, parameters, error
    return best


def read(file):
    """Stretches and stresses of a csv, without points at the stretch 1, where every law is exact."""
    points = []
    with open(file, newline="") as stream:
        for row in csv.reader(line for line in stream if not line.startswith("#")):
            try:
                points.append((float(row[0]), float(row[1])))
            except (ValueError, IndexError):
                if points or not row:
                    raise SystemExit(f"{file}: {','.join(row)}: allowed: stretch,stress")
    l, stress = numpy.array([point for point in points if point[0] != 1]).T
    if numpy.any(l <= 0) or numpy.any(stress == 0):
        raise SystemExit(f"{file}: allowed: stretches above 0, stresses other than 0")
    return l, stress


def draw(data, fits, table, picture):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    columns = min(3, len(fits))
    rows = -(-len(fits) // columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(4.6 * columns, 3.8 * rows), squeeze=False)
    for axis in axes.flat[len(fits):]:
        axis.set_visible(False)
    for axis, (name, (constants, parameters, error)) in zip(axes.flat, fits.items()):
        for colour, (test, (l, stress)) in zip(COLOURS, data.items()):
            line = numpy.linspace(min(1, l.min()), max(1, l.max()), 200)
            curve = numpy.array(table[name].columns(test, line, parameters)).T @ constants
            axis.plot(line, curve, color=colour, label=test)
            axis.plot(l, stress, "o", color=colour, markersize=3.5, markerfacecolor="none")
        axis.set_title(f"{name}: error {100 * error:.1f} %", fontsize=10)
        axis.set_xlabel("stretch")
        axis.set_ylabel("nominal stress")
        low, high = min(0, *(s.min() for _, s in data.values())), max(0, *(s.max() for _, s in data.values()))
        axis.set_ylim(low - 0.05 * (high - low), high + 0.1 * (high - low))
        axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("prefix", nargs="?", metavar="PREFIX", help="the files are PREFIX_TEST.csv")
    for test in TESTS:
        parser.add_argument("--" + test, metavar="FILE.csv", help=f"stretch and nominal stress of a {test} test")
    parser.add_argument("--law", action="append", choices=list(laws(1)),
                        help="a law to fit; may be repeated (default: all)")
    parser.add_argument("--terms", type=int, default=3, help="terms of ogden, 1 to 5 (default 3)")
    parser.add_argument("--relative", action="store_true", help="errors over the stress itself")
    parser.add_argument("--free", action="store_true", help="constants of any sign")
    parser.add_argument("--volume", default="incompressible: true", help="what the material line says of the volume")
    parser.add_argument("--out", default="out/rubber", help="directory of the picture (default out/rubber)")
    args = parser.parse_args()
    files = {test: getattr(args, test) for test in TESTS if getattr(args, test)}
    for test in TESTS if args.prefix else ():
        if pathlib.Path(f"{args.prefix}_{test}.csv").exists():
            files.setdefault(test, f"{args.prefix}_{test}.csv")
    data = {test: read(files[test]) for test in TESTS if test in files}
    if not data:
        parser.error("no data; allowed: at least one of " + ", ".join("--" + test for test in TESTS))
    if not 1 <= args.terms <= 5:
        parser.error(f"--terms {args.terms}; allowed: 1 to 5")
    table = laws(args.terms)
    fits = {name: fit(table[name], data, args.relative, args.free) for name in args.law or table}
    for name, (constants, parameters, error) in fits.items():
        print(f"{name}: error {100 * error:.2f} %")
        print(f"  material: {{{table[name].line(constants, parameters)}, {args.volume}}}")
    picture = pathlib.Path(args.out) / "fit.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw(data, fits, table, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main()
