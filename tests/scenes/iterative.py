"""The iterative solver gives the direct one's answers, in space with oblique contact and bodies held by contact only,
in the plane and axisymmetric with a follower load, without contact, on any ranks, bit for bit when a step is
repeated. Friction that slips, whose tangent is not symmetric, takes at most 1.3 times the Krylov iterations of the
scene without friction."""
from harness import Check, arguments, run, SCENES

RUNS = SCENES.parent.parent / "runs"
# Scene, overrides, and the largest mean number of Krylov iterations in a Newton iteration. The bounds guard the
# multigrid preconditioner on each kind of problem. On 1 and 3 ranks rings take 8, blocks 8.8, the pipe 28, the plane
# 11, the cup 52, friction 8, slip 6 and the cylinder 5, so that the bounds leave more than a quarter of room.
CASES = {
    "rings": ("ring_in_ring_3d.yaml", ["mesh.parameters={n_inner: 10, n_outer: 12, n_len: 4, jitter: 0}"], 15),
    "blocks": ("patch_blocks.yaml",
               ["mesh.parameters={n_lower: 6, n_upper: 7, jitter: 0.25}", "stepping.initial=0.5"], 15),
    "pipe": ("pipe_pinch.yaml", ["mesh.parameters={n_arc: 12, n_wall: 1, n_len: 5}", "loads.0.uy=-5",
                                 "stepping.initial=0.5", "contact.0.smoother=diffuse"], 40),
    "plane": ("ring_in_ring.yaml", [], 15),
    "cup": ("cup_flattening.yaml", ["stepping={control: fixed, initial: 0.25}"], 100),  # a thin wall
    "friction": ("../tests/scenes/shear.yaml", ["mesh.parameters.jitter=0.25"], 15),  # unsymmetric
    "slip": ("../tests/scenes/shear.yaml",
             ["mesh.parameters.jitter=0.25", "supports=[{surface: lower_bottom, ux: 0, uy: 0, uz: 0}]",
              "loads=[{surface: upper_top, uy: -0.002, ux: 0.01, uz: 0.004}]",
              "contact=[{name: joint, slave: upper_bottom, master: lower_top, penalty: {scale: 100}}]"], 15),
    "cylinder": ("../tests/scenes/lame.yaml", ["probes=[{name: growth, displacement: [1, 0], component: x}]"], 10),
}

args = arguments(("case", "which", CASES))
check = Check()
scene, overrides, most = CASES[args.case]
smooth = None
if args.case == "slip":
    smooth = run(args, RUNS / scene, out="smooth", overrides=[*overrides, "solver.type=iterative"]).summary()
    overrides = [*overrides, "contact.0.friction={mu: 0.3}"]
# direct: by a Krylov method with the factor, which settles no contact within a step, as the iterative solver cannot:
# iterations then compare
runs = {
    name: run(args, RUNS / scene, *options, out=name, overrides=[*overrides, f"solver.type={kind}"])
    for name, kind, options in (("direct", "direct", ("-ksp_type", "gmres")), ("iterative", "iterative", ()),
                                ("again", "iterative", ()))
}
summary = {name: a.summary() for name, a in runs.items()}
# A solve ends as soon as the residual is within the tolerance of 1e-8, where a direct one overshoots it; deviations are
# in per cent of the mean pressure.
for name, value in summary["direct"]["probes"].items():
    if value is not None:
        check.near(name, summary["iterative"]["probes"][name], value,
                   1e-5 * (100 if "noise" in name or "deviation" in name else abs(value)))
iterations = summary["iterative"]["krylov_iterations"] / summary["iterative"]["newton_iterations"]
check.holds("Krylov iterations", 1 < iterations <= most, f"{iterations:.1f} in the mean, allowed {most}")
if smooth:
    ratio = iterations * smooth["newton_iterations"] / smooth["krylov_iterations"]
    friction = summary["iterative"]["contact"][0]["friction"]
    check.holds("every node slips", friction["slipping"] > 0 and friction["sticking"] == 0)
    check.holds("Krylov iterations beside those without friction", ratio <= 1.3, f"{ratio:.2f} times as many")
# This guards the accuracy of the iterative solves: Newton's method takes a quarter more or less at most, or 3. Today
# the difference is 6 of some 36 for the cup on 3 ranks and 0 to 2 otherwise.
check.near("Newton iterations", summary["iterative"]["newton_iterations"], summary["direct"]["newton_iterations"],
           max(3, summary["direct"]["newton_iterations"] // 4))
if args.ranks == 1:
    check.holds("the same again", summary["iterative"]["probes"] == summary["again"]["probes"])
check.finish()
