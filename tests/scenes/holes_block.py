"""A rubber block with nine holes jumps aside where its walls buckle. Static steps get no farther than that; damped ones
do, and the run says what the jump lost."""
import re

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
scene = SCENES / "holes_block.yaml"

damped = run(args, scene, out="holes_block", overrides=("stepping.damping=auto", )).summary()
check.holds("damped: some steps", damped["damping"]["steps"] >= 1, str(damped["damping"]))
check.holds("damped: jumps", damped["jumps"]["found"] >= 1, str(damped["jumps"]))
share = damped["damping"]["energy_taken"] / damped["damping"]["stored_energy"]
check.holds("damped: little is lost", 0 < share < 0.1, f"{share:.3g}")
energy = damped["energy"]
total = sum(energy[name] for name in ("elastic", "contact", "damping"))
check.near("damped: energies balance", energy["external"] / total, 1, 0.01)

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
