"""A billet (radius 10, length 30 mm, E 200 GPa, yield 700, hardening 300 MPa) is upset by 60 % between dies to which its
ends stick, and its side folds onto them: done at default settings; the force of meshes and orders agrees, and up to 12 %
it is that of CalculiX on the second-order mesh (jobs/plastic_calculix.py, CAX8R, 50 increments, without the contact)."""
import numpy

from harness import Check, arguments, run, SCENES

CALCULIX = {0.1: 245113, 0.2: 269900}  # t: force; 60 % is t = 1
PLACES = (1 / 3, 2 / 3, 0.9, 1)
CASES = {"second order": ["mesh.order=2", "mesh.parameters.ny=16"], "fbar": [],
         "fbar, twice as fine": ["mesh.parameters.nx=20", "mesh.parameters.ny=30"]}
args = arguments()
check = Check()


def forces(name, at, *overrides):
    finished = run(args, SCENES / "upset.yaml", "-quiet", out=name.replace(" ", "_").replace(",", ""),
                   overrides=overrides)
    summary, steps = finished.summary(), finished.steps()
    check.holds(f"{name}: at most one step in ten failed", summary["steps_failed"] <= summary["steps"] / 10,
                f"{summary['steps_failed']} of {summary['steps']}, {summary['newton_iterations']} iterations")
    return numpy.interp(at, [row["t"] for row in steps], [row["force"] + row["die"] for row in steps])


for name, overrides in CASES.items():
    forces(f"{name}, default steps", PLACES, *overrides)
    found = forces(name, (*CALCULIX, *PLACES), "stepping.dt_max=0.02", *overrides)
    if name == "second order":
        for (t, expected), value in zip(CALCULIX.items(), found):
            check.near(f"{name}: CalculiX at {60 * t:.0f} %", value / expected, 1, 0.005)
        reference = found
    check.near(f"{name}: as second order", found / reference, 1, 0.02)
check.finish()
