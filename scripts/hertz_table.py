"""Hertz's line and point contact on series of meshes, node to surface and surface to surface: contact width and peak pressure against the closed form.
Runs the scenes, leaves one record per run and prints the table; --print tables an existing record.
    python scripts/hertz_table.py [--burnish BINARY] [--record FILE] [--jobs N] [--print] [line] [sphere]
Width from the pressure itself: where the half-ellipse through the nodes of the inner part ends (p^2 is linear in r^2), beside the probe's edge."""
import argparse
import csv
import json
import shutil
import subprocess
import pathlib

import h5py
import numpy

from launch import environment, write_records

ROOT = pathlib.Path(__file__).resolve().parent.parent
INNER = 0.8  # the part of the contact zone that the ellipse is fitted to
SCENES = {  # pair, exact width and pressure, mesh parameter and its values by order, its probe of the width
    "line": ("line", 6.215, 3585.4, "h", {1: (1.6, 0.8, 0.4, 0.2), 2: (3.2, 1.6, 0.8, 0.4)}, "half_width"),
    "sphere": ("point", 1.0, 734.6, "n", {1: (3, 4, 6, 8)}, "radius"),
}
FORMULATIONS = ("node_to_surface", "surface_to_surface")
COLUMNS = ("scene", "order", "mesh", "formulation", "status", "elements", "iterations", "wall_s", "edge", "width", "peak", "fitted_peak")


def ellipse(directory, pair, width):
    """Peak and end of the half-ellipse through the pressures of the inner nodes."""
    with h5py.File(directory / "results.h5", "r") as file:
        nodes = file["mesh/nodes"][()][file["contact"][pair]["nodes"][()]]
        pressure = file["steps"][sorted(file["steps"])[-1]]["contact"][pair]["pressure"][()]
    r = numpy.hypot(nodes[:, 0], nodes[:, 2])
    inner = (pressure > 0) & (r < INNER * width)
    slope, top = numpy.polyfit(r[inner] ** 2, pressure[inner] ** 2, 1)
    return numpy.sqrt(-top / slope), numpy.sqrt(top)


def solve(case, args):
    scene, order, mesh, formulation = case
    pair, width, _, parameter, _, probe = SCENES[scene]
    directory = args.out / "-".join(str(v) for v in case)
    shutil.rmtree(directory, ignore_errors=True)
    command = [args.burnish, str(ROOT / "runs" / f"hertz_{scene}.yaml"), "-o", str(directory), "-quiet"]
    for override in (f"mesh.order={order}", f"mesh.parameters.{parameter}={mesh}", f"contact.0.formulation={formulation}"):
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    record = dict(zip(COLUMNS, (*case, finished.returncode)))
    if finished.returncode == 0:
        summary = json.loads((directory / "summary.json").read_text())
        end, top = ellipse(directory, pair, width)
        record.update(elements=summary["elements"], iterations=summary["newton_iterations"], wall_s=round(summary["wall_s"], 2), edge=summary["probes"][probe],
                      peak=summary["probes"]["peak_pressure"], width=f"{end:.6g}", fitted_peak=f"{top:.6g}")
    else:
        print(case, finished.stdout)
    shutil.rmtree(directory, ignore_errors=True)
    return record


def print_table(records):
    print("Error against Hertz, per cent: end of the contact by the probe; width and peak of the half-ellipse through the inner pressures; peak pressure\n")
    print("| scene | order | mesh | elements | node to surface: edge, width, peak, largest | surface to surface | iterations |\n|" + " --- |" * 7)
    for key in dict.fromkeys((r["scene"], r["order"], r["mesh"]) for r in records):
        found = {r["formulation"]: r for r in records if (r["scene"], r["order"], r["mesh"]) == key and r["status"] == "0"}
        _, width, peak, *_ = SCENES[key[0]]
        cells = []
        for formulation in FORMULATIONS:
            r = found.get(formulation)
            values = [(r["edge"], width), (r["width"], width), (r["fitted_peak"], peak), (r["peak"], peak)] if r else []
            cells.append(", ".join(f"{100 * (float(v) / exact - 1):+.2f}" for v, exact in values) or "-")
        some = next(iter(found.values()), {"elements": "-"})
        print(f"| {key[0]} | {key[1]} | {key[2]} | {some['elements']} | {cells[0]} | {cells[1]} | {' / '.join(found[f]['iterations'] if f in found else '-' for f in FORMULATIONS)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of {', '.join(SCENES)}; default: both")
    parser.add_argument("--burnish", default=str(ROOT / "build/burnish"))
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/hertz")
    parser.add_argument("--record", type=pathlib.Path, default=ROOT / "out/hertz.csv")
    parser.add_argument("--print", dest="only_print", action="store_true", help="of the record that is there; runs nothing")
    args = parser.parse_args()
    cases = [(scene, order, mesh, formulation) for scene in args.scenes or SCENES for order, meshes in SCENES[scene][4].items() for mesh in meshes for formulation in FORMULATIONS]
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda case: [solve(case, args)], cases, args.jobs)
    with open(args.record, newline="") as file:
        print_table(list(csv.DictReader(file)))


if __name__ == "__main__":
    main()
