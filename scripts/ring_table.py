"""Shrink-fitted rings and spheres: how far the contact pressure is from its mean, by smoother, mesh pair, slave side and jitter.
Runs the scenes, leaves one record per run in out/rings.csv and prints the tables; --print tables an existing file.
    python scripts/ring_table.py [plane] [jitter] [solid] [spheres]"""
import argparse
import csv
import json
import os
import pathlib
import shutil
import statistics
import subprocess

from launch import command, environment, read_summary

ROOT = pathlib.Path(__file__).resolve().parent.parent
LAME = {"ring_in_ring": 6.439, "ring_in_ring_3d": 5.859, "spheres": 15.224}
SMOOTHERS = {
    "facets": ["contact.0.smoother=facet"],
    "degree 2, 2.6, 3": ["contact.0.degree=2", "contact.0.support=2.6", "contact.0.weight=3"],
    "degree 2": ["contact.0.degree=2"],
    "degree 4": ["contact.0.degree=4"],
}
SIDES = ("inner", "outer")
PLANE_PAIRS = ((16, 20), (32, 40), (40, 32), (24, 48), (48, 24), (24, 30), (30, 24), (36, 25))
PROBES = ("mean_pressure", "noise_max", "noise_rms", "noise_end_max", "noise_end_rms")
COLUMNS = ("table", "scene", "n_inner", "n_outer", "slave", "smoother", "jitter", "seed", "status", "newton", "contact_nodes", "slave_nodes", "wall_s", "fall_backs", *PROBES)


def cases(table):
    """Every (scene, pair, slave, smoother, jitter, seed) of a table."""
    if table == "plane":
        return [("ring_in_ring", pair, slave, smoother, 0, 1) for pair in PLANE_PAIRS for slave in SIDES for smoother in SMOOTHERS]
    if table == "jitter":
        return [("ring_in_ring", pair, slave, smoother, jitter, seed) for pair in ((24, 30), (24, 48)) for slave in SIDES
                for smoother in ("facets", "degree 2", "degree 4") for jitter in (0.125, 0.25) for seed in (1, 2, 3)]
    scene, pairs = ("ring_in_ring_3d", ((24, 30), (30, 24))) if table == "solid" else ("spheres", ((10, 12),))
    return [(scene, pair, slave, smoother, jitter, seed) for smoother in ("degree 4", "degree 2", "facets") for jitter in (0, 0.125, 0.25)
            for seed in ((1, 2) if jitter and smoother == "degree 4" else (1,)) for pair in pairs for slave in SIDES]


def solve(table, case, burnish, ranks, out):
    scene, (n_inner, n_outer), slave, smoother, jitter, seed = case
    directory = out / f"rings-{table}-{os.getpid()}"
    shutil.rmtree(directory, ignore_errors=True)
    master = SIDES[1 - SIDES.index(slave)]
    overrides = [f"mesh.parameters.n_inner={n_inner}", f"mesh.parameters.n_outer={n_outer}", f"mesh.parameters.jitter={jitter}", f"mesh.parameters.seed={seed}",
                 f"contact.0.slave={slave}_contact", f"contact.0.master={master}_contact", *SMOOTHERS[smoother]]
    line = command(burnish, ranks, ROOT / "runs" / f"{scene}.yaml", directory, overrides, "-quiet")
    finished = subprocess.run(line, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    record = dict(zip(COLUMNS, (table, scene, n_inner, n_outer, slave, smoother, jitter, seed, finished.returncode)))
    if finished.returncode == 0:
        summary = read_summary(directory)
        n = n_inner if slave == "inner" else n_outer
        rows = round(8 * n / min(n_inner, n_outer)) + 1
        slave_nodes = {"ring_in_ring": n + 1, "ring_in_ring_3d": (n + 1) * rows, "spheres": 3 * n * n + 3 * n + 1}[scene]
        record.update(newton=summary["newton_iterations"], contact_nodes=summary["contact_nodes"], slave_nodes=slave_nodes, wall_s=round(summary["wall_s"], 2),
                      fall_backs=json.dumps(summary["contact"][0].get("fall_backs")))
        record.update({name: value for name, value in summary["probes"].items() if name in PROBES})
    else:
        print(finished.stdout)
    shutil.rmtree(directory, ignore_errors=True)
    return record


def number(record, name):
    return float(record[name]) if record.get(name) not in (None, "") else float("nan")


def worst(records, name):
    return max((number(r, name) for r in records), default=float("nan"))


def figure(value):
    return "-" if value != value else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def print_plane(records):
    print("\nPlane strain, structured: largest deviation from the mean, per cent (share of slave nodes in contact where not all)\n")
    print("| inner/outer | slave | " + " | ".join(SMOOTHERS) + " | mean, degree 4 |\n|" + " --- |" * (len(SMOOTHERS) + 3))
    for pair in PLANE_PAIRS:
        for slave in SIDES:
            cells, mean = [], "-"
            for smoother in SMOOTHERS:
                found = [r for r in records if (int(r["n_inner"]), int(r["n_outer"])) == pair and r["slave"] == slave and r["smoother"] == smoother and r["newton"] not in (None, "")]
                if not found:
                    cells.append("-")
                    continue
                share = number(found[0], "contact_nodes") / number(found[0], "slave_nodes")
                cells.append(figure(number(found[0], "noise_max")) + (f" ({100 * share:.0f} %)" if share < 1 else ""))
                mean = f"{number(found[0], 'mean_pressure'):.4f}" if smoother == "degree 4" else mean
            print(f"| {pair[0]}/{pair[1]} | {slave} | " + " | ".join(cells) + f" | {mean} |")


def print_worst(title, records, ends):
    """Largest (rms) over all seeds, pairs and slave sides of one kind, by smoother and jitter."""
    print(f"\n{title}: largest (rms) deviation, per cent, worst of all runs of the row\n")
    print("| smoother | slave | jitter | runs | all | " + ("free end | " if ends else "") + "mean pressure | iterations |\n|" + " --- |" * (8 if ends else 7))
    for smoother in SMOOTHERS:
        kinds = sorted({"coarser" if (int(r["n_inner"]) < int(r["n_outer"])) == (r["slave"] == "inner") else "finer" for r in records if r["smoother"] == smoother})
        for kind in kinds:
            for jitter in sorted({float(r["jitter"]) for r in records}):
                found = [r for r in records if r["smoother"] == smoother and float(r["jitter"]) == jitter and r["newton"] not in (None, "")
                         and ("coarser" if (int(r["n_inner"]) < int(r["n_outer"])) == (r["slave"] == "inner") else "finer") == kind]
                if not found:
                    continue
                means = [number(r, "mean_pressure") for r in found]
                end = f"{figure(worst(found, 'noise_end_max'))} ({figure(worst(found, 'noise_end_rms'))}) | " if ends else ""
                print(f"| {smoother} | {kind} | {jitter:g} | {len(found)} | {figure(worst(found, 'noise_max'))} ({figure(worst(found, 'noise_rms'))}) | {end}"
                      f"{min(means):.4f} to {max(means):.4f} (Lame {LAME[found[0]['scene']]}) | {statistics.median(int(r['newton']) for r in found):.0f} |")


def print_tables(records):
    by_table = {name: [r for r in records if r["table"] == name] for name in ("plane", "jitter", "solid", "spheres")}
    if by_table["plane"]:
        print_plane(by_table["plane"])
    for name, title in (("jitter", "Plane strain, jittered"), ("solid", "Rings, eight elements long (all: farther than two faces from the free end)"), ("spheres", "Spheres")):
        if by_table[name]:
            print_worst(title, by_table[name], name == "solid")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", choices=[[], "plane", "jitter", "solid", "spheres"], help="which; default: all")
    parser.add_argument("--burnish", default=str(ROOT / "build/burnish"))
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out")
    parser.add_argument("--print", dest="only_print", action="store_true", help="of the file that is there; runs nothing")
    args = parser.parse_args()
    args.out.mkdir(exist_ok=True)
    path = args.out / "rings.csv"
    if not args.only_print:
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            for table in args.tables or ("plane", "jitter", "solid", "spheres"):
                for case in cases(table):
                    writer.writerow(solve(table, case, args.burnish, args.ranks, args.out))
                    file.flush()
    with open(path, newline="") as file:
        print_tables(list(csv.DictReader(file)))


main()
