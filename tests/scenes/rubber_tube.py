"""A thick tube of nearly incompressible rubber, inflated by half of its inner radius between rigid ends: the force on
the inner wall against the closed form of the incompressible tube, p = integral of (sigma_theta - sigma_r) / r over the
wall, and its order of convergence."""
import math

import numpy

from harness import Check, arguments, run, SCENES
from rubberlaws import LAWS, principal

A, B, MOVED, LENGTH, BULK = 1, 2, 0.5, 0.25, 1e5


def force(law):
    """Gauss's rule over the wall. A point at R in the unloaded tube is at r, with r^2 - R^2 the same for all."""
    grown = (A + MOVED)**2 - A**2
    inner, outer = A + MOVED, math.sqrt(B**2 + grown)
    points, weights = numpy.polynomial.legendre.leggauss(40)
    pressure = 0
    for x, weight in zip(points, weights):
        r = (inner + outer) / 2 + x * (outer - inner) / 2
        stretch = r / math.sqrt(r**2 - grown)
        radial, hoop, _ = principal(law, (1 / stretch, stretch, 1), 0)
        pressure += weight * (outer - inner) / 2 * (hoop - radial) / r
    return pressure * 2 * math.pi * inner * LENGTH


def error(n_wall):
    material = f"bodies.0.material={{law: {args.law}, {LAWS[args.law]}, K: {BULK}}}"
    finished = run(args, SCENES / "rubber_tube.yaml", out=f"wall_{n_wall}",
                   overrides=[material, f"mesh.parameters.n_wall={n_wall}"])
    return abs(finished.summary()["probes"]["force"] / force(args.law) - 1)


args = arguments(("law", "of the material", LAWS))
check = Check()
coarse, fine = error(6), error(12)
# First order converges with h^2, up to the compressibility of mu/K = 1e-5.
check.holds("force", fine <= 5e-4, f"error {fine:.2e}")
check.holds("convergence", coarse / fine >= 3, f"factor {coarse / fine:.2f}, at least 3")
check.finish()
