"""Thick cylinder under internal pressure against Lame's solution: the error of the displacement, its order, and
equilibrium of the cut."""
import numpy

from harness import Check, arguments, run, SCENES

E, NU, P, A, B, LENGTH = 1000, 0.3, 10, 1, 2, 0.5
FORMS = {"plane_strain": 0, "solid": 1, "axisymmetric": 2}
# (order, simplex) -> elements through the wall, largest displacement error over the largest displacement on them, least
# factor it falls by on twice as many: h^2 = 4 and h^3 = 8 in theory, less on coarse meshes; simplices are slow to reach
# it (axisymmetric tri3: 1.8 from 3 to 6 elements, 3.1 from 24 to 48). The bounds are what was measured, rounded: they
# guard against change.
ALLOWED = {("1", "0"): (3, 0.03, 3.5), ("2", "0"): (3, 6e-4, 8), ("1", "1"): (6, 0.06, 2.2), ("2", "1"): (6, 8e-4, 6)}


def lame(r):
    return (1 + NU) / E * P * A**2 / (B**2 - A**2) * ((1 - 2 * NU) * r + B**2 / r)


def error(args, n_wall):
    overrides = [
        f"geometry={args.geometry}", f"mesh.order={args.order}", f"mesh.parameters.form={FORMS[args.geometry]}",
        f"mesh.parameters.simplex={args.simplex}"
    ]
    overrides += [
        f"mesh.parameters.n_arc={2 * n_wall}", f"mesh.parameters.n_wall={n_wall}",
        f"mesh.parameters.n_len={n_wall // 3}", f"mesh.parameters.len={LENGTH}"
    ]
    if args.geometry == "axisymmetric":
        overrides += ["supports=[{surface: end_low, uy: 0}, {surface: end_high, uy: 0}]"]
    else:
        overrides += ["probes=[{name: cut, reaction: symmetry_y, component: y, absolute: true}]"]
    if args.geometry == "solid":
        overrides += ["supports.2={surface: end_low, uz: 0}", "supports.3={surface: end_high, uz: 0}"]
    finished = run(args, SCENES / "lame.yaml", out=f"wall_{n_wall}", overrides=overrides)
    fields = finished.fields()
    if args.geometry != "axisymmetric":
        force = P * A * (LENGTH if args.geometry == "solid" else 1)
        check.near("force in the cut", finished.summary()["probes"]["cut"], force, 1e-9 * force)
    x, u = fields["nodes"], fields["displacement"]
    if args.geometry == "axisymmetric":
        radial, r = u[:, 0], x[:, 0]
    else:
        r = numpy.hypot(x[:, 0], x[:, 1])
        radial = (u[:, 0] * x[:, 0] + u[:, 1] * x[:, 1]) / r
    return numpy.max(numpy.abs(radial - lame(r))) / lame(A)


args = arguments(("geometry", "of the scene", FORMS), ("order", "of the elements", ["1", "2"]),
                 ("simplex", "1: triangles or tetrahedra", ["0", "1"]))
check = Check()
n_wall, allowed, factor = ALLOWED[args.order, args.simplex]
coarse, fine = error(args, n_wall), error(args, 2 * n_wall)
check.holds("displacement", coarse <= allowed, f"error {coarse:.2e}, allowed {allowed:.2e}")
check.holds("convergence", coarse / fine >= factor, f"factor {coarse / fine:.2f}, at least {factor}")
check.finish()
