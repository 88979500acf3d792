"""Routines of users (law: umat) in every kind of element: they agree with the laws of the program in plane strain,
about an axis and in space, in contact and on any ranks, and the tangent of the scene is the derivative of its
residual. Flat fbar elements in a neck carry the force of elements of second order."""
import pathlib
import re
import subprocess

import numpy

from harness import SCENES, Check, arguments, run

E, NU, YIELD, SLOPE = 200e3, 0.3, 450, 2000
MU, LAMBDA = E / (2 * (1 + NU)), E * NU / ((1 + NU) * (1 - 2 * NU))
ROOT = pathlib.Path(__file__).resolve().parents[2]
# Error of the differences: they are forward ones, so that it is their step over the way on which the law bends, which
# is an element's size in hyperelastic laws and a thousandth of it where the law yields.
JACOBIAN = {"j2": 1e-5, "damage": 1e-5, "neo_hookean": 1e-6, "weakened": 1e-6}
SOLID = ["mesh={file: ../../meshes/block.geo, order: 1, "
         "parameters: {lx: 2, ly: 1, lz: 1, nx: 2, ny: 2, nz: 1, tet: 0}}",
         "supports=[{surface: x_min, ux: 0, uy: 0, uz: 0}]"]
FLAT = ["mesh={file: ../../meshes/square.geo, order: 1, parameters: {lx: 2, ly: 1, nx: 4, ny: 2}}",
        "supports=[{surface: x_min, ux: 0, uy: 0}]",
        "loads.0={surface: x_max, ux: 0, uy: 0, history: [[0, 0], [0.5, 1], [1, 0.3]]}"]
GEOMETRIES = {"solid": SOLID, "plane_strain": FLAT, "axisymmetric": FLAT}
ELEMENTS = {"full_1": ("full", 1), "fbar_1": ("fbar", 1), "full_2": ("full", 2)}
# routine, constants, states, kinematics, built-in law, displacements
CASES = {
    "j2": ("j2.f", [E, NU, YIELD, SLOPE], 1, "small",
           f"{{law: von_mises, E: {E}, nu: {NU}, yield: {YIELD}, hardening: {{linear: {SLOPE}}}}}", (0.02, 0.03)),
    "neo_hookean": ("neo_hookean.c", [MU, LAMBDA], 0, "finite", f"{{law: neo_hookean, E: {E}, nu: {NU}}}", (0.3, 0.2)),
}
args = arguments(("geometry", "of the scene", GEOMETRIES))
check = Check()
folder = pathlib.Path(args.out).resolve()
folder.mkdir(parents=True, exist_ok=True)


def routine(source, constants, states, more=""):
    built = folder / f"{pathlib.Path(source).stem}_{args.ranks}.so"
    subprocess.run([ROOT / "scripts/build_umat.sh", ROOT / "tests/umat" / source, built], check=True)
    return f"{{law: umat, E: {E}, nu: {NU}, library: {built}, constants: {constants}, states: {states}{more}}}"


def scene(name, material, kinematics, element, way, *options, more=(), must=0):
    formulation, order = ELEMENTS[element]
    overrides = [f"geometry={args.geometry}", *GEOMETRIES[args.geometry], f"kinematics={kinematics}",
                 f"mesh.order={order}", f"bodies.0.material={material}", f"bodies.0.formulation={formulation}",
                 f"loads.0={{surface: x_max, ux: {way[0]}, uy: {way[1]}, history: [[0, 0], [0.5, 1], [1, 0.3]]}}",
                 "stepping={control: fixed, initial: 0.125}", *more]
    return run(args, SCENES / "plastic_bar.yaml", "-trust", *options, out=f"{name}_{element}_{args.geometry}",
               overrides=overrides, must=must)


def jacobian(name, *case):
    finished = scene(name + "_jacobian", *case, "-snes_test_jacobian", more=["stepping.initial=0.25"])
    ratios = [float(value) for value in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = ([0-9.e+-]+)", finished.text)]
    check.holds(f"{name}, {case[2]}: tangent", ratios and max(ratios) < JACOBIAN[name], f"{max(ratios, default=0):.1e}")


def forces(finished):
    return {row["t"]: row["force"] for row in finished.steps()}


for element in ELEMENTS:
    for name, (source, constants, states, kinematics, own, way) in CASES.items():
        what = f"{name}, {element}"
        material = routine(source, constants, states)
        built_in = scene(name + "_own", own, kinematics, element, way)
        umat = scene(name, material, kinematics, element, way)
        force = [forces(built_in), forces(umat)]
        size = max(abs(value) for value in force[0].values())
        check.near(f"{what}: force", [force[1][t] / size for t in force[0]],
                   [force[0][t] / size for t in force[0]], 1e-8)
        fields = [finished.fields()["stress"] for finished in (built_in, umat)]
        size = numpy.max(numpy.abs(fields[0]))
        check.near(f"{what}: stress", fields[1] / size, fields[0] / size, 1e-8)
        if name == "j2":  # the other law of the program has no balance
            energies = [finished.summary()["energy"] for finished in (built_in, umat)]
            for key in ("elastic", "plastic", "work"):
                check.near(f"{what}: energy, {key}", energies[1][key], energies[0][key], 1e-8 * energies[0]["work"])
        iterations = [finished.summary()["newton_iterations"] for finished in (built_in, umat)]
        check.holds(f"{what}: as many iterations", iterations[1] <= 1.2 * iterations[0] + 2, iterations)
        if args.ranks == 1:
            jacobian(name, material, kinematics, element, way)
    if args.ranks == 1:
        damage = routine("damage.c", [E, NU, 400, 0.6, 0, 1], 2, ", unsymmetric: true")
        weakened = routine("neo_hookean.c", [MU, LAMBDA, 0, 0.5], 0, ", unsymmetric: true")
        jacobian("damage", damage, "small", element, (0.01, 0.02))
        jacobian("weakened", weakened, "finite", element, (0.3, 0.2))
if args.geometry == "axisymmetric":
    ends = []
    for name, more in (("flat", ["mesh.parameters={nr: 8, nl: 60, progression: 1.06}", "bodies.0.formulation=fbar"]),
                       ("second order", ["mesh.parameters={nr: 4, nl: 30, progression: 1.12}", "mesh.order=2",
                                         "bodies.0.formulation=full"])):
        finished = run(args, SCENES / "necking.yaml", "-quiet", "-trust", out=f"neck {name}", overrides=[
            f"bodies.0.material={routine('j2.f', [E, NU, 600, 150], 1)}", "loads.0.uy=3.5", "stepping.dt_max=0.04", *more])
        ends.append(finished.steps()[-1]["force"])
    check.near("flat fbar elements in a neck: force over that of second order", ends[0] / ends[1], 1, 0.005)
check.finish()
