"""A wheel rolls: contact travels along its tread, and long steps lose the slip of nodes that come in. The bound on the
travel shortens the steps by itself, and the last screen tells what is left."""
from harness import SCENES, Check, arguments, run

# Thrust at the end: -2.5618, -2.5612 and -2.5609 in 100, 200 and 400 steps of one length.
THRUST = -2.561
# Energy that friction takes: 1.2622 and 1.2630 in 100 and 200 of them.
ENERGY = 1.263
args = arguments()
check = Check()
wheel = SCENES / "rolled_wheel.yaml"
rolled = run(args, wheel, out="default")
travel = rolled.summary()["contact"][0]["friction"]["travel"]
check.holds("it is done without a failed step",
            rolled.status == 0 and rolled.summary()["steps_failed"] == 0, f"{rolled.summary()['steps']} steps")
check.holds("travel is found and kept small", 0.005 < travel < 0.04, f"{travel:.4f}")
check.near("thrust", rolled.steps()[-1]["thrust"], THRUST, travel * abs(THRUST))
check.near("energy taken", rolled.summary()["contact"][0]["friction"]["dissipated"], ENERGY, travel * ENERGY)
check.holds("the last screen tells it", "it travels along the slave" in rolled.text)
# Steps of one length have no bound but one that is asked for.
fixed = run(args, wheel, out="fixed", overrides=["stepping={control: fixed, initial: 0.1}"])
travel = fixed.summary()["contact"][0]["friction"]["travel"]
check.holds("fixed steps stay", fixed.summary()["steps"] == 10, str(fixed.summary()["steps"]))
check.holds("contact travels far in them", travel > 0.1, f"{travel:.3f}")
check.near("their thrust is off by no more", fixed.steps()[-1]["thrust"], THRUST, travel * abs(THRUST))
lines = [line for line in fixed.summary()["advice"] if "-set stepping.contact_travel=0.02" in line]
check.holds("advice of a bound", len(lines) == 1, str(fixed.summary()["advice"]))
# A contact that only presses does not travel.
pressed = run(args, wheel, "-quiet", out="pressed", overrides=["stepping={control: fixed, initial: 0.1}",
                                                               "loads.0.ux=0", "loads.0.uy=-1"])
surface = run(args, wheel, "-quiet", out="surface", overrides=["contact.0.formulation=surface_to_surface"])
contact = surface.summary()["contact"][0]
# 2.5403, 2.5407 and 2.5399 in 100, 200 and 400 steps of one length with stiff penalties. With those of the run, what
# they leave is told beside the travel.
told = contact["friction"]["travel"] + contact["penalty"]["error_force"] + contact["friction"]["error_force"]
check.near("thrust, surface to surface", surface.steps()[-1]["thrust"], -2.540, told * 2.540)
check.holds("pressed alone: no travel", pressed.summary()["contact"][0]["friction"]["travel"] == 0)
# Where a load begins, nodes that had next to no force leave as others come in: nothing has travelled.
begun = run(args, SCENES.parent / "jobs/wedge_clamp.yaml", "-quiet", out="begun",
            overrides=["loads.0.pressure=100", "output.every=0"])
travel = begun.summary()["contact"][0]["friction"]["travel"]
check.holds("a load that begins: no travel", travel < 1e-3, f"{travel:.3g}")
refused = run(args, wheel, out="smooth", must=1,
              overrides=["contact.0.friction={mu: 0}", "stepping.contact_travel=0.1"])
check.holds("no pair has friction: refused", "contact_travel" in refused.text, refused.text[-200:])
check.finish()
