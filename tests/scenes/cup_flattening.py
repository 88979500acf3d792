"""The spherical cup on a plane: reference answers whatever the steps and the order, first touch, and fewer steps and iterations when they follow the contact."""
from harness import Check, arguments, run, SCENES

REFERENCE = {1: {"plane_force": (434500, 400), "contact_radius": (25.10, 0.1), "apex_thickness": (1.9246, 1e-4)}, 0.5: {"plane_force": (116900, 130), "contact_radius": (17.33, 0.1)}}
MESH = 0.005  # what a mesh may add to the estimated error of the reference, which another code gave; of the value
TOUCH = (4.6, 4.8)  # MPa: open and in contact
PRESSURE = 200  # MPa at t = 1
MOST_NEW = 1.5 * 5  # nodes that may come into contact in a step, unless they tie

STEPS = {
    "uniform": "{control: fixed, initial: 0.025}",
    "control": "{control: contact, initial: 0.025, N_c: 5}",
    "tangent": "{control: contact, initial: 0.025, N_c: 5, prediction: tangent}",
    "single": "{control: fixed, initial: 1}",
}
args = arguments()
check = Check()
scene = SCENES.parent.parent / "runs" / "cup_flattening.yaml"
for order, n_arc in ((2, 60), (1, 120)):
    counts = {}
    for name, stepping in STEPS.items():
        finished = run(args, scene, out=f"{name}-{order}", overrides=[f"mesh.order={order}", f"mesh.parameters.n_arc={n_arc}", f"stepping={stepping}"])
        steps, summary = finished.steps(), finished.summary()
        counts[name] = (summary["steps"], summary["newton_iterations"])
        for row in steps:
            for probe, (reference, error) in REFERENCE.get(round(row["t"], 9), {}).items():
                check.near(f"order {order}, {name}: {probe} at t = {row['t']:g}", row[probe], reference, error + MESH * reference)
        if name in ("control", "tangent"):
            check.holds(f"order {order}, {name}: new contact per step", all(row["nodes_in"] <= MOST_NEW for row in steps), f"{max(row['nodes_in'] for row in steps):.0f}")
    print(f"     order {order}: " + ", ".join(f"{name} {steps} steps, {iterations} iterations" for name, (steps, iterations) in counts.items()))
    check.holds(f"order {order}: control takes a quarter of the uniform steps, half of their iterations", 4 * counts["control"][0] <= counts["uniform"][0] and 2 * counts["control"][1] <= counts["uniform"][1])
touch = run(args, scene, out="touch", overrides=["stepping={control: fixed, initial: 0.025, at: [" + ", ".join(f"{P / PRESSURE:g}" for P in TOUCH) + "]}"]).steps()
check.holds(f"first touch between {TOUCH[0]} and {TOUCH[1]} MPa", [row["contact_nodes"] for row in touch if round(PRESSURE * row["t"], 6) in TOUCH] == [0, 1])
check.finish()
