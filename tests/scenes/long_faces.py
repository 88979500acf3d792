"""Fits through faces ten times as long as wide: around a cylinder, where few of them turn by much, and along it. Every
slave point has a fit of its degree. Lame's pressure is met in the mean, and along the cylinder at every node."""
from harness import Check, arguments, run, SCENES

RINGS = SCENES.parent.parent / "runs" / "ring_in_ring_3d.yaml"
PRESSURE = 5.859  # Lame's
SETTINGS = ("contact.0.formulation=surface_to_surface", "probes.2.excluding=0.1", "output.every=0")
CASES = {  # mesh, bound on the mean pressure, on the noise in per cent
    "around": ("{n_inner: 12, n_outer: 15, n_len: 20, jitter: 0.2, stretch: 0.1}", 0.02, None),
    "along": ("{n_inner: 24, n_outer: 30, n_len: 6, jitter: 0.2, stretch: 10}", 0.001, 0.5)
}

args = arguments()
check = Check()
for name, (mesh, mean, noise) in CASES.items():
    summary = run(args, RINGS, out=name, overrides=(*SETTINGS, f"mesh.parameters={mesh}")).summary()
    check.near(f"{name}: mean pressure", summary["probes"]["mean_pressure"], PRESSURE, mean * PRESSURE)
    fall_backs = summary["contact"][0]["fall_backs"]
    check.holds(f"{name}: no fall-back", fall_backs == 0, str(fall_backs))
    if noise:
        check.holds(f"{name}: noise", summary["probes"]["noise_rms"] <= noise, str(summary["probes"]["noise_rms"]))
check.finish()
