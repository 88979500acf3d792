"""A force in all: spread evenly over a surface it is the traction F/A, in the plane, axisymmetric and in space; on points
each node carries an equal part; an expression of t is the force at t; one of the place is refused."""
import math

from harness import SCENES, Check, arguments, run

SQUARE, BLOCK = SCENES / "wrong_mesh.yaml", SCENES / "patch.yaml"
args = arguments()
check = Check()


def bar(scene, load, *overrides, out="bar", must=0):
    finished = run(args, scene, out=out, must=must, overrides=[f"loads=[{load}]", "kinematics=small", *overrides])
    return finished


def stretch(finished):
    return finished.fields()["displacement"][:, 0].max()


HELD = "probes=[{name: held, reaction: x_min, component: x}]"
ROD = "probes=[{name: held, reaction: y_min, component: y}]"
solid = bar(BLOCK, "{surface: x_max, force: [3, 0, 0]}", "supports=[{surface: x_min, ux: 0}, {surface: y_min, uy: 0}, "
            "{surface: z_min, uz: 0}]", HELD)
check.near("solid: reaction", solid.summary()["probes"]["held"], -3, 1e-12)
plane = bar(SQUARE, "{surface: x_max, force: [2, 0]}", HELD)
same = bar(SQUARE, "{surface: x_max, traction: [2, 0]}", HELD)
check.near("plane: as the traction F/A", stretch(plane), stretch(same), 1e-14)
ring = bar(SQUARE, "{surface: y_max, force: [0, 5]}", "geometry=axisymmetric", "supports=[{surface: y_min, uy: 0}]", ROD)
even = bar(SQUARE, f"{{surface: y_max, traction: [0, {5 / math.pi}]}}", "geometry=axisymmetric",
           "supports=[{surface: y_min, uy: 0}]", ROD)
check.near("axisymmetric: over 360 degrees", ring.summary()["probes"]["held"], -5, 1e-11)
check.near("axisymmetric: as the traction F/A", ring.fields()["displacement"], even.fields()["displacement"], 1e-13)
axis = bar(SQUARE, "{surface: x_min, force: [0, 5]}", "geometry=axisymmetric", "supports=[{surface: y_min, uy: 0}]", ROD)
check.near("axisymmetric: on the axis", axis.summary()["probes"]["held"], -5, 1e-11)
point = bar(SQUARE, "{surface: end_x, force: [0, 4]}", "supports=[{surface: x_min, ux: 0, uy: 0}]",
            "probes=[{name: held, reaction: x_min, component: y}]")
check.near("on a point", point.summary()["probes"]["held"], -4, 1e-11)
varied = bar(SQUARE, '{surface: x_max, force: ["2*t", 0]}', HELD)
check.near("an expression of t", stretch(varied), stretch(plane), 1e-13)
on_point = bar(SQUARE, '{surface: end_x, force: ["0*t", "4*t"]}', "supports=[{surface: x_min, ux: 0, uy: 0}]",
               "probes=[{name: held, reaction: x_min, component: y}]")
check.near("an expression of t on a point", on_point.fields()["displacement"], point.fields()["displacement"], 1e-12)
refused = bar(SQUARE, '{surface: x_max, force: ["x", 0]}', must=1)
check.holds("an expression of the place: refused", "loads.0.force: differs from place to place" in refused.text,
            refused.text[:200])
check.finish()
