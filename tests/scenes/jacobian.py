"""The tangent of the whole problem, contact closed or pressure following, against finite differences of its residual (-snes_test_jacobian), every iteration of the run."""
import re

from harness import Check, arguments, run, SCENES

BOUND = 1e-6
FOLLOWER = ["kinematics=finite", "bodies.0.material.law=neo_hookean", "loads.0.pressure=200", "loads.0.follower=true", "stepping={control: fixed, initial: 0.5}", "mesh.parameters.n_arc=3", "mesh.parameters.n_wall=2"]
HELD = "supports=[{surface: end_low, uy: 0}, {surface: end_high, uy: 0}]"
CASES = {
    "flat blocks, first order": (SCENES / "contact_patch.yaml", ["kinematics=finite", "bodies.0.material.law=svk", "bodies.1.material.law=svk", "stepping.initial=1"]),
    "flat blocks, second order": (SCENES / "contact_patch.yaml", ["kinematics=finite", "bodies.0.material.law=svk", "bodies.1.material.law=svk", "stepping.initial=1", "mesh.order=2"]),
    "coarse pinched pipe": (SCENES.parent.parent / "runs" / "pipe_pinch.yaml", ["mesh.parameters.n_arc=5", "mesh.parameters.n_len=2", "loads.0.uy=-10", "stepping={control: fixed, initial: 0.25}", "probes=[]"]),
    "meshed rigid cylinder": (SCENES.parent.parent / "runs" / "slide_cylinder.yaml", ["stepping.initial=0.1"]),
    "follower pressure, plane strain": (SCENES / "lame.yaml", [*FOLLOWER]),
    "follower pressure, axisymmetric": (SCENES / "lame.yaml", [*FOLLOWER, "geometry=axisymmetric", "mesh.parameters.form=2", "mesh.order=2", HELD]),
    "follower pressure, solid": (SCENES / "lame.yaml", [*FOLLOWER, "geometry=solid", "mesh.parameters.form=1", "mesh.parameters.n_len=1", "mesh.parameters.len=0.5", "supports.2={surface: end_low, uz: 0}"]),
}

args = arguments()
check = Check()
for name, (scene, overrides) in CASES.items():
    finished = run(args, scene, "-snes_test_jacobian", out=name.replace(" ", "_").replace(",", ""), overrides=overrides)
    ratios = [float(ratio) for ratio in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = ([0-9.e+-]+)", finished.text)]
    if not name.startswith("follower"):
        check.holds(f"{name}: contact is closed", finished.summary()["contact_nodes"] > 0)
    check.holds(name, ratios and max(ratios) <= BOUND, f"{len(ratios)} tangents, largest relative difference {max(ratios, default=0):.2e}, allowed {BOUND:.0e}")
check.finish()
