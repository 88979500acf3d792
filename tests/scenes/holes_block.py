"""A rubber block with nine holes jumps aside where its walls buckle, and then touches itself inside its holes: static
steps get to the end. Of second order it creases within faces."""
import re

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
scene = SCENES / "holes_block.yaml"

crushed = run(args, scene, out="holes_block", overrides=("stepping.damping=none", )).summary()
check.holds("crushed: jumps", crushed["jumps"]["found"] >= 1, str(crushed["jumps"]))
check.holds("crushed: few iterations", crushed["newton_iterations"] < 150, str(crushed["newton_iterations"]))
energy = crushed["energy"]
check.near("crushed: energies balance", energy["external"] / (energy["elastic"] + energy["contact"]), 1, 0.01)

# The block of second order creases within faces. None of them folds over itself in an accepted step.
FOLDS = r"contact 'any': face \d+ of 'skin of block' folds over itself about node \d+ \(\d[^)]*, 0\); .*\[B125\]\n"
steps = []
for ranks in (1, 3):
    looped = run(args, scene, out=f"looped{ranks}", ranks=ranks, must=2,
                 overrides=("mesh.order=2", "contact.0.smoother=diffuse", "output.every=0", "stepping.dt_min=0.002"))
    check.holds(f"looped: told with face and place, {ranks} ranks", re.search(FOLDS, looped.text), looped.text[-400:])
    check.holds(f"looped: refused, {ranks} ranks", looped.summary()["certificate"]["refused"] >= 1)
    steps.append(looped.summary()["steps"])
check.holds("looped: the same steps on all ranks", steps[0] == steps[1], str(steps))
check.finish()
