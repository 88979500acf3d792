"""Steps along a smooth history of states start from the extrapolated state. They take fewer iterations than the first
steps and end where larger steps end. After a break of the load the next step starts from the accepted state.
Predictions of contact use the extrapolated state too.

The bounds on iterations leave a quarter of room over the figures of today, which stand beside them."""
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
# These guard the extrapolation. The first two steps have no history and take 4 iterations each. The 16 steps from the
# fifth on take 30 together, the last one takes 1.
check.holds("ring: from the fifth step on", sum(fine[4:]) <= 38, f"{sum(fine[4:])}: {fine}")
check.holds("ring: the last step needs at most half of the first", 2 * fine[-1] <= fine[0], str(fine))
# This guards the degree of the polynomials on larger steps: 31.
check.holds("ring: larger steps", sum(coarse) <= 39, f"{sum(coarse)}: {coarse}")
for name, value in reference.items():
    check.near(f"ring: {name}", probes[name], value, 1e-6 * abs(value))
    check.near(f"ring with a break: {name}", ends[name], value, 1e-6 * abs(value))
# The step after the break must not use the states before it, so it takes more iterations than the step before: 3 to 2.
check.holds("ring with a break: the step after it starts afresh", broken[9] < broken[10], str(broken[9:13]))
# This guards the judgement of when an extrapolation is smooth, with contact: 85; a stricter judgement took 103.
check.holds("cup in contact: 40 steps", sum(cup) <= 106, f"{sum(cup)}: {cup}")
forecasts, radius = iterations("forecasts", "cup_flattening",
                               "stepping={control: contact, initial: 0.01, N_c: 1, dt_max: 0.03, prediction: tangent}")
_, whole = iterations("whole", "cup_flattening")
# This guards predictions of contact from the extrapolated state: 2.4 iterations a step, the prediction included.
check.holds("cup, forecasts: iterations a step",
            sum(forecasts) <= 3 * len(forecasts), f"{sum(forecasts)} in {len(forecasts)}")
for name, value in whole.items():
    check.near(f"cup, forecasts: {name}", radius[name], value, 1e-6 * abs(value))
check.finish()
