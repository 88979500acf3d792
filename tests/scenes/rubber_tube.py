"""A thick tube of nearly and of exactly incompressible rubber, inflated by half of its inner radius between rigid ends:
the force on the inner wall against the closed form of the incompressible tube, p = integral of (sigma_theta - sigma_r) /
r over the wall, and its order of convergence."""
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


def error(n_wall, formulation, volume, order):
    material = f"bodies.0.material={{law: {args.law}, {LAWS[args.law]}, {volume}}}"
    finished = run(args, SCENES / "rubber_tube.yaml", out=f"{formulation}_{order}_{n_wall}",
                   overrides=[material, f"bodies.0.formulation={formulation}", f"mesh.order={order}",
                              f"mesh.parameters.n_wall={n_wall}"])
    return abs(finished.summary()["probes"]["force"] / force(args.law) - 1)


args = arguments(("law", "of the material", LAWS))
check = Check()
# The energy, and the force with it, converges with h^2 in first order, up to the compressibility of mu/K = 1e-5, and with
# h^4 in second order.
for formulation, volume, order, n_wall, allowed, faster in (("fbar", f"K: {BULK}", 1, 6, 5e-4, 3),
                                                            ("mixed", "incompressible: true", 1, 6, 5e-4, 3.5),
                                                            ("mixed", "incompressible: true", 2, 3, 2e-5, 12)):
    coarse, fine = (error(n, formulation, volume, order) for n in (n_wall, 2 * n_wall))
    what = f"{formulation}, order {order}"
    check.holds(f"{what}: force", fine <= allowed, f"error {fine:.2e}")
    check.holds(f"{what}: convergence", coarse / fine >= faster, f"factor {coarse / fine:.2f}, at least {faster}")
check.finish()
