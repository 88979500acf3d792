"""A strip is rolled by a roll that a force pushes and that turns, drawn by friction alone: the force is the given one,
the strip leaves faster than it enters, as it is thinner, and at most one step in ten fails."""
from harness import Check, arguments, run, SCENES

FORCE, THICKNESS = 800, 2
args = arguments()
check = Check()
finished = run(args, SCENES / "rolled_strip.yaml")
summary, steps = finished.summary(), finished.steps()
half, last = next(row for row in steps if row["t"] > 0.6), steps[-1]
check.near("force", last["force"] / FORCE, 1, 1e-6)
check.holds("the rolls draw it without a pull", abs(last["along"]) < 1e-4 * FORCE, f"{last['along']:.2e}")
ratio = (last["exit"] - half["exit"]) / (last["entry"] - half["entry"])
thinner = THICKNESS / (THICKNESS + (half["way"] + last["way"]) / 2)
check.near("speeds of both ends over the thicknesses", ratio / thinner, 1, 0.02)
check.holds("at most one step in ten fails", 10 * summary["steps_failed"] <= summary["steps"],
            f"{summary['steps']} steps, {summary['steps_failed']} failed, {summary['newton_iterations']} iterations")
check.finish()
