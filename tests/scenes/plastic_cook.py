"""Cook's membrane of steel in plane strain, its right end moved up until all of it has yielded: the force over the
movement against CalculiX on the same mesh, in small and finite strains, elements of second order. First-order elements
come near it on a finer mesh.

References: jobs/plastic_calculix.py with CPE8 and 40 increments, whose elements lack the middle node. They lock a little
as full integration does, so that mixed elements are compared with their own fine mesh, too."""
import numpy

from harness import Check, arguments, run, SCENES

REFERENCE = {
    "small": {0.5: 2195.10, 1: 2272.04, 1.5: 2323.03, 2: 2367.49, 2.5: 2407.16, 3: 2444.43, 3.5: 2480.27, 4: 2515.15},
    "finite": {0.5: 2203.23, 1: 2290.59, 1.5: 2354.80, 2: 2411.87, 2.5: 2465.25, 3: 2517.11, 3.5: 2569.41, 4: 2622.50}
}
ALLOWED = {"small": 0.001, "finite": 0.005}  # of the largest force
FIRST_ORDER = {"fbar": 0.01, "enhanced": 0.01, "mixed": 0.01}
args = arguments(("kinematics", "of the scene", ALLOWED))
check = Check()


def force(*overrides, out):
    finished = run(args, SCENES / "plastic_cook.yaml", "-quiet", out=out,
                   overrides=[f"kinematics={args.kinematics}", *overrides])
    summary = finished.summary()
    check.holds(f"{out}: no step failed", summary["steps_failed"] == 0,
                f"{summary['steps']} steps, {summary['newton_iterations']} iterations")
    steps = finished.steps()
    return numpy.interp(list(reference), [4 * row["t"] for row in steps], [row["force"] for row in steps])


reference = REFERENCE[args.kinematics]
expected, largest = numpy.array(list(reference.values())), max(reference.values())
check.near("second order, full", force("bodies.0.formulation=full", out="second_full") / largest, expected / largest,
           ALLOWED[args.kinematics])
mixed = {n: force("bodies.0.formulation=mixed", f"mesh.parameters.n={n}", out=f"mixed_{n}") / largest for n in (16, 32)}
check.near("second order, mixed, n = 16: as 32", mixed[16], mixed[32], ALLOWED[args.kinematics])
check.near("second order, mixed: CalculiX", mixed[16], expected / largest, 0.005)
for name, allowed in FIRST_ORDER.items():
    values = force("mesh.order=1", f"bodies.0.formulation={name}", "mesh.parameters.n=32", out=name)
    check.near(name, values / largest, expected / largest, allowed)
check.finish()
