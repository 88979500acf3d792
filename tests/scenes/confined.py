"""A block in a rigid box under a lid: both sides of a corner of the box hold the node in it, by name and in a list, and
the force is that of a confined block in closed form. A block in a tapered groove gets through, too."""
import math

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
E, NU, WIDTH, J = 5, 0.45, 20, 10 / 12
MU, LAMBDA = E / 2 / (1 + NU), E * NU / (1 + NU) / (1 - 2 * NU)
FORCE = -WIDTH * (MU * (J - 1 / J) + LAMBDA * math.log(J) / J)  # neo-Hookean, stretched along one axis alone
FACE = 2  # size of the block's faces
LIST = "contact=[{name: fit, surfaces: all, formulation: node_to_surface}]"
for name, contact in (("named", ()), ("list", (LIST, ))):
    summary = run(args, SCENES / "confined.yaml", out=name, overrides=contact).summary()
    check.near(f"{name}: force", summary["probes"]["push"] / FORCE, 1, 3e-3)
    check.near(f"{name}: corner across", summary["probes"]["corner_x"] / FACE, 0, 1e-3)
    check.near(f"{name}: corner along", summary["probes"]["corner_y"] / FACE, 0, 1e-3)
    check.holds(f"{name}: no step fails", summary["steps_failed"] == 0)
for order in (1, 2):
    groove = run(args, SCENES / "groove.yaml", out=f"groove_{order}", overrides=[
        "contact.0.formulation=node_to_surface", f"mesh.order={order}"]).summary()
    check.holds(f"groove, order {order}: no step fails", groove["steps_failed"] == 0)
check.finish()
