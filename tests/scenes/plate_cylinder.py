"""The plate on a rigid cylinder, exact, meshed and smoothed: the scenes as they stand give the reference answers."""
from harness import Check, arguments, run, SCENES

REFERENCE = {
    "tip_uy": (-0.845, 0.001),
    "cylinder_fx": (1326, 10),
    "cylinder_fy": (79234, 5),
    "peak_pressure": (3590, 40)
}
EDGES = {"contact_x_min": (49.59, 0.1), "contact_x_max": (51.06, 0.1)}  # mm
MESH = 0.005  # what a mesh may add to the estimated error of the reference, which another code gave; of the value

args = arguments()
check = Check()
for name, scene, overrides in (("exact", "plate_cylinder", ()), ("facet", "plate_cylinder_meshed", ()),
                               ("diffuse", "plate_cylinder_meshed", ("contact.0.smoother=diffuse",))):
    probes = run(args, SCENES.parent.parent / "runs" / f"{scene}.yaml", out=name,
                 overrides=overrides).summary()["probes"]
    for probe, (reference, error) in REFERENCE.items():
        check.near(f"{name}: {probe}", probes[probe], reference, error + MESH * abs(reference))
    for probe, (reference, error) in EDGES.items():
        check.near(f"{name}: {probe}", probes[probe], reference, error)
check.finish()
