"""A pipe is pinched under control by contact, with the diffuse smoother. No step fails, the run takes fewer iterations
than the scene's own fixed steps, and its answer is that of fixed steps of its mean size."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
pipe = SCENES.parent.parent / "runs" / "pipe_pinch.yaml"
result = run(
    args, pipe, out="contact",
    overrides=("contact.0.smoother=diffuse",
               "stepping={control: contact, initial: 0.05, N_c_fraction: 0.05, prediction: tangent, at: [0.5]}"))
summary = result.summary()
fixed = run(
    args, pipe, out="fixed",
    overrides=("contact.0.smoother=diffuse",
               f"stepping={{control: fixed, initial: {1 / summary['steps']}, at: [0.5]}}")).summary()
own = run(args, pipe, out="own", overrides=("contact.0.smoother=diffuse",)).summary()
check.holds("no failed step", summary["steps_failed"] == 0)
# This guards the gain of the control. Today it takes 41 iterations in 10 steps, the fixed steps 54 in 20.
check.holds(
    "fewer iterations", summary["newton_iterations"] < own["newton_iterations"],
    f"{summary['newton_iterations']} in {summary['steps']} steps, fixed {own['newton_iterations']} in {own['steps']}")
half = next(row for row in result.steps() if row["t"] == 0.5)
check.near("plate force at half stroke", half["plate_force"], 52390, 0.005 * 52390)
check.near("plate force", summary["probes"]["plate_force"], 123920, 0.005 * 123920)
check.near("plate force as with fixed steps", summary["probes"]["plate_force"], fixed["probes"]["plate_force"],
           1e-6 * 123920)
check.finish()
