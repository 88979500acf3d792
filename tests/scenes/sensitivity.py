"""Derivatives of probes by numbers of the scene are those of whole runs, on any number of ranks: the adjoint way, and the
direct one where contact lists follow the solution. What has none is refused before the run."""
import csv

from harness import Check, arguments, run, SCENES

STACK, RUNS = SCENES / "stack.yaml", SCENES.parent.parent / "runs"
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
    here = rows(scene, "here", probe, key, f"{key}={number}", *overrides)
    more, less = (float(rows(scene, "near", probe, key, f"{key}={number * (1 + side * STEP)!r}", *overrides)["value"])
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
bolt = run(args, SCENES / "bolt.yaml", out="bolt", must=1, overrides=['sensitivity=["tension:bodies.0.material.E"]'])
check.holds("a locked bolt is refused", "where a bolt is locked" in bolt.text and "[B144]" in bolt.text, bolt.text)
check.holds("nothing unless asked for",
            not (run(args, STACK, out="none").directory / "sensitivity.csv").exists())
check.finish()
