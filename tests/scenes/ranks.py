"""The same scene on 1, 2 and 3 ranks, and on 4 and 7 where --ranks says so: same steps, same iterations, same contact,
probes and fields equal to 1e-9 of the largest, 1e-7 where penalties or multipliers follow the penetration."""
import re

import numpy

from harness import Check, arguments, run, SCENES

COUNTS = ("step", "contact_nodes", "nodes_in", "nodes_out", "newton", "attempts", "outside_window")

args = arguments(("scene", "scene file, from tests/scenes"), ("set", "overrides, ' + ' between them, or none"))
overrides = [] if args.set == "none" else args.set.split(" + ")
numbers = [n for n in (1, 2, 3, 4, 7) if n <= args.ranks]
runs = {n: run(args, SCENES / args.scene, out=f"on_{n}", ranks=n, overrides=overrides) for n in numbers}
TOLERANCE = 1e-7 if re.search("(adjust|augment): true", (SCENES / args.scene).read_text() + args.set) else 1e-9
check = Check()
one = runs[1].steps()
probes = list(runs[1].summary()["probes"])
# A pressure deviation is a pressure in per cent of the mean one: 100 is the scale to compare it on, however small it
# is.
scales = {name: 100 for name in re.findall(r"name: (\w+), pressure_deviation:", (SCENES / args.scene).read_text())}
fields = runs[1].fields()
for n in numbers[1:]:
    other = runs[n].steps()
    check.holds(f"{n} ranks: number of steps", len(one) == len(other), f"{len(one)} and {len(other)}")
    for name in COUNTS:
        check.holds(f"{n} ranks: {name}", [row[name] for row in one] == [row[name] for row in other])
    for name in ("t", "max_penetration", "contact_force", *probes):
        a, b = ([row[name] for row in rows] for rows in (one, other))
        check.holds(f"{n} ranks: {name}: value or none", [v is None for v in a] == [v is None for v in b])
        pairs = numpy.array([(v, w) for v, w in zip(a, b) if v is not None and w is not None] or [(0, 0)])
        check.near(f"{n} ranks: {name}", pairs[:, 1], pairs[:, 0],
                   TOLERANCE * max(numpy.max(numpy.abs(pairs)), scales.get(name, 1e-300)))
    for name, value in runs[n].fields().items():
        check.near(f"{n} ranks: {name}", numpy.nan_to_num(value), numpy.nan_to_num(fields[name]),
                   TOLERANCE * max(numpy.nanmax(numpy.abs(fields[name])), 1e-300))
    ours, theirs = runs[1].summary(), runs[n].summary()
    for name in ("name", "dofs", "elements", "status", "steps", "steps_failed", "newton_iterations", "newton_accepted",
                 "contact_nodes"):
        check.holds(f"{n} ranks: summary {name}", ours[name] == theirs[name], f"{ours[name]} and {theirs[name]}")
check.finish()
