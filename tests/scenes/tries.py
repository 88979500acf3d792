"""What a failed run proposes works: scenes fail, the change on the line `try` is made as it stands there, and the run ends
well. Every failure names the body and the pair. Advice after runs that end well is followed in the same way, until there
is none of its kind."""
import re
import shlex

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
RUNS = SCENES.parent.parent / "runs"
STACK = SCENES / "stack.yaml"
SVK = "material: {law: svk, E: 1000, nu: 0.3}"
FLOOR = ("mesh.parameters={floor: 1.5, thickness: 0.1, height: 3}",
         f"bodies=[{{volume: lower, {SVK}}}, {{volume: floor, {SVK}}}, {{volume: upper, {SVK}}}]",
         "supports=[{surface: lower_bottom, ux: 0, uy: 0}, {surface: floor_bottom, ux: 0, uy: 0}]",
         "contact.0.master=tops", "loads.0.uy=-1.5")


def proposed(text, head):
    """The options -set of the first change on the first line that begins so; none where it is no key."""
    line = re.search(rf"^{head}.*$", text, re.MULTILINE)
    first = re.split(r", (?:or|so that) ", line[0])[0] if line else ""
    words = shlex.split(first[first.index("-set"):]) if "-set" in first else []
    return words[1::2]


def fails(name, scene, *overrides, key, body, pair):
    """Fails, names body and pair, and is done with the change that it proposes, which is of that key."""
    failed = run(args, scene, out=f"{name}-before", overrides=overrides, must=None)
    change = proposed(failed.text, "try  ")
    where = re.search(r"^where .*; body '(\w+)', pair '(\w+)'$", failed.text, re.MULTILINE)
    check.holds(f"{name}: fails", failed.status == 2, str(failed.status))
    check.holds(f"{name}: names body and pair", where and where[1] in body.split() and where[2] == pair,
                where and where[0])
    check.holds(f"{name}: proposes {key}", len(change) == 1 and change[0].startswith(key + "="), str(change))
    if failed.status != 2 or not change:
        return
    done = run(args, scene, out=f"{name}-after", overrides=(*overrides, *change), must=None)
    check.holds(f"{name}: works with {change[0]}", done.status == 0, done.text if done.status else "")


def advises(name, scene, *overrides, head, key):
    """Is done, gives advice of that kind, and gives it no more when it is followed."""
    before = run(args, scene, out=f"{name}-before", overrides=overrides)
    change = proposed(before.text, f"advice .*{head}")
    check.holds(f"{name}: advises {key}", bool(change) and change[0].startswith(key + "="), str(change))
    after = run(args, scene, out=f"{name}-after", overrides=(*overrides, *change))
    check.holds(f"{name}: no more of it", not re.search(f"^advice .*{head}", after.text, re.MULTILINE))
    return before.summary()["contact"][0], after.summary()["contact"][0]


fails("loose", STACK, "supports=[{surface: lower_bottom, ux: 0, uy: 0}]", "loads=[{surface: upper_top, pressure: 10}]",
      "contact.0.stabilise=false", key="contact.0.stabilise", body="upper", pair="joint")
fails("long", STACK, "loads.0.uy=-0.86", "loads.0.ux=2", "stepping={control: fixed, initial: 1, dt_min: 0.6}",
      "output.certificate=false", key="stepping.dt_min", body="lower upper", pair="joint")
fails("lost", STACK, *FLOOR, "contact.0.penalty.scale=1e-4", "stepping.initial=0.1", "output.certificate=false",
      key="contact.0.penalty", body="upper", pair="joint")
fails("few", RUNS / "slide_cylinder.yaml", "solver.max_iterations=1",
      "stepping={control: fixed, initial: 0.1, dt_min: 0.06, damping: none}",
      key="solver.max_iterations", body="block", pair="sole")
fails("crushed", STACK, "loads.0.uy=-0.8", "contact.0.penalty.scale=100", "bodies.0.material.E=1e6",
      key="bodies.1.material.law", body="lower upper", pair="joint")

before, after = advises("soft", STACK, head="penetration leaves", key="contact.0.penalty")
LINE = ("mesh.order=2", "contact.0.formulation=node_to_surface", "mesh.parameters={h: 1, ratio: 2}", "stepping.initial=1")
before, after = advises("scatter", RUNS / "hertz_line.yaml", *LINE, "contact.0.penalty.scale=100",
                        head="nodal pressures scatter", key="contact.0.formulation")
check.holds("scatter: figures", before["pressure_scatter"] > 3 * after["pressure_scatter"],
            f"{before['pressure_scatter']:.3g}, {after['pressure_scatter']:.3g}")

# A floor touches the lower block from below with less than 1e-5 of what the other pair bears, through a soft penalty:
# what that leaves of error is large as a part of this force, and next to nothing in the model.
light = run(args, STACK, out="light", overrides=[
    "mesh.parameters.floor=0.01", f"bodies.2={{volume: floor, {SVK}}}", "contact.0.penalty.scale=1000",
    "contact.1={name: touch, slave: floor_top, master: lower_bottom, penalty: {scale: 0.1}}",
    "loads.1={surface: floor_bottom, ux: 0, uy: 0.010001}",
    "probes.1={name: touch, contact_force: touch, component: y, absolute: true}"
])
forces, error = light.summary()["probes"], light.summary()["contact"][1]["penalty"]["error_force"]
check.holds("light: a light pair", 1e-8 < forces["touch"] / forces["force"] < 1e-5, str(forces))
check.holds("light: its error counts by a thousandth of the other pair's force",
            0 < error < 1e3 * forces["touch"] / forces["force"], str(error))
check.holds("light: no advice", "advice   touch" not in light.text)
check.finish()
