"""A rigid cylinder turns by 20 of its facets under a block, so that nothing should change: under a constant load the
force along x and the block's height, at a fixed height the normal force move at least 20 times less with the diffuse
smoother than with facets on the same mesh, in both formulations, on a jittered cylinder too; surface to surface no more
than node to surface."""
from harness import Check, arguments, run, SCENES

PRESSED = 0.2  # load parameter from which the cylinder turns
FACTOR = 20
LOADS = {
    "constant load": ([], ("force_x", "height")),
    "fixed height": (["loads=[{surface: block_top, uy: -0.05, history: [[0, 0], [0.2, 1], [1, 1]]}]"], ("force_y",)),
}
SMOOTHERS = {
    "facets": ["contact.0.smoother=facet"],
    "degree 4": ["contact.0.degree=4"],
    "degree 2": ["contact.0.degree=2"],
    "surface to surface": ["contact.0.formulation=surface_to_surface"]
}

args = arguments(("jitter", "of the cylinder's nodes, in facets", ["0", "0.25"]))
check = Check()
for load, (how, probes) in LOADS.items():
    amplitude = {}
    for smoother, override in SMOOTHERS.items():
        finished = run(args, SCENES.parent.parent / "runs" / "slide_facets.yaml",
                       out=f"{load} {smoother}".replace(" ", "_"),
                       overrides=[f"mesh.parameters.jitter={args.jitter}"] + how + override)
        turning = [row for row in finished.steps() if row["t"] > PRESSED - 1e-9]
        check.near(f"{load}, {smoother}: end of the run", turning[-1]["t"], 1, 1e-12)
        amplitude[smoother] = {
            probe: (max(row[probe]
                        for row in turning) - min(row[probe]
                                                  for row in turning)) / 2
            for probe in probes
        }
    for probe in probes:
        facets = amplitude["facets"][probe]
        for smoother in list(SMOOTHERS)[1:]:
            smooth = amplitude[smoother][probe]
            check.holds(
                f"{load}, {smoother}: {probe}", FACTOR * smooth <= facets,
                f"amplitude {smooth:.3g}, facets {facets:.3g}: {facets / smooth:.0f} times smaller, asked for {FACTOR}")
        node, surface = amplitude["degree 4"][probe], amplitude["surface to surface"][probe]
        check.holds(f"{load}: {probe}, surface to surface", surface <= node,
                    f"amplitude {surface:.3g}, node to surface {node:.3g}")
check.finish()
