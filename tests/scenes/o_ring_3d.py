"""A quarter of an O-ring in space has the force of the axisymmetric ring on the same cross-section, in as few steps."""
from harness import Check, arguments, run, SCENES

RUNS = SCENES.parent.parent / "runs"
STEPS, ITERATIONS = 8, 35
NEAR = 0.01  # of the force

args = arguments()
check = Check()
section = ("mesh.order=2", "mesh.parameters.n=4", "output.every=0")
plane = run(args, RUNS / "o_ring.yaml", out="plane", overrides=section).summary()["probes"]["force"]
solid = run(args, RUNS / "rubber/o_ring_3d.yaml", out="solid", overrides=section).summary()
check.holds("steps", solid["steps"] <= STEPS and solid["steps_failed"] == 0,
            f"{solid['steps']}, {solid['steps_failed']} failed")
check.holds("iterations", solid["newton_iterations"] <= ITERATIONS, str(solid["newton_iterations"]))
check.near("force", 4 * solid["probes"]["force"], plane, NEAR * plane)
check.finish()
