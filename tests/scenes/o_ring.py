"""An O-ring of nearly incompressible rubber is squeezed into its groove at default settings: in few steps, none of which
fails, and in few iterations; in one single step too. Every path leads to the same force."""
from harness import Check, arguments, run, SCENES

args = arguments(("cases", "first-order quadrangles, or all elements and ratios", ("few", "all")))
check = Check()
RUNS = SCENES.parent.parent / "runs"
RING = RUNS / "o_ring.yaml"
ELEMENTS = {
    "quad4": ("mesh.order=1", "bodies.0.formulation=fbar"),
    "quad9": ("mesh.order=2", "bodies.0.formulation=full"),
    "tri6": ("mesh.order=2", "bodies.0.formulation=full", "mesh.parameters.triangles=1"),
    "tri3 mixed": ("mesh.order=1", "mesh.parameters.triangles=1"),
    "tri6 mixed": ("mesh.order=2", "mesh.parameters.triangles=1"),
    "tri6 that rolls": ("mesh.order=2", "mesh.parameters.triangles=1", "mesh.parameters.n=12"),
    "tri6 coarse": ("mesh.order=2", "mesh.parameters.triangles=1", "mesh.parameters.n=10")
}
WAYS = {
    "steps": (),
    "deeper": ("bodies.2.rigid.motion=[{uy: -1.059}]", ),
    "one": ("stepping={control: fixed, initial: 1}", ),
    "rolling": ()
}
# These guard that the tangent extrapolates the pressure. Without it quad4 takes 7 steps and 39 iterations at nu 0.499, 12
# steps (2 failed) and 149 iterations at 0.4999, and with one step asked for 2 (1 failed) and 80, 10 (10 failed) and
# 402. Today 19 to 34 iterations are taken, and 6 to 11 in one step.
# Without friction the ring may roll about its own cord, and on a mesh of triangles it does, to and fro: 7 steps and 37
# to 40 iterations. A search that wants less energy in each iteration takes 11 and 13 steps, 2 and 4 of them failed, and
# 131 and 229 iterations. In one step it takes 11 iterations, and 21 with a search that only looks at an energy which may
# rise from the start of a step on.
# "tri6 coarse" guards that stiffer penalties begin from a prediction. Without one it takes 53 iterations instead of 18,
# goes back to the soft penalties, and its force is 0.94 % off.
BOUNDS = {"steps": (8, 35), "deeper": (8, 35), "one": (1, 15), "rolling": (8, 50)}
CASES = [("quad4", "steps", 0.499), ("quad4", "one", 0.499), ("tri3 mixed", "steps", 0.499),
         ("tri6 that rolls", "one", 0.499), ("tri6 coarse", "deeper", 0.4999)]
if args.cases == "all":
    CASES += [("quad4", "steps", nu) for nu in (0.45, 0.49, 0.4999, 0.49999)]
    CASES += [("quad9", "steps", nu) for nu in (0.45, 0.49, 0.499, 0.4999)]
    CASES += [(element, "deeper", nu) for element in ("quad4", "quad9") for nu in (0.45, 0.49, 0.499, 0.4999)]
    CASES += [("quad4", "one", nu) for nu in (0.45, 0.49, 0.4999, 0.49999)]
    CASES += [(element, "one", nu) for element in ("quad9", "tri6") for nu in (0.45, 0.49, 0.499, 0.4999)]
    CASES += [("tri3 mixed", "steps", nu) for nu in (0.49, 0.4999)]
    CASES += [("tri6 mixed", "rolling", nu) for nu in (0.499, 0.4999)]
# Force by nu, squeezed as it is and deeper: quad9 with mixed elements, n = 16. quad4 is up to 0.98 % below it, the
# others are up to 0.44 % above.
FINE = {
    False: {0.45: 424.758, 0.49: 463.652, 0.499: 474.742, 0.4999: 475.913, 0.49999: 476.031},
    True: {0.45: 893.077, 0.49: 1021.326, 0.499: 1061.198, 0.4999: 1065.514}
}
forces = {}
for element, way, nu in CASES:
    name = f"{element}, {way}, nu {nu}"
    summary = run(args, RING, out=f"{element}_{way}_{nu}",
                  overrides=(*ELEMENTS[element], *WAYS[way], f"bodies.0.material.nu={nu}", "output.every=0")).summary()
    steps, iterations = BOUNDS[way]
    check.holds(f"{name}: steps", summary["steps"] <= steps and summary["steps_failed"] == 0,
                f"{summary['steps']}, {summary['steps_failed']} failed")
    check.holds(f"{name}: iterations", summary["newton_iterations"] <= iterations, str(summary["newton_iterations"]))
    causes = summary["guards"]["cut_causes"]
    check.holds(f"{name}: every cut has a cause", sum(causes.values()) == summary["guards"]["line_search_cuts"])
    fine = FINE[way == "deeper"][nu]
    forces[way, nu, element] = summary["probes"]["force"]
    check.near(f"{name}: force", summary["probes"]["force"], fine, 0.01 * fine)
# The unit of stress is free. Pressures at nodes are unknowns beside the displacements and no lengths: taken for lengths
# they gave 32 instead of 34 iterations and another force with the second unit.
small = run(args, RING, out="other_unit",
            overrides=(*ELEMENTS["tri3 mixed"], "bodies.0.material.E=5.5e-6", "output.every=0")).summary()
usual = forces["steps", 0.499, "tri3 mixed"]
check.near("other unit of stress: force", 1e6 * small["probes"]["force"], usual, 1e-6 * usual)
if args.cases == "all":
    # Rubber goes into the mouth of a gap. Faces as long as the mouth do not follow it, those of 0.05 do. A search that
    # compares residuals, and a fluid that dries places within a step, end below 3 MPa.
    pressed = run(args, RUNS / "o_ring_pressure.yaml", out="pressed", overrides=(
        *(value for value in ELEMENTS["tri6 mixed"] if value.startswith("mesh")), "mesh.parameters.n=12",
        "mesh.parameters.gap=0.05", "stepping.dt_max=0.1", "output.every=0")).summary()
    check.holds("pressed: 10 MPa", pressed["status"] == "done", pressed["status"])
    check.holds("pressed: steps", pressed["steps"] <= 14 and pressed["steps_failed"] == 0,
                f"{pressed['steps']}, {pressed['steps_failed']} failed")
    check.near("pressed: tight", pressed["probes"]["tight_to"], 11.94, 0.003 * 11.94)  # faces of 0.025
    # Squeezed deeper, then 10 MPa. These guard that offsets which a rolling ring turns to and fro are damped, that the first
    # step of the fluid is a short one, and that a prediction which leads nowhere is left: without them quad4 takes 10
    # steps with one failed, at nu 0.4999 18 with 23 failed, and ends at 9.7 MPa.
    # quad9 at nu 0.5 takes 25 steps with ten failed where pressures change after solves only and work is that of stiff
    # volumes.
    deeper = "bodies.2.rigid.motion=[{uy: -1.059, history: [[0, 0], [0.5, 1], [1, 1]]}]"
    for element, n, nu in (("quad4", 24, 0.499), ("quad4", 24, 0.4999), ("quad9", 12, 0.499), ("quad9", 12, 0.5),
                           ("tri3 mixed", 24, 0.499), ("tri6 mixed", 12, 0.499)):
        name = f"{element} squeezed and pressed, nu {nu}"
        order = [value for value in ELEMENTS[element] if value.startswith("mesh")]
        summary = run(args, RUNS / "o_ring_pressure.yaml", out=f"pressed_{element}_{nu}", overrides=(
            *order, f"mesh.parameters.n={n}", f"bodies.0.material.nu={nu}", deeper, "output.every=0")).summary()
        check.holds(f"{name}: done", summary["status"] == "done", summary["status"])
        check.holds(f"{name}: steps", summary["steps"] <= 14 and summary["steps_failed"] == 0,
                    f"{summary['steps']}, {summary['steps_failed']} failed")
        tight = 12.99 if nu == 0.499 else 13.04
        check.near(f"{name}: tight", summary["probes"]["tight_to"], tight, 0.003 * tight)
check.finish()
