"""Steps along a smooth path start from where it leads to: they take fewer iterations than the first ones and end where
larger ones do; after a break of the load the next step starts afresh; forecasts of contact that are cut short go along
the path too."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
RUNS = SCENES.parent.parent / "runs"
BREAK = "loads=[{surface: symmetry_x, uy: -50, history: [[0, 0], [0.5, 0.8], [1, 1]]}]"


def iterations(name, scene, *overrides):
    """Those of each step, and the probes at the end."""
    done = run(args, RUNS / f"{scene}.yaml", out=name, overrides=overrides)
    return [int(row["newton"]) for row in done.steps()], done.summary()["probes"]


coarse, reference = iterations("coarse", "ring_pinch", "stepping.initial=0.1")
fine, probes = iterations("fine", "ring_pinch", "stepping.initial=0.05")
broken, ends = iterations("broken", "ring_pinch", "stepping.initial=0.05", BREAK)
cup, _ = iterations("cup", "cup_flattening", "stepping={control: fixed, initial: 0.025}")
check.holds("ring: the first two steps", min(fine[:2]) >= 4, str(fine[:2]))
check.holds("ring: from the fifth on at most 2 iterations", max(fine[4:]) <= 2, str(fine[4:]))
check.holds("ring: the last step needs one", fine[-1] == 1, str(fine[-1]))
check.holds("ring: larger steps", sum(coarse) <= 33, str(coarse))
for name, value in reference.items():
    check.near(f"ring: {name}", probes[name], value, 1e-6 * abs(value))
    check.near(f"ring with a break: {name}", ends[name], value, 1e-6 * abs(value))
check.holds("ring with a break: before, at it and after", broken[9] <= 2 <= 3 <= broken[10], str(broken[9:13]))
check.holds("cup in contact: 40 steps", sum(cup) <= 92, f"{sum(cup)}: {cup}")
forecasts, radius = iterations("forecasts", "cup_flattening",
                               "stepping={control: contact, initial: 0.01, N_c: 1, dt_max: 0.03, prediction: tangent}")
_, whole = iterations("whole", "cup_flattening")
check.holds("cup, forecasts: iterations a step",
            sum(forecasts) <= 2.5 * len(forecasts), f"{sum(forecasts)} in {len(forecasts)}")
for name, value in whole.items():
    check.near(f"cup, forecasts: {name}", radius[name], value, 1e-6 * abs(value))
check.finish()
