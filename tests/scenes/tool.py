"""Rigid tools that are pushed by a force instead of moved: the force arrives, the tool starts from a gap, and a tool
that is moved to the same place gives the same force; columns between a plate and the ground against beam theory; a cylinder
that friction rolls; motions by expressions."""
import math

from harness import Check, arguments, run, SCENES

SAME = 1e-6  # between the tool that is pushed and the one that is moved
SLIDE = SCENES.parent.parent / "runs" / "slide_cylinder.yaml"
BALL = "bodies=[{volume: block, material: {law: neo_hookean, E: 1000, nu: 0.3}}]"
AXIS = ["geometry=axisymmetric", "supports.0={surface: y_min, uy: 0}"]
PENALTY = "contact.0.penalty={scale: 100}"  # held, so that both ways have the same one


def sphere(motion):
    return "contact.0.master={sphere: {centre: [0, 8.2], radius: 3, " + motion + "}}"


def cylinder(motion):
    return "contact.0.master={cylinder: {point: [5, 8.2], radius: 3, " + motion + "}}"


def obstacle(motion):
    return "bodies.1.rigid={point: [0, -20, 0], " + motion + "}"


MESHED = [
    "loads=[]", "stepping.initial=0.5", "mesh.parameters.overlap=-0.1", "supports.1={surface: block_top, ux: 0, uy: 0}",
    "probes=[{name: force, contact_force: sole, component: y, absolute: true}, {name: way, tool_motion: sole, "
    "component: y}]"
]
WAYS = {  # scene, overrides, tool with its motion, force
    "cylinder": ("tool.yaml", [PENALTY], cylinder, "force: [0, -300]", 300),
    "cylinder, surface to surface": ("tool.yaml", [
        PENALTY, "contact.0.formulation=surface_to_surface", "contact.0.smoother=facet"
    ], cylinder, "force: [0, -300]", 300),
    "sphere about the axis": ("tool.yaml", [PENALTY, *AXIS], sphere, "force: [0, -300]", 300),
    "cylinder, plastic block": ("tool.yaml", [
        PENALTY, "bodies.0.material={law: von_mises, E: 1000, nu: 0.3, yield: 30, hardening: {linear: 20}}"
    ], cylinder, "force: [0, -150]", 150),
    "meshed cylinder, solid": (SLIDE, MESHED, obstacle, "force: [0, 30, 0]", 30),
}
ON_RANKS = "cylinder, surface to surface", "meshed cylinder, solid"
args = arguments(("cases", "all of them, a few, or those in which ranks matter", ("all", "few", "ranks")))
check = Check()


def name_of(name):
    return name.replace(" ", "_").replace(",", "")


for name, (scene, overrides, tool, pushed, force) in WAYS.items():
    if args.cases == "ranks" and name not in ON_RANKS:
        continue
    by_force = run(args, SCENES / scene, out=name_of(name), overrides=[*overrides, tool(f"free: [uy], {pushed}")])
    last = by_force.steps()[-1]
    check.near(f"{name}: the force", last["force"] / force, 1, SAME)
    check.holds(f"{name}: starts from a gap", "moved into contact" in by_force.text)
    steps = [row["t"] for row in by_force.steps()]
    way = [[0, 0]] + [[row["t"], row["way"] / last["way"]] for row in by_force.steps()]
    by_motion = run(args, SCENES / scene, out=name_of(name) + "_moved", overrides=[
        *overrides, tool(f"motion: [{{uy: {last['way']!r}, history: {way!r}}}]"), "stepping.initial=1"
    ]).steps()[-1]
    check.near(f"{name}: moved to the same place", by_motion["force"] / last["force"], 1, SAME)

# A roller that is pressed and drawn along rolls; the way on the slab is a little longer than that on the roller, because
# contact stretches the slab and presses the roller's place into it.
rolled = run(args, SCENES / "tool.yaml", out="rolled", overrides=[
    "contact.0.friction.mu=0.3", "stepping.contact_travel=0", "mesh.order=1",
    "probes.5={name: torque, friction_torque: punch, at: [8, 8.2]}",
    cylinder("free: [uy, rz], force: [0, -30], history: [[0, 0], [0.3, 1], [1, 1]], "
             "motion: [{ux: 3, history: [[0, 0], [0.3, 0], [1, 1]]}]")
])
last = rolled.steps()[-1]
check.near("rolled: the turn", -math.radians(last["turn"]) * 3 / last["aside"], 1, 0.05)
check.holds("rolled: friction has next to nothing to do", abs(last["along"]) < 0.05 * 0.3 * 30, f"{last['along']:.3f}")
check.near("rolled: moment of friction about the axle, over mu N R", last["torque"] / (0.3 * 30 * 3), 0, 1e-6)
check.holds("rolled: few iterations", rolled.summary()["newton_iterations"] < 60,
            str(rolled.summary()["newton_iterations"]))
if args.cases == "ranks":
    check.finish()

# A column between the ground and a plate that force and moment press: closed forms of compression and of pure bending.
E, NU, WIDTH, HEIGHT, FORCE, MOMENT = 1000, 0.3, 10, 5, 3, 2
modulus = E / (1 - NU**2)
plate = run(args, SCENES / "tool.yaml", out="plate", overrides=[
    "kinematics=small", "bodies.0.material.law=linear", "supports=[{surface: y_min, uy: 0}, {surface: origin, ux: 0}]",
    "contact.0.penalty={scale: 1000}", f"contact.0.master={{plane: {{point: [5, 5], normal: [0, -1], free: [uy, rz], "
    f"force: [0, {-FORCE}], moment: {{z: {MOMENT}}}}}}}", "stepping.initial=1",
    "probes.5={name: twist, contact_torque: punch, at: [5, 5]}", "probes.6={name: off, contact_torque: punch}",
    "probes.7={name: held, reaction_torque: y_min, at: [5, 0]}"
]).steps()[-1]
check.near("plate: its way", plate["way"] / (-FORCE * HEIGHT / modulus / WIDTH), 1, 1e-3)
check.near("plate: its turn", math.radians(plate["turn"]) / (MOMENT * HEIGHT / modulus / (WIDTH**3 / 12)), 1, 1e-3)

check.near("plate: moment of the contact", plate["twist"] / -MOMENT, 1, 1e-6)
check.near("plate: moment of the contact about the origin", plate["off"] / (5 * FORCE - MOMENT), 1, 1e-3)
check.near("plate: moment of the ground", plate["held"] / -MOMENT, 1, 1e-3)

# A cylinder that sticks to the block carries a moment by friction: the force along the block is the moment over its
# arm.
roll = run(args, SCENES / "tool.yaml", out="roll", overrides=[
    "contact.0.friction.mu=0.5", cylinder("free: [uy, rz], force: [0, -30], moment: {z: 6}")
]).steps()[-1]
check.near("roll: force along the block", abs(roll["along"]) * 3 / 6, 1, 0.03)  # the contact bends round the cylinder
check.holds("roll: it has turned", abs(roll["turn"]) > 0.01, f"{roll['turn']:.3f} degrees")

# A moment that nothing resists: without friction, and with one that friction cannot bear.
for what, friction, moment in (("smooth", [], 1), ("slipping", ["contact.0.friction.mu=0.3"], -40)):
    text = run(args, SCENES / "tool.yaml", out="spins", must=2, overrides=[
        *friction, "mesh.order=1", "stepping.dt_min=0.02",
        cylinder(f"free: [uy, rz], force: [0, -30], moment: {{z: {moment}}}")
    ]).text
    check.holds(f"{what}: refused, and the motion is named", "no equilibrium" in text and "'punch': rotation" in text)

if args.cases == "all":
    # A motion that is an expression of t is that of a history.
    expression = run(args, SCENES / "tool.yaml", out="expression",
                     overrides=[cylinder("motion: [{uy: \"-1.5*t\"}]"), "stepping={control: fixed, initial: 0.25}"])
    history = run(args, SCENES / "tool.yaml", out="history",
                  overrides=[cylinder("motion: [{uy: -1.5}]"), "stepping={control: fixed, initial: 0.25}"])
    check.near("expression", expression.steps()[-1]["force"] / history.steps()[-1]["force"], 1, 1e-12)
    # What cannot be pushed is refused.
    for what, wrong in {
            "free and moved": cylinder("free: [uy], motion: [{uy: 1}]"),
            "force without freedom": cylinder("free: [uy], force: [1, 0]"),
            "out of the plane": cylinder("free: [rx]"),
            "of the place": cylinder("motion: [{uy: \"x\"}]"),
            "twice": cylinder("free: [uy, uy]"),
            "history of nothing": cylinder("history: [[0, 0], [1, 1]]")
    }.items():
        text = run(args, SCENES / "tool.yaml", out="refused", overrides=[wrong], must=1).text
        check.holds(f"refused: {what}", "allowed:" in text and "contact.0.master.cylinder" in text, text.split("\n")[0])
check.finish()
