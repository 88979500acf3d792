"""CalculiX 2.20 (Debian's calculix-ccx) on the mesh and with the law of a plastic scene, for the references of
tests/scenes/necking.py and plastic_notch.py: the force at imposed displacements.
    plastic_calculix.py RESULTS --kind CAX8R --young 200e3 --nu 0.3 --plastic "451 0 476 0.006 ..." \\
        --fix "y 0 2" --fix "x 0 1" --pull "y 26.667 2 7" [--small] [--increment 0.02] [--watch "6.297566 0"]
RESULTS is the directory of a finished run of Burnish, whose mesh is taken; a fix names a coordinate, its value and the
direction that is held there, a pull the displacement besides. Forces of axisymmetric models are those of the whole
circumference."""
import argparse
import pathlib
import subprocess

import h5py
import numpy

CELLS = {"CAX4": ("quad4", 4), "CAX4R": ("quad4", 4), "CAX8": ("quad9", 8), "CAX8R": ("quad9", 8),
         "CPE4": ("quad4", 4), "CPE8": ("quad9", 8), "CPE8R": ("quad9", 8), "C3D8": ("hex8", 8), "CAX6": ("tri6", 6),
         "C3D20R": ("hex27", 20)}

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("results", type=pathlib.Path)
parser.add_argument("--kind", choices=CELLS, required=True)
parser.add_argument("--young", type=float, required=True)
parser.add_argument("--nu", type=float, required=True)
parser.add_argument("--plastic", required=True)
parser.add_argument("--fix", action="append", default=[])
parser.add_argument("--pull", required=True)
parser.add_argument("--watch")
parser.add_argument("--small", action="store_true")
parser.add_argument("--increment", type=float, default=0.02)
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/calculix"))
args = parser.parse_args()

name, corners = CELLS[args.kind]
with h5py.File(args.results / "results.h5", "r") as file:
    nodes, cells = file["mesh/nodes"][()], file[f"mesh/cells_{name}"][()][:, :corners]


def at(coordinate, value):
    hit = numpy.abs(nodes[:, "xyz".index(coordinate)] - float(value)) < 1e-6 * numpy.ptp(nodes)
    return sorted(set(numpy.flatnonzero(hit)) & set(cells.ravel()))


def write_set(lines, label, numbers):
    lines += [f"*NSET, NSET={label}", *(f"{number + 1}," for number in numbers)]


used = sorted(set(cells.ravel()))
deck = ["*NODE", *(f"{k + 1}, {', '.join(repr(float(x)) for x in nodes[k])}" for k in used)]
deck.append(f"*ELEMENT, TYPE={args.kind}, ELSET=body")
for number, cell in enumerate(cells):
    words = [str(number + 1), *(str(k + 1) for k in cell)]
    deck += [", ".join(words[:16]) + ("," if len(words) > 16 else ""), *([", ".join(words[16:])] * (len(words) > 16))]
points = numpy.reshape([float(word) for word in args.plastic.split()], (-1, 2))
deck += ["*MATERIAL, NAME=steel", "*ELASTIC", f"{args.young}, {args.nu}", "*PLASTIC",
         *(f"{stress}, {strain}" for stress, strain in points), "*SOLID SECTION, ELSET=body, MATERIAL=steel",
         *(["1."] if args.kind[:3] == "CPE" else [])]
for number, fix in enumerate(args.fix):
    coordinate, value, direction = fix.split()
    write_set(deck, f"fix{number}", at(coordinate, value))
    deck += ["*BOUNDARY", f"fix{number}, {direction}, {direction}"]
coordinate, value, direction, way = args.pull.split()
write_set(deck, "pull", at(coordinate, value))
if args.watch:
    point = [float(word) for word in args.watch.split()]
    write_set(deck, "watch", [min(used, key=lambda k: numpy.sum((nodes[k, :len(point)] - point)**2))])
deck += [f"*STEP{'' if args.small else ', NLGEOM'}, INC=100000", "*STATIC", f"{args.increment}, 1, 1e-6, {args.increment}", "*BOUNDARY",
         f"pull, {direction}, {direction}, {way}", "*NODE PRINT, NSET=pull, FREQUENCY=1, TOTALS=ONLY", "RF"]
deck += ["*NODE PRINT, NSET=watch, FREQUENCY=1", "U"] * bool(args.watch) + ["*END STEP"]
args.out.mkdir(parents=True, exist_ok=True)
(args.out / "plastic.inp").write_text("\n".join(deck) + "\n")
finished = subprocess.run(["ccx", "-i", "plastic"], cwd=args.out, capture_output=True, text=True)
(args.out / "plastic.log").write_text(finished.stdout)
time, way, row = None, float(way), {}
for line in (args.out / "plastic.dat").read_text().splitlines():
    words = line.split()
    if "time" in words:
        time, what = float(words[-1]), words[0]
        row.setdefault(time, {})["force" if what == "total" else "watch"] = None
    elif words:
        key = "force" if what == "total" else "watch"
        row[time][key] = [float(word) for word in words[-3:]]
for time, values in row.items():
    print(f"{time * way:.6g}", *values["force"], *values.get("watch", []))
print(finished.stdout.splitlines()[-2:] if finished.returncode else "")
