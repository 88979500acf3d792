"""The penalty follows the penetration: within the step until the window holds, from starts 1e4 too soft and too stiff,
or as eq. 16 from step to step; a window out of reach ends with status 2."""
import numpy

from harness import Check, arguments, run, SCENES

args = arguments(("scene", "whole: the mesh of the scene file; coarse: a quick one", ("whole", "coarse")))
check = Check()

# 1. A plate on a rigid cylinder, from the first accepted step on: every node that carries more than 1e-3 of the largest
# nodal force inside, none beyond g_max.
plate = SCENES.parent.parent / "runs" / "plate_cylinder.yaml"
low, high = 1e-6, 5e-6
mesh = ("mesh.parameters={h_contact: 0.5, h_far: 8, n_thick: 3, n_width: 1}",) if args.scene == "coarse" else ()
results = {}
for scale in ("1", "1e-4", "1e4"):
    result = results[scale] = run(args, plate, out=f"scale_{scale}",
                                  overrides=(*mesh, f"contact.0.penalty.scale={scale}"))
    steps = result.steps()
    check.holds(f"scale {scale}: largest penetration",
                max(row["max_penetration"] for row in steps) <= high,
                f"{max(row['max_penetration'] for row in steps):.3e}")
    check.holds(f"scale {scale}: least of a loaded node",
                min(row["min_penetration"] for row in steps) >= low,
                f"{min(row['min_penetration'] for row in steps):.3e}")
    check.holds(f"scale {scale}: none outside in any step", all(row["outside_window"] == 0 for row in steps))
    check.holds(f"scale {scale}: reaches the end", steps[-1]["t"] == 1,
                f"{result.summary()['newton_iterations']} iterations, {result.summary()['steps_failed']} failed steps")
    penalty = result.summary()["contact"][0]["penalty"]
    check.holds(f"scale {scale}: counted", penalty["raised"] > 0 and penalty["outside_window"] == 0
                and penalty["largest_excess"] <= 1, str(penalty))
    check.near(f"scale {scale}: largest penetration on disk", numpy.nanmax(-result.fields()["contact/ridge/gap"]),
               steps[-1]["max_penetration"], 1e-12 * high)
for name, value in results["1"].summary()["probes"].items():
    for scale in ("1e-4", "1e4"):
        check.near(f"{name}: scale {scale} as scale 1", results[scale].summary()["probes"][name], value,
                   1e-3 * abs(value))

# 1b. Surface to surface: loaded is what its own gap presses, not what its neighbours press on the faces between; a
# tight window does not lock.
surface = {}
for g_min, g_max in ((low, high), (100 * low, 100 * high)):
    result = surface[g_min] = run(
        args, plate, out=f"surface_{g_min:g}",
        overrides=(*mesh, "contact.0.formulation=surface_to_surface", f"contact.0.penalty.g_min={g_min}",
                   f"contact.0.penalty.g_max={g_max}"))
    check.holds(f"surface, from {g_min:g}: no step fails",
                result.summary()["steps_failed"] == 0, f"{result.summary()['newton_iterations']} iterations")
    check.holds(
        f"surface, from {g_min:g}: none outside in any step",
        all(row["outside_window"] == 0 and row["min_penetration"] >= g_min and row["max_penetration"] <= g_max
            for row in result.steps()))
for name in ("tip_uy", "cylinder_fx", "cylinder_fy"):
    value = surface[100 * low].summary()["probes"][name]
    check.near(f"surface, {name}: tight as loose", surface[low].summary()["probes"][name], value, 2e-3 * abs(value))

# 2. Two blocks under a pressure that stays from t = 0.2 on: eq. 16 to the letter lands on the edge of the window with
# one update at constant force.
patch = SCENES / "contact_patch.yaml"
hold = ("loads.0.history=[[0, 0], [0.2, 1], [1, 1]]", "stepping.initial=0.1")
letter = run(
    args, patch, out="letter",
    overrides=(*hold,
               f"contact.0.penalty={{adjust: true, when: step, g_min: {low}, g_max: {high}, unit: length}}")).steps()
check.near("eq. 16: ends on the edge", letter[-1]["max_penetration"], high, 1e-9 * high)
check.holds("eq. 16: from outside", letter[0]["max_penetration"] > 100 * high
            and letter[0]["outside_window"] == letter[0]["contact_nodes"])
check.holds("eq. 16: none outside at the end", letter[-1]["outside_window"] == 0)
check.near("eq. 16: an update is clamped to 100", letter[1]["penalty_max"] / letter[0]["penalty_max"], 100, 1e-9)

# 3. The window in face sizes of the slave nodes, which are all alike here.
size = (2 / 5 * 1 / 3) ** 0.5
spacing = run(args, patch, out="spacing",
              overrides=(*hold, "contact.0.penalty={adjust: true, g_min: 1e-6, g_max: 5e-6, unit: spacing}")).steps()
check.holds("spacing: inside",
            all(low * size <= row["min_penetration"] and row["max_penetration"] <= high * size for row in spacing),
            f"{spacing[-1]['max_penetration'] / size:.3e} face sizes")

# 4. Nothing is adjusted unless asked for.
plain = run(args, patch, out="plain")
check.holds("off: no window",
            plain.steps()[-1]["outside_window"] is None and plain.summary()["contact"][0]["penalty"]["raised"] == 0)

# 5. A range that does not reach the window.
stuck = run(
    args, patch, out="stuck",
    overrides=("stepping.dt_min=0.4",
               "contact.0.penalty={adjust: true, g_min: 1e-6, g_max: 5e-6, unit: length, range: 10}"), must=2)
check.holds(
    "out of reach: message",
    all(word in stuck.text for word in ("window of the adjusted penalty", "contact 'joint': node",
                                        "penalty.range allows no more", "tried 2 steps")))
check.finish()
