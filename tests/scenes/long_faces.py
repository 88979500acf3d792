"""Fits through faces ten times as long as wide: around a cylinder, where few of them turn by much, along it, and around
a flat ring, where rows bend by several of their widths. Every slave point has a fit of its degree. The pressure is met
in the mean, and, but around the cylinder, at every node."""
from harness import Check, arguments, run, SCENES

RUNS = SCENES.parent.parent / "runs"
SHRINK = ("contact.0.formulation=surface_to_surface", "probes.2.excluding=0.1", "output.every=0")
LAME, FLAT = 5.859, 2.5  # Lame's pressure; that of the flat rings
CASES = {  # scene, settings, pressure, bound on its error, on the noise in per cent
    "around": (RUNS / "ring_in_ring_3d.yaml",
               (*SHRINK, "mesh.parameters={n_inner: 12, n_outer: 15, n_len: 20, jitter: 0.2, stretch: 0.1}"), LAME, 0.02,
               None),
    "along": (RUNS / "ring_in_ring_3d.yaml",
              (*SHRINK, "mesh.parameters={n_inner: 24, n_outer: 30, n_len: 6, jitter: 0.2, stretch: 10}"), LAME, 0.001,
              0.5),
    "flat ring": (SCENES / "flat_rings.yaml", (), FLAT, 0.01, 1),
}

args = arguments()
check = Check()
for name, (scene, settings, pressure, mean, noise) in CASES.items():
    summary = run(args, scene, out=name.replace(" ", "_"), overrides=settings).summary()
    check.near(f"{name}: mean pressure", summary["probes"]["mean_pressure"], pressure, mean * pressure)
    fall_backs = summary["contact"][0]["fall_backs"]
    check.holds(f"{name}: no fall-back", fall_backs == 0, str(fall_backs))
    if noise:
        check.holds(f"{name}: noise", summary["probes"]["noise_rms"] <= noise, str(summary["probes"]["noise_rms"]))
check.finish()
