"""A wire and a strip are drawn through a die: done without a failed step. Where the die has three long faces only, the
force is that of a die with short ones, as no smooth surface goes through them; or the last screen says that the smooth
surface is off them."""
from harness import Check, arguments, run, SCENES

STEADY = 0.5  # load parameter from which on the force is averaged
SPREAD = 0.02  # of the mean force: as the corners of the die are rounded by its own faces

args = arguments(("geometry", "of the scene", ("axisymmetric", "plane_strain")))
check = Check()
force = {}
for size in (0.5, 1.5, 4):
    finished = run(args, SCENES / "wire.yaml", out=f"wire_{size}",
                   overrides=[f"geometry={args.geometry}", f"mesh.parameters.die_size={size}"])
    summary, rows = finished.summary(), [row for row in finished.steps() if row["t"] > STEADY]
    force[size] = sum(row["force"] * row["dt"] for row in rows) / sum(row["dt"] for row in rows)
    check.holds(f"faces of {size}: no failed step", summary["status"] == "done" and summary["steps_failed"] == 0,
                f"{summary['steps']} steps, {summary['newton_iterations']} iterations, force {force[size]:.5g}")
    if "off the faces of 'die'" in finished.text:
        check.holds(f"faces of {size}: no smooth surface through them is said to be one", size > 0.5)
    else:
        check.near(f"faces of {size}: force", force[size] / force[0.5], 1, SPREAD)
check.finish()
