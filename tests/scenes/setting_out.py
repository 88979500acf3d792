"""Bodies that set out against each other after they rested while another one flew: the first step sees them meet, and
the work from outside is what the bodies and contact store."""
from harness import Check, arguments, run, SCENES

SPRING, WIDTH, RISE, GAP = 0.1, 9.8, 30, 1.5

args = arguments()
check = Check()
summary = run(args, SCENES / "setting_out.yaml").summary()
energy = summary["energy"]
stored = energy["elastic"] + energy["contact"]
lifted = SPRING * WIDTH * (RISE - GAP)
check.holds("no failed step", summary["steps_failed"] == 0, str(summary["steps_failed"]))
check.near("force", summary["probes"]["force"], lifted, 1e-2 * lifted)
check.near("work from outside", energy["external"], stored, 1e-2 * stored)
check.finish()
