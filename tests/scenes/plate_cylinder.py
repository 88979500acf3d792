"""The plate on the exact cylinder: reference answers, and at every step a penetration inside the window, wherever the penalty starts."""
from harness import Check, arguments, run, SCENES

REFERENCE = {"tip_uy": (-0.845, 0.001), "cylinder_fx": (1326, 10), "cylinder_fy": (79234, 5), "contact_x_min": (49.59, 0.1), "contact_x_max": (51.06, 0.1), "peak_pressure": (3590, 40)}
MESH = 0.005  # what a mesh may add to the estimated error of the reference, which another code gave; of the value
START = {"soft": 1e-4, "automatic": 1, "stiff": 1e4}
COARSE = ["mesh.order=1", "mesh.parameters={h_contact: 0.5, h_far: 5, n_thick: 2, n_width: 4}"]

args = arguments(("mesh", "the scene's or a coarse one", ("scene", "coarse")))
check = Check()
coarse = args.mesh == "coarse"
ends = {}
for start, scale in START.items():
    finished = run(args, SCENES.parent.parent / "runs" / "plate_cylinder.yaml", out=start, overrides=[*(COARSE if coarse else []), f"contact.0.penalty.scale={scale}"])
    steps, ends[start] = finished.steps(), finished.summary()["probes"]
    check.holds(f"{start} start: t = 1 in 10 steps", len(steps) == 10 and steps[-1]["t"] == 1)
    check.holds(f"{start} start: largest penetration below g_max", all(row["max_penetration"] <= 5e-6 for row in steps), f"{max(row['max_penetration'] for row in steps):.2e}")
    check.holds(f"{start} start: smallest one of loaded nodes above g_min", all(row["min_penetration"] >= 1e-6 for row in steps), f"{min(row['min_penetration'] for row in steps):.2e}")
    check.holds(f"{start} start: nobody outside", all(row["outside_window"] == 0 for row in steps))
    if not coarse:
        for name, (reference, error) in REFERENCE.items():
            check.near(f"{start} start: {name}", ends[start][name], reference, error + MESH * abs(reference) if name[:7] != "contact" else error)
for start in ("soft", "stiff"):
    check.near(f"{start} start: the tip as with the automatic one", ends[start]["tip_uy"], ends["automatic"]["tip_uy"], 1e-4 * abs(ends["automatic"]["tip_uy"]))
check.finish()
