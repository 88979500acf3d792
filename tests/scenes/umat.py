"""Routines of users (law: umat) beside the laws of the program: Hooke's law and J2 plasticity at small strains, the
neo-Hookean law at finite strains from DFGRD1. A bar is pulled, sheared by its supports, and let go; a tool is pressed
into a block. A law of damage is held against its closed form, which needs COORDS, CELENT and KINC; its tangent is not
symmetric, and it asks for shorter steps. And what a run says of routines that crash, give no number, are not there, or
write more states than they have."""
import math
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
    return run(args, SCENES / "plastic_bar.yaml", "-quiet", "-trust", out=f"{name}", overrides=overrides, **options)


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
    blamed = "a routine of the user's (law: umat) failed; the routine umat gave a number" in finished.text
    check.holds(f"fault {fault}: the routine is blamed, no element", blamed == (fault == 2)
                and "inside out" not in finished.text)


def damaged(steps, slope, length):
    """Force of a bar of unit section: E grows by `slope` from y = 0 to 1, with nu = 0; else nu is NU."""
    most = 0
    for row in steps:
        strain = 0.005 * (2 * row["t"] if row["t"] <= 0.5 else 1 - 1.6 * (row["t"] - 0.5))
        most = max(most, strain * (1 if slope else math.sqrt(1 + 2 * NU**2)))
        yield E * (1 + slope / 2) * strain * (1 - 0.6 * (1 - math.exp(-400 * length * most)))


built = library("damage.c")
OFF = ["supports=[{surface: x_min, ux: 0}, {surface: y_min, uy: 0}, {surface: z_min, uz: 0}]",
       "mesh.parameters={lx: 2, ly: 1, lz: 1, nx: 4, ny: 2, nz: 2, tet: 0, skew: 0}",
       "loads.0={surface: x_max, ux: 0.01, history: [[0, 0], [0.5, 1], [1, 0.2]]}"]
for what, slope, limit in (("damage", 0, 1), ("modulus over y", 0.5, 1), ("shorter steps", 0, 3e-4)):
    routine = (f"{{law: umat, E: {E}, nu: {NU}, library: {built}, states: 2, unsymmetric: true, "
               f"constants: [{E}, {0 if slope else NU}, 400, 0.6, {slope}, {limit}]}}")
    finished = scene(what.replace(" ", "_"), routine, "small", *OFF, "stepping.dt_min=1e-3")
    expected = list(damaged(finished.steps(), slope, 0.5 / int(args.order)))
    check.near(f"{what}: force", [row["force"] for row in finished.steps()], expected, 1e-9 * max(expected))
    check.holds(f"{what}: steps that failed", (finished.summary()["steps_failed"] > 0) == (limit < 1))
finished = scene("too_short", routine, "small", *OFF, "stepping.dt_min=0.05", must=2)
check.holds("a routine that asks for too short a step is named",
            "the routine umat asked for a shorter step" in finished.text)
sheared = [scene(f"sheared_{unsymmetric}", f"{{law: umat, E: {E}, nu: {NU}, library: {built}, states: 2, "
                 f"constants: [{E}, {NU}, 400, 0.6, 0, 1], unsymmetric: {unsymmetric}}}", "small", "loads.0.ux=0.01",
                 "stepping.initial=0.125")
           for unsymmetric in ("true", "false")]
iterations = [finished.summary()["newton_iterations"] for finished in sheared]
check.holds("the whole tangent takes fewer iterations", iterations[0] < 0.8 * iterations[1], iterations)

tools = []
for name in ("neo_hookean", "umat"):
    material = CASES["neo_hookean"][4] if name == "neo_hookean" else (
        f"{{law: umat, E: {E}, nu: {NU}, library: {library('neo_hookean.c')}, constants: [{MU}, {LAMBDA}]}}")
    tools.append(run(args, SCENES / "tool.yaml", "-quiet", "-trust", out=f"tool_{name}", overrides=[
        f"bodies.0.material={material}", "contact.0.master.cylinder.force=[0, -60e3]", "mesh.parameters.nx=10",
        "mesh.parameters.ny=5", "bodies.0.formulation=full", f"mesh.order={args.order}", "contact.0.friction.mu=0.3"]))
for key in ("force", "way"):
    size = abs(tools[0].steps()[-1][key])
    check.near(f"contact: {key}", tools[1].steps()[-1][key] / size, tools[0].steps()[-1][key] / size, 1e-7)

NOTHING = folder / "nothing.so"
subprocess.run(["gcc", "-shared", "-fPIC", "-x", "c", "-o", NOTHING, "/dev/null"], check=True)
REFUSED = {  # what a user may get wrong: words of the one line, exit status
    "library: missing.so": ("missing.so", 1),
    f"library: {NOTHING}": ("neither a routine umat_ nor umat", 1),
    "states: 101": ("an integer in [0, 100]", 1),
    "states: 1": ("wrote state 2", 2),
}
for key, (text, status) in REFUSED.items():
    routine = f"{{law: umat, E: {E}, nu: {NU}, library: {built}, constants: [{E}, {NU}, 400, 0.6, 0, 1], states: 2}}"
    finished = scene("refused", routine, "small", *OFF, f"bodies.0.material.{key.replace(': ', '=')}", must=status)
    lines = {line for line in finished.text.splitlines() if line.startswith("burnish:") and "warning" not in line}
    told = all(text in line for line in lines) and (len(lines) == 1 or status == 2)  # each rank has its own element
    check.holds(f"{key} is told in one line", told, sorted(lines)[:2])
for formulation in ("enhanced", "mixed"):
    if formulation == "enhanced" and args.order == "2":
        continue
    finished = scene("refused", routine, "small", *OFF, f"bodies.0.formulation={formulation}", must=1)
    check.holds(f"{formulation} is refused", "allowed" in finished.text and "with umat: full | fbar" in finished.text)
check.finish()
