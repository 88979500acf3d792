"""Turns a mesh file of another program into gmsh's format 4.1, which Burnish reads. Burnish calls it by itself for a
`mesh.file` that is neither a .geo nor a .msh of this format.
    python scripts/convert_mesh.py IN OUT.msh --dim 2|3 [--bodies NAMES] [--list]
Formats: .inp (Abaqus, CalculiX), .msh of other versions, .med, .unv, .cgns, .bdf, .nas by gmsh, .vtk and .vtu by
meshio. --bodies: the groups (with commas) that are
bodies, where groups overlap. --list prints the groups, that is, what a scene can name. Lines that start with `note:` say what was changed."""
import argparse
import pathlib
import sys

from meshfiles.deck import Deck
from meshfiles.libraries import read_gmsh, read_meshio
from meshfiles.mesh import MeshError

READERS = {
    ".inp": lambda file, dim: Deck(file).mesh(dim),
    ".vtk": read_meshio,
    ".vtu": read_meshio,
    **dict.fromkeys((".msh", ".med", ".unv", ".cgns", ".bdf", ".nas"), read_gmsh)
}


def convert(file, dim, bodies):
    """Reads a mesh and makes it fit for the solver."""
    reader = READERS.get(file.suffix.lower())
    if reader is None:
        raise MeshError(f"the ending '{file.suffix}' is not known; there are {', '.join(sorted(READERS))}")
    mesh = reader(file, dim)
    mesh.complete()
    mesh.merge_faces()
    mesh.choose_bodies(bodies)
    mesh.check()
    return mesh


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--dim", type=int, choices=(2, 3), required=True)
    parser.add_argument("--bodies", default="", help="names with commas")
    parser.add_argument("--list", action="store_true", help="print the groups")
    args = parser.parse_args()
    try:
        mesh = convert(args.file, args.dim, args.bodies.split(","))
    except MeshError as error:
        sys.exit(f"Error: {error}")
    mesh.write(args.out)
    for note in mesh.notes:
        print(f"note: {note}")
    for group in mesh.groups if args.list else ():
        if group.size:
            print(f"{group.dim} {group.name}: {group.size} elements")


if __name__ == "__main__":
    main()
