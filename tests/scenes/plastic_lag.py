"""A pin is pressed into a bore that yields. Contact travels along the bore, and the flow below it turns: long steps
lose most of the force. The bound on the lag of the stresses shortens them by itself, and the last screen tells what is
left."""
from harness import SCENES, Check, arguments, run

# Force at the end and plastic work: limits of 100, 200 and 400 steps of one length (2225.6, 2266.2, 2285.5 N and 20650,
# 21232, 21513 N mm).
FORCE, WORK = 2304, 21790
args = arguments()
check = Check()
pressed = run(args, SCENES / "pin_pressed.yaml", out="default")
energy = pressed.summary()["energy"]
force = -pressed.steps()[-1]["push"]
check.holds("it is done without a failed step",
            pressed.status == 0 and pressed.summary()["steps_failed"] == 0, f"{pressed.summary()['steps']} steps")
check.holds("the bound is kept in the mean", 0 < energy["lag"] < 0.2, f"{energy['lag']:.3f}")
check.near("force", force, FORCE, energy["lag"] * FORCE)
check.near("plastic work", energy["plastic"], WORK, energy["lag"] * WORK)
check.holds("the last screen tells it", "stresses lag behind the turns of plastic flow by" in pressed.text)
lines = [line for line in pressed.summary()["advice"] if "-set stepping.plastic_lag=" in line]
check.holds("advice of a smaller bound", len(lines) == 1, str(lines))
# Steps of one length have no bound but one that is asked for.
fixed = run(args, SCENES / "pin_pressed.yaml", "-quiet", out="fixed",
            overrides=["stepping={control: fixed, initial: 0.1}"])
check.holds("fixed steps stay", fixed.summary()["steps"] == 10, str(fixed.summary()["steps"]))
check.holds("they lag", fixed.summary()["energy"]["lag"] > 0.3, f"{fixed.summary()['energy']['lag']:.3f}")
refused = run(args, SCENES / "pin_pressed.yaml", out="elastic", must=1, overrides=[
    "bodies.0.material={law: svk, E: 200e3, nu: 0.3}", "stepping.plastic_lag=0.1"
])
check.holds("no body flows: refused", "plastic_lag" in refused.text, refused.text[-200:])
check.finish()
