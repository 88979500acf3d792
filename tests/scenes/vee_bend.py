"""A steel strip is bent into a vee die by a punch that a force drives, and let go: the force is
the one that was given; with finer elements and of second order the bending angle under load and after it are the same;
so is the angle of a punch that is moved by the way that the force has taken it."""
import math

from harness import Check, arguments, run, SCENES

FORCE = 45
CASES = {"coarse": [], "fine": ["mesh.parameters.nx=200", "mesh.parameters.ny=16"], "second order": ["mesh.order=2"]}
args = arguments()
check = Check()


def angle(row):
    """Turn of the strip's end (degrees), by two of its nodes 5 mm apart."""
    return math.degrees(math.atan2(row["end_y"] - row["mid_y"], 5 + row["end_x"] - row["mid_x"]))


found = {}
for name, overrides in CASES.items():
    finished = run(args, SCENES / "vee_bend.yaml", out=name.replace(" ", "_"), overrides=overrides)
    summary, steps = finished.summary(), finished.steps()
    loaded, after = next(row for row in steps if row["t"] == 0.5), steps[-1]
    found[name] = angle(loaded), angle(after)
    check.near(f"{name}: force", loaded["force"] / FORCE, 1, 1e-6)
    print(f"     {summary['steps']} steps, {summary['steps_failed']} failed, {summary['newton_iterations']} iterations; "
          f"{found[name][0]:.3f} degrees under load, {found[name][1]:.3f} after it, way {loaded['way']:.4f}")
    check.holds(f"{name}: at most one step in ten fails", 10 * summary["steps_failed"] <= summary["steps"])
    if name == "coarse":
        way = loaded["way"]
for name in ("fine", "second order"):
    check.near(f"{name}: angle under load", found[name][0] / found["coarse"][0], 1, 0.005)
    check.near(f"{name}: springback", (found[name][0] - found[name][1]) / (found["coarse"][0] - found["coarse"][1]), 1,
               0.01)
moved = run(
    args, SCENES / "vee_bend.yaml", out="moved", overrides=[
        f"contact.1.master={{cylinder: {{point: [0, 6], radius: 4, motion: [{{uy: {way!r}, history: [[0, 0], [0.5, 1], "
        "[1, 0]]}]}}"
    ]).steps()
at = next(row for row in moved if row["t"] == 0.5)
check.near("moved punch: force", at["force"] / FORCE, 1, 0.01)
check.near("moved punch: angle after", angle(moved[-1]) / found["coarse"][1], 1, 0.01)
check.finish()
