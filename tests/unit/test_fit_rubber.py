"""Shows that scripts/fit_rubber.py finds the constants from which data were computed, and that Ogden's constants of
1972 describe Treloar's data."""
import pathlib
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import fit_rubber  # noqa: E402

KNOWN = {
    "neo_hookean": (1, [0.4], []),
    "mooney_rivlin": (1, [0.19, 0.02], []),
    "yeoh": (1, [0.17, -6e-4, 3e-5], []),
    "arruda_boyce": (1, [0.28], [numpy.log(4.7)]),
    "ogden": (2, [0.6, -0.01], [1.5, -2.2]),
}
STRETCHES = {"uniaxial": numpy.linspace(0.6, 6, 20), "equibiaxial": numpy.linspace(0.8, 4, 15),
             "planar": numpy.linspace(0.7, 5, 15)}
failed = 0


def holds(what, error, allowed):
    global failed
    print(f"{'ok  ' if error <= allowed else 'FAIL'} {what}: {error:.1e}, allowed {allowed:.0e}")
    failed += not error <= allowed


for name, (terms, constants, parameters) in KNOWN.items():
    law = fit_rubber.laws(terms)[name]
    data = {}
    for test, l in STRETCHES.items():
        l = l[numpy.abs(l - 1) > 1e-3]
        data[test] = l, numpy.array(law.columns(test, l, parameters)).T @ constants
    for relative in (False, True):
        found, others, error = fit_rubber.fit(law, data, relative)
        order = numpy.argsort(others)[::-1] if len(others) == len(found) else slice(None)
        exact = numpy.concatenate([constants, parameters])
        found = numpy.concatenate([found[order], numpy.sort(others)[::-1]])
        holds(f"{name}{', relative' if relative else ''}", numpy.max(numpy.abs(found / exact - 1)), 1e-6)
        holds("  error", error, 1e-9)

# Ogden, "Large deformation isotropic elasticity", Proceedings of the Royal Society A 326, 1972: 6.3, 0.012 and -0.1
# kg/cm^2 with the exponents 1.3, 5 and -2. They do not describe the last points of the uniaxial test.
for test in fit_rubber.TESTS:
    l, stress = fit_rubber.read(ROOT / f"runs/rubber/treloar_{test}.csv")
    computed = 0.0980665 * (6.3 * fit_rubber.power(test, l, 1.3) + 0.012 * fit_rubber.power(test, l, 5) -
                            0.1 * fit_rubber.power(test, l, -2))
    holds(f"Ogden 1972, {test}", numpy.max(numpy.abs(computed - stress)[l < 7]) / stress.max(), 0.07)
sys.exit(failed > 0)
