"""Curved bodies that a force presses together and nothing else holds start from the one node that touches, at the end of
the slave: at a plane of symmetry, at the axis, and in space; either body as slave, both orders. A ball in a cone starts
from a circle that lies between the nodes."""
from harness import Check, arguments, run, SCENES

RUNS = SCENES.parent.parent / "runs"
SURFACE = ["contact.0.formulation=surface_to_surface", "contact.0.smoother=diffuse", "contact.0.penalty.scale=100"]
LINE = [*SURFACE, "mesh.parameters={h: 1, growth: 0.5}", "loads.0.pressure=20", "stepping.initial=0.5"]
LINES = {"block": [], "cylinder": ["contact.0.slave=cylinder_sole", "contact.0.master=block_top"]}
POINTS = {"block": [], "sphere": ["contact.0.slave=sphere_sole", "contact.0.master=block_top"]}
CONES = {"ball": [], "cone": ["contact.0.slave=cone_seat", "contact.0.master=ball_sole"]}
SOLID = [
    "geometry=solid", "mesh.parameters={solid: 1, h_ball: 2.2, h_cone: 2.5}",
    "supports=[{surface: cone_bottom, uy: 0}, {surface: sides_x, ux: 0}, {surface: sides_z, uz: 0}]",
    "contact.0.symmetry=[sides_x, sides_z]"
]
CASES = {}  # scene, overrides, force
for order in (1, 2):
    for name, roles in LINES.items():
        for geometry, area in (("plane_strain", 50), ("axisymmetric", 3.14159265358979 * 50**2)):
            CASES[f"{geometry}, order {order}, {name} as slave"] = ("hertz_line", [
                *LINE, *roles, f"geometry={geometry}", f"mesh.order={order}"
            ], 20 * area)
    for name, roles in CONES.items():
        CASES[f"ball in a cone, order {order}, {name} as slave"] = ("ball_in_cone", [
            *SURFACE, *roles, f"mesh.order={order}"
        ], 2000 * 3.14159265358979)
for name, roles in POINTS.items():
    CASES[f"solid, order 1, {name} as slave"] = ("hertz_sphere", [
        *SURFACE, *roles, "mesh.order=1", "mesh.parameters.n=2"
    ], 1.50240 * 16 * 16)
for name, roles in CONES.items():
    CASES[f"ball in a cone, solid, {name} as slave"] = ("ball_in_cone", [*SOLID, *roles], None)

args = arguments()
check = Check()
for name, (scene, overrides, force) in CASES.items():
    finished = run(args, RUNS / f"{scene}.yaml", out=name.replace(" ", "_").replace(",", ""), overrides=overrides,
                   must=None)
    check.holds(f"{name}: starts", finished.status == 0, finished.text[-300:] if finished.status else "")
    if finished.status == 0 and force:
        check.near(f"{name}: force over load", finished.summary()["probes"]["force"] / force, 1, 1e-6)
check.finish()
