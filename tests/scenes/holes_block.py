"""A rubber block with nine holes jumps aside where its walls buckle. Static steps get no farther than that; damped ones
do, and the run says what the jump lost."""
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
check.finish()
