"""Routines of users (law: umat) beside the laws of the program: Hooke's law and J2 plasticity at small strains, the
neo-Hookean law at finite strains from DFGRD1, in the plane and in space; and what a run says of a routine that crashes
or gives no number. A bar is pulled, sheared by its supports, and let go."""
import pathlib
import subprocess

import numpy

from harness import SCENES, Check, arguments, run

E, NU, YIELD, SLOPE = 200e3, 0.3, 450, 2000
MU, LAMBDA = E / (2 * (1 + NU)), E * NU / ((1 + NU) * (1 - 2 * NU))
# routine, constants, states, kinematics, built-in law
CASES = {
    "elastic": ("elastic.f", [E, NU], 1, "small", f"{{law: linear, E: {E}, nu: {NU}}}"),
    "j2": ("j2.f", [E, NU, YIELD, SLOPE], 1, "small",
           f"{{law: von_mises, E: {E}, nu: {NU}, yield: {YIELD}, hardening: {{linear: {SLOPE}}}}}"),
    "neo_hookean": ("neo_hookean.c", [MU, LAMBDA], 0, "finite", f"{{law: neo_hookean, E: {E}, nu: {NU}}}"),
}
args = arguments(("order", "of the elements", ["1", "2"]))
check = Check()
ROOT = pathlib.Path(__file__).resolve().parents[2]
folder = pathlib.Path(args.out).resolve()
folder.mkdir(parents=True, exist_ok=True)


def library(source):
    built = folder / f"{pathlib.Path(source).stem}_{args.order}_{args.ranks}.so"
    subprocess.run([ROOT / "scripts/build_umat.sh", ROOT / "tests/umat" / source, built], check=True)
    return built


def scene(name, material, kinematics, *more, **options):
    overrides = [f"kinematics={kinematics}", f"mesh.order={args.order}", f"bodies.0.material={material}",
                 "mesh.parameters={lx: 2, ly: 1, lz: 1, nx: 3, ny: 2, nz: 2, tet: 0}",
                 "bodies.0.formulation=full", "supports.1={surface: x_min, uy: 0, uz: 0}",
                 "loads.0={surface: x_max, ux: 0.02, uy: 0.03, history: [[0, 0], [0.5, 1], [1, 0.3]]}",
                 "supports.2={surface: z_min, uz: 0}", *more]
    if kinematics == "finite":
        overrides += ["loads.0.ux=0.3", "loads.0.uy=0.2"]
    return run(args, SCENES / "plastic_bar.yaml", "-quiet", out=f"{name}", overrides=overrides, **options)


for name, (source, constants, states, kinematics, own) in CASES.items():
    routine = (f"{{law: umat, E: {E}, nu: {NU}, library: {library(source)}, constants: {constants}, states: {states}}}")
    built_in, umat = scene(name + "_own", own, kinematics), scene(name, routine, kinematics)
    force = [{row["t"]: row["force"] for row in finished.steps()} for finished in (built_in, umat)]
    force = [[of[t] for t in sorted(set(force[0]) & set(force[1]))] for of in force]  # a linear scene has few steps
    size = numpy.max(numpy.abs(force[0]))
    check.near(f"{name}: force", numpy.array(force[1]) / size, numpy.array(force[0]) / size, 1e-8)
    fields = [finished.fields()["stress"] for finished in (built_in, umat)]
    size = numpy.max(numpy.abs(fields[0]))
    check.near(f"{name}: stress", fields[1] / size, fields[0] / size, 1e-8)
    iterations = [finished.summary()["newton_iterations"] for finished in (built_in, umat)]
    if name != "elastic":
        check.holds(f"{name}: as many iterations", iterations[1] <= 1.2 * iterations[0] + 2, iterations)
    check.holds(f"{name}: no step failed", umat.summary()["steps_failed"] == 0)
for fault, text in ((1, "crashed (signal"), (2, "not finite")):
    routine = (f"{{law: umat, E: {E}, nu: {NU}, library: {library('neo_hookean.c')}, "
               f"constants: [{MU}, {LAMBDA}, {fault}]}}")
    finished = scene(f"fault_{fault}", routine, "finite", "stepping.dt_min=0.05", must=2)
    check.holds(f"fault {fault} is told", text in finished.text and "in element" in finished.text,
                [line for line in finished.text.splitlines() if "umat" in line][:1])
check.finish()
