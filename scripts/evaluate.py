"""Probes of a finished run from its results, without solving.
    python scripts/evaluate.py DIR PROBES.yaml
`burnish -evaluate DIR PROBES.yaml` calls it. PROBES.yaml has a list `probes` as a scene has, of these kinds:
    {name: a, displacement: [x, y, z], component: x}     also distance, gap and pressure_max, as in a scene
    {name: b, field: von_mises, at: [x, y, z]}           any nodal field of results.h5; component for vectors
    {name: c, field: pressure, over: max, body: ring}    max, min or mean of the nodes of a body, or of all
    {name: d, field: stress_xx, line: [[...], [...]], points: 20}    along a line, into a file of its own
Points are reference coordinates. One without a node takes the nearest node, and its distance is reported. Each written
step becomes a row of DIR/evaluated.csv. Forces (reaction, contact_force) need the solver and are refused."""
import argparse
import csv
import functools
import pathlib
import sys

import h5py
import numpy
import yaml

ON_NODE = 1e-6  # of the model's size: farther points are off a node
COMPONENTS = {"x": 0, "y": 1, "z": 2}
KINDS = {"displacement": {"component", "body"}, "distance": {"change", "body"}, "gap": {"at"}, "pressure_max": {"at"},
         "field": {"at", "over", "line", "points", "body", "component"}}
COMMON = {"name", "absolute", "factor"}
OVER = {"max": numpy.nanmax, "min": numpy.nanmin, "mean": numpy.nanmean}


class Mistake(Exception):
    """What is wrong with the probes, and what is allowed."""


class Results:
    """Nodes, bodies and fields of a run."""

    def __init__(self, directory):
        self.directory = directory
        try:
            self.file = h5py.File(directory / "results.h5", "r")
            scene = yaml.safe_load((directory / "scene.yaml").read_text())
        except OSError as error:
            raise Mistake(f"{directory} has no results of a run: {error.args[-1]}; allowed: the folder of a run") from None
        self.nodes = self.file["mesh/nodes"][()]
        self.size = float(numpy.linalg.norm(numpy.ptp(self.nodes, axis=0)))
        self.names = [body.get("volume") for body in scene["bodies"]]
        self.steps = [self.file["steps"][key] for key in sorted(self.file["steps"])]
        if not self.steps:
            raise Mistake(f"{directory} has no written step; allowed: a run with output.every")

    @functools.cache
    def rows(self, body):
        """Nodes of a body, of all bodies for None."""
        if body is None:
            return numpy.arange(len(self.nodes))
        if body not in self.names:
            raise Mistake(f"body '{body}' is not there; allowed: {', '.join(filter(None, self.names))}")
        found = []
        for key in self.file["mesh"]:
            if key.startswith("cells_") and not key.endswith("_body"):
                own = self.file[f"mesh/{key}_body"][()] == self.names.index(body)
                found.append(self.file[f"mesh/{key}"][()][own].ravel())
        return numpy.unique(numpy.concatenate(found))

    def nearest(self, point, rows):
        """The node nearest to a point, and its distance, 0 at a node."""
        place = numpy.zeros(3)
        place[:len(point)] = point
        distances = numpy.linalg.norm(self.nodes[rows] - place, axis=1)
        k = int(distances.argmin())
        return int(rows[k]), 0.0 if distances[k] <= ON_NODE * self.size else float(distances[k])

    def field(self, step, name, component):
        if name not in step or not isinstance(step[name], h5py.Dataset):
            fields = sorted(key for key in step if isinstance(step[key], h5py.Dataset))
            raise Mistake(f"field '{name}' is not in the results; allowed: {', '.join(fields)}")
        values = step[name][()]
        if values.ndim == 1:
            return values
        if component not in COMPONENTS or values.shape[1] != 3:
            raise Mistake(f"field '{name}' has {values.shape[1]} components; allowed: a vector with component: x, y or z, "
                          "or a scalar such as stress_xx")
        return values[:, COMPONENTS[component]]


def check(probe, number):
    """The kind of a probe, after its keys were looked at."""
    where = f"probes.{number}"
    if not isinstance(probe, dict) or "name" not in probe:
        raise Mistake(f"{where}: has no name; allowed: a map with a name and one kind: {', '.join(KINDS)}")
    kinds = [kind for kind in KINDS if kind in probe]
    if len(kinds) != 1:
        raise Mistake(f"{where}: '{probe['name']}' has {len(kinds)} kinds that results can tell; allowed: exactly one of "
                      f"{', '.join(KINDS)} (forces need the solver: put the probe into the scene)")
    for key in set(probe) - COMMON - KINDS[kinds[0]] - {kinds[0]}:
        raise Mistake(f"{where}.{key}: has no place in {kinds[0]}; allowed: "
                      f"{', '.join(sorted(COMMON | KINDS[kinds[0]]))}")
    if kinds[0] == "field" and sum(key in probe for key in ("at", "over", "line")) != 1:
        raise Mistake(f"{where}: field needs one of at, over and line")
    if probe.get("over", "max") not in OVER:
        raise Mistake(f"{where}.over: {probe['over']} is not allowed; allowed: {', '.join(OVER)}")
    return kinds[0]


def pair(results, step, name):
    """Nodes and group of a pair's slave."""
    pairs = results.file.get("contact", {})
    if name not in pairs:
        raise Mistake(f"contact '{name}' is not in the results; allowed: {', '.join(pairs) or 'none, without contact'}")
    return pairs[name]["nodes"][()], step[f"contact/{name}"]


def value(results, step, probe, kind):
    """Value of a probe in a step, and the distance of the node that was taken."""
    body = results.rows(probe.get("body")) if kind in ("displacement", "distance", "field") else None
    if kind == "displacement":
        node, off = results.nearest(probe[kind], body)
        return results.field(step, "displacement", probe.get("component"))[node], off
    if kind == "distance":
        (a, off_a), (b, off_b) = (results.nearest(point, body) for point in probe[kind])
        apart = results.nodes[b] - results.nodes[a]
        moved = step["displacement"][()]
        length = numpy.linalg.norm(apart + moved[b] - moved[a])
        return length - (numpy.linalg.norm(apart) if probe.get("change") else 0), max(off_a, off_b)
    if kind in ("gap", "pressure_max"):
        nodes, group = pair(results, step, probe[kind])
        if kind == "gap":
            node, off = results.nearest(probe["at"], nodes)
            return group["gap"][()][numpy.flatnonzero(nodes == node)[0]], off
        own = numpy.ones(len(nodes), bool)
        for axis, place in probe.get("at", {}).items():
            own &= abs(results.nodes[nodes, COMPONENTS[axis]] - place) <= ON_NODE * results.size
        return numpy.nanmax(group["pressure"][()][own], initial=0.0), 0.0
    values = results.field(step, probe["field"], probe.get("component"))
    if "over" in probe:
        return OVER[probe["over"]](values[body]), 0.0
    node, off = results.nearest(probe["at"], body)
    return values[node], off


def along(results, probe):
    """Rows of a probe along a line: step, t, part of the way, place and value at the nearest node, its distance."""
    ends = [numpy.pad(numpy.array(end, float), (0, 3 - len(end))) for end in probe["line"]]
    rows, body = [], results.rows(probe.get("body"))
    parts = numpy.linspace(0, 1, int(probe.get("points", 11)))
    found = [results.nearest(ends[0] + part * (ends[1] - ends[0]), body) for part in parts]
    for step in results.steps:
        values = results.field(step, probe["field"], probe.get("component"))
        for part, (node, off) in zip(parts, found):
            rows.append([int(step.attrs["step"]), float(step.attrs["t"]), float(part), *map(float, results.nodes[node]),
                         changed(values[node], probe), off])
    return rows


def changed(number, probe):
    number = float(number) * float(probe.get("factor", 1))
    return abs(number) if probe.get("absolute") else number


def write(path, head, rows):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(["" if isinstance(v, float) and numpy.isnan(v) else v for v in row] for row in rows)


def evaluate(directory, probes):
    results = Results(directory)
    kinds = [check(probe, k) for k, probe in enumerate(probes)]
    columns, table = [], [[int(step.attrs["step"]), float(step.attrs["t"])] for step in results.steps]
    lines = {probe["name"]: along(results, probe) for probe in probes if "line" in probe}
    for probe, kind in zip(probes, kinds):
        if "line" in probe:
            continue
        found = [value(results, step, probe, kind) for step in results.steps]
        columns.append(probe["name"])
        for row, (number, _) in zip(table, found):
            row.append(changed(number, probe))
        note = f"  (nearest node, {found[-1][1]:.3g} away)" if found[-1][1] else ""
        print(f"{probe['name']:<24} {table[-1][-1]:.9g}{note}")
    for name, rows in lines.items():
        write(directory / f"{name}.csv", ["step", "t", "part", "x", "y", "z", name, "distance"], rows)
        print(f"{name:<24} {directory / name}.csv")
    if columns:
        write(directory / "evaluated.csv", ["step", "t", *columns], table)
        print(f"{len(table)} steps in {directory / 'evaluated.csv'}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("probes", type=pathlib.Path)
    args = parser.parse_args()
    try:
        read = yaml.safe_load(args.probes.read_text())
        if not isinstance(read, dict) or not isinstance(read.get("probes"), list) or set(read) != {"probes"}:
            raise Mistake("allowed: one key, probes, with a list")
        evaluate(args.directory, read["probes"])
    except (Mistake, OSError, yaml.YAMLError, TypeError, ValueError, KeyError) as error:
        sys.exit(f"burnish: {args.probes}: {error} [B100]")


if __name__ == "__main__":
    main()
