"""Turns a mesh file of another program into gmsh's format 4.1, which Burnish reads. Burnish calls it by itself for a
`mesh.file` that is neither a .geo nor a .msh of this format.
    python scripts/convert_mesh.py IN OUT.msh [--dim 2|3] [--bodies NAMES] [--list]
    python scripts/convert_mesh.py IN --list                                            # without a mesh file
Formats: .inp (Abaqus, CalculiX), .msh of other versions, .med, .unv, .cgns, .bdf, .nas by gmsh, .vtk and .vtu by
meshio; geometry of CAD programs, which gmsh meshes: .step, .stp, .brep, .igs, .iges. --bodies: the groups (with commas)
that are bodies, where groups overlap. --cad: how geometry is meshed, a map in JSON with size, order and surfaces, as
under `mesh` in a scene. --list prints the groups, that is, what a scene can name; geometry is not meshed for that.
Lines that start with `note:` say what was changed."""
import argparse
import json
import pathlib
import sys

from meshfiles.cad import ENDINGS, list_cad, read_cad
from meshfiles.deck import Deck
from meshfiles.libraries import read_gmsh, read_meshio
from meshfiles.mesh import MeshError

READERS = {
    ".inp": lambda file, dim: Deck(file).mesh(dim),
    ".vtk": read_meshio,
    ".vtu": read_meshio,
    **dict.fromkeys((".msh", ".med", ".unv", ".cgns", ".bdf", ".nas"), read_gmsh)
}


def convert(file, dim, bodies, cad):
    """Reads a mesh, or meshes geometry, and makes the mesh fit for the solver."""
    reader = READERS.get(file.suffix.lower())
    if file.suffix.lower() in ENDINGS:
        mesh = read_cad(file, dim, cad)
    elif reader:
        mesh = reader(file, dim)
    else:
        raise MeshError(f"the ending '{file.suffix}' is not known; there are {', '.join(sorted([*READERS, *ENDINGS]))}")
    mesh.complete()
    mesh.merge_faces()
    mesh.choose_bodies(bodies)
    mesh.turn_bodies()
    mesh.check()
    return mesh


def list_groups(groups):
    for group in groups:
        if group.size:
            print(f"{group.dim} {group.name}: {group.size} elements")


def list_geometry(rows, dim):
    """Bodies and surfaces with all their names, their size, and a point by which a surface can be told in a program."""
    measures = ("", "length", "area", "volume")
    for entity_dim, names, centre, size in rows:
        place = ", ".join("%.5g" % (round(x, 9) + 0.0) for x in centre[:dim])
        print(f"{'body' if entity_dim == dim else 'surface':<8} {' = '.join(names)}: {measures[entity_dim]} {size:.5g}, "
              f"centre ({place})")


def work(args):
    geometry = args.file.suffix.lower() in ENDINGS
    if args.list and geometry:
        list_geometry(list_cad(args.file, args.dim, args.cad), args.dim)
    if geometry and not args.out:
        return
    mesh = convert(args.file, args.dim, args.bodies.split(","), args.cad)
    if args.out:
        args.out.parent.mkdir(parents=True, exist_ok=True)
        mesh.write(args.out)
    for note in mesh.notes:
        print(f"note: {note}")
    if args.list and not geometry:
        list_groups(mesh.groups)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, nargs="?", help="can be left out with --list")
    parser.add_argument("--dim", type=int, choices=(2, 3), default=3)
    parser.add_argument("--bodies", default="", help="names with commas")
    parser.add_argument("--cad", default={}, type=json.loads, help="a map with size, order and surfaces")
    parser.add_argument("--list", action="store_true", help="print the groups")
    args = parser.parse_args()
    if not (args.out or args.list):
        parser.error("OUT.msh is missing; only with --list it can be left out")
    try:
        work(args)
    except MeshError as error:
        sys.exit(f"Error: {error}")


if __name__ == "__main__":
    main()
