"""Ranks without cells, nodes, slave points or faces: scenes of a few elements with many features on so many ranks that
METIS leaves one or two of them empty. Each ends as it does on one rank, with the same steps, contact, probes, errors,
derivatives and fields to 1e-9 of the largest, 1e-7 where multipliers follow the penetration or the linear solver
iterates; refusals and failures have the same one message and status."""
import csv
import re

import numpy

from harness import Check, arguments, run, SCENES

SCENE = SCENES / "few_cells.yaml"
LIMIT = 60  # seconds, of which a run takes less than three: ranks that wait for each other do so for ever
COUNTS = ("step", "contact_nodes", "nodes_in", "nodes_out", "newton", "attempts")
SOLID = [
    "mesh.parameters.dim=3", "geometry=solid", "supports.0.uz=0", "loads.0.uz=0",
    "probes.1.displacement=[1, 0.52, 0]"
]
RUBBER = [f"bodies.{b}.material={{law: neo_hookean, E: 100, nu: 0.5}}" for b in (0, 1)]
YIELDS = "bodies.1.material={law: von_mises, E: 100, nu: 0.3, yield: 3, hardening: {linear: 5}}"
FREE = "supports.1={surface: left, ux: 0}"
NODES = ["contact.0.smoother=facet", "contact.0.formulation=node_to_surface"]
TOOL = [
    "bodies.2={surface: tool, rigid: {point: [0.5, 1.1], free: [uy, rz], force: [0, -3]}}", FREE, "loads=[]",
    "contact.1={name: punch, slave: upper_top, master: tool, friction: {mu: 0.2}}",
    "probes.2={name: way, tool_motion: punch, component: y}", YIELDS
]
ERRORS = "output.error=true"
SENSITIVITY = 'sensitivity=["force:bodies.0.material.E", "pressed:loads.0.uy"]'
LISTED = "contact.0={name: joint, surfaces: all}"
PRESSED = "probes.2={name: pressed, contact_force: joint, component: y}"
SPRINGS = [
    "supports.1={surface: upper_top, spring: [5, 10]}",
    "loads=[{volume: upper, body_force: [0, -2]}, "
    "{surface: upper_bottom, pressure: 1, where: open, from: [0, 0.52], history: [[0, 0], [0.5, 0], [1, 1]]}, "
    "{surface: lower_top, pressure: 1, where: open, from: [0, 0.5], history: [[0, 0], [0.5, 0], [1, 1]]}]",
]
MULTIPLIERS = [
    "contact.0.penalty={augment: true, g_max: 0.001, unit: length}", "contact.0.friction={mu: 0.3}",
    "contact.0.master={plane: {point: [0, 0.5, 0], normal: [0, 1, 0]}}", "stepping.damping=auto"
]
PHASES = [
    "stepping.steps=[{name: one, until: 0.5}, {name: two, until: 1}]", "loads=[{surface: upper_top, ux: 0, uy: -0.1}]",
    "supports.1={surface: left, ux: 0, during: two}", "mesh.parameters.simplex=1"
]
# name: overrides, ranks, exit status. Of 3 ranks one has none of the four elements, of 7 two have none of the nine.
CASES = {
    "errors of rubber": ([*RUBBER, ERRORS, LISTED], 3, 0),
    "derivatives": ([*NODES, SENSITIVITY, PRESSED], 3, 0),
    "tool": ([*TOOL, ERRORS], 7, 0),
    "fluid and springs": (SPRINGS, 3, 0),
    "multipliers": ([*SOLID, *MULTIPLIERS], 3, 0),
    "iterative solver": ([*SOLID, "solver.type=iterative"], 3, 0),
    "nodal pressures": ([*RUBBER, *PHASES], 3, 0),
    "refused": (["mesh.parameters.gap=-0.02", "probes.1.displacement=[1, 0.48]"], 3, 1),
    "failed": (["solver.max_iterations=1", "stepping={initial: 1, dt_min: 1, damping: none}"], 3, 2),
}


def messages(finished):
    """What a run complains of, without its directory."""
    return [line for line in finished.text.splitlines() if line.startswith("burnish: ")]


def same(name, ours, theirs, size=None):
    """Compares numbers, to the tolerance of the case."""
    a, b = (numpy.nan_to_num(numpy.asarray(v, dtype=float)) for v in (ours, theirs))
    check.near(name, a, b, tolerance * max(numpy.max(numpy.abs(b), initial=0) if size is None else size, 1e-300))


def estimates(summary):
    """Errors of probes by cause, over the probes' values."""
    return [part / error["value"] for error in summary["error"].values()
            for part in error.get("causes", {}).values() if not isinstance(part, str)]  # a text: not known


def derivatives(finished):
    with open(finished.directory / "sensitivity.csv", newline="") as file:
        return [float(row["derivative"]) for row in csv.DictReader(file)]


def compare(name, one, other):
    rows, others = one.steps(), other.steps()
    check.holds(f"{name}: steps", len(rows) == len(others), f"{len(rows)} and {len(others)}")
    for column in COUNTS:
        check.holds(f"{name}: {column}", [row[column] for row in rows] == [row[column] for row in others])
    ours, theirs = other.summary(), one.summary()
    for probe, value in theirs["probes"].items():
        same(f"{name}: {probe}", ours["probes"][probe], value)
    if "error" in theirs:
        same(f"{name}: errors", estimates(ours), estimates(theirs), size=1)
    if (one.directory / "sensitivity.csv").exists():
        same(f"{name}: derivatives", derivatives(other), derivatives(one))
    fields, others = one.fields(), other.fields()
    moved = numpy.max(numpy.abs(fields["displacement"]))  # the scale of gaps too, which are differences of places
    for field, value in fields.items():
        same(f"{name}: {field}", others[field], value, size=moved if re.search("gap|penetration", field) else None)


args = arguments()
check = Check()
for case, (overrides, ranks, status) in CASES.items():
    tolerance = 1e-7 if re.search("augment: true|iterative", str(overrides)) else 1e-9
    cells = ["mesh.parameters.n_upper=3", "mesh.parameters.n_lower=6"] if ranks == 7 else []
    finished = [run(args, SCENE, out=f"{case.replace(' ', '_')}_{n}", ranks=n, overrides=[*cells, *overrides],
                    must=None, limit=LIMIT) for n in (1, ranks)]
    check.holds(f"{case}: status", [each.status for each in finished] == [status, status],
                [each.status for each in finished])
    told = [messages(each) for each in finished]
    check.holds(f"{case}: messages", told[0] == told[1] and (not status or len(told[1]) == 1), told)
    if finished[0].status == finished[1].status == 0:
        compare(case, *finished)
check.finish()
