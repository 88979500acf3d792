"""Four jaws crimp a tube on a rod. With friction, the tube's offsets change by jumps where fits fall to another rung:
lists that turn them to and fro must settle, else steps become shorter without end."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
result = run(args, SCENES / "crimp.yaml")
summary, last = result.summary(), result.steps()[-1]
check.effort(summary, 80, 6, 1100)
check.near("bulge between the jaws", last["bulge"], 0.331, 0.02)
check.finish()
