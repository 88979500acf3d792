"""Plane stress: rubber of every law under uniaxial, equibiaxial and planar tension and compression, a ring under
pressure, a bent strip, a cylinder on a block, each against its closed form; thickness of the plane in forces; what has
no plane stress is refused."""
import math
import re

import numpy

from harness import Check, arguments, run, SCENES
from rubberlaws import LAWS, principal

BULK, STRETCHES = 50, (0.6, 1.8)
SUPPORTS = "supports=[{surface: x_min, ux: 0}, {surface: y_min, uy: 0}]"


def nominal(law, test, stretch):
    """The nominal stress in x. The lateral stretch has no stress: bisection."""
    def stretches(lateral):
        return {"uniaxial": (stretch, lateral, lateral), "equibiaxial": (stretch, stretch, lateral),
                "planar": (stretch, 1, lateral)}[test]

    low, high = 0.1, 5
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (low, middle) if principal(law, stretches(middle), BULK)[2] > 0 else (middle, high)
    return principal(law, stretches(low), BULK)[0] / stretch


def rubber(law):
    for order, tri, formulation in ((1, 0, "auto"), (1, 0, "enhanced"), (2, 1, "full")):
        for test, stretch in ((t, s) for t in ("uniaxial", "equibiaxial", "planar") for s in STRETCHES):
            sides = {"uniaxial": "x", "equibiaxial": "xy", "planar": "x"}[test]
            loads = ", ".join(f"{{surface: {axis}_max, u{axis}: {stretch - 1}}}" for axis in sides)
            held = SUPPORTS[:-1] + ", {surface: y_max, uy: 0}]" if test == "planar" else SUPPORTS
            finished = run(args, SCENES / "rubber.yaml", out="rubber", overrides=[
                f"mesh={{file: ../../meshes/square.geo, order: {order}, parameters: {{tri: {tri}}}}}",
                "geometry=plane_stress", f"bodies.0.formulation={formulation}", "thickness=2.5",
                f"bodies.0.material={{law: {law}, {LAWS[law]}, K: {BULK}}}", held, f"loads=[{loads}]"
            ])
            force = 2.5 * nominal(law, test, stretch)
            check.near(f"{law}, order {order}, {formulation}, {test} {stretch}",
                       finished.summary()["probes"]["force"] / force, 1, 1e-7)


def ring():
    """A thin ring under pressure: Lame."""
    e, nu, p, a, b = 1000, 0.3, 10, 1, 2
    for order, allowed in ((1, 0.01), (2, 1e-3)):
        finished = run(args, SCENES / "lame.yaml", out="ring", overrides=[
            "geometry=plane_stress", f"mesh.order={order}", "mesh.parameters.n_arc=12", "mesh.parameters.n_wall=6"])
        fields = finished.fields()
        x, u = fields["nodes"], fields["displacement"]
        r = numpy.hypot(x[:, 0], x[:, 1])
        exact = p * a**2 / (e * (b**2 - a**2)) * ((1 - nu) * r + (1 + nu) * b**2 / r)
        radial = (u[:, 0] * x[:, 0] + u[:, 1] * x[:, 1]) / r
        check.near(f"ring, order {order}", radial / exact.max(), exact / exact.max(), allowed)
        check.near(f"ring, order {order}: stress across the plane", fields["stress"][:, 2] / p, 0, 1e-12)


def strip():
    """A strip of enhanced elements and of order 2 that a force bends: beam with shear."""
    e, nu, length, height, thickness, force = 1000, 0.3, 10, 1, 4, 2
    bending, shear = force * length**3 / (3 * e * thickness * height**3 / 12), 2 * (1 + nu) / (5 / 6) / 4
    exact = bending * (1 + shear * (height / length)**2)
    for order, formulation in ((1, "enhanced"), (2, "full")):
        finished = run(args, SCENES / "patch_plane.yaml", out="strip", overrides=[
            f"mesh.order={order}", f"mesh.parameters={{lx: {length}, ly: {height}, nx: 20, ny: 2, skew: 0}}",
            "geometry=plane_stress", "kinematics=small", f"thickness={thickness}",
            f"bodies.0={{volume: block, formulation: {formulation}, material: {{law: linear, E: {e}, nu: {nu}}}}}",
            "supports=[{surface: x_min, ux: 0, uy: 0}]", f"loads=[{{surface: x_max, force: [0, {force}]}}]",
            f"probes=[{{name: end, displacement: [{length}, 0], component: y}}, "
            "{name: held, reaction: x_min, component: y}]"
        ])
        probes = finished.summary()["probes"]
        check.near(f"strip, order {order}: deflection", probes["end"] / exact, 1, 0.01)
        check.near(f"strip, order {order}: reaction", probes["held"], -force, 1e-6)


def hertz():
    """A steel cylinder on an aluminium block, thickness 2: Hertz with E in the place of E/(1 - nu^2). The probes of the
    scene in plane strain are off by 1.4 and 0.2 % of Hertz's half-spaces in the same way, see runs/hertz_line.yaml."""
    figures = {}
    for geometry, factor in (("plane_strain", 1 - 0.3**2), ("plane_stress", 1.0)):
        finished = run(args, SCENES / "../../runs/hertz_line.yaml", out="hertz", overrides=[
            f"geometry={geometry}", "thickness=2", "mesh.parameters.h=0.4", "stepping.initial=0.25"
        ])
        compliance = factor * (1 / 210000 + 1 / 70000)
        half_width = math.sqrt(4 * 35000 * 50 * compliance / math.pi)
        figures[geometry] = (finished.summary()["probes"], half_width, 2 * 35000 / (math.pi * half_width))
    for geometry, (probes, half_width, peak) in figures.items():
        check.near(f"hertz, {geometry}: force", probes["force"] / (2 * 17500), 1, 1e-4)
        check.near(f"hertz, {geometry}: peak pressure", probes["peak_pressure"] / peak, 1, 0.02)
        check.near(f"hertz, {geometry}: half-width", probes["half_width"] / half_width, 1, 0.03)
    ratio = figures["plane_stress"][0]["peak_pressure"] / figures["plane_strain"][0]["peak_pressure"]
    check.near("hertz: peak pressure over that of plane strain", ratio / math.sqrt(1 - 0.3**2), 1, 0.01)


def tool():
    """A plane with a force presses a block of thickness 3."""
    finished = run(args, SCENES / "patch_plane.yaml", out="tool", overrides=[
        "geometry=plane_stress", "kinematics=small", "thickness=3", "solver.tolerance=1e-9",
        "bodies.0.material={law: linear, E: 1000, nu: 0}",
        "supports=[{surface: y_min, ux: 0, uy: 0}]", "contact=[{name: pair, slave: y_max, penalty: {initial: 1e6, scale: "
        "1}, master: {plane: {point: [0, 1], normal: [0, -1], free: [uy], force: [0, -12]}}}]",
        "probes=[{name: force, contact_force: pair, component: y}, {name: way, tool_motion: pair, component: y}]"
    ])
    probes = finished.summary()["probes"]
    check.near("tool: force", abs(probes["force"]), 12, 1e-6)
    check.near("tool: way", probes["way"] / (-12 / (2 * 3) * (1 / 1000 + 1 / 1e6)), 1, 1e-6)
    check.near("tool: contact force in steps.csv", finished.steps()[-1]["contact_force"], 12, 1e-6)
    checked = run(args, SCENES / "patch_plane.yaml", "-check", out="check", overrides=[
        "geometry=plane_stress", "thickness=3", SUPPORTS])
    check.holds("-check says so", "plane    stress, thickness 3" in checked.text)


REFUSED = (
    (["bodies.0.material={law: von_mises, E: 1000, nu: 0.3, yield: 3}"], r"material\.law: .*no plane stress"),
    (["bodies.0.formulation=mixed"], r"formulation: mixed has no plane stress.*full \| enhanced \| auto"),
    (["bodies.0.material={law: mooney_rivlin, c10: 1, c01: 0, incompressible: true}"],
     r"plane stress has not.*0\.4999"),
    (["bodies.0.material={law: neo_hookean, E: 1, nu: 0.5}"], r"plane stress has not.*0\.4999"),
    (["geometry=axisymmetric", "thickness=2"], r"thickness: has no meaning here"),
    (["thickness=0"], r"thickness: 0 is out of range"),
)


def refusals():
    for overrides, message in REFUSED:
        finished = run(args, SCENES / "patch_plane.yaml", "-check", out="refused", must=None,
                       overrides=["geometry=plane_stress", SUPPORTS, *overrides])
        check.holds(f"refused: {overrides[-1]}", finished.status == 1 and re.search(message, finished.text),
                    finished.text.strip())


args = arguments(("part", "what is shown", ("rubber", "bodies")))
check = Check()
if args.part == "rubber":
    for name in LAWS:
        rubber(name)
else:
    ring()
    strip()
    hertz()
    tool()
    refusals()
check.finish()
