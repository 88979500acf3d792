"""Derivatives of probes by numbers of the scene are those of whole runs, on any number of ranks: the adjoint way, and the
direct one where contact lists follow the solution. What has none is refused before the run."""
import csv
import math

from harness import Check, arguments, run, SCENES

STACK, RUNS, JOBS = SCENES / "stack.yaml", SCENES.parent.parent / "runs", SCENES.parent / "jobs"
STEP = 1e-4  # of a number, between whole runs
TIGHT = ["solver.tolerance=1e-12", "solver.max_iterations=60"]
FIXED = "contact.{}.penalty={{initial: auto, scale: 50}}"


def rows(scene, name, probe, key, *overrides):
    """The row of sensitivity.csv."""
    found = run(args, scene, out=name, overrides=[*TIGHT, *overrides, f"sensitivity=[\"{probe}:{key}\"]"])
    with open(found.directory / "sensitivity.csv", newline="") as file:
        return next(csv.DictReader(file))


def compare(scene, probe, key, number, way, *overrides):
    """Checks one derivative."""
    here = rows(scene, "here", probe, key, *overrides, f"{key}={number}")
    more, less = (float(rows(scene, "near", probe, key, *overrides, f"{key}={number * (1 + side * STEP)!r}")["value"])
                  for side in (1, -1))
    whole = (more - less) / (2 * STEP * number)
    deviation = float(here["derivative"]) / whole - 1
    check.holds(f"{scene.stem}: {probe} by {key}", abs(deviation) < 1e-4, f"{deviation:.1e}")
    check.holds(f"the {way} way", here["way"] == way)


args = arguments()
check = Check()
for key, number in (("bodies.0.material.E", 1000), ("bodies.1.material.nu", 0.3), ("loads.0.uy", -0.4),
                    ("contact.0.penalty.scale", 1), ("mesh.parameters.gap", 0.25)):
    compare(STACK, "force", key, number, "adjoint")
SEAL = ["mesh.parameters.n=6", FIXED.format(0), FIXED.format(1)]
compare(RUNS / "o_ring.yaml", "force", "bodies.2.rigid.motion.0.uy", -0.706, "direct", *SEAL)
# Where the answer depends on the way to it, two whole runs with the same steps take the place of the end's equations
compare(STACK, "force", "bodies.0.material.E", 1000, "runs", "contact.0.friction={mu: 0.05}", "loads.0.ux=0.1")
compare(SCENES / "bolt.yaml", "tension", "bodies.0.material.E", 1000, "runs")
held = rows(SCENES / "held_bar.yaml", "held", "low", "loads.0.force.1")
check.holds("supports that come and go", held["way"] == "runs" and math.isfinite(float(held["derivative"])), str(held))
brake = run(args, JOBS / "wedge_brake.yaml", out="brake", overrides=['sensitivity=["brake:contact.0.friction.mu"]'])
tan, press = math.tan(math.radians(20)), 10 * (5 + 20 * math.tan(math.radians(20)))
with open(brake.directory / "sensitivity.csv", newline="") as file:
    check.near("brake: closed form of stiff bodies", float(next(csv.DictReader(file))["derivative"]),
               press * tan / (tan - 0.2)**2, 0.2)
check.holds("nothing unless asked for",
            not (run(args, STACK, out="none").directory / "sensitivity.csv").exists())
check.finish()
