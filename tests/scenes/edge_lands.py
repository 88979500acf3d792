"""An elastic block lands with its edge on a flat face: a fifth of a face deep it presses back as on finer faces, as a
named pair and as a list of surfaces. Without terms of ends it pressed with nothing (first order) or 0.6 of that (second).
Where surfaces cross and no contact presses, the run says so."""
from harness import Check, arguments, run, SCENES

FINER = 40
OWN_ERROR = {1: 0.12, 2: 0.03}  # of the coarse faces, measured 0.098 and 0.009
LISTED = ["contact=[{name: edge, surfaces: all}]"]

args = arguments()
check = Check()


def push(name, *overrides):
    return run(args, SCENES / "edge_lands.yaml", out=name, overrides=list(overrides))


for order, error in OWN_ERROR.items():
    coarse, fine, listed = (push(f"order{order}-{case}", f"mesh.order={order}", *more).summary()["probes"]["push"]
                            for case, more in (("coarse", []), ("fine", [f"mesh.parameters.n={FINER}"]),
                                               ("listed", LISTED)))
    check.near(f"order {order}: force over that on finer faces", coarse / fine, 1, error)
    check.near(f"order {order}: force of a list over that of the pair", listed / coarse, 1, 0.01)
for case, more in (("pair", []), ("listed", LISTED), ("roles", ["contact.0.slave=top", "contact.0.master=skin"])):
    finished = push(f"shallow-{case}", "loads.0.uy=-0.04", *more)
    check.holds(f"{case}: says that surfaces cross and nothing presses", "[B154]" in finished.text)
check.holds("no such word where contact presses", "[B154]" not in push("deep").text)
check.finish()
