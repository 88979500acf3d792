"""The balance of energies of a plastic block: the work on it is what it stores and dissipates, whatever does the work, a
tool that is pushed or moved, friction, its weight, springs below it, a pressure that follows it or displacements. The
bound is the error of the trapezoidal rule over 50 steps."""
from harness import SCENES, Check, arguments, run

BOUND = 2e-3
TOOL = "contact.0.master={cylinder: {point: [5, 8.2], radius: 3, "
PUSHED = [TOOL + "free: [uy], force: [0, -200]}}"]
MOVED = [TOOL + "motion: [{uy: -0.8, ux: 0.3}]}}"]
FRICTION = ["contact.0.friction.mu=0.3"]
NOTHING = ["contact=[]", "probes=[]"]
BACKSTRESSES = "{law: von_mises, E: 1000, nu: 0.3, yield: 20, kinematic: [{C: 300, gamma: 10}, {C: 50}]}"
GROWTH = 5e-3
CASES = {
    "tool that is pushed": PUSHED,
    "pushed, friction": PUSHED + FRICTION,
    "moved, friction": MOVED + FRICTION,
    "springs and weight": [*PUSHED, "supports.0={surface: y_min, spring: [500, 500]}",
                           "loads=[{volume: block, body_force: [0, -3]}]"],
    "pressure that follows": NOTHING + [
        "loads=[{surface: y_max, pressure: 26, follower: true, history: [[0, 0], [0.7, 1], [1, 0]]}]"
    ],
    "displacements": NOTHING + ["loads=[{surface: y_max, ux: 0.2, uy: -0.5, history: [[0, 0], [0.7, 1], [1, 0.8]]}]"],
}
args = arguments()
check = Check()
COMMON = ["kinematics=finite", "mesh.parameters.nx=10", "mesh.parameters.ny=5", "mesh.order=1"]
for name, overrides in CASES.items():
    finished = run(args, SCENES / "tool.yaml", "-quiet", out=name.replace(" ", "_").replace(",", ""),
                   overrides=COMMON + overrides + [
                       "bodies.0.material={law: von_mises, E: 1000, nu: 0.3, yield: 20, hardening: {linear: 50}}",
                       "stepping={dt_max: 0.02, initial: 0.02}"
                   ])
    energy = finished.summary()["energy"]
    check.near(name, energy["elastic"] + energy["plastic"], energy["work"], BOUND * energy["work"])
    check.holds(f"{name}: it yields", energy["plastic"] > energy["elastic"])
# Few steps are too long for a tool that travels along a body that flows. A line of advice says so.
finished = run(args, SCENES / "tool.yaml", out="few_steps", overrides=COMMON + [
    TOOL + "motion: [{uy: -0.8, ux: 3}]}}",
    "bodies.0.material={law: von_mises, E: 1000, nu: 0.3, yield: 20, hardening: {linear: 50}}",
    "stepping={control: fixed, initial: 0.2, dt_min: 1e-3}"
])
lines = [line for line in finished.summary()["advice"] if "of the plastic work apart" in line]
check.holds("advice of few steps", len(lines) == 1 and "-set stepping." in lines[0], str(lines))
check.holds("the last screen has it", lines and f"advice   {lines[0]}" in finished.text)
# The bound on the growth of plastic strains sees them beside the numbers of backstresses, too.
finished = run(args, SCENES / "tool.yaml", "-quiet", out="growth", overrides=COMMON + MOVED + [
    f"bodies.0.material={BACKSTRESSES}", f"stepping={{plastic_strain: {GROWTH}, dt_min: 1e-4}}"
])
strain = [0] + [row["max_plastic_strain"] for row in finished.steps()]
growth = max(after - before for before, after in zip(strain, strain[1:]))
check.holds("growth of plastic strains", 0.2 * GROWTH < growth <= GROWTH * (1 + 1e-9), f"{growth:.3g}")
check.finish()
