"""Load steps land on every `at` and breakpoint, a failed step is taken back whole, and a run that cannot go on ends
with status 2 and its last state on disk."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
lame = SCENES / "lame.yaml"
finite = ("kinematics=finite", "bodies.0.material.law=neo_hookean", "loads.0.pressure=200")

# 1. Landing: 0.15 is a breakpoint of the history, 0.3 and 0.77 are asked for.
landed = run(
    args, lame, out="landing", overrides=(*finite, "stepping={control: fixed, initial: 0.13, at: [0.3, 0.77]}",
                                          "loads.0.history=[[0, 0], [0.15, 0.5], [1, 1]]"))
t = [row["t"] for row in landed.steps()]
for point in (0.15, 0.3, 0.77, 1):
    check.holds(f"lands on {point}", point in t)
check.holds("no step beyond sqrt(2) dt", max(b - a for a, b in zip([0, *t], t)) <= 2**0.5 * 0.13 + 1e-12)

# 2. Cutback: three iterations are too few for a tenth of the way where no factor settles their contact, and where
# friction, next to none, keeps a solve from being made once more with softened penalties; the cut steps reach the same
# end as steps that never failed. The end is off the facets' edges: a node over one is pushed to either
# side, by round-off.
slide = SCENES.parent.parent / "runs" / "slide_cylinder.yaml"
turn = ("stepping.initial=0.1", "bodies.1.rigid.motion=[{rz: 59, history: [[0, 0], [0.2, 0], [1, 1]]}]")
good = run(args, slide, out="uncut", overrides=turn)
cut = run(args, slide, out="cut", overrides=(*turn, "solver.max_iterations=3", "solver.type=iterative",
                                              "contact.0.friction.mu=1e-10"))
check.holds("uncut run never failed", good.summary()["steps_failed"] == 0)
check.holds("cut run failed and went on",
            cut.summary()["steps_failed"] > 0, f"{cut.summary()['steps_failed']} failed steps")
check.holds("failed attempts are counted", cut.summary()["newton_iterations"] > cut.summary()["newton_accepted"])
for name, value in good.summary()["probes"].items():
    check.near(f"{name} after cutbacks",
               cut.summary()["probes"][name], value, 1e-6 * abs(good.summary()["probes"]["force_y"]))

# 2b. A body that only contact holds from its first touch on: the first step fails (one iteration allowed) and is taken
# back with its touching start.
touch = run(args, SCENES.parent.parent / "runs" / "slide_flat.yaml", out="touch",
            overrides=("stepping.initial=0.2", "solver.max_iterations=1"))
check.holds("first step failed", touch.summary()["steps_failed"] > 0 and touch.steps()[0]["attempts"] > 1)
check.near("force after it", touch.summary()["probes"]["force_y"], 160, 1e-6 * 160)

# 3. A step that cannot be cut: one iteration is enough for the first half, which has no load, but not for the second
# half, and dt_min is more than half of dt.
stuck = run(
    args, lame, out="stuck",
    overrides=(*finite, "loads.0.pressure=5000", "loads.0.history=[[0, 0], [0.5, 0], [1, 1]]",
               "solver.max_iterations=1", "stepping={control: fixed, initial: 0.5, dt_min: 0.3}"), must=2)
check.holds(
    "message names load parameter, cause, node and what was tried",
    all(word in stuck.text for word in ("no equilibrium from t = 0.5 to 1", "inside out", "node", "dt_min 0.3")))
check.holds("summary says so",
            stuck.summary()["status"] == "not converged" and "no equilibrium" in stuck.summary()["message"])
check.holds("last good state is on disk", "displacement" in stuck.fields())

# 4. A body that slides freely along its only contact: the cause is named, not a line search. (One without contact is
# refused: motions.py.)
flat = SCENES.parent.parent / "runs" / "slide_flat.yaml"
loose = run(
    args, flat, out="loose",
    overrides=("loads=[{surface: block_top, traction: [1, -1, 0]}]", "stepping.initial=1", "stepping.dt_min=0.9"),
    must=2)
check.holds("the body and its free motion are named",
            all(word in loose.text for word in ("nothing holds a body", "'block'", "translation along x")))

# 5. Small strains and no contact: one linear solve, whatever the steps asked for.
linear = run(args, lame, out="linear", overrides=("stepping.initial=0.1",))
check.holds("one linear solve",
            linear.summary()["newton_iterations"] == 1 and linear.summary()["krylov_iterations"] == 1)

# 6. Moved without any force until the tool comes back: only round-off is there to be measured against, on the way.
approach = ("loads=[{surface: block_top, ux: 0, uy: -0.2}]", "stepping.initial=0.1")
late = run(args, SCENES.parent.parent / "runs" / "slide_flat.yaml", out="late",
           overrides=(*approach, "bodies.1.rigid.motion=[{uy: -1, history: [[0, 0], [0.5, 1], [1, 0]]}]"))
near = run(args, SCENES.parent.parent / "runs" / "slide_flat.yaml", out="near", overrides=approach)
check.holds("no step failed on the way", late.summary()["steps_failed"] == 0)
check.near("force after late contact",
           late.summary()["probes"]["force_y"],
           near.summary()["probes"]["force_y"], 1e-6 * near.summary()["probes"]["force_y"])
never = run(args, SCENES.parent.parent / "runs" / "slide_flat.yaml", out="never",
            overrides=(*approach, "bodies.1.rigid.motion=[{uy: -1}]"))
check.holds(
    "contact that never came is warned of", "no node of 'block_bottom' met" in never.text
    and "warning" not in near.text.replace("warning: this is the reference BLAS", ""))

# 7. However small dt_min is, a run that cannot go on ends, before steps are too short to move t.
tiny = run(args, SCENES / "stack.yaml", out="tiny", must=2,
           overrides=("loads.0.uy=-1.2", "stepping={control: fixed, initial: 0.1, dt_min: 1e-18}"))
check.holds("steps that would not move t", "no equilibrium from t = " in tiny.text)
check.finish()
