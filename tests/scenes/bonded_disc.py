"""A disc of incompressible rubber bonded between plates that approach: the force against the limit of refined meshes,
whose error falls at the rate of the singular corner where the free side meets the plate, and against the approximation
of Gent and Lindley (Proc. Inst. Mech. Eng. 173, 1959), apparent modulus E (1 + 2 S^2) with the shape factor S."""
import math

from harness import Check, arguments, run, SCENES

RADIUS, HEIGHT, YOUNG, STRAIN = 10, 4, 3, 0.1
# Richardson's limit of second-order quadrilaterals, 40 x 8, 80 x 16 and 160 x 32; that of triangles is 379.95.
LIMIT = 379.98
# The displacement at the corner of a free and a bonded side goes with the distance to the power 0.595 where the volume
# is kept (Williams, J. Appl. Mech. 19, 1952), so that the error of the energy falls by 2^1.19 = 2.28 on twice as many
# elements. Coarse meshes are a little slower.
FASTER = 1.9
# (order, simplex, elements along the radius) -> largest error on that mesh, as measured, rounded up
ELEMENTS = {("1", "0", 40): 0.013, ("2", "0", 20): 0.004, ("2", "1", 20): 0.006}

args = arguments()
check = Check()


def force(order, simplex, n, *overrides):
    mesh = [f"mesh.order={order}", f"mesh.parameters.tri={simplex}", f"mesh.parameters.nx={n}",
            f"mesh.parameters.ny={n // 5}", *overrides]
    return run(args, SCENES / "bonded_disc.yaml", out=f"{order}_{simplex}_{n}",
               overrides=mesh).summary()["probes"]["force"]


shape = RADIUS / (2 * HEIGHT)
rough = YOUNG * (1 + 2 * shape**2) * math.pi * RADIUS**2 * STRAIN
check.holds("limit against Gent and Lindley", abs(LIMIT / rough - 1) <= 0.03, f"{LIMIT} and {rough:.1f}")
for (order, simplex, n), allowed in ELEMENTS.items():
    what = f"order {order}{', triangles' if simplex == '1' else ''}"
    coarse, fine = (force(order, simplex, m) / LIMIT - 1 for m in (n, 2 * n))
    check.holds(f"{what}: force", 0 <= coarse <= allowed, f"error {coarse:.2e}, {fine:.2e}")
    check.holds(f"{what}: rate", coarse / fine >= FASTER, f"factor {coarse / fine:.2f}")
check.finish()
