"""A coarse rubber ring in space that is squeezed by 30 % and then pressed on by a fluid. Its sections roll on their
own, so that one motion that is held is not enough: with a fluid of 4 MPa the run then takes steps of 0.0005 from 1.1
MPa on, and is at 1.2 MPa after 20 steps. Motions that are held remain from step to step, also in a restart, and so do
offsets that lists turned to and fro."""
from harness import Check, arguments, run, run_in_parts, SCENES

SCENE = SCENES.parent.parent / "runs/rubber/o_ring_3d_pressure.yaml"
PRESSURE = 4  # MPa
MOST = 1e-3  # the coefficient of friction up to which motions are held

args = arguments()
check = Check()
overrides = ("mesh.order=1", "mesh.parameters.triangles=1", "mesh.parameters.n=4", "mesh.parameters.arc=6",
             f"loads.0.pressure={PRESSURE}", "output.every=0")
summary = run(args, SCENE, out="ring", overrides=overrides).summary()
held = summary["stabilisation"]
check.holds("it ends", summary["status"] == "done", f"{summary['status']} at {summary['t']}")
check.holds("steps", summary["steps"] <= 12 and summary["steps_failed"] <= 2,
            f"{summary['steps']}, {summary['steps_failed']} failed")
check.holds("iterations", summary["newton_iterations"] <= 350, f"{summary['newton_iterations']}")
check.holds("several motions were held", held["held_soft_motions"] > 1, f"{held['held_soft_motions']}")
check.holds("held as by next to no friction", 0 < held["held_soft_friction"] <= MOST, f"{held['held_soft_friction']}")
parts = run_in_parts(args, SCENE, "parts", overrides).summary()
check.holds("restarted: steps", parts["steps"] == summary["steps"], f"{parts['steps']} {summary['steps']}")
check.near("restarted: force", parts["probes"]["force"], summary["probes"]["force"],
           1e-9 * abs(summary["probes"]["force"]))
check.finish()
