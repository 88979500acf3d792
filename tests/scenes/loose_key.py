"""A shaft turns a hub by a loose key, by contact of all surfaces with friction. Faces that overhang others by less than
a face have one partner, whichever way the two are tilted; few steps fail, which else ended the run. What the shaft is
turned by is what the hub holds, and torques about two points differ by the moment of the force."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
result = run(args, SCENES / "loose_key.yaml")
summary, last = result.summary(), result.steps()[-1]
check.effort(summary, 12, 1, 130)
check.near("torques", last["drive"] / -last["torque"], 1, 1e-3)  # levers of contact forces over gaps
check.near("torque about another point",
           (last["drive_there"] - last["drive"] + 3 * last["pull_y"] - 4 * last["pull_x"]) / last["torque"], 0, 1e-9)
check.finish()
