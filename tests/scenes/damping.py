"""A shallow arch under a dead load snaps through. With few iterations no static solve gets past the limit load: with
damping the run does, ends in the same static equilibrium, and says what the restraint took. A solve that may turn its
steps gets there by itself, and says that it jumped."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
scene = SCENES / "damping.yaml"
FEW = "solver.max_iterations=6"
LIMIT = 0.0374  # t of the limit load, from steps of dt_min

plain = run(args, scene, out="damping_plain").summary()
check.holds("plain: jumps once", plain["jumps"]["found"] == 1, str(plain["jumps"]))
check.holds("plain: no damping", plain["damping"]["steps"] == 0 and plain["damping"]["energy_taken"] == 0)
stopped = run(args, scene, out="damping_none", overrides=(FEW, "stepping.damping=none"), must=None)
check.holds("few iterations: exit 2", stopped.status == 2, str(stopped.status))
check.near("few iterations: limit load", stopped.summary()["t"], LIMIT, 1e-4)
last = run(args, scene, out="damping_last", overrides=(FEW, ))
check.near("default: end", last.summary()["probes"]["crown"], plain["probes"]["crown"], 1e-6)
check.holds("default: one step is damped", last.summary()["damping"]["steps"] == 1, str(last.summary()["damping"]))
check.holds("default: warns", "damping took" in last.text)
taken = []
for name, options in (("6 iterations", ()), ("8 iterations", ("solver.max_iterations=8", ))):
    damped = run(args, scene, out=f"damping_{len(taken)}", overrides=(FEW, *options, "stepping.damping=auto"))
    figures = damped.summary()
    check.near(f"{name}: end", figures["probes"]["crown"], plain["probes"]["crown"], 1e-6)
    check.holds(f"{name}: one step is damped", figures["damping"]["steps"] == 1, str(figures["damping"]))
    check.holds(f"{name}: jumps once", figures["jumps"]["found"] == 1, str(figures["jumps"]))
    check.holds(f"{name}: warns", "damping took" in damped.text)
    taken.append(figures["damping"]["energy_taken"])
check.near("energy taken: the same on another way", taken[1] / taken[0], 1, 0.15)
check.finish()
