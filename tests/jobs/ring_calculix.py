"""CalculiX 2.20 (Debian's calculix-ccx) on the mesh and with the law of tests/scenes/ring_springback.yaml: surface to
surface penalty contact with a row of stiff elements as the plate, which comes down; then the contact is removed.
    ring_calculix.py RESULTS [--increment 0.02] [--stiffness 20]
RESULTS is the directory of a finished run of Burnish, whose mesh is taken. A line has the way of the plate, its force,
the displacements (x, y) of the ring's top and of its side."""
import argparse
import pathlib
import subprocess

import h5py
import numpy

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("results", type=pathlib.Path)
parser.add_argument("--increment", type=float, default=0.02)
parser.add_argument("--stiffness", type=float, default=20)
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/calculix"))
args = parser.parse_args()
YOUNG, OUTER, WAY, PLATE = 200e3, 50., 20., 60

with h5py.File(args.results / "results.h5", "r") as file:
    nodes, cells = file["mesh/nodes"][()], file["mesh/cells_quad9"][()][:, :8]
used = sorted(set(cells.ravel()))
deck = ["*NODE", *(f"{k + 1}, {', '.join(repr(float(x)) for x in nodes[k])}" for k in used)]
deck += ["*ELEMENT, TYPE=CPE8, ELSET=ring", *(f"{n + 1}, {', '.join(str(k + 1) for k in cell)}"
                                             for n, cell in enumerate(cells))]
radius = numpy.hypot(nodes[:, 0], nodes[:, 1])
deck.append("*SURFACE, NAME=skin")
for number, cell in enumerate(cells):
    for side, ends in enumerate(((0, 1), (1, 2), (2, 3), (3, 0))):
        if all(abs(radius[cell[end]] - OUTER) < 1e-6 * OUTER for end in ends):
            deck.append(f"{number + 1}, S{side + 1}")
first, block = len(nodes) + 1, len(cells) + 1
deck += ["*NODE", *(f"{first + i}, {-5 + 50 * (i // 2) / PLATE!r}, {(OUTER, OUTER + 2)[i % 2]!r}, 0"
                    for i in range(2 * PLATE + 2))]
deck += ["*ELEMENT, TYPE=CPE4, ELSET=plate",
         *(f"{block + i}, {first + 2 * i}, {first + 2 * i + 2}, {first + 2 * i + 3}, {first + 2 * i + 1}"
           for i in range(PLATE)), "*NSET, NSET=plate", *(f"{first + i}," for i in range(2 * PLATE + 2)),
         "*SURFACE, NAME=under", *(f"{block + i}, S1" for i in range(PLATE))]
deck += ["*MATERIAL, NAME=steel", "*ELASTIC", f"{YOUNG}, 0.3", "*PLASTIC", "300, 0", "1300, 1",
         "*SOLID SECTION, ELSET=ring, MATERIAL=steel", "1.", "*MATERIAL, NAME=stiff", "*ELASTIC", f"{YOUNG}, 0.3",
         "*SOLID SECTION, ELSET=plate, MATERIAL=stiff", "1.", "*SURFACE INTERACTION, NAME=law",
         "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", repr(args.stiffness * YOUNG),
         "*CONTACT PAIR, INTERACTION=law, TYPE=SURFACE TO SURFACE", "skin, under"]
for direction, label in ((1, "middle"), (2, "side")):
    deck += [f"*NSET, NSET={label}", *(f"{k + 1}," for k in used if abs(nodes[k, direction - 1]) < 1e-9),
             "*BOUNDARY", f"{label}, {direction}, {direction}"]
deck += ["*BOUNDARY", "plate, 1, 1"]
for label, point in (("top", (0, OUTER)), ("edge", (OUTER, 0))):
    deck += [f"*NSET, NSET={label}", f"{min(used, key=lambda k: numpy.sum((nodes[k, :2] - point)**2)) + 1},"]
for change in ([], ["*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE", "skin, under"]):
    deck += ["*STEP, NLGEOM, INC=100000", "*STATIC", f"{args.increment}, 1, 1e-7, {args.increment}", *change, "*BOUNDARY",
             f"plate, 2, 2, {-WAY}", "*NODE PRINT, NSET=plate, FREQUENCY=1, TOTALS=ONLY", "RF",
             "*NODE PRINT, NSET=top, FREQUENCY=1", "U", "*NODE PRINT, NSET=edge, FREQUENCY=1", "U", "*END STEP"]
args.out.mkdir(parents=True, exist_ok=True)
(args.out / "ring.inp").write_text("\n".join(deck) + "\n")
finished = subprocess.run(["ccx", "-i", "ring"], cwd=args.out, capture_output=True, text=True)
(args.out / "ring.log").write_text(finished.stdout)
rows, label = {}, None
for line in (args.out / "ring.dat").read_text().splitlines():
    words = line.split()
    if "time" in words:
        time, label = float(words[-1]), "force" if words[0] == "total" else words[words.index("set") + 1].lower()
    elif words:
        rows.setdefault(time, {})[label] = [float(word) for word in words[-3:]]
for time, row in rows.items():
    print(f"{WAY * (time if time <= 1 else 2 - time):.6g}", -row["force"][1], *row["top"][:2], *row["edge"][:2])
