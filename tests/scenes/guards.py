"""What must never end in silence: contact lost behind a master, a master passed through in one step, a body that
nothing holds or that flies off, contact sets that repeat themselves; and bodies that only contact holds."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
stack = SCENES / "stack.yaml"
pipe = SCENES.parent.parent / "runs" / "pipe_pinch.yaml"
SVK = "material: {law: svk, E: 1000, nu: 0.3}"
FLOOR = ("mesh.parameters={floor: 1.5, thickness: 0.1}",
         f"bodies=[{{volume: lower, {SVK}}}, {{volume: floor, {SVK}}}, {{volume: upper, {SVK}}}]",
         "supports=[{surface: lower_bottom, ux: 0, uy: 0}, {surface: floor_bottom, ux: 0, uy: 0}]",
         "contact.0.master=tops", "contact.0.penalty.scale=1e-4")
UNJUDGED = "output.certificate=false"
FREE = ("supports=[{surface: lower_bottom, ux: 0, uy: 0}]", "loads=[{surface: upper_top, pressure: 10}]")


def ends(name, run, status, *words):
    """The run ended with that status, and a message that has all the words."""
    message = run.summary()["message"] or ""
    check.holds(f"{name}: exit {status}", run.status == status, str(run.status))
    check.holds(f"{name}: says why", all(word in message for word in words), message)


# A soft penalty: the body goes right through the other one, 6.5 faces deep, and contact still acts as the law says. A
# run that judges its steps stops.
judged = run(args, stack, out="judged",
             overrides=("contact.0.penalty.scale=1e-4", "loads.0.uy=-3.5", "stepping.initial=0.1"), must=None)
ends("judged", judged, 2, "cannot be certified", "'joint': node ", " deep, at face ")
soft = run(args, stack, out="soft",
           overrides=("contact.0.penalty.scale=1e-4", "loads.0.uy=-3.5", "stepping.initial=0.1", UNJUDGED))
check.near("soft: force over penetration",
           soft.summary()["probes"]["force"] / soft.summary()["max_penetration"], 0.4, 0.004)
check.holds("soft: warns of the depth", "6.5 face sizes behind its master" in soft.text)

# The same over a floor that belongs to the master: below the middle between them the floor is nearer.
lost = run(args, stack, out="lost", must=None,
           overrides=(*FLOOR, "loads.0.uy=-1.5", "stepping.initial=0.1", UNJUDGED))
ends("lost", lost, 2, "contact was lost behind a master", "'joint': node ", "0.8 behind its master")
check.near("lost: t of the last good state", lost.summary()["t"], 0.7, 1e-3)
leap = run(args, stack, out="leap",
           overrides=(*FLOOR, "loads.0.uy=-1.5", "stepping={control: fixed, initial: 1, dt_min: 0.6}"), must=None)
ends("leap", leap, 2, "contact was lost behind a master",
     "1.25 behind its master and is found 0.35 in front of another part of it")

loose = run(args, stack, out="loose", overrides=(*FREE, "contact.0.stabilise=false"), must=None)
ends("loose", loose, 2, "singular", "holds 'upper'", "stabilise: auto")
for name, options in (("gap", ()), ("touching", ("mesh.parameters={gap: 0}",)), ("asked", ("contact.0.stabilise=true",)),
                      ("facets", ("contact.0.smoother=facet", "contact.0.formulation=node_to_surface"))):
    held = run(args, stack, out=f"held_{name}", overrides=(*FREE, *options))
    check.near(f"held, {name}: force", held.summary()["probes"]["force"], 20, 2e-6)
    check.holds(f"held, {name}: nothing left in the springs", held.summary()["stabilisation"]["force_share"] < 1e-6)
    check.holds(f"held, {name}: no failed step", held.summary()["steps_failed"] == 0)
adrift = run(args, stack, out="adrift", overrides=(FREE[0], "loads=[{surface: upper_top, pressure: -10}]"), must=None)
ends("adrift", adrift, 2, "nothing holds a body against its load", "'upper': translation along y")
LATER = ("loads=[{surface: upper_top, pressure: 10, history: [[0, 0], [0.5, 1], [0.75, -1], [1, -1]]}]")
flies = run(args, stack, out="flies", overrides=(FREE[0], LATER), must=None)
ends("flies", flies, 2, "'upper': translation along y")
# It comes so far in one step that rounding of its positions is a force above the load's.
pulled = run(args, SCENES / "pulled_ball.yaml", out="pulled", must=None)
ends("pulled", pulled, 2, "nothing holds a body against its load", "'ball': translation along x")
gripped = run(args, SCENES / "pulled_ball.yaml", out="gripped", overrides=("loads.1.force=[1.5, 0]",))
check.holds("gripped: held by friction", gripped.summary()["probes"]["way"] < 0.1)

# Plain Newton steps on facets repeat themselves where their contact is not settled, as with GMRES; with a factor, or
# with the line search, they do not.
COARSE = ("mesh.order=1", "mesh.parameters={n_arc: 12, n_wall: 1, n_len: 4}", "contact.0.symmetry=[]",
          "stepping.initial=0.2", "probes=[]", "contact.0.penalty.scale=3000")
plain = run(args, pipe, "-snes_linesearch_type", "basic", "-ksp_type", "gmres", out="plain", overrides=COARSE)
cycles = plain.summary()["cycles"]
check.holds("cycles: found", cycles["found"] >= 1, str(cycles["found"]))
check.holds("cycles: named", "repeats every 3 iterations" in cycles["last"] and "of 'crown'" in cycles["last"],
            cycles["last"])
settled = run(args, pipe, "-snes_linesearch_type", "basic", out="settled", overrides=COARSE)
check.holds("cycles: none where steps are settled", settled.summary()["cycles"]["found"] == 0)
searched = run(args, pipe, "-ksp_type", "gmres", out="searched", overrides=COARSE)
check.holds("cycles: none with the line search", searched.summary()["cycles"]["found"] == 0)
check.near("cycles: the same end", plain.summary()["max_penetration"], searched.summary()["max_penetration"], 1e-9)
check.finish()
