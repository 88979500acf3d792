"""Three loose plates, pressed on each other: with named pairs and with `surfaces: all` the run is done without a failed
step, with about as many iterations, and the base carries the load. The middle plate bears no load itself, so that its
ties must not take what the load does by the unevenness of the faces for a force along them."""
from harness import Check, arguments, run, SCENES

SPACE = ("geometry=solid", "mesh.parameters.solid=1", "supports.0.uz=0")
ALL = ("contact=[{name: any, surfaces: all}]", )
MORE = 1.5  # iterations with `surfaces: all` over those with named pairs, at most

args = arguments()
check = Check()
for name, overrides, component, force in (("plane", ("mesh.parameters.n=12", ), "y", -0.1 * 20), ("space", SPACE, "z", -0.1 * 20**2)):
    probe = (f"probes=[{{name: force, reaction: base, component: {component}}}]", )
    iterations = []
    for way, contact in (("named", ()), ("all", ALL)):
        summary = run(args, SCENES / "loose_plates.yaml", out=f"{name}-{way}",
                      overrides=(*overrides, *contact, *probe)).summary()
        iterations.append(summary["newton_iterations"])
        check.holds(f"{name}, {way}: no failed step", summary["steps_failed"] == 0, str(summary["steps_failed"]))
        check.near(f"{name}, {way}: force", abs(summary["probes"]["force"]), abs(force), 1e-2 * abs(force))
    check.holds(f"{name}: iterations", iterations[1] <= MORE * iterations[0], str(iterations))
check.finish()
