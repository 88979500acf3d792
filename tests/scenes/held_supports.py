"""Supports that hold in some steps only, in the plane, about an axis and in space, against closed forms: a bar that is
let go and held again, a block that contact alone holds in the end, one that falls, a bar that yields; restarts; what
cannot be is refused."""
import re
import subprocess

import numpy

from harness import Check, Run, arguments, run, SCENES

E, F, LENGTH = 1000, 6, 2
SOLID = "mesh.parameters.solid=1"
AREA = {"plane_strain": 1.0, "axisymmetric": numpy.pi, "solid": 1.5}
WHEN = {"pull": 0.3, "fading": 0.4, "free": 0.5, "hold": 0.6, "off": 1.0}
FORMS = [("plane_strain", 1, "small", "direct"), ("plane_strain", 2, "finite", "direct"),
         ("axisymmetric", 2, "small", "direct"), ("axisymmetric", 1, "finite", "direct"),
         ("solid", 1, "small", "iterative"), ("solid", 2, "finite", "direct")]


def form(geometry):
    """The overrides that take the scene to a geometry: supports of the sides, vectors of its dimension."""
    if geometry == "plane_strain":
        return [], lambda x, y: [x, y]
    if geometry == "axisymmetric":
        return ["geometry=axisymmetric", "supports.1={surface: low, ux: 0}"], lambda x, y: [x, y]
    return ["geometry=solid", SOLID, "supports.1={surface: left, ux: 0}", "supports.4={surface: back, uz: 0}"
            ], lambda x, y: [x, y, 0]


def at(finished, t, name):
    return next(row[name] for row in finished.steps() if abs(row["t"] - t) < 1e-9)


def root(f, low, high):
    """The zero of a rising function."""
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (low, middle) if f(middle) > 0 else (middle, high)
    return low


def exact(area, kinematics):
    """Step -> displacement of the middle, force of the low end, of the high end."""
    half = LENGTH / 2

    def tension(elongation):
        stretch = 1 + elongation / half
        return area * (E * elongation / half if kinematics == "small" else E / 2 * (stretch**3 - stretch))

    pull = root(lambda u: tension(u) - tension(-u) - F, 0, 0.1)
    fading = root(lambda u: tension(u) - (F + tension(-pull) / 2), 0, 0.1)
    free = root(lambda u: tension(u) - F, 0, 0.1)
    return {"pull": (pull, -tension(pull), tension(-pull)), "fading": (fading, -tension(fading), tension(-pull) / 2),
            "free": (free, -F, 0), "hold": (free, -F, 0), "off": (free / 2, -tension(free / 2), tension(free / 2))}


def bar(geometry, order, kinematics, solver):
    sides, vector = form(geometry)
    what = f"{geometry}, order {order}, {kinematics}, {solver}"
    law = "linear" if kinematics == "small" else "svk"
    finished = run(args, SCENES / "held_bar.yaml", out=f"bar_{geometry}_{order}", overrides=[
        *sides, f"mesh.order={order}", f"kinematics={kinematics}", f"solver.type={solver}",
        f"bodies.0.material.law={law}", f"mesh.parameters.tri={order - 1}", "stepping.at=[0.4]",
        f"loads.0.force={vector(0, F)}", f"probes.2.displacement={vector(0, 1)}",
        f"probes.3.displacement={vector(0, 2)}"
    ])
    for step, (middle, low, high) in exact(AREA[geometry], kinematics).items():
        t = WHEN[step]
        check.near(f"{what}: forces in {step}", [at(finished, t, "low") / F, at(finished, t, "high") / F],
                   [low / F, high / F], 1e-9)
        check.near(f"{what}: middle in {step}", at(finished, t, "middle") / middle, 1, 1e-9)
    return finished


def driven():
    """A support that comes with an expression reaches it at the end of its first step."""
    finished = run(args, SCENES / "held_bar.yaml", out="driven", overrides=[
        "supports.3={surface: high, uy: \"0.001*y\", during: [hold, off]}", "stepping.at=[0.55]"
    ])
    free, k = F / E * (LENGTH / 2), E / (LENGTH / 2)
    for t, end in ((0.5, free), (0.55, (free + 0.002) / 2), (0.6, 0.002), (1, 0.002)):
        check.near(f"driven: end at t = {t}", at(finished, t, "end") / free, end / free, 1e-9)
    check.near("driven: force of the high end", at(finished, 0.6, "high") / F, k * (0.002 - 0.004) / F, 1e-9)


BLOCK = [
    "loads=[]", "supports=[{surface: low, ux: 0, uy: 0, during: press}]",
    "stepping={control: fixed, initial: 0.1, steps: [{name: press, until: 0.5}, {name: alone, until: 1}]}",
    "probes=[{name: held, reaction: low, component: y}, {name: punch, contact_force: punch, component: y}, "
    "{name: bed, contact_force: bed, component: y}]"
]


def contact(geometry):
    """A punch is pressed on a block that is held below; then it is let go, and a bed holds it. Exact: block and contact
    in series, with one penalty, then with two."""
    penalty, way, area = 1e5, 0.02, AREA[geometry]
    sides, vector = form(geometry)
    plane = "{{plane: {{point: {}, normal: {}{}}}}}, penalty: {{initial: {}, scale: 1}}".format
    motion = f", motion: [{{uy: {-way}, during: press}}]"
    punch, bed = plane(vector(0, 2), vector(0, -1), motion, penalty), plane(vector(0, 0), vector(0, 1), "", penalty)
    hold = "supports.0={surface: low, ux: 0, uy: 0, uz: 0, during: press}"
    finished = run(args, SCENES / "held_bar.yaml", out=f"contact_{geometry}", overrides=[
        *BLOCK, *[side for side in sides if not side.startswith("supports")], *([hold] if geometry == "solid" else []),
        f"contact=[{{name: punch, slave: high, master: {punch}}}, {{name: bed, slave: low, master: {bed}}}]"
    ])
    first, second = (area * way / (LENGTH / E + n / penalty) for n in (1, 2))
    check.near(f"contact, {geometry}: held", [at(finished, 0.5, n) / first for n in ("held", "punch", "bed")],
               [1, 1, 0], 1e-7)
    check.near(f"contact, {geometry}: alone", [at(finished, 1, n) / second for n in ("held", "punch", "bed")],
               [0, 1, -1], 1e-7)
    return finished


def falls():
    """A block that hangs above its bed is let go under its weight. Exact: the gap, its own shortening, the penalty."""
    penalty, gap, weight = 1e5, 0.05, 5
    finished = run(args, SCENES / "held_bar.yaml", out="falls", overrides=[
        *BLOCK, f"loads=[{{volume: bar, body_force: [0, {-weight}]}}]",
        "probes=[{name: bed, contact_force: bed, component: y}, {name: top, displacement: [0, 2], component: y}]",
        f"contact=[{{name: bed, slave: low, master: {{plane: {{point: [0, {-gap}], normal: [0, 1]}}}}, penalty: "
        f"{{initial: {penalty}, scale: 1}}}}]"
    ])
    check.near("falls: force of the bed", -at(finished, 1, "bed") / (weight * LENGTH), 1, 1e-7)
    down = gap + weight * LENGTH / penalty + weight * LENGTH**2 / 2 / E
    check.near("falls: top", -at(finished, 1, "top") / down, 1, 1e-7)
    check.holds("falls: the last screen says so", "moved into contact, without force: 'bar'" in finished.text)


def yields():
    """An end is driven until the bar flows, and let go. Exact: linear hardening in one dimension. What enters from
    outside is what is stored and what flow takes."""
    y, h, way = 10, 100, 0.04
    sides, _ = form("solid")
    finished = run(args, SCENES / "held_bar.yaml", out="yields", overrides=[
        *sides, f"bodies.0.material={{law: von_mises, E: {E}, nu: 0.3, yield: {y}, hardening: {{linear: {h}}}}}",
        "loads=[]", "supports.2={surface: high, uy: \"0.04*t/0.3\", during: pull}",
        "supports.3={surface: low, uy: 0}", "probes.2.displacement=[0, 1, 0]", "probes.3.displacement=[0, 2, 0]",
        "stepping.initial=0.05"
    ])
    stress = (y * E + E * h * way / LENGTH) / (E + h)
    check.near("yields: force", at(finished, 0.3, "high") / (stress * AREA["solid"]), 1, 1e-8)
    check.near("yields: what is left", at(finished, 1, "end") / (way - LENGTH * stress / E), 1, 1e-8)
    energy = finished.summary()["energy"]
    check.near("yields: energy balance", energy["work"] / (energy["elastic"] + energy["plastic"]), 1, 1e-8)


def go_on(directory, ranks, *overrides):
    command = ["mpirun", "-n", str(ranks), args.burnish, "-restart", str(directory)]
    for override in overrides:
        command += ["-set", override]
    again = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    check.holds("the restart ends well", again.returncode == 0, again.stdout if again.returncode else "")
    return Run(0, "", directory).steps()


FEW = ("solver.max_iterations=2", "stepping.damping=none")


def fails():
    """A run that fails in its first load step with other supports goes on with these."""
    overrides = ["kinematics=finite", "bodies.0.material.law=svk", "loads.0.force=[0, 100]", "stepping.dt_min=0.09"]
    first = run(args, SCENES / "held_bar.yaml", out="fails", must=2, overrides=[*overrides, *FEW])
    check.holds("it fails where the support has left", first.summary()["during"] == "pull")
    after = go_on(first.directory, args.ranks, "solver.max_iterations=20")
    whole = run(args, SCENES / "held_bar.yaml", out="fails_not", overrides=[*overrides, "solver.max_iterations=20"])
    for name, scale in (("low", 100), ("high", 100), ("end", 0.1)):
        values, expected = ([row[name] / scale for row in rows] for rows in (after, whole.steps()))
        check.near(f"goes on after a failure: {name}", values, expected, 1e-9)


def restart():
    """A run that goes on from where a support leaves, or from amidst its fading forces, ends as one in a whole."""
    friction = "{name: bed, slave: low, master: {plane: {point: [0, -0.001], normal: [0, 1]}}, friction: {mu: 0.3}}"
    punch = ("{name: punch, slave: high, master: {cylinder: {point: [0.5, 4], radius: 2, motion: [{uy: -0.02, during: "
             "press}]}}, friction: {mu: 0.3}}")
    for step in (5, 7):
        whole = run(args, SCENES / "held_bar.yaml", out=f"restart_{step}", overrides=[
            *BLOCK, "kinematics=finite", "bodies.0.material={law: neo_hookean, E: 1000, nu: 0.3}",
            "supports=[{surface: left, ux: 0, uy: 0, during: press}, {surface: right, ux: 0, uy: 0, during: press}]",
            f"contact=[{punch}, {friction}]", f"output={{every: 1, checkpoint: {step}}}", "probes.0.reaction=left"
        ])
        before = whole.steps()
        ranks = args.ranks if step == 5 else max(1, (args.ranks + 1) % 4)  # 1 goes on as 2, 2 as 3, 3 as 1
        after = go_on(whole.directory, ranks)
        for name in ("held", "punch", "bed", "contact_nodes", "newton"):
            values, expected = ([row[name] or 0 for row in rows] for rows in (after, before))
            scale = max(1, numpy.abs(expected).max())
            check.near(f"restart after step {step}: {name}", numpy.array(values) / scale, numpy.array(expected) / scale,
                       0 if args.ranks == ranks == 1 else 1e-8)


def says(what, part, *overrides, scene="held_bar.yaml"):
    command = [args.burnish, str(SCENES / scene), "-check"]
    for override in overrides:
        command += ["-set", override]
    text = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout
    check.holds(what, re.search(part, text), "" if re.search(part, text) else text)


def words():
    """What -check says, and what it refuses."""
    says("-check lists supports", r"'hold' from t = 0.5 to 0.6: supports.3")
    says("-check tells what holds", r"from step 'free' on:\nmotion   held by supports[^\n]*: bar\n")
    says("a step in which nothing holds a body", r"in step 'free' body 'bar' is free to move.*\[B107\]",
         "supports.0.during=pull")
    says("two rules for one node", r"is prescribed differently by supports.3", "supports.4={surface: high, uy: "
         "\"0.1*t\", during: hold}")
    says("springs in the same entry", r"stands beside a displacement with `during`.*\[B131\]",
         "supports.0={surface: low, uy: 0, spring: [1, 0], during: pull}")
    says("a volume that is enclosed in some steps", r"in some steps only.*\[B130\]", "mesh.order=2", "supports.0.ux=0",
         "bodies.0={volume: bar, material: {law: linear, mu: 1000, nu: 0.5}, formulation: mixed}",
         "supports.4={surface: right, ux: 0}")


args = arguments()
check = Check()
for each in FORMS:
    bar(*each)
driven()
for each in AREA:
    contact(each)
falls()
yields()
fails()
restart()
if args.ranks == 1:
    words()
check.finish()
