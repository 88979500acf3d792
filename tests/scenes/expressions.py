"""Loads and supports by expression against closed forms: a ring under the pressure p_0 + p_1 cos(2 theta) against
Michell's solution, a beam under a traction that is linear over its end, a body force that grows along the bar, imposed
displacements and forces that are functions of t; rings that an added overlap shrinks onto each other; and equal scenes
with and without expressions. Wrong values that only the mesh shows are refused."""
import numpy

from harness import Check, arguments, run, SCENES

E, NU = 1000.0, 0.3
PLANE = SCENES / "patch_plane.yaml"
SMALL = ["kinematics=small", f"bodies.0.material={{law: linear, E: {E}, nu: {NU}}}"]


def michell(inner, outer, pressure):
    """Radial and hoop displacement of a ring, plane strain, under the pressure p cos(2 theta) on its outer side.
    Source: Barber, Elasticity, table 9.1, with the stress function (A r^2 + B r^4 + C r^-2 + D) cos(2 theta)."""
    rows, right = [], []
    for r, p in ((inner, 0.0), (outer, pressure)):
        rows += [[-2, 0, -6 / r**4, -4 / r**2], [2, 6 * r**2, -6 / r**4, -2 / r**2]]  # sigma_rr and sigma_rt
        right += [-p, 0]
    a, b, c, d = numpy.linalg.solve(rows, right)
    kappa, double_mu = 3 - 4 * NU, E / (1 + NU)
    return (lambda r: (-2 * a * r + (kappa - 3) * b * r**3 + 2 * c / r**3 + (kappa + 1) * d / r) / double_mu,
            lambda r: (2 * a * r + (kappa + 3) * b * r**3 + 2 * c / r**3 - (kappa - 1) * d / r) / double_mu)


def uniform(inner, outer, p, r):
    """Radial displacement under a uniform pressure p on the outer side (Lame)."""
    return -(1 + NU) / E * p * outer**2 / (outer**2 - inner**2) * ((1 - 2 * NU) * r + inner**2 / r)


def ring(args, n_wall):
    """Largest error of the displacement over the largest displacement, on n_wall elements of second order."""
    fields = run(
        args, SCENES / "lame.yaml", out=f"ring_{n_wall}", overrides=[
            "mesh.order=2", f"mesh.parameters.n_wall={n_wall}", f"mesh.parameters.n_arc={3 * n_wall}",
            'loads=[{surface: outer, pressure: "10 + 4*cos(2*theta)"}]'
        ]).fields()
    x, y = fields["nodes"][:, 0], fields["nodes"][:, 1]
    r, theta = numpy.hypot(x, y), numpy.arctan2(y, x)
    along, around = michell(1, 2, 4)
    u_r, u_t = uniform(1, 2, 10, r) + along(r) * numpy.cos(2 * theta), around(r) * numpy.sin(2 * theta)
    cos, sin = numpy.cos(theta), numpy.sin(theta)
    exact = numpy.array([u_r * cos - u_t * sin, u_r * sin + u_t * cos])
    return numpy.abs(fields["displacement"][:, :2].T - exact).max() / numpy.abs(exact).max()


def bending(args, check):
    """A traction that is linear over the end: u is quadratic and second-order elements hold it exactly. The other end
    is a support whose displacement is an expression."""
    curvature = 0.01
    stress, lateral = E * curvature / (1 - NU**2), NU / (1 - NU) * curvature
    fields = run(
        args, PLANE, out="bending", overrides=[
            "mesh.order=2", *SMALL, f"loads=[{{surface: x_max, traction: ['{stress}*(y - 0.5)', 0]}}]",
            f"supports=[{{surface: x_min, ux: 0, uy: '-{lateral}/2*(y - 0.5)^2'}}]"
        ]).fields()
    x, y = fields["nodes"][:, 0], fields["nodes"][:, 1] - 0.5
    largest = curvature * 2
    check.near("bending: u_x", fields["displacement"][:, 0], curvature * x * y, 1e-9 * largest)
    check.near("bending: u_y", fields["displacement"][:, 1], -curvature / 2 * x**2 - lateral / 2 * y**2, 1e-9 * largest)


def of_t(args, check):
    """Displacement and force as functions of t; a component without t keeps its history."""
    at = [0.25, 0.6, 1]
    overrides = [
        "mesh.order=2", f"stepping={{control: fixed, initial: 1, at: {at[:2]}}}", *SMALL,
        "bodies.0.material.nu=0", "supports=[{surface: x_min, ux: 0}, {surface: y_min, uy: 0}]",
        "probes=[{name: end, displacement: [2, 1], component: x}, {name: top, displacement: [2, 1], component: y}]"
    ]
    for name, traction, upper, end, top in (
        ("of_t", "10*t^2", 'uy: "t*(1 - t)"', lambda t: 20 / E * t**2, lambda t: t * (1 - t)),
        ("mixed", "10*sin(t)", 'traction: ["0*t", 20]', lambda t: 20 / E * numpy.sin(t), lambda t: 20 / E * t),
    ):
        loads = f'loads=[{{surface: x_max, traction: ["{traction}", 0]}}, {{surface: y_max, {upper}}}]'
        finished = run(args, PLANE, out=name, overrides=[*overrides, loads])
        steps = [step for step in finished.steps() if any(abs(step["t"] - t) < 1e-12 for t in at)]
        check.holds("steps end where they are asked to", len(steps) == len(at))
        for step in steps:
            check.near(f"t = {step['t']}: x", step["end"], end(step["t"]), 1e-9 * 20 / E)
            check.near(f"t = {step['t']}: y", step["top"], top(step["t"]), 1e-9)


def body_force(args, check):
    """The force on a bar under the body force 3 y: its support carries the integral."""
    for name, scene, overrides, zero, amount in (
        ("plane", PLANE, [], "", 3.0),
        ("axis", PLANE, ["geometry=axisymmetric"], "", 1.5 * numpy.pi * 4),
        ("solid", SCENES / "patch.yaml", [], ", 0", 1.5 * 2 * 1.5),
    ):
        carried = run(
            args, scene, out=f"force_{name}", overrides=[
                *overrides, "mesh.order=2", *SMALL, "supports=[{surface: y_max, ux: 0, uy: 0" +
                (", uz: 0}]" if zero else "}]"), f'loads=[{{volume: block, body_force: [0, "-3*y"{zero}]}}]',
                "probes=[{name: carried, reaction: y_max, component: y}]"
            ]).summary()["probes"]["carried"]
        check.near(f"body force, {name}", carried, amount, 1e-9 * amount)


def equal(args, check):
    """A constant in the words of an expression gives the answer of the number, dead or following, with t or without."""
    for scene, geometry, follower in ((PLANE, "plane_strain", "false"), (PLANE, "axisymmetric", "true"),
                                      (SCENES / "patch.yaml", "solid", "true")):
        fields = {}
        for name, pressure in (("number", "40"), ("place", '"40 + 0*x"'), ("of t", '"40*t"')):
            fields[name] = run(
                args, scene, out=f"{geometry}_{name.replace(' ', '_')}", overrides=[
                    f"geometry={geometry}", f"loads=[{{surface: y_max, pressure: {pressure}, follower: {follower}}}]",
                    "supports=[{surface: y_min, ux: 0, uy: 0" + (", uz: 0}]" if geometry == "solid" else "}]"),
                    "stepping={control: fixed, initial: 0.5}"
                ]).fields()["displacement"]
        largest = numpy.abs(fields["number"]).max()
        for name in ("place", "of t"):
            check.near(f"{geometry}, follower {follower}, {name}", fields[name], fields["number"], 1e-10 * largest)


def refused(args, check):
    """Values that are not finite, and rules that contradict each other at a corner."""
    for name, load, expect in (
        ("place", 'surface: y_min, ux: "1/x"', "loads.0.ux: the expression has no finite value at node"),
        ("time", 'surface: y_min, traction: [0, "ln(0.5 - t)"]',
         "loads.0.traction.1: the expression has no finite value near node"),
        ("corner", 'surface: y_min, ux: "0.1*t + x"', "is prescribed differently by supports.0"),
    ):
        finished = run(args, PLANE, out=f"refused_{name}", must=None,
                       overrides=[*SMALL, "supports=[{surface: x_min, ux: 0}]", f"loads=[{{{load}}}]"])
        message = next((line for line in finished.text.splitlines() if line.startswith("burnish: ")), "")
        check.holds(f"refused: {name}", finished.status == 1 and expect in message, message)
    for name, key, value in (("overlap", "initial_overlap.add", "1e-3/(x - x)"), ("friction", "friction.mu", "sqrt(-1 - x^2)"),
                             ("friction_later", "friction.mu", "t < 0.5 ? 0.2 : 1/0")):
        finished = run(args, SCENES / "../../runs/ring_in_ring.yaml", "-check", out=f"refused_{name}", must=1,
                       overrides=["mesh.parameters={interference: 0}", f'contact.0.{key.split(".")[0]}={{{key.split(".")[1]}: '
                                  f'"{value}"}}'])
        check.holds(f"refused: {name}", f"contact.0.{key}: the expression has no finite value" in finished.text,
                    finished.text.strip().splitlines()[-1])


def corners(args, check):
    """Expressions that differ at a corner by round-off agree, with t too."""
    fields = run(
        args, PLANE, out="corners", overrides=[
            *SMALL, "supports=[{surface: x_min, ux: 0}]", 'loads=[{surface: y_min, ux: "0.1*sin(pi*x)*t", uy: 0}, '
            '{surface: x_max, ux: "0.05*sin(pi*x)*t^2"}]'
        ]).fields()
    x, y = fields["nodes"][:, 0], fields["nodes"][:, 1]
    check.near("corners", fields["displacement"][y == 0, 0], 0.1 * numpy.sin(numpy.pi * x[y == 0]), 1e-12)


def shrink_fit(args, check):
    """A ring of radii 10 to 20 shrunk into one of 20 to 30, whose meshes touch: the pressure of ring_in_ring (Lame)."""
    for name, overlap in (("number", "0.0025"), ("place", '"1.25e-4*r"'), ("of_t", '"1.25e-4*r*t"')):
        pressure = run(
            args, SCENES / "../../runs/ring_in_ring.yaml", out=f"shrink_{name}", overrides=[
                "mesh.parameters={n_inner: 12, n_outer: 15, interference: 0}", "mesh.order=2",
                "contact.0.formulation=surface_to_surface", f"contact.0.initial_overlap={{add: {overlap}}}"
            ]).summary()["probes"]["mean_pressure"]
        check.near(f"shrink fit, overlap by {name}", pressure, 6.439, 0.002 * 6.439)


args = arguments()
check = Check()
coarse, fine = ring(args, 3), ring(args, 6)
check.holds("ring: displacement", coarse <= 2e-3, f"error {coarse:.2e}, allowed 2e-3")
check.holds("ring: convergence", coarse / fine >= 7, f"factor {coarse / fine:.2f}, at least 7")
bending(args, check)
of_t(args, check)
body_force(args, check)
equal(args, check)
refused(args, check)
corners(args, check)
shrink_fit(args, check)
check.finish()
