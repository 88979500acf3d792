"""A rubber ring that can roll next to freely: where it rolls is held as long as next to no friction would hold it, and
moves on else. Few steps fail, which without that takes 17 steps, 5 failed ones and 267 iterations. The answer does not
depend on the ranks, and a restart goes on as if nothing had happened."""
from harness import Check, arguments, run, run_in_parts, SCENES

args = arguments(("cases", "few: one run", ("few", "all")))
check = Check()
SCENE = SCENES / "chamfer_ring.yaml"
MOST = 1e-3  # the coefficient of friction up to which a motion is held

summary = run(args, SCENE, out="whole", overrides=("output.every=0", )).summary()
held = summary["stabilisation"]
check.holds("steps", summary["steps"] <= 10 and summary["steps_failed"] <= 1,
            f"{summary['steps']}, {summary['steps_failed']} failed")
check.holds("iterations", summary["newton_iterations"] <= 130, str(summary["newton_iterations"]))
check.holds("the roll was held", held["held_soft_steps"] > 0 and 0 < held["held_soft_friction"] <= MOST,
            f"{held['held_soft_steps']} steps, as by {held['held_soft_friction']}")
if args.cases == "all":
    free = run(args, SCENE, out="free", overrides=("output.every=0", "solver.hold_rolling=false")).summary()
    check.holds("false: none is held", free["stabilisation"]["held_soft_steps"] == 0)
    alone = run(args, SCENE, out="alone", ranks=1, overrides=("output.every=0", )).summary()
    parts = run_in_parts(args, SCENE, "parts", ("output.every=0", )).summary()
    for name, other in ("one rank", alone), ("restarted", parts):
        check.holds(f"{name}: steps", other["steps"] == summary["steps"], f"{other['steps']} {summary['steps']}")
        check.near(f"{name}: side", other["probes"]["side"], summary["probes"]["side"],
                   1e-6 * abs(summary["probes"]["side"]))
check.finish()
