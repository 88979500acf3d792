"""An elastic block lands with its edge on a flat face. Where surfaces cross and no contact presses, because an edge is
between the points that are measured, the run says so, and with what it says the edge presses: finer faces, or node to
surface."""
from harness import Check, arguments, run, SCENES

FINE, FINER = 40, 80
LISTED = ["contact=[{name: edge, surfaces: all}]"]
CASES = {"pair": [], "listed": LISTED, "roles": ["contact.0.slave=top", "contact.0.master=skin"]}
OWN_ERROR = 0.06  # of the force on the fine faces

args = arguments()
check = Check()


def push(name, *overrides):
    return run(args, SCENES / "edge_lands.yaml", out=name, overrides=list(overrides))


for case, more in CASES.items():
    finished = push(f"shallow-{case}", "loads.0.uy=-0.04", *more)
    check.holds(f"{case}: says that surfaces cross and nothing presses", "[B154]" in finished.text)
nodes, fine, finer = (push(name, *more) for name, more in (
    ("nodes", ["contact.0.formulation=node_to_surface"]), ("fine", [f"mesh.parameters.n={FINE}"]),
    ("finer", [f"mesh.parameters.n={FINER}"])))
for finished in (nodes, fine):
    check.holds("no such word where contact presses", "[B154]" not in finished.text)
force, fine_force, finer_force = (finished.summary()["probes"]["push"] for finished in (nodes, fine, finer))
check.near("fine faces over finer ones: force", fine_force / finer_force, 1, OWN_ERROR)
check.holds("node to surface presses", force > finer_force, str(force))
check.finish()
