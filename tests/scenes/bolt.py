"""Bolts that are tightened to a force and then keep their length, in the plane, about an axis and in 3D, in both orders
and kinematics, with and without contact, against closed forms; what cannot be is refused."""
import numpy

from harness import Check, arguments, run, run_in_parts, SCENES

E, LENGTH, DEPTH, FORCE, PULL = 1000, 4, 0.5, 2, 1
SHANK = {"plane_strain": 1, "solid": DEPTH, "axisymmetric": numpy.pi}
SLEEVE = {"plane_strain": 1.5, "solid": 1.5 * DEPTH, "axisymmetric": numpy.pi * (2.75**2 - 1.25**2)}
SCENE = SCENES / "bolt.yaml"


def options(geometry, *more):
    solid = [
        f"mesh.parameters.depth={DEPTH}", "bodies.0.pretension.axis=[0, 3, 0]", f"loads.0.force=[0, {PULL}, 0]",
        "supports.2={surface: front, uz: 0}"
    ]
    return [f"geometry={geometry}", *(solid if geometry == "solid" else []), *more]


def columns(finished, *names):
    steps = finished.steps()
    return [numpy.array([row[name] for row in steps]) for name in ("t", *names)]


def judge(name, finished, geometry, allowed):
    """The force is given until t = 0.5; then shank and sleeve share the pull by their stiffnesses."""
    t, tension, shortening = columns(finished, "tension", "shortening")
    shank, sleeve = SHANK[geometry], SLEEVE[geometry]
    exact = FORCE * numpy.minimum(t / 0.5, 1) + PULL * numpy.maximum(t - 0.5, 0) / 0.5 * shank / (shank + sleeve)
    check.near(f"{name}: tension", tension / FORCE, exact / FORCE, allowed)
    way = FORCE * LENGTH / E * (1 / shank + 1 / sleeve)
    check.near(f"{name}: shortening", shortening / way, numpy.minimum(t / 0.5, 1), allowed)


def forms(orders, kinematics):
    for geometry in SHANK:
        for order in orders:
            finished = run(args, SCENE, out=f"{geometry}_{order}", overrides=options(geometry, f"mesh.order={order}"))
            judge(f"{geometry}, order {order}", finished, geometry, 1e-4)  # the head gives way by some 1e-5 of it
        if "finite" in kinematics:
            finished = run(args, SCENE, out=f"{geometry}_finite", overrides=options(
                geometry, "kinematics=finite", *(f"bodies.{b}.material.law=svk" for b in range(3))))
            judge(f"{geometry}, finite strains", finished, geometry, 0.01)
        finished = run(args, SCENE, out=f"{geometry}_contact", overrides=options(
            geometry, "mesh.parameters.apart=1", "contact=[{name: seat, slave: crown, master: seat, smoother: facet, initial_overlap: ignore}]"))
        judge(f"{geometry}, contact", finished, geometry, 0.01)


def opens():
    """A pull beyond what the sleeve bears frees it; the bolt then has the whole pull."""
    finished = run(args, SCENE, out="opens", overrides=options(
        "plane_strain", "mesh.parameters.apart=1", "loads.0.force=[0, 5]",
        "contact=[{name: seat, slave: crown, master: seat, smoother: facet, initial_overlap: ignore}]"))
    check.near("sleeve free: tension", finished.summary()["probes"]["tension"], 5, 0.01)


def parts():
    """A run that goes on from a checkpoint after each step keeps the length at which the bolt was locked."""
    overrides = options("plane_strain", "mesh.parameters.apart=1", "stepping.initial=0.1",
                        "contact=[{name: seat, slave: crown, master: seat, smoother: facet, initial_overlap: ignore}]")
    whole = columns(run(args, SCENE, out="whole", overrides=overrides), "tension", "shortening")
    several = columns(run_in_parts(args, SCENE, "parts", overrides), "tension", "shortening")
    check.holds("in parts: there are parts", len(whole[0]) > 4, str(len(whole[0])))
    for name, one, other in zip(("t", "tension", "shortening"), whole, several):
        check.near(f"in parts: {name}", other / numpy.max(numpy.abs(one)), one / numpy.max(numpy.abs(one)), 1e-12)


def flange():
    """A scene of the usual kind: contact alone holds the bolt, with friction, springs and a free flange. The joint rests on
    the edge of the hole, and the head beyond it. The pull turns the flange about that edge, and the head sinks."""
    finished = run(args, SCENES / "bolted_flange.yaml", out="flange", overrides=["mesh.order=1"])
    t, tension = columns(finished, "tension")
    early = t <= 0.5
    check.near("flange: tension while it is given", tension[early] / 8000, t[early] / 0.5, 1e-6)
    stiff = [f"contact.{pair}.penalty.scale=1000" for pair in range(3)]
    finished = run(args, SCENES / "bolted_flange.yaml", out="flange_stiff", overrides=[
        "mesh.order=1", "stepping.dt_max=0.05", "contact.0.friction.stick.slip=1e-4", *stiff])
    limit = numpy.interp([0.75, 1], *columns(finished, "tension"))
    check.near("flange: tension with the pull, over short steps with stiff penalties",
               numpy.interp([0.75, 1], t, tension) / limit, 1, 0.02)
    check.holds("flange: the pull takes tension from the bolt", limit[0] < 8000)


def refusals():
    for name, override, words in (
            ("axis", "bodies.0.pretension.axis=[1, 0]", "would break the symmetry"),
            ("locked", "bodies.0.pretension.locked=later", "is no step and no load parameter"),
            ("direction", "bodies.0.pretension.axis=[0, 0]", "has no direction"),
            ("probe", "probes.0={name: tension, bolt_force: sleeve}", "is no bolt")):
        finished = run(args, SCENE, out=f"refused_{name}", must=1, overrides=options("axisymmetric", override))
        check.holds(f"refused: {name}", words in finished.text, finished.text)


args = arguments(("cases", "which", ["few", "all"]))
check = Check()
whole = args.cases == "all"
forms((1, 2) if whole else (1, ), ("small", "finite") if whole else ("small", ))
if whole or args.ranks == 1:
    parts()
    refusals()
if whole:
    opens()
    flange()
check.finish()
