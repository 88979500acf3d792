"""The balance of energies of a plastic block: the work on it is what it stores and dissipates, and the work from outside
is that and what contact stores and friction takes. This holds whatever does the work, a tool that is pushed, moved or
turned, friction, its weight, springs below it, a pressure that follows it, displacements, an overlap that grows or is
there at the start, a pair that comes or fades, or a fluid that enters below it. The bound is the error of the
trapezoidal rule over 50 steps, and of friction's own rule, which takes the traction at the end of a step for all of its
slip."""
from harness import SCENES, Check, arguments, run

BOUND, SLIP = 2e-3, 0.03
TOOL = "contact.0.master={cylinder: {point: [5, 8.2], radius: 3, "
PUSHED = [TOOL + "free: [uy], force: [0, -200]}}"]
MOVED = [TOOL + "motion: [{uy: -0.8, ux: 0.3}]}}"]
FRICTION = ["contact.0.friction.mu=0.3"]
NOTHING = ["contact=[]", "probes=[]"]
BACKSTRESSES = "{law: von_mises, E: 1000, nu: 0.3, yield: 20, kinematic: [{C: 300, gamma: 10}, {C: 50}]}"
GROWTH = 5e-3
# Steps of a quarter: a pair comes or goes in part of the way.
SHORT = ("pair that fades", "pair that comes")
CASES = {
    "tool that is pushed": PUSHED,
    "pushed, friction": PUSHED + FRICTION,
    "moved, friction": MOVED + FRICTION,
    "turned and moved, friction": [TOOL + "motion: [{uy: -0.8, rz: -20}]}}"] + FRICTION,
    "overlap that grows": [TOOL + "motion: [{uy: 0}]}}", "contact.0.initial_overlap={add: 0.9}"],
    "overlap resolved at once": [
        "contact.0.master={cylinder: {point: [5, 7.995], radius: 3, motion: [{uy: -0.8, ux: 0.3}]}}",
        "contact.0.initial_overlap=resolve"
    ],
    "pair that fades": [
        TOOL + "motion: [{uy: -0.8, history: [[0, 0], [0.4, 1]]}]}}",
        "contact.0.history=[[0, 1], [0.4, 1], [0.8, 0]]"
    ],
    "pair that comes": [
        TOOL + "motion: [{uy: -0.8, history: [[0, 0], [0.4, 1]]}]}}",
        "contact.0.history=[[0, 0], [0.4, 0], [1, 1]]"
    ],
    "augmented": MOVED + ["contact.0.penalty={augment: true, g_max: 1e-3, unit: length}"],
    "springs and weight": [*PUSHED, "supports.0={surface: y_min, spring: [500, 500]}",
                           "loads=[{volume: block, body_force: [0, -3]}]"],
    "pressure that follows": NOTHING + [
        "loads=[{surface: y_max, pressure: 26, follower: true, history: [[0, 0], [0.7, 1], [1, 0]]}]"
    ],
    "displacements": NOTHING + ["loads=[{surface: y_max, ux: 0.2, uy: -0.5, history: [[0, 0], [0.7, 1], [1, 0.8]]}]"],
}
args = arguments()
check = Check()


def check_energy(name, energy):
    bodies, work = energy["elastic"] + energy["plastic"], energy["external"]
    check.near(name, bodies, energy["work"], BOUND * energy["work"])
    check.near(f"{name}, from outside", bodies + energy["contact"] + energy["friction"], work,
               BOUND * work + SLIP * energy["friction"])
    check.near(f"{name}: apart", energy["apart"], abs(work - bodies - energy["contact"] - energy["friction"]) /
               (energy["plastic"] + energy["friction"]), 1e-9)


COMMON = ["kinematics=finite", "mesh.parameters.nx=10", "mesh.parameters.ny=5", "mesh.order=1"]
for name, overrides in CASES.items():
    finished = run(args, SCENES / "tool.yaml", "-quiet", out=name.replace(" ", "_").replace(",", ""),
                   overrides=COMMON + overrides + [
                       "bodies.0.material={law: von_mises, E: 1000, nu: 0.3, yield: 20, hardening: {linear: 50}}",
                       "stepping={dt_max: 0.005, initial: 0.005}" if name in SHORT else
                       "stepping={dt_max: 0.02, initial: 0.02}"
                   ])
    energy = finished.summary()["energy"]
    check_energy(name, energy)
    check.holds(f"{name}: it yields", energy["plastic"] > energy["elastic"])
# A gasket that flows under a fluid.
finished = run(args, SCENES.parent / "jobs/seal_leak.yaml", "-quiet", out="fluid", overrides=[
    "bodies.0.material={law: von_mises, E: 6, nu: 0.45, yield: 1, hardening: {linear: 2}}", "mesh.order=1",
    "stepping.dt_max=0.02", "loads.1.pressure=1.4"
])
summary = finished.summary()
check_energy("fluid", summary["energy"])
check.holds("fluid: it enters", summary["fluids"][0]["wetted"] > 0.2, str(summary["fluids"][0]["wetted"]))
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
