"""Contact pairs that come and go by named steps, against tools and between bodies, in the plane, about an axis and in
3D, against closed forms; what cannot be is refused."""
import itertools

import numpy

from harness import Check, arguments, run, run_in_parts, SCENES

E, PENALTY, WAY = 1000, 1e6, 0.01
STEPS = "[{name: close, until: 0.2}, {name: hold, until: 0.5}, {name: open, until: 0.6}, {name: push, until: 1}]"
STEPPING = f"stepping={{control: fixed, initial: 0.05, steps: {STEPS}}}"
GEOMETRIES = {
    "solid": (SCENES / "patch.yaml", 3.0),
    "plane_strain": (SCENES / "patch_plane.yaml", 2.0),
    "axisymmetric": (SCENES / "patch_plane.yaml", numpy.pi * 4)
}
# which steps the pair names -> the part of it that is there over t
PRESENCE = {
    "[close, hold]": ([0, 0.5, 0.6, 1], [1, 1, 0, 0]),
    "push": ([0, 0.6, 1], [0, 0, 1]),
    "hold": ([0, 0.2, 0.5, 0.6, 1], [0, 0, 1, 0, 0])
}


def force_of(t, during, way):
    """Body and pair are springs in series; the pair's is p / (p + 100 (1 - p)) of its penalty."""
    p = numpy.interp(t, *PRESENCE[during])
    stiffness = numpy.maximum(PENALTY * p / (p + 100 * (1 - p)), 1e-30)
    return way / (1 / E + 1 / stiffness)


def columns(finished, *names):
    steps = finished.steps()
    return [numpy.array([row[name] for row in steps]) for name in ("t", *names)]


def tool(geometry, order, during):
    """A block under a plane that comes down in the first step and stays there."""
    scene, area = GEOMETRIES[geometry]
    solid = geometry == "solid"
    master = "{plane: {point: %s, normal: %s, motion: [{uy: %g, during: close}]}}" % (
        [0, 1, 0][:3 if solid else 2], [0, -1, 0][:3 if solid else 2], -WAY)
    finished = run(args, scene, out=f"tool_{geometry}_{order}_{during}", overrides=[
        f"geometry={geometry}", f"mesh.order={order}", "kinematics=small",
        "bodies.0.material={law: linear, E: 1000, nu: 0}", STEPPING,
        f"supports=[{{surface: y_min, uy: 0{', ux: 0' if geometry != 'axisymmetric' else ''}{', uz: 0' if solid else ''}}}]",
        f"contact=[{{name: pair, slave: y_max, penalty: {{initial: {PENALTY}, scale: 1}}, master: {master}, "
        f"during: {during}}}]", "probes=[{name: force, contact_force: pair, component: y}]"
    ])
    t, force = columns(finished, "force")
    way = WAY * numpy.minimum(t / 0.2, 1)
    check.near(f"{geometry}, order {order}, {during}: force", numpy.abs(force) / area / (E * WAY),
               force_of(t, during, way) / (E * WAY), 1e-6)


def bodies(kinematics, smoother):
    """A block is pushed into another one, which stops it in the last step alone; the penalty is the automatic one."""
    law = "linear" if kinematics == "small" else "svk"
    finished = run(args, SCENES / "stack.yaml", out=f"bodies_{kinematics}_{smoother}", overrides=[
        f"kinematics={kinematics}", "mesh.parameters={gap: 1e-3, overhang: 0}",
        *(f"bodies.{b}.material={{law: {law}, E: {E}, nu: 0}}" for b in range(2)), STEPPING,
        "loads=[{surface: upper_top, ux: 0, uy: -0.011, during: close}]", "probes=[{name: force, contact_force: joint, "
        "component: y, absolute: true}]",
        f"contact=[{{name: joint, slave: upper_bottom, master: lower_top, smoother: {smoother}, during: push}}]"
    ])
    t, force = columns(finished, "force")
    stretch = 1 - 0.01 / 2  # of both blocks, whose width is 2
    exact = 2 * E * (1 - stretch if kinematics == "small" else (1 - stretch**2) / 2 * stretch)
    check.near(f"bodies, {kinematics}, {smoother}: away", force[t <= 0.6], 0, 1e-12)
    check.near(f"bodies, {kinematics}, {smoother}: there", force[-1] / exact, 1, 0.01)
    check.holds(f"bodies, {kinematics}, {smoother}: it comes evenly", numpy.all(numpy.diff(force[t >= 0.6]) > 0))


def parts(t, first, second):
    """A run that goes on from a checkpoint after each step has the same forces."""
    found = columns(run_in_parts(args, SCENES / "handover.yaml", "handover_in_parts"), "first", "second")
    for name, one, other in zip(("t", "first", "second"), (t, first, second), found):
        check.near(f"handover in parts: {name}", other, one, 1e-9 * numpy.max(numpy.abs(one)))


def handover(in_parts):
    """A scene of the usual kind: the planes bear the load together, then the second one alone."""
    finished = run(args, SCENES / "handover.yaml", out="handover")
    t, first, second = columns(finished, "first", "second")
    load = 60 * numpy.minimum(t / 0.3, 1)
    check.holds("handover: the certificate says when", "judged while they were wholly there" in finished.text)
    if in_parts:
        parts(t, first, second)
    check.near("handover: sum of the forces", -(first + second) / 60, load / 60, 1e-6)
    check.near("handover: the first plane", -first / 60, numpy.interp(t, [0, 0.3, 0.6, 1], [0, 1, 0.5, 0]), 1e-3)


def refusals():
    base = [STEPPING, "supports=[{surface: y_min, uy: 0, ux: 0, uz: 0}]"]
    pair = "contact=[{name: pair, slave: y_max, master: {plane: {point: [0, 1, 0], normal: [0, -1, 0]}}, %s}]"
    for name, keys, words in (("augment", "during: hold, penalty: {augment: true, g_max: 1e-3, unit: length}",
                               "follows the penetration"),
                              ("step", "during: later", "is no step"),
                              ("factor", "history: [[0, 0], [1, 2]]", "is a part of the pair")):
        finished = run(args, SCENES / "patch.yaml", "-check", out=f"refused_{name}", must=1, overrides=[*base, pair % keys])
        check.holds(f"refused: {name}", words in finished.text, finished.text)


TOOLS = {
    "few": [("solid", 2, "[close, hold]"), ("plane_strain", 1, "push"), ("axisymmetric", 1, "hold")],
    "all": [(form, *case) for form in GEOMETRIES
            for case in ((1, "[close, hold]"), (2, "[close, hold]"), (1, "push"), (1, "hold"))]
}
BODIES = {"few": [("finite", "diffuse")], "all": itertools.product(("small", "finite"), ("facet", "diffuse"))}
args = arguments(("cases", "which", ["few", "all"]))
check = Check()
for case in TOOLS[args.cases]:
    tool(*case)
for case in BODIES[args.cases]:
    bodies(*case)
handover(args.cases == "all" or args.ranks == 1)
if args.ranks == 1:
    refusals()
check.finish()
