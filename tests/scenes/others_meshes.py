"""Meshes of other people's making, from packages of Debian (libpetsc3.18-dev-examples, syrthes-tests), where they are
installed: MED files of SALOME and of others, a CGNS file with left-handed axes. Their bodies have the volumes that
another reader finds."""
import pathlib

import meshio
import numpy
from harness import SCENES, Check, arguments, run

PETSC = pathlib.Path("/usr/share/petsc/3.18/share/petsc/datafiles/meshes")
SYRTHES = pathlib.Path("/usr/share/syrthes/tests")
args = arguments()
check = Check()
place = pathlib.Path(args.out).resolve() / "others"
place.mkdir(parents=True, exist_ok=True)


def tets(file):
    """The volume of all tetrahedra of a file, as meshio reads them."""
    mesh = meshio.read(file)
    x = mesh.points[numpy.vstack([block.data for block in mesh.cells if block.type == "tetra"])]
    return abs(numpy.linalg.det(x[:, 1:] - x[:, :1])).sum() / 6


def checked(file, bodies, surface):
    """What -check says of a scene with these bodies."""
    scene = place / "scene.yaml"
    names = "".join(f"\n  - {{volume: {name}, material: {{law: svk, E: 1000, nu: 0.3}}}}" for name in bodies)
    held = f"\nsupports:\n  - {{surface: {surface}, ux: 0, uy: 0, uz: 0}}" if surface else ""
    scene.write_text(f"mesh: {{file: {file}}}\ngeometry: solid\nbodies:{names}{held}\n")
    return run(args, scene, "-check", out="run", must=None)


def volume(text, bodies):
    rows = [line.split() for line in text.splitlines()]
    return sum(float(row[2]) for row in rows if len(row) > 5 and row[0] in bodies)


for file, bodies, surface, expected in (
    (PETSC / "cylinder.med", ["G_3D_1"], "G_2D_1", tets),
    (SYRTHES / "cas_param/salome/box_hole.med", ["Group_vol"], "Group_faces_box", tets),
    (SYRTHES / "cas_plates3d_salome/salome/plates3d.med",
     ["Disk1", "Disk2-int", "Disk2-ext", "Disk3-int", "Disk3-ext", "Disk4-int", "Disk4-ext", "four"], "dessous", tets),
    (PETSC / "grid_c.cgns", ["volume_1"], None, lambda _: 18 * 12 * 18),
):
    if not file.exists():
        continue
    finished = checked(file, bodies, surface)
    check.near(f"{file.name}: volume", volume(finished.text, bodies) / expected(file), 1, 1e-4)
    print(f"     {file.name}: exit {finished.status}, {finished.text.strip().splitlines()[-1][:150]}")
check.finish()
