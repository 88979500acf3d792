"""Shrink-fitted rings and spheres: how far the contact pressure is from its mean, by smoother, formulation, order, mesh
pair, slave side and jitter. Runs the scenes, leaves one record per run and prints the tables; --print tables an
existing record.
    python scripts/ring_table.py [--record FILE] [--jobs N] [--print] [TABLE ...]
plane      smoothers, node to surface, structured meshes in the plane        (runs/records/rings.csv) plane12    the
three formulations, both orders, jittered meshes in the plane (this and the rest: runs/records/formulations.csv)
matching   meshes whose nodes face each other, beside the rings tied         (what the elements themselves leave) solid
rings in 3D, 14 elements long, away from the free end and near it spheres    concentric spheres offsets    surface to
surface, offsets held and live, in the plane and in 3D       (runs/records/offsets.csv)"""
import json
import shutil
import statistics
import subprocess

import ring_floor
from launch import ROOT, environment, read_records, table_parser, write_records

LAME = {"ring_in_ring": 6.439, "ring_in_ring_3d": 5.859, "spheres": 15.224}
METHODS = {
    "facets": ["contact.0.smoother=facet", "contact.0.formulation=node_to_surface"],
    "degree 2, 2.6, 3":
    ["contact.0.formulation=node_to_surface", "contact.0.degree=2", "contact.0.support=2.6", "contact.0.weight=3"],
    "degree 2": ["contact.0.formulation=node_to_surface", "contact.0.degree=2"],
    "degree 4": ["contact.0.formulation=node_to_surface", "contact.0.degree=4"],
    "surface to surface": ["contact.0.formulation=surface_to_surface"],
    "live": ["contact.0.formulation=surface_to_surface", "contact.0.offset=live"],
}
SMOOTHERS = ("facets", "degree 2, 2.6, 3", "degree 2", "degree 4")
FORMULATIONS = ("facets", "degree 4", "surface to surface")
OFFSETS = ("surface to surface", "live")
HEADS = {
    "facets": "facets",
    "degree 4": "node to surface",
    "surface to surface": "surface to surface",
    "tied": "tied",
    "live": "with live offsets"
}
SIDES = ("inner", "outer")
PLANE_PAIRS = ((16, 20), (32, 40), (40, 32), (24, 48), (48, 24), (24, 30), (30, 24), (36, 25))
ORDER_PAIRS = {1: ((24, 30), (30, 24), (24, 48)), 2: ((12, 15), (15, 12), (12, 24))}
SPHERE_PAIRS = ((1, (10, 12)), (2, (5, 6)), (2, (8, 10)))  # the first two with as many nodes
LENGTH, END = 14, 6  # face sizes: of the rings in 3D, and how far the free end counts
PROBES = ("mean_pressure", "noise_max", "noise_rms", "noise_end_max", "noise_end_rms")
COLUMNS = ("table", "scene", "n_inner", "n_outer", "slave", "smoother", "jitter", "seed", "status", "newton",
           "contact_nodes", "slave_nodes", "wall_s", "fall_backs", *PROBES, "order", "cpu_s")
TABLES = ("plane", "plane12", "matching", "solid", "spheres", "offsets")


def seeds(jitter):
    return (1, 2) if jitter else (1,)


def cases(table):
    """Every (scene, order, pair, slave, method, jitter, seed) of a table."""
    jitters = (0, 0.125, 0.25)
    if table == "plane":
        return [("ring_in_ring", 1, pair, slave, smoother, 0, 1)
                for pair in PLANE_PAIRS
                for slave in SIDES
                for smoother in SMOOTHERS]
    if table == "plane12":
        return [("ring_in_ring", order, pair, slave, method, jitter, seed)
                for order in (1, 2)
                for pair in ORDER_PAIRS[order]
                for slave in SIDES
                for method in FORMULATIONS
                for jitter in jitters
                for seed in seeds(jitter)]
    if table == "offsets":
        plane = [
            case[:4] + (method,) + case[5:] for case in cases("plane12") if case[4] == "surface to surface"
            for method in OFFSETS
        ]
        return plane + [("ring_in_ring_3d", 1, (24, 30), slave, method, jitter, 1)
                        for slave in SIDES
                        for method in OFFSETS
                        for jitter in (0, 0.25)]
    if table == "matching":
        return [("ring_in_ring", order, (n, n), "inner", method, jitter, seed)
                for order, n in ((1, 24), (2, 12))
                for method in FORMULATIONS
                for jitter in jitters
                for seed in seeds(jitter)]
    if table == "solid":
        solid = [("ring_in_ring_3d", 1, pair, slave, method, jitter, 1)
                 for pair in ((24, 30), (30, 24))
                 for slave in SIDES
                 for method in FORMULATIONS
                 for jitter in (0, 0.25)]
        solid += [("ring_in_ring_3d", 2, (12, 15), slave, method, jitter, 1)
                  for slave in SIDES
                  for method in FORMULATIONS
                  for jitter in (0, 0.25)]
    else:
        solid = [("spheres", order, pair, slave, method, jitter, 1)
                 for order, pair in SPHERE_PAIRS
                 for slave in SIDES
                 for method in FORMULATIONS
                 for jitter in jitters]
    return [case for case in solid
            if case[4] != "facets" or case[1] == 1 and not case[5]]  # facets: hundreds of per cent, in many iterations


def overrides(table, scene, order, pair, slave, method, jitter, seed):
    master = SIDES[1 - SIDES.index(slave)]
    values = [
        f"mesh.order={order}", f"mesh.parameters.n_inner={pair[0]}", f"mesh.parameters.n_outer={pair[1]}",
        f"mesh.parameters.jitter={jitter}", f"mesh.parameters.seed={seed}", f"contact.0.slave={slave}_contact",
        f"contact.0.master={master}_contact", *METHODS[method]
    ]
    if table == "matching":
        values.append("mesh.parameters.matching=1")
    if scene == "ring_in_ring_3d":
        values += [
            f"mesh.parameters.n_len={LENGTH // order}", f"mesh.parameters.rows={order - 1}",
            *(f"probes.{probe}.{key}={END // order}" for probe, key in ((1, "excluding"), (2, "excluding"), (3, "only"),
                                                                        (4, "only")))
        ]
    return values


def nodes_of_slave(scene, order, pair, slave):
    n = order * pair[SIDES.index(slave)]
    rows = order * round(LENGTH // order * n / order / min(pair)) + 1
    return {"ring_in_ring": n + 1, "ring_in_ring_3d": (n + 1) * rows, "spheres": 3 * n * n + 3 * n + 1}[scene]


def solve(table, case, args):
    """One run as a record; matching: a second record with the rings tied."""
    scene, order, pair, slave, method, jitter, seed = case
    directory = args.out / "-".join(
        str(v) for v in (table, scene, order, *pair, slave, method.replace(" ", "_"), jitter, seed))
    shutil.rmtree(directory, ignore_errors=True)
    command = ["mpirun", "-n", str(args.ranks)] if args.ranks > 1 else []
    command += [args.burnish, str(ROOT / "runs" / f"{scene}.yaml"), "-o", str(directory), "-quiet"]
    for override in overrides(table, *case):
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    record = dict(zip(COLUMNS, (table, scene, *pair, slave, method, jitter, seed, finished.returncode)), order=order)
    records = [record]
    if finished.returncode == 0:
        summary = json.loads((directory / "summary.json").read_text())
        record.update(newton=summary["newton_iterations"], contact_nodes=summary["contact_nodes"],
                      slave_nodes=nodes_of_slave(scene, order, pair, slave), wall_s=round(summary["wall_s"], 2),
                      cpu_s=round(summary["cpu_s"], 2), fall_backs=json.dumps(summary["contact"][0].get("fall_backs")))
        record.update({
            name: f"{value:.6g}"
            for name, value in summary["probes"].items()
            if name in PROBES and value is not None
        })
        if table == "matching" and method == "surface to surface":
            tied = {name: f"{value:.6g}" for name, value in ring_floor.floor(directory).items()}
            records.append({
                **{
                    name: record[name]
                    for name in ("table", "scene", "n_inner", "n_outer", "slave", "jitter", "seed", "order")
                }, "smoother": "tied",
                "status": 0,
                **tied
            })
    else:
        print(case, finished.stdout)
    shutil.rmtree(directory, ignore_errors=True)
    return records


def number(record, name):
    return float(record[name]) if record.get(name) not in (None, "") else float("nan")


def worst(records, name):
    return max((number(r, name) for r in records), default=float("nan"))


def figure(value):
    return "-" if value != value else "0.00" if value < 0.005 else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def ended(records):
    return [r for r in records if r["status"] == "0"]


def print_plane(records):
    print(
        "\nPlane strain, structured, node to surface: largest deviation from the mean, per cent (share of slave nodes "
        "in contact where not all)\n"
    )
    print("| inner/outer | slave | " + " | ".join(SMOOTHERS) + " | mean, degree 4 |\n|" + " --- |" *
          (len(SMOOTHERS) + 3))
    for pair in PLANE_PAIRS:
        for slave in SIDES:
            cells, mean = [], "-"
            for smoother in SMOOTHERS:
                found = [
                    r for r in ended(records)
                    if (int(r["n_inner"]),
                        int(r["n_outer"])) == pair and r["slave"] == slave and r["smoother"] == smoother
                ]
                if not found:
                    cells.append("-")
                    continue
                share = number(found[0], "contact_nodes") / number(found[0], "slave_nodes")
                cells.append(figure(number(found[0], "noise_max")) + (f" ({100 * share:.0f} %)" if share < 1 else ""))
                mean = f"{number(found[0], 'mean_pressure'):.4f}" if smoother == "degree 4" else mean
            print(f"| {pair[0]}/{pair[1]} | {slave} | " + " | ".join(cells) + f" | {mean} |")


def print_worst(title, records, methods):
    """Largest (rms) over all seeds, pairs and slave sides, by order and jitter; how many runs failed, where some
    did."""
    ends = any(number(r, "noise_end_rms") == number(r, "noise_end_rms") for r in records)
    print(f"\n{title}: largest (rms) deviation from the mean, per cent, worst of the runs of the row" +
          ("; free end, rms" if ends else "") + f"; Lame {LAME[records[0]['scene']]}\n")
    print("| order | jitter | runs | " + " | ".join(HEADS[m] for m in methods) +
          " | mean pressure, surface to surface |\n|" + " --- |" * (len(methods) + 4))
    for order in sorted({r["order"] for r in records}):
        for jitter in sorted({float(r["jitter"]) for r in records if r["order"] == order}):
            row = [r for r in records if r["order"] == order and float(r["jitter"]) == jitter]
            cells = []
            for method in methods:
                runs = [r for r in row if r["smoother"] == method]
                found = ended(runs)
                cell = f"{figure(worst(found, 'noise_max'))} ({figure(worst(found, 'noise_rms'))})" + (
                    f"; {figure(worst(found, 'noise_end_rms'))}" if ends else "")
                cells.append(cell + (f", {len(runs) - len(found)} failed" if len(found) < len(runs) else ""))
            means = [number(r, "mean_pressure") for r in ended(row) if r["smoother"] == "surface to surface"]
            print(f"| {order} | {100 * jitter:g} % | {len([r for r in row if r['smoother'] == methods[-1]])} | " +
                  " | ".join(cells) + f" | {min(means):.4f} to {max(means):.4f} |")
    for name, text, places in (("newton", "Newton iterations", 0), ("cpu_s", "CPU seconds", 2)):
        medians = {
            HEADS[m]: statistics.median(number(r, name)
                                        for r in ended(records)
                                        if r["smoother"] == m)
            for m in methods
            if m != "tied"
        }
        if not any(value != value for value in medians.values()):
            print(f"\nmedian {text}: " + ", ".join(f"{head} {value:.{places}f}" for head, value in medians.items()))


def print_tables(records):
    titles = {
        "plane12": "Plane strain",
        "matching": "Plane strain, nodes facing each other",
        "solid": f"Rings, {LENGTH} faces long, farther than {END} faces from the free end"
    }
    plane = [r for r in records if r["table"] == "plane"]
    if plane:
        print_plane(plane)
    for name, title in titles.items():
        found = [r for r in records if r["table"] == name]
        if found:
            print_worst(title, found, (*FORMULATIONS, "tied") if name == "matching" else FORMULATIONS)
    for _, pair in SPHERE_PAIRS:
        found = [r for r in records if r["table"] == "spheres" and (int(r["n_inner"]), int(r["n_outer"])) == pair]
        if found:
            print_worst(f"Spheres, {pair[0]}/{pair[1]}", found,
                        [m for m in FORMULATIONS if any(r["smoother"] == m for r in found)])
    for scene in ("ring_in_ring", "ring_in_ring_3d"):
        found = [r for r in records if r["table"] == "offsets" and r["scene"] == scene]
        if found:
            print_worst(titles["plane12" if scene == "ring_in_ring" else "solid"] + ", offsets", found, OFFSETS)


def main():
    parser = table_parser(__doc__, "rings")
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"of {', '.join(TABLES)}; default: all")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    args = parser.parse_args()
    unknown = [name for name in args.tables if name not in TABLES]
    if unknown:
        parser.error(f"no table {unknown[0]}; there are {', '.join(TABLES)}")
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        work = [(table, case) for table in args.tables or TABLES for case in cases(table)]
        write_records(args.record, COLUMNS, lambda entry: solve(*entry, args), work, args.jobs)
    print_tables(read_records(args.record))


if __name__ == "__main__":
    main()
