"""What the ranks hold while a mesh is read and cut: the peak of memory of each of them above that before the mesh is
read, CPU seconds, and the faces that are cut, by tests/bench/meshpeak.c. The meshes are blocks of tetrahedra of second
order, a block of bricks and two rings of bricks in contact. Ranks may be more than the machine has cores. Leaves one
record per run and prints the table.
    python scripts/mesh_memory_table.py [--meshpeak BINARY] [--record FILE] [--program NAME] [--only MESH ...]
--program names what is run (`now`, or `before` or `whole graph` for older binaries); rows of other programs and meshes
are kept."""
import argparse
import csv
import pathlib
import subprocess

from launch import ROOT, environment, read_records

BLOCK = ("mesh: {file: %s, order: %d, parameters: {nx: %d, ny: %d, nz: %d, tet: %d}}\ngeometry: solid\n"
         "bodies: [{volume: block, material: {law: svk, E: 1, nu: 0.3}}]\n")
RINGS = "mesh.parameters={n_inner: 100, n_outer: 125, n_len: 33}"
# Bricks along a side of the block, and whether each is cut into tetrahedra. The last one has 1e7 unknowns.
BLOCKS = ((36, True), (52, True), (62, True), (150, False))
RANKS = (1, 2, 4, 8)
COLUMNS = ("program", "mesh", "ranks", "cells", "nodes", "first_mb", "mean_mb", "largest_mb", "first_cpu_s",
           "edge_cut")


def scenes(out):
    """Name and arguments of each mesh."""
    for size, tet in BLOCKS:
        scene = out / f"block_{size}.yaml"
        scene.write_text(BLOCK % (ROOT / "meshes/block.geo", 2 if tet else 1, size, size, size, tet))
        yield f"{'block' if tet else 'bricks'}, {size}", [scene]
    yield "rings", [ROOT / "runs/ring_in_ring_3d.yaml", RINGS]


def measure(args, name, arguments, ranks):
    line = ["mpirun", "-n", str(ranks), str(args.meshpeak), *map(str, arguments)]
    text = subprocess.run(line, env=environment(args.meshpeak), cwd=args.out, capture_output=True, text=True,
                          check=True).stdout
    rows = [[float(word) for word in line.split()] for line in text.splitlines() if line[:1].isdigit()]
    cut = [line.split()[1] for line in text.splitlines() if line.startswith("cut")]
    held = [after - before for _, _, _, before, after, _ in rows]
    return dict(zip(COLUMNS, (args.program, name, ranks, int(sum(row[1] for row in rows)),
                              int(sum(row[2] for row in rows)), f"{held[0]:.1f}", f"{sum(held) / ranks:.1f}",
                              f"{max(held):.1f}", f"{rows[0][5]:.2f}", cut[0] if cut else "")))


def table(rows):
    print("| mesh | cells | ranks | program | first rank, MB | mean, MB | largest, MB | first rank, bytes a cell "
          "| first rank, CPU s | edge cut |")
    print("| --- " * 10 + "|")
    for row in sorted(rows, key=lambda row: (row["mesh"], int(row["ranks"]), row["program"])):
        print(f"| {row['mesh']} | {int(row['cells']):,} | {row['ranks']} | {row['program']} "
              f"| {float(row['first_mb']):.0f} | {float(row['mean_mb']):.0f} | {float(row['largest_mb']):.0f} "
              f"| {float(row['first_mb']) * 2**20 / int(row['cells']):.0f} "
              f"| {row['first_cpu_s']} | {row['edge_cut']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshpeak", type=pathlib.Path, default=ROOT / "build/bench/meshpeak")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/mesh_memory")
    parser.add_argument("--record", type=pathlib.Path, default=ROOT / "out/mesh_memory.csv")
    parser.add_argument("--program", default="now")
    parser.add_argument("--only", nargs="*", metavar="MESH", help="of these meshes, such as rings")
    parser.add_argument("--print", dest="only_print", action="store_true", help="of the record that is there")
    args = parser.parse_args()
    rows = read_records(args.record)
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        args.meshpeak = args.meshpeak.resolve()
        for name, arguments in scenes(args.out):
            if args.only and name not in args.only:
                continue
            measure(args, name, arguments, 1)  # makes the mesh
            rows = [row for row in rows if (row["program"], row["mesh"]) != (args.program, name)]
            rows += [measure(args, name, arguments, ranks) for ranks in RANKS]
            with open(args.record, "w", newline="") as file:
                writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
    table(rows)


if __name__ == "__main__":
    main()
