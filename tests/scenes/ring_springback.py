"""A steel ring is flattened between two plates by 40 % of its height and let go: force, place of its top and of its side
under load, and the shape that remains, against CalculiX on the same mesh, with mixed elements, and with finer elements of
first order. With twice as many elements the force is 77.18 (full) and 77.02 (mixed).

References: jobs/ring_calculix.py (CPE8, surface to surface penalty contact)."""
from harness import Check, arguments, run, SCENES

FORCE, TOP, SIDE = 77.796, -20.4506, 14.6611  # under load
TOP_AFTER, SIDE_AFTER = -18.9638, 14.0466
FULL = "bodies.0.formulation=full"
CASES = {"second order": ([FULL, "stepping.dt_max=0.02"], 0.005, 0.02), "default steps": ([FULL], 0.005, 0.02),
         "mixed": (["bodies.0.formulation=mixed"], 0.02, 0.05),
         "fbar": (["mesh.order=1", "mesh.parameters={form: 0, r_in: 46, r_out: 50, n_arc: 96, n_wall: 6}"], 0.02, 0.05)}
args = arguments()
check = Check()
for name, (overrides, allowed, allowed_spring) in CASES.items():
    finished = run(args, SCENES / "ring_springback.yaml", "-quiet", out=name.replace(" ", "_"),
                   overrides=["stepping.at=[0.5]", *overrides])
    summary, steps = finished.summary(), finished.steps()
    loaded, after = next(row for row in steps if row["t"] == 0.5), steps[-1]
    for what, value, reference in (("force", loaded["force"], FORCE), ("top", loaded["height"], TOP),
                                   ("side", loaded["width"], SIDE), ("top after", after["height"], TOP_AFTER),
                                   ("side after", after["width"], SIDE_AFTER)):
        check.near(f"{name}: {what}", value / reference, 1, allowed)
    check.near(f"{name}: springback of the top", (after["height"] - loaded["height"]) / (TOP_AFTER - TOP), 1,
               allowed_spring)
    check.near(f"{name}: springback of the side", (after["width"] - loaded["width"]) / (SIDE_AFTER - SIDE), 1,
               allowed_spring)
    check.holds(f"{name}: at most one step in ten failed", summary["steps_failed"] <= summary["steps"] / 10,
                f"{summary['steps']} steps, {summary['newton_iterations']} iterations")
check.finish()
