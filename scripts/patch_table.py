"""Contact patch test in 3D (runs/patch_blocks.yaml): by how much the slave nodes' pressure and the stress in the
elements next to the interface differ from the load, which is exact everywhere. Runs formulations, elements, mesh pairs,
jitters and strains, leaves one record per run and prints the tables; --print tables an existing record. The way is
`pair`, slave and master by name; `symmetric`, both surfaces in one list, each the other's slave with half weight; or
`augmented`, the same with multipliers until no node is beyond 1e-7 of the nodes' spacing.
    python scripts/patch_table.py [--burnish BINARY] [--jobs N] [--record FILE]
Stress is the one along y in the elements that have a face on the interface, from the displacements in results.h5: the
mean over an element's quadrature points, and in the record also the largest over the points themselves."""
import functools
import itertools
import json
import re
import shutil
import subprocess

import h5py
import numpy

from launch import ROOT, environment, read_records, table_parser, write_records

SCENE = ROOT / "runs/patch_blocks.yaml"
E, NU = 1000, 0.3
STRAINS = {"small": (1.0, ["kinematics=small", "stepping.initial=1"]), "finite": (193.846153846, [])}  # load, how
FORMS = {
    "bricks": (0, 0),
    "tetrahedra": (1, 1),
    "gmsh triangles/bricks": (2, 0),
    "bricks/gmsh triangles": (0, 2)
}  # master/slave: parameters lower, upper
PAIRS = {
    1: ((12, 15), (15, 12), (12, 24), (24, 12)),
    2: ((6, 7), (7, 6), (6, 12), (12, 6))
}  # faces per side, master/slave
FORMULATIONS = ("node_to_surface", "surface_to_surface")
# What a list of surfaces has besides the settings of the scene's pair, and more of its penalty. A pair is the scene's.
WAYS = {"pair": None, "symmetric": "", "augmented": ", augment: true, g_max: 1e-7, unit: spacing"}
LIST = ("contact=[{{name: joint, surfaces: [upper_bottom, lower_top], smoother: diffuse, formulation: {}, symmetry: "
        "[wall_x_low, wall_x_high, wall_z_low, wall_z_high], penalty: {{initial: auto, scale: 100{}}}}}]")
SIDES = ("joint", "joint.upper_bottom.lower_top", "joint.lower_top.upper_bottom")  # of a pair; of a list
COLUMNS = ("strain", "elements", "order", "master", "slave", "jitter", "formulation", "way", "status", "iterations",
           "fall_backs", "wall_s", "pressure_max", "pressure_rms", "stress_master", "stress_slave", "point_master",
           "point_slave")
CORNERS = {"tet": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
           "hex": [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]}
EDGES = {"tet": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],  # XDMF's order
         "hex": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}
FACES = [(0, 3, 4, 7), (1, 2, 5, 6), (0, 1, 4, 5), (2, 3, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7)]


@functools.cache
def derivatives(element):
    """Derivatives of the shape functions at the element's quadrature points: points x 3 x nodes. From the monomials
    that span them."""
    kind, order = element[:3], 1 if element in ("tet4", "hex8") else 2
    corners = numpy.array(CORNERS[kind], dtype=float)
    nodes = list(corners)
    if order == 2:
        nodes += [corners[list(edge)].mean(axis=0) for edge in EDGES[kind]]
        nodes += [corners[list(face)].mean(axis=0) for face in FACES] + [corners.mean(axis=0)] if kind == "hex" else []
    powers = [p for p in itertools.product(range(order + 1), repeat=3) if kind == "hex" or sum(p) <= order]
    coefficients = numpy.linalg.inv([[numpy.prod(x ** numpy.array(p)) for p in powers] for x in nodes])
    line = {1: (-1, 1), 2: (-1, 0, 1)}[order]
    if kind == "hex":
        points = [numpy.array(p) * (3 ** -0.5 if order == 1 else 0.6 ** 0.5) for p in itertools.product(line, repeat=3)]
    else:
        a, b = 0.1381966011250105, 0.5854101966249685
        points = [numpy.full(3, 0.25)
                  ] if order == 1 else [numpy.array(p) for p in ((a, a, a), (b, a, a), (a, b, a), (a, a, b))]

    def slope(p, x, d):
        q = list(p)
        q[d] -= 1
        return p[d] * numpy.prod(x ** numpy.array(q)) if p[d] else 0

    return numpy.array([[[slope(p, x, d)
                          for d in range(3)]
                         for p in powers]
                        for x in points]).transpose(0, 2, 1) @ coefficients


def cauchy_yy(gradient, finite):
    """Stress along y from displacement gradients (..., 3, 3): St. Venant-Kirchhoff, or its linearisation."""
    lame, mu = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
    transposed = gradient.swapaxes(-1, -2)
    strain = (gradient + transposed + (transposed @ gradient if finite else 0)) / 2
    stress = lame * numpy.trace(strain, axis1=-2, axis2=-1)[..., None, None] * numpy.eye(3) + 2 * mu * strain
    if finite:
        F = gradient + numpy.eye(3)
        stress = F @ stress @ F.swapaxes(-1, -2) / numpy.linalg.det(F)[..., None, None]
    return stress[..., 1, 1]


def layer_stress(directory, finite):
    """Stress along y at the quadrature points of the elements with a face on the interface, a row for each: of the
    lower (master) and the upper body."""
    stresses = ([], [])
    with h5py.File(directory / "results.h5", "r") as file:
        nodes = file["mesh/nodes"][()]
        displacement = file["steps"][sorted(file["steps"])[-1]]["displacement"][()]
        for name in file["mesh"]:
            if not re.fullmatch(r"cells_[a-z]+\d+", name):
                continue
            cells, body = file["mesh"][name][()], file["mesh"][name + "_body"][()]
            slopes = derivatives(name.removeprefix("cells_"))
            corners = 4 if name.startswith("cells_tet") else 8
            on = numpy.sum(numpy.abs(nodes[cells[:, :corners], 1]) < 1e-9, axis=1) == (3 if corners == 4 else 4)
            for b in (0, 1):
                chosen = cells[on & (body == b)]
                jacobian = numpy.einsum("pdn,enk->epkd", slopes, nodes[chosen])
                gradient = numpy.einsum("pdn,enk->epkd", slopes, displacement[chosen]) @ numpy.linalg.inv(jacobian)
                if len(chosen):
                    stresses[b].append(cauchy_yy(gradient, finite))
    return [numpy.concatenate(s) for s in stresses]  # one type of element in each body


def overrides(strain, elements, order, pair, jitter, formulation, way):
    load, how = STRAINS[strain]
    lower, upper = FORMS[elements]
    contact = [f"contact.0.formulation={formulation}"]
    if way != "pair":
        contact = [LIST.format(formulation, WAYS[way]), "probes=[]"]
    return [
        f"mesh.order={order}", f"mesh.parameters.n_lower={pair[0]}", f"mesh.parameters.n_upper={pair[1]}",
        f"mesh.parameters.jitter={jitter}", f"mesh.parameters.lower={lower}", f"mesh.parameters.upper={upper}",
        f"loads.0.pressure={load}", *contact, *how
    ]


def deviations(directory, strain):
    """Largest and rms deviation of the slave nodes' pressure, on both sides where there are two, and largest of the
    elements' stress on both sides, from the load, in per cent."""
    load = STRAINS[strain][0]
    with h5py.File(directory / "results.h5", "r") as file:
        contact = file["steps"][sorted(file["steps"])[-1]]["contact"]
        pressure = numpy.concatenate([contact[side]["pressure"][()] for side in SIDES if side in contact])
    error = 100 * (pressure / load - 1)
    figures = {"pressure_max": numpy.max(numpy.abs(error)), "pressure_rms": numpy.sqrt(numpy.mean(error**2))}
    for side, stress in zip(("master", "slave"), layer_stress(directory, strain == "finite")):
        figures["stress_" + side] = 100 * numpy.max(numpy.abs(stress.mean(axis=1) / load + 1))
        figures["point_" + side] = 100 * numpy.max(numpy.abs(stress / load + 1))
    return figures


def cases():
    """Strain, elements, order, pair, jitter, formulation, way of every run."""
    jitters = (0, 0.125, 0.25)
    chosen = [("small", "bricks", order, pair, jitter, how)
              for order in (1, 2)
              for pair in PAIRS[order]
              for jitter in jitters
              for how in FORMULATIONS]
    chosen += [("small", "tetrahedra", order, pair, jitter, how)
               for order in (1, 2)
               for pair in PAIRS[order]
               for jitter in (0, 0.25)
               for how in FORMULATIONS]
    chosen += [("small", form, order, pair, 0, how)
               for form in list(FORMS)[2:]
               for order in (1, 2)
               for pair in PAIRS[order][:2]
               for how in FORMULATIONS]
    chosen += [("finite", "bricks", order, pair, 0.25, "surface_to_surface")
               for order in (1, 2)
               for pair in PAIRS[order]]
    chosen += [("finite", "tetrahedra", order, PAIRS[order][0], 0.25, "surface_to_surface") for order in (1, 2)]
    chosen = [(*case, "pair") for case in chosen]
    chosen += [("small", "bricks", order, pair, jitter, how, "symmetric")
               for order in (1, 2)
               for pair in PAIRS[order]
               for jitter in (0, 0.25)
               for how in FORMULATIONS]
    return chosen + [("small", "bricks", order, pair, 0.25, "surface_to_surface", "augmented")
                     for order in (1, 2)
                     for pair in PAIRS[order]]


def solve(case, args):
    strain, elements, order, pair, jitter, formulation, way = case
    directory = args.out / "-".join(
        str(v) for v in (strain, elements.replace(" ", "_").replace("/", "_"), order, *pair, jitter, formulation, way))
    shutil.rmtree(directory, ignore_errors=True)
    command = [args.burnish, str(SCENE), "-o", str(directory), "-quiet"]
    for override in overrides(*case):
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    record = dict(zip(COLUMNS, (strain, elements, order, *pair, jitter, formulation, way, finished.returncode)))
    if finished.returncode == 0:
        summary = json.loads((directory / "summary.json").read_text())
        record.update(iterations=summary["newton_iterations"],
                      fall_backs=json.dumps(sum(pair["fall_backs"] for pair in summary["contact"])), wall_s=round(summary["wall_s"], 2))
        record.update({name: f"{value:.4g}" for name, value in deviations(directory, strain).items()})
    else:
        print(case, finished.stdout)
    shutil.rmtree(directory, ignore_errors=True)
    return record


def figure(record, name):
    return "-" if not record or not record[name] else "0.00" if float(
        record[name]) < 0.005 else f"{float(record[name]):.2g}"


def print_tables(records):
    print(
        "Largest deviation from the load, per cent: pressure of the slave nodes; mean stress in the elements next to "
        "the interface, master / slave\n"
    )
    print(
        "| strain | elements | order | master/slave | jitter | way | node to surface | surface to surface | iterations |\n|" +
        " --- |" * 9)
    named = (*COLUMNS[:6], "way")
    keys = dict.fromkeys(tuple(r[name] for name in named) for r in records)
    for key in keys:
        found = {r["formulation"]: r for r in records if tuple(r[name] for name in named) == key}
        cells = [
            f"{figure(r, 'pressure_max')}; {figure(r, 'stress_master')} / {figure(r, 'stress_slave')}" if r else "-"
            for r in (found.get(name) for name in FORMULATIONS)
        ]
        iterations = " / ".join(found[name]["iterations"] if name in found else "-" for name in FORMULATIONS)
        print(
            f"| {key[0]} | {key[1]} | {key[2]} | {key[3]}/{key[4]} | {key[5]} | {key[6]} | {cells[0]} | {cells[1]} | {iterations} "
            "|"
        )


def main():
    parser = table_parser(__doc__, "patch")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    args = parser.parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda case: [solve(case, args)], cases(), args.jobs)
    print_tables(read_records(args.record))


if __name__ == "__main__":
    main()
