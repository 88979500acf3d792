"""CalculiX 2.20 (Debian's calculix-ccx) on the mesh and with the law of tests/scenes/curved_beams.yaml or upset.yaml:
surface to surface penalty contact, stiff.
    forming_calculix.py beams|upset RESULTS [--kind CPE8R] [--increment 0.01] [--stiffness 20] [--mu 0.3]
RESULTS is the directory of a finished run of Burnish with elements of second order, whose mesh is taken. A line has the
load parameter and the forces x and y on what moves. Forces of axisymmetric models are those of the whole
circumference."""
import argparse
import pathlib
import subprocess

import h5py
import numpy

SIDES = ((0, 1), (1, 2), (2, 3), (3, 0))


class Deck:
    def __init__(self, results, kind):
        with h5py.File(results / "results.h5", "r") as file:
            self.nodes, self.cells = file["mesh/nodes"][()], file["mesh/cells_quad9"][()][:, :8]
        self.kind, self.section = kind, ["1."] if kind.startswith("CPE") else []
        self.used = numpy.array(sorted(set(self.cells.ravel())))
        self.lines = ["*NODE", *(f"{k + 1}, {', '.join(repr(float(x)) for x in self.nodes[k])}" for k in self.used)]

    def body(self, cells, young, nu, plastic):
        self.lines += [f"*ELEMENT, TYPE={self.kind}, ELSET=steel",
                       *(f"{n + 1}, {', '.join(str(k + 1) for k in self.cells[n])}" for n in cells),
                       "*MATERIAL, NAME=steel", "*ELASTIC", f"{young}, {nu}", "*PLASTIC",
                       *(f"{stress}, {strain}" for stress, strain in plastic),
                       "*SOLID SECTION, ELSET=steel, MATERIAL=steel", *self.section]

    def surface(self, name, on):
        """The sides of cells whose ends are on it."""
        self.lines.append(f"*SURFACE, NAME={name}")
        self.lines += [f"{n + 1}, S{side + 1}" for n, cell in enumerate(self.cells)
                       for side, ends in enumerate(SIDES) if all(on[cell[end]] for end in ends)]

    def plate(self, name, low, high, y, young, n):
        """A row of stiff elements whose lower side is the surface."""
        first, block = len(self.nodes) + 1, len(self.cells) + 1
        kind = self.kind[:3] + "4"
        self.lines += ["*NODE", *(f"{first + i}, {low + (high - low) * (i // 2) / n!r}, {(y, y + 1)[i % 2]!r}, 0"
                                  for i in range(2 * n + 2)), f"*ELEMENT, TYPE={kind}, ELSET={name}",
                       *(f"{block + i}, {first + 2 * i}, {first + 2 * i + 2}, {first + 2 * i + 3}, {first + 2 * i + 1}"
                         for i in range(n)), f"*SURFACE, NAME={name}", *(f"{block + i}, S1" for i in range(n)),
                       "*MATERIAL, NAME=stiff", "*ELASTIC", f"{young}, 0.3",
                       f"*SOLID SECTION, ELSET={name}, MATERIAL=stiff", *self.section]
        return [first - 1 + i for i in range(2 * n + 2)]

    def contact(self, slave, master, stiffness, mu=0):
        self.lines += ["*SURFACE INTERACTION, NAME=law", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
                       repr(stiffness)]
        if mu:
            self.lines += ["*FRICTION", f"{mu}, {stiffness / 10!r}"]
        self.lines += ["*CONTACT PAIR, INTERACTION=law, TYPE=SURFACE TO SURFACE", f"{slave}, {master}"]

    def fix(self, name, members, *directions):
        self.lines += [f"*NSET, NSET={name}", *(f"{k + 1}," for k in members)]
        for direction in directions:
            self.lines += ["*BOUNDARY", f"{name}, {direction}, {direction}"]

    def at(self, hit):
        return [k for k in self.used if hit[k]]


def beams(args):
    deck = Deck(args.results, args.kind or "CPE8R")
    x, y = deck.nodes[:, 0], deck.nodes[:, 1]
    centre = (numpy.min(x[numpy.abs(y - 17) < 1e-6]) + numpy.max(x[numpy.abs(y - 17) < 1e-6])) / 2
    deck.body(range(len(deck.cells)), 689.56, 0.32, [(31, 0), (31 + 2 * 261.2, 2)])
    deck.surface("below", numpy.abs(numpy.hypot(x, y) - 10) < 1e-6)
    deck.surface("above", numpy.abs(numpy.hypot(x - centre, y - 17) - 12) < 1e-6)
    deck.contact("above", "below", args.stiffness * 689.56, args.mu)
    deck.fix("held", deck.at(numpy.abs(y) < 1e-6), 1, 2)
    deck.fix("moved", deck.at(numpy.abs(y - 17) < 1e-6))
    return deck, ["moved, 1, 1, 31.5", "moved, 2, 2, 0"]


def upset(args):
    deck = Deck(args.results, args.kind or "CAX8R")
    x, y = deck.nodes[:, 0], deck.nodes[:, 1]
    deck.body(range(len(deck.cells)), 200e3, 0.3, [(700, 0), (700 + 300 * 5, 5)])
    deck.surface("side", numpy.abs(x - 10) < 1e-6)
    die = deck.plate("die", 5, 25, 15, 200e3, 40)
    deck.contact("side", "die", args.stiffness * 200e3)
    deck.fix("middle", deck.at(numpy.abs(y) < 1e-6), 2)
    deck.fix("axis", deck.at(numpy.abs(x) < 1e-6), 1)
    deck.fix("moved", deck.at(numpy.abs(y - 15) < 1e-6) + die)
    return deck, ["moved, 1, 1, 0", "moved, 2, 2, -9"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", choices=("beams", "upset"))
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--kind")
    parser.add_argument("--increment", type=float, default=0.01)
    parser.add_argument("--stiffness", type=float, default=20)
    parser.add_argument("--mu", type=float, default=0.3)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/calculix"))
    args = parser.parse_args()
    deck, loads = {"beams": beams, "upset": upset}[args.case](args)
    deck.lines += ["*STEP, NLGEOM, INC=100000", "*STATIC", f"{args.increment}, 1, 1e-7, {args.increment}", "*BOUNDARY",
                   *loads, "*NODE PRINT, NSET=moved, FREQUENCY=1, TOTALS=ONLY", "RF", "*END STEP"]
    args.out.mkdir(parents=True, exist_ok=True)
    (args.out / "forming.inp").write_text("\n".join(deck.lines) + "\n")
    finished = subprocess.run(["ccx", "-i", "forming"], cwd=args.out, capture_output=True, text=True)
    (args.out / "forming.log").write_text(finished.stdout)
    time = None
    for line in (args.out / "forming.dat").read_text().splitlines():
        words = line.split()
        if "time" in words:
            time = float(words[-1])
        elif words:
            print(f"{time:.6g}", *(float(word) for word in words[:2]))
    print("to the end" if finished.returncode == 0 else f"CalculiX ended: {finished.stdout.splitlines()[-2:]}")


if __name__ == "__main__":
    main()
