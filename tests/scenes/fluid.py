"""A fluid that enters between surfaces in contact: front and leak pressure by statics, in the plane, in space and about
an axis; nothing where contact is closed, the plain pressure where it is open; a restart goes on as if nothing had
happened; what cannot be served is refused.

The block is stiff beside its ground, the penalty k. Its bottom goes down by d(x), a straight line, and total pressure is
max(k d, P). Flat, with the force F and the moment M about the left end per depth: the forces balance where the front is
at a = 3 (M - P L^2/2)/(F - P L) - 2 L. A wedge of slope s with its edge at c, which goes down only: the fluid P acts up
to where k d = P; it leaks where that is the edge, F = P c + P^2/(2 k s)."""
import math

from harness import Check, arguments, run, run_in_parts, SCENES

args = arguments(("cases", "few: quick ones", ("few", "all")))
check = Check()
SCENE, SEAL, JOINT = SCENES / "uplift.yaml", SCENES.parent / "jobs" / "seal_leak.yaml", SCENES / "joint.yaml"
CUP = SCENES.parent / "jobs" / "u_cup.yaml"
SOLID = ("mesh.parameters.solid=1", "geometry=solid",
         "supports=[{surface: pin, ux: 0}, {surface: sides, uz: 0}]",
         "contact.0.master={plane: {point: [0, 0, 0], normal: [0, 1, 0]}}")
SOLID_JOINT = ("mesh.parameters={n: 12, solid: 1}", "geometry=solid",
               "supports=[{surface: pin, ux: 0}, {surface: sides, uz: 0}, {surface: base, ux: 0, uy: 0}]")
WEDGE = ("mesh.parameters.s=0.1", "supports=[{surface: left, ux: 0}]", "loads.0.pressure=1", "loads.1.pressure=2*t",
         "stepping.initial=0.1", "bodies.0.material.E=1e6")
DRAWN = "contact.0.master={plane: {point: [0, 0], normal: [0, 1], motion: [{ux: 1}]}}"
PUSHED = "contact.0.master={plane: {point: [0, 0], normal: [0, 1], free: [uy], force: [0, 1]}}"
SURFACE = "contact.0.formulation=surface_to_surface"


def front(name, error, *overrides):
    """The front under a flat block at two pressures."""
    rows = run(args, SCENE, out=name, overrides=overrides).steps()
    for row in rows:
        P = 0.8 * row["t"]
        if P <= 0.5:
            check.holds(f"{name}: dry at {P:g}", row["area"] == 0 and row["front"] is None)
            continue
        exact = 3 * (175 / 3 - 50 * P) / (10 - 10 * P) - 20
        check.near(f"{name}: front at {P:g}", row["front"], exact, error * 10)


def leak(name, error, *overrides):
    """The pressure at which the fluid passes the edge of a wedge."""
    result = run(args, SCENE, out=name, overrides=(*WEDGE, *overrides))
    summary, exact = result.summary(), math.sqrt(45) - 5
    fluid = summary["fluids"][0]
    check.near(f"{name}: leak pressure", fluid["leak_pressure"], exact, error * exact)
    check.holds(f"{name}: ends there", summary["status"] == "done" and 0 < 2 * summary["t"] <= exact * (1 + error)
                and exact * (1 - error) <= 2 * fluid["leak_t"] and "leaks at a pressure of 1." in result.text,
                f"t {summary['t']}, {fluid['leak_t']}")
    check.holds(f"{name}: half of it is wet", 0.4 < fluid["wetted"] < 0.5, str(fluid["wetted"]))
    return summary


def dragged(name, face, ground, *overrides):
    """The ground is drawn away under the block: friction has what the ground presses where it is dry, F - P a, at a
    front that friction does not move, as it acts at the height of the pin. Nodes are wet or dry, so that a differs by
    up to half a face. In space the block is 2 deep."""
    depth = 2 if "geometry=solid" in overrides else 1
    rows = run(args, SCENE, out=name, overrides=(
        ground, "contact.0.friction={mu: 0.3}",
        "probes=[{name: drag, friction_force: ground, component: x}, {name: area, fluid_area: bottom}]",
        *overrides)).steps()
    for row in rows:
        P = 0.8 * row["t"]
        a = 3 * (175 / 3 - 50 * P) / (10 - 10 * P) - 20 if P > 0.5 else 0
        drag = abs(row["drag"]) / depth
        check.near(f"{name}: friction at {P:g}", drag, 0.3 * (10 - P * a), 0.3 * P * face * 0.51)
        check.near(f"{name}: on the dry part at {P:g}", drag, 0.3 * (10 - 10 * P * row["area"]), 1e-6)


def joint(name, face, error, *overrides):
    """Two blocks that deform: the fluid presses on the upper one as contact lacks, exactly, and on the lower one, whose
    base then bears all of the load, within half a face of the front. Stopped after each step and restarted it is the
    same."""
    result = run(args, JOINT, out=name, overrides=overrides)
    depth = 2 if "geometry=solid" in overrides else 1
    for row in result.steps():
        P, load = 0.8 * row["t"], 10 * depth
        check.near(f"{name}: contact at {P:.3g}", row["force"] + 10 * depth * P * row["upper"], load, error * load)
        check.near(f"{name}: base at {P:.3g}", row["base"], load, depth * (P * face / 2 + 10 * error))
    check.holds(f"{name}: it has come in", result.summary()["probes"]["lower"] > 0.6)
    end = run_in_parts(args, JOINT, f"{name}_stopped", overrides).summary()
    for key in "base", "force", "lower":
        check.near(f"{name}: restarted, {key}", end["probes"][key], result.summary()["probes"][key],
                   (0 if args.ranks == 1 else 1e-7) * 10)


def retreat(name, *overrides):
    """The pressure rises and falls: the lower block still bears all of the load, within half a face, and the fluid
    retreats to where it came from."""
    pressure = "pressure=0.8*(1-abs(2*t-1))"
    rows = run(args, JOINT, out=name, overrides=(
        f"loads.1.{pressure}", f"loads.2.{pressure}", "stepping.dt_max=0.04", *overrides)).steps()
    for row in rows:
        P = 0.8 * (1 - abs(2 * row["t"] - 1))
        check.near(f"{name}: base at {row['t']:.3g}", row["base"], 10, P * 0.25 + 1e-4)
    check.holds(f"{name}: it has come in and gone", max(row["lower"] for row in rows) > 0.6 and rows[-1]["lower"] == 0)


def faces_of_all_sizes(name, n, error, *overrides):
    """A ground with coarser or finer faces than the block that is the slave."""
    row = run(args, JOINT, out=name, overrides=(f"mesh.parameters.lower={n}", *overrides)).steps()[-1]
    check.near(f"{name}: base", row["base"], 10, error)
    check.near(f"{name}: as far in", row["lower"], row["upper"], 0.16)
    check.holds(f"{name}: it has come in", row["lower"] > 0.5)


def open_and_closed():
    """Open: what the plain pressure does. Closed: nothing."""
    held = ("mesh.parameters={n: 8, s: 0.1}", "kinematics=finite", "bodies.0.material={law: svk, E: 100, nu: 0.3}",
            "probes=[{name: down, displacement: [5, 0], component: y}]", "stepping.initial=0.5")
    plain = "{surface: bottom, pressure: 5, follower: true}"
    fluid = "{surface: bottom, pressure: 5, where: open, from: left, to: right}"
    away = "contact.0.master={plane: {point: [0, -30], normal: [0, 1]}}"
    for formulation in "node_to_surface", "surface_to_surface":
        kind = f"contact.0.formulation={formulation}"
        up = "supports=[{surface: top, ux: 0, uy: 0}]"
        one = run(args, SCENE, out=f"plain_{formulation}", overrides=(*held, up, away, kind, f"loads=[{plain}]"))
        other = run(args, SCENE, out=f"leaks_{formulation}", overrides=(*held, up, away, kind, f"loads=[{fluid}]"))
        check.holds(f"open, {formulation}: leaks at once", other.summary()["t"] == 0
                    and other.summary()["fluids"][0]["leak_pressure"] == 0)
        ends = f"loads=[{fluid.replace('from: left, to: right', 'from: ends')}]"
        other = run(args, SCENE, out=f"open_{formulation}", overrides=(*held, up, away, kind, ends))
        check.near(f"open, {formulation}: the plain pressure", other.summary()["probes"]["down"],
                   one.summary()["probes"]["down"], 1e-9)
        closed(formulation, held, fluid, kind, *((1e-9, "held"), ) if formulation == "node_to_surface" else
               ((1e-6, "held"), (1e-9, "live")))


def closed(formulation, held, fluid, kind, *bounds):
    """Closed: as with a fluid of no pressure, whose pair has terms of nodes alone, too. Held offsets may lag."""
    down = "{surface: top, ux: 0, uy: -0.7}"
    for bound, offset in bounds:
        ends = []
        for pressure in "0", "0.1":
            load = f"loads=[{down}, {fluid.replace('pressure: 5', f'pressure: {pressure}')}]"
            result = run(args, SCENE, out=f"closed_{formulation}_{offset}_{pressure}", overrides=(
                *held, "supports=[{surface: pin, ux: 0}]", kind, load,
                *(() if formulation == "node_to_surface" else (f"contact.0.offset={offset}", ))))
            ends.append(result.summary())
        check.holds(f"closed, {formulation}, {offset}: dry", ends[1]["fluids"][0]["wetted"] == 0)
        check.near(f"closed, {formulation}, {offset}: no pressure", ends[1]["probes"]["down"],
                   ends[0]["probes"]["down"], bound)


def seal(name, reference, error, *overrides):
    """The gasket of the jobs, the same on one rank, and stopped after each step and restarted. reference: leak pressure
    with steps of dt_max: 0.001, as it depends on the steps; with friction by up to the part by which P may change in
    the step of the leak."""
    whole = run(args, SEAL, out=name, overrides=overrides)
    figures = whole.summary()
    check.near(f"{name}: leak pressure, as with short steps", figures["fluids"][0]["leak_pressure"], reference,
               error * reference)
    alone = run(args, SEAL, out=f"{name}_alone", ranks=1, overrides=overrides).summary()
    check.holds(f"{name}: as many steps as on one rank", figures["steps"] == alone["steps"])
    for key in "pressure", "wetted", "seal_pressure", "leak_t", "leak_pressure":
        check.near(f"{name}: as on one rank, {key}", figures["fluids"][0][key], alone["fluids"][0][key],
                   1e-9 * alone["fluids"][0][key])
    end = run_in_parts(args, SEAL, f"{name}_stopped", overrides).summary()
    check.holds(f"{name}: restarted", end["restarts"] > 1 and end["status"] == "done", str(end["restarts"]))
    check.holds(f"{name}: same steps", end["steps"] == figures["steps"], f"{end['steps']} {figures['steps']}")
    for key in "pressure", "wetted", "seal_pressure", "leak_t", "leak_pressure":
        check.near(f"{name}: restarted, {key}", end["fluids"][0][key], figures["fluids"][0][key],
                   (0 if args.ranks == 1 else 1e-7) * figures["fluids"][0][key])


def drawn_cup():
    """A U-cup under oil whose rod is drawn out past it. Its lips stick where oil bears all that presses them, and slip
    anew in the other direction; it holds until the rod has drawn the lip so far that the oil comes through."""
    sticks = "friction: {mu: 0.1}"
    pairs = [f"{{name: {name}, slave: skin, master: {name}, {more}{sticks}}}"
             for name, more in (("rod", "initial_overlap: ramp, "), ("bore", "initial_overlap: ramp, "), ("step", ""))]
    end = run(args, CUP, out="drawn_cup", overrides=(
        "bodies.1.rigid={motion: [{uy: 1.5, history: [[0, 0], [0.6, 0], [1, 1]]}]}",
        "loads.0.history=[[0, 0], [0.5, 0], [0.6, 1], [1, 1]]", f"contact=[{', '.join(pairs)}]")).summary()
    check.holds("drawn cup: it holds the whole pressure until it leaks",
                end["status"] == "done" and end["t"] > 0.65 and end["fluids"][0]["leak_pressure"] == 10,
                f"{end['status']} at {end['t']:.3g}, {end['fluids'][0]}")
    check.holds("drawn cup: steps", end["steps"] <= 20 and end["steps_failed"] <= 2,
                f"{end['steps']}, {end['steps_failed']} failed")


def refused(what, message, *overrides, scene=SCENE):
    result = run(args, scene, "-check", out="refused", overrides=overrides, must=None)
    check.holds(f"refused: {what}", result.status == 1 and message in result.text, result.text.strip()[:300])


front("flat", 0.003, "mesh.parameters.n=40")
leak("wedge", 0.002, "mesh.parameters.n=40")
joint("joint", 0.5, 1e-6, "contact.0.formulation=node_to_surface")
retreat("retreat")
dragged("dragged", 0.25, DRAWN, "mesh.parameters.n=40")
if args.cases == "all":
    front("flat_second_order", 0.001, "mesh.order=2")
    front("flat_faces", 0.01, "mesh.parameters.n=40", SURFACE)
    front("flat_faces_second_order", 0.01, "mesh.order=2", SURFACE)
    front("flat_solid", 0.01, *SOLID)
    front("flat_solid_second_order", 0.01, "mesh.order=2", *SOLID)
    leak("wedge_second_order", 0.002, "mesh.parameters.n=40", "mesh.order=2")
    leak("wedge_faces", 0.01, "mesh.parameters.n=40", SURFACE)
    leak("wedge_faces_second_order", 0.01, "mesh.parameters.n=40", "mesh.order=2", SURFACE)
    leak("wedge_solid", 0.01, *SOLID, "supports=[{surface: left, ux: 0}, {surface: sides, uz: 0}]")
    dragged("dragged_faces", 0.25, DRAWN, "mesh.parameters.n=40", SURFACE)
    dragged("dragged_second_order", 0.5, DRAWN, "mesh.order=2")
    dragged("dragged_faces_second_order", 0.5, DRAWN, "mesh.order=2", SURFACE)
    dragged("dragged_solid", 0.5, DRAWN.replace("0, 0]", "0, 0, 0]").replace("0, 1]", "0, 1, 0]"), *SOLID[:3])
    joint("joint_faces_second_order", 0.5, 1e-6, "mesh.order=2")
    joint("joint_finite", 0.5, 1e-3, "kinematics=finite", "bodies.0.material.law=svk", "bodies.1.material.law=svk")
    joint("joint_friction", 0.5, 1e-6, "contact.0.friction={mu: 0.3}")
    retreat("retreat_nodes_friction", "contact.0.formulation=node_to_surface", "contact.0.friction={mu: 0.3}")
    faces_of_all_sizes("fine_ground", 99, 0.1)
    faces_of_all_sizes("fine_ground_nodes", 99, 0.2, "contact.0.formulation=node_to_surface")
    faces_of_all_sizes("coarse_ground", 6, 0.8 * 5 / 6)
    faces_of_all_sizes("coarse_ground_nodes", 6, 0.8 * 5 / 6, "contact.0.formulation=node_to_surface")
    joint("joint_solid", 0.83, 1e-6, *SOLID_JOINT)
    open_and_closed()
    seal("seal", 2.616, 1e-3)
    drawn_cup()
    seal("seal_friction", 2.654, 1e-2, "contact.0.friction={mu: 0.1}")
    seal("seal_faces", 2.74117, 1e-3, "mesh.order=1", SURFACE)
    refused("both ends open or closed", "of the 2 ends of 'bottom' 0 are open",
            "loads.1={surface: bottom, pressure: 1, where: open}")
    refused("an end off the surface", "has no node in common", "loads.1.to=top")
    refused("an end that is off the surface", "is not on the loaded", "loads.1.to=[3.21, 0.5]")
    refused("the same end twice", "have a node in common", "loads.1.to=left")
    refused("no contact", "is in no contact pair", "loads.1.surface=top", "probes=[]")
    refused("an adjusted penalty", "adjusted or augmented",
            "contact.0.penalty={augment: true, g_max: 1e-6, unit: length}")
    refused("a master that deforms without the fluid", "the fluid presses on 'bottom' alone",
            "loads=[{surface: bottom, pressure: 1, where: open, from: left}]", "probes=[]", scene=JOINT)
    refused("a slave without the fluid", "but the slave 'bottom' of contact 'joint' deforms",
            "loads=[{surface: ground, pressure: 1, where: open, from: bank}]", "probes=[]", scene=JOINT)
    refused("another pressure on the master", "the same pressure and history on both sides", "loads.2.pressure=0.7*t",
            scene=JOINT)
    refused("a tool that forces move", "is a tool that forces move", PUSHED)
    refused("suction in a formula", "allowed with where: open: 0 or more", "loads.1.pressure=-t")
check.finish()
