"""A steel strip with a round hole, or with round notches in its sides, in plane strain, pulled until it has yielded
through: the force over the movement against CalculiX on the same mesh, in small and finite strains. Other elements come
near it: mixed ones on the same mesh, those of first order on one twice as fine.

References: jobs/plastic_calculix.py with CPE8 and 50 increments, whose elements lack the middle node. CalculiX yields
by the Cauchy stress, Burnish by the Kirchhoff stress: with finite strains the force is 0.1 to 0.16 % less here."""
import numpy

from harness import Check, arguments, run, SCENES

AT = numpy.linspace(0.1, 1, 10)
REFERENCE = {
    ("hole", "small"): (1903.45, 2034.30, 2143.86, 2241.99, 2332.46, 2417.58, 2498.68, 2576.48, 2651.09, 2723.14),
    ("hole", "finite"): (1892.14, 2006.33, 2099.84, 2182.65, 2257.99, 2326.89, 2390.64, 2450.32, 2506.69, 2559.88),
    ("notches", "small"): (2488.17, 2585.61, 2671.14, 2751.00, 2826.90, 2899.45, 2969.16, 3033.40, 3093.54, 3152.64),
    ("notches", "finite"): (2462.28, 2532.39, 2591.13, 2644.58, 2694.05, 2740.36, 2784.05, 2825.38, 2864.68, 2902.17),
}
ALLOWED = {"small": 0.001, "finite": 0.005}
FINE = ["mesh.order=1", "mesh.parameters.n=16", "mesh.parameters.n_out=24", "mesh.parameters.n_far=12"]
args = arguments(("kinematics", "of the scene", ALLOWED))
check = Check()


def force(name, shape, *overrides):
    finished = run(args, SCENES / "plastic_notch.yaml", "-quiet", out=f"{name}_{shape}",
                   overrides=[f"kinematics={args.kinematics}", f"mesh.parameters.notch={int(shape == 'notches')}",
                              *overrides])
    summary, steps = finished.summary(), finished.steps()
    check.holds(f"{shape}, {name}: no step failed", summary["steps_failed"] == 0,
                f"{summary['steps']} steps, {summary['newton_iterations']} iterations")
    return numpy.interp(AT, [row["t"] for row in steps], [row["force"] for row in steps])


for shape in ("hole", "notches"):
    expected = numpy.array(REFERENCE[shape, args.kinematics])
    check.near(f"{shape}: CalculiX", force("full", shape) / expected, 1, ALLOWED[args.kinematics])
    check.near(f"{shape}: mixed", force("mixed", shape, "bodies.0.formulation=mixed") / expected, 1, 0.01)
for name in ("fbar", "enhanced", "mixed"):
    found = force(f"{name}_1", "hole", f"bodies.0.formulation={name}", *FINE)
    check.near(f"hole, {name} of first order", found / numpy.array(REFERENCE["hole", args.kinematics]), 1, 0.01)
check.finish()
