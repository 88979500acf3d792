"""Bodies that only contact holds start by themselves, from any gap, without failed steps and without a force left in
springs: a cylinder in a vee, which may roll, a ball in a cone, three balls in a row, a pin in a bore with much clearance,
a cord that a lid pushes to the floor, a load that comes later. What stays free to move is named, how far a body may
have come. A restart goes on as if nothing had happened."""
import math

from harness import Check, arguments, run, run_in_parts, SCENES

args = arguments()
check = Check()
SCENE = SCENES / "free_bodies.yaml"
MATERIAL = "material: {law: neo_hookean, E: 1000, nu: 0.3}"


def held(name, overrides, most, force, tolerance, loose=(), moved=True):
    """The run is done within `most` iterations, no step failed, and the load arrives."""
    result = run(args, SCENE, out=name, overrides=overrides)
    summary = result.summary()
    check.holds(f"{name}: no failed step", summary["steps_failed"] == 0, str(summary["steps_failed"]))
    check.holds(f"{name}: iterations", summary["newton_iterations"] <= most, str(summary["newton_iterations"]))
    check.near(f"{name}: force", summary["probes"]["force"], force, tolerance * abs(force))
    springs = summary["stabilisation"]
    check.holds(f"{name}: nothing left in the springs", springs["force_share"] < 1e-6, str(springs["force_share"]))
    check.holds(f"{name}: ties hold what unevenness asks for", springs["held_force_share"] < 1e-3,
                str(springs["held_force_share"]))
    check.holds(f"{name}: says what was moved", bool(springs["moved"]) == moved, springs["moved"])
    for motion in loose:
        check.holds(f"{name}: names {motion}", motion in springs["held_by_springs"], springs["held_by_springs"])
    return result


def scene(kind, gap, balls=1, geometry="axisymmetric", load="loads=[{volume: body1, body_force: [0, -1]}]"):
    pairs = [f"{{name: pair{i}, slave: low{i}, master: {'seat' if i == 1 else f'up{i - 1}'}}}" for i in range(1, balls + 1)]
    bodies = [f"{{volume: {name}, {MATERIAL}}}" for name in ("holder", *(f"body{i}" for i in range(1, balls + 1)))]
    return (f"mesh.parameters={{kind: {kind}, gap: {gap}}}", f"geometry={geometry}", f"bodies=[{', '.join(bodies)}]",
            load, f"contact=[{', '.join(pairs)}]", "probes.0.contact_force=pair1")


# The force of a vee's flank is half the weight; polygons weigh a little less than circles.
vee = held("vee", (), 30, -math.pi / 2, 0.02, ("'body1': rotation in the plane",))
far = held("far", ("mesh.parameters.gap=16",), 30, -math.pi / 2, 0.02, ("'body1': rotation in the plane",))
told = far.summary()["stabilisation"]["held_by_springs"]
check.holds("far: the vee holds translations", "translation" not in told, told)
held("cone", scene(1, 0.3), 30, -4 / 3 * math.pi, 0.03)
held("row", scene(2, 0.7, 3, load="loads=[{surface: up3, traction: [0, -1]}]"), 40, -2 * math.pi, 0.03)
held("pin", scene(3, 0.3, geometry="plane_strain"), 30, -math.pi, 0.03, ("'body1': rotation in the plane",))
held("later", ("loads=[{volume: body1, body_force: [0, -1], history: [[0, 0], [0.5, 0], [1, 1]]}]",), 40, -math.pi / 2,
     0.02)
LID = ("contact=[{name: pair1, slave: low1, master: {plane: {point: [0, -2], normal: [0, 1]}}}, "
       "{name: lid, slave: low1, master: {plane: {point: [0, 1.5], normal: [0, -1], motion: [{uy: -1.7}]}}}]",
       "loads=[]", "probes.0.contact_force=pair1", "probes.1={name: lid, contact_force: lid, component: y}")
cord = held("cord", LID, 60, run(args, SCENE, out="cord_fine", overrides=(*LID, "stepping.initial=0.05", "stepping.dt_max=0.05")).summary()
            ["probes"]["force"], 0.01, moved=False)
check.near("cord: what the lid presses the floor bears",
           cord.summary()["probes"]["lid"] + cord.summary()["probes"]["force"], 0, 1e-3 * 50)

# Stopped after each step and restarted: the same end, bit by bit on one rank.
stopped = run_in_parts(args, SCENE, "stopped")
end, whole = stopped.summary(), vee.summary()
check.holds("stopped: goes on to the end", end["status"] == whole["status"] and end["restarts"] > 1, str(end["restarts"]))
for key in ("steps", "newton_iterations"):
    check.holds(f"stopped: {key}", end[key] == whole[key], f"{end[key]} {whole[key]}")
check.near("stopped: force", end["probes"]["force"], whole["probes"]["force"],
           0 if args.ranks == 1 else 1e-9 * abs(whole["probes"]["force"]))
check.finish()
