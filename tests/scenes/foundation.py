"""Springs under surfaces: a thick cylinder in an elastic bed against Lame's solution in every geometry, and a block that
only springs hold."""
import numpy

from harness import Check, arguments, run, SCENES

E, NU, P, A, B, LENGTH, SPRING = 1000, 0.3, 10, 1, 2, 0.5, 300
FORMS = {"plane_strain": 0, "solid": 1, "axisymmetric": 2}
# order -> largest displacement error over the largest displacement with 6 elements through the wall: what was measured,
# rounded, as a guard against change
ALLOWED = {1: 0.008, 2: 6e-5}


def lame():
    """c_1 and c_2 of u = c_1 r + c_2 / r, with the pressure P at A and SPRING u at B (plane strain)."""
    bulk, shear = E / (1 + NU) / (1 - 2 * NU), E / (1 + NU)  # stress: bulk c_1 - shear c_2 / r^2
    return numpy.linalg.solve([[bulk, -shear / A**2], [bulk + SPRING * B, -shear / B**2 + SPRING / B]], [-P, 0])


def cylinder(geometry, order):
    finished = run(args, SCENES / "lame.yaml", out=f"{geometry}_{order}", overrides=[
        f"geometry={geometry}", f"mesh.order={order}", f"mesh.parameters.form={FORMS[geometry]}",
        "mesh.parameters.n_arc=12", "mesh.parameters.n_wall=6", "mesh.parameters.n_len=2",
        f"mesh.parameters.len={LENGTH}",
        *(["supports=[{surface: end_low, uy: 0}, {surface: end_high, uy: 0}]"] if geometry == "axisymmetric" else []),
        *(["supports.2={surface: end_low, uz: 0}", "supports.3={surface: end_high, uz: 0}"]
          if geometry == "solid" else []),
        f"supports.{4 if geometry == 'solid' else 2}={{surface: outer, spring: "
        f"{[SPRING, 0] if geometry == 'axisymmetric' else [SPRING] * (3 if geometry == 'solid' else 2)}}}",
        "probes=[{name: bed, reaction: outer, component: x}]"
    ])
    fields, (c_1, c_2) = finished.fields(), lame()
    x, u = fields["nodes"], fields["displacement"]
    r = x[:, 0] if geometry == "axisymmetric" else numpy.hypot(x[:, 0], x[:, 1])
    radial = u[:, 0] if geometry == "axisymmetric" else (u[:, 0] * x[:, 0] + u[:, 1] * x[:, 1]) / r
    exact = c_1 * r + c_2 / r
    check.near(f"{geometry}, order {order}: displacement", radial / exact.max(), exact / exact.max(), ALLOWED[order])
    if geometry == "axisymmetric":
        force = 2 * numpy.pi * B * LENGTH * SPRING * (c_1 * B + c_2 / B)
        found = -finished.summary()["probes"]["bed"]
        check.near(f"{geometry}, order {order}: force of the springs", found / force, 1, ALLOWED[order])


def block(order):
    """Nothing but springs holds it. Exact: bed and block are in series."""
    finished = run(args, SCENES / "patch.yaml", out=f"block_{order}", overrides=[
        f"mesh.order={order}", "kinematics=small", "bodies.0.material={law: linear, E: 1000, nu: 0}",
        "supports=[{surface: y_min, spring: [50, 200, 80]}]", "loads=[{surface: y_max, traction: [0, -4, 0]}]",
        "probes=[{name: bed, reaction: y_min, component: y}]"
    ])
    fields = finished.fields()
    x, u = fields["nodes"], fields["displacement"]
    across = x[:, 1] - x[:, 1].min()
    exact = numpy.stack([0 * across, -4 / 200 - 4 / 1000 * across, 0 * across], axis=1)
    check.near(f"block, order {order}: displacement", u, exact, 1e-11)
    check.near(f"block, order {order}: force of the springs", finished.summary()["probes"]["bed"], 4 * 2 * 1.5, 1e-8)


args = arguments()
check = Check()
for mesh_order in (1, 2):
    for name in FORMS:
        cylinder(name, mesh_order)
    block(mesh_order)
check.finish()
