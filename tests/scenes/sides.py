"""Sides, corners and edges: a slave that turns a corner, a slave that slides off a sharp edge, rigid masters whose normals
point the wrong way, a box that fills a groove, pairs that never meet, bodies that lie in each other."""
from harness import Check, arguments, run, SCENES

PRESSED = ["loads=[{surface: upper_top, ux: 0, uy: -0.45}]", "stepping={}"]
ALIKE = 0.02  # force with the sides in the slave against the force without them
FALL, RISE = 0.2, 0.03  # of the largest force, in a step of a quarter of a face: a node at the edge carries a ninth


def corner(form, radius, left):
    """The side of the upper block stands over the rounded edge of the lower one."""
    parameters = f"mesh.parameters={{radius: {radius}, faces: 3, left: {left}, width: 6, solid: {form}}}"
    overrides = [*PRESSED, parameters]
    if form:
        overrides += ["geometry=solid", "supports=[{surface: lower_bottom, ux: 0, uy: 0, uz: 0}, {surface: ends, uz: 0}]"]
    skin, sole = (run(args, SCENES / "edge.yaml", out=f"corner_{form}_{left}_{slave}",
                      overrides=[*overrides, f"contact.0.slave={slave}"]) for slave in ("upper_skin", "upper_sole"))
    forces = [r.summary()["probes"]["force_y"] for r in (skin, sole)]
    name = f"corner at {left}{', solid' if form else ''}"
    check.holds(f"{name}: no failed step", skin.summary()["steps_failed"] == 0)
    check.near(f"{name}: force of the sole alone", forces[0] / forces[1], 1, ALIKE)
    check.holds(f"{name}: faces that take no part are counted", "do not face it and take no part" in skin.text)


def slide(slave, master, formulation, failed):
    """The upper block slides off the edge: the force falls to 0, and never by much more than a node carries."""
    finished = run(args, SCENES / "edge.yaml", out=f"slide_{slave}_{formulation}",
                   overrides=[f"contact.0.slave={slave}", f"contact.0.master={master}",
                              f"contact.0.formulation={formulation}"])
    name = f"slide, slave {slave}, {formulation}"
    summary = finished.summary()
    rows = [row for row in finished.steps() if row["t"] > 0.2 - 1e-9]
    force, t = [abs(row["force_y"]) for row in rows], [row["t"] for row in rows]
    # a step that was cut moves less far: changes are for a step of the scene
    changes = [(b - a) / max(force) for a, b, s, e in zip(force, force[1:], t, t[1:]) if e - s > 0.019]
    check.holds(f"{name}: failed steps", summary["steps_failed"] <= failed, str(summary["steps_failed"]))
    check.holds(f"{name}: off the edge at the end", force[-1] == 0)
    check.holds(f"{name}: falls", -min(changes) <= FALL, f"by up to {-min(changes):.3f}")
    check.holds(f"{name}: rises", max(changes) <= RISE, f"by up to {max(changes):.3f}")


def groove():
    plain = ["contact.0.smoother=facet", "contact.0.formulation=node_to_surface"]
    force = [run(args, SCENES / "groove.yaml", out=f"groove_{turned}_{clockwise}",
                 overrides=[*plain, f"mesh.parameters={{turned: {turned}, clockwise: {clockwise}}}"])
             .summary()["probes"]["force_y"] for turned, clockwise in ((0, 0), (1, 0), (2, 1))]
    check.near("groove: normals turned to the slave", [f / force[0] for f in force], 1, 1e-6)
    wrong = [*plain, "mesh.parameters={turned: 1}"]
    flip = run(args, SCENES / "groove.yaml", out="flip", overrides=[*wrong, "contact.0.master_normal=flip"])
    check.near("groove: master_normal flip", flip.summary()["probes"]["force_y"] / force[0], 1, 1e-6)
    keep = run(args, SCENES / "groove.yaml", out="keep", overrides=[*wrong, "contact.0.master_normal=keep"])
    check.holds("groove: normals that are kept", "contact fit never came near" in keep.text)
    both = run(args, SCENES / "groove.yaml", out="both", must=1, overrides=[*plain, "mesh.parameters={turned: 3}",
                                                                        "contact.0.slave=sides"])
    check.holds("a start on both sides is refused", "master_normal: keep" in both.text)
    apart = run(args, SCENES / "groove.yaml", out="apart", overrides=["loads=[{surface: top, ux: 0, uy: 0.2}]"])
    check.holds("a pair that never meets is named", "contact fit never came near: nearest distance 0.02" in apart.text)


def box():
    """Faces of the box that are square to the floor meet the walls alone: as two pairs, because each side of a corner
    has a term of its own, and without chatter."""
    for order in (1, 2):
        one, two = (run(args, SCENES / "box.yaml", out=f"box_{order}_{len(pairs)}", overrides=[f"mesh.order={order}", *pairs])
                    for pairs in ([], ["contact=[{name: bed, slave: sole, master: bed}, "
                                       "{name: walls, slave: sides, master: walls}]"]))
        name = f"box in a groove, order {order}"
        check.holds(f"{name}: no failed step", one.summary()["steps_failed"] == 0)
        check.holds(f"{name}: iterations", one.summary()["newton_iterations"] <= 40, str(one.summary()["newton_iterations"]))
        check.near(f"{name}: force of two pairs", one.summary()["probes"]["force"] / two.summary()["probes"]["force"], 1,
                   0.001)


def seal():
    """The foot's corners slide into the corners of the groove: what they see of it changes, and the lists settle."""
    force = []
    for order in (1, 2):
        summary = run(args, SCENES / "corner_seal.yaml", out=f"seal_{order}",
                      overrides=[f"mesh.order={order}"]).summary()
        force.append(summary["probes"]["force"])
        name = f"seal, order {order}"
        check.holds(f"{name}: no failed step", summary["steps_failed"] == 0)
        check.holds(f"{name}: iterations", summary["newton_iterations"] <= 60, str(summary["newton_iterations"]))
    check.near("seal: force of the lid, order 1 over order 2", force[0] / force[1], 1, 0.04)


def immersed():
    for gap, words in ((-3, "lie in each other"), (-4.9, "lie in each other")):
        finished = run(args, SCENES / "edge.yaml", out="immersed", must=1,
                       overrides=[f"mesh.parameters={{gap: {gap}, left: -6, width: 5}}",
                                  "contact.0.initial_overlap=resolve"])
        check.holds(f"bodies {-gap} deep in each other are refused", words in finished.text)
    thin = run(args, SCENES / "edge.yaml", out="thin", must=1,
               overrides=["mesh.parameters={gap: -0.4, left: -6, width: 5, height: 0.6}", "contact.0.slave=lower_top",
                          "contact.0.master=upper_sole", "contact.0.initial_overlap=resolve"])
    check.holds("an overlap by more than half a wall is refused", "more than half of its wall" in thin.text)


args = arguments(("case", "what is shown", ["corner", "slide", "seal", "rest"]))
check = Check()
if args.case == "corner":
    corner(0, 1.5, -1.8)
    corner(0, 1.5, -2.1)
    corner(1, 1.5, -1.8)
elif args.case == "slide":
    slide("upper_skin", "lower_skin", "surface_to_surface", 0)
    slide("upper_skin", "lower_skin", "node_to_surface", 0)
    slide("lower_skin", "upper_skin", "surface_to_surface", 5)
elif args.case == "seal":
    seal()
else:
    groove()
    box()
    immersed()
check.finish()
