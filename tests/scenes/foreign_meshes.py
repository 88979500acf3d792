"""Meshes of other programs: the same mesh in every format gives the same answer, with bodies and surfaces by their
names; serendipity elements are completed, which is said; decks with parts, labels of faces and included files are read;
partitions of gmsh do not matter; what cannot be taken is refused by name; a file is converted once, and again when it
or an included one changes."""
import pathlib
import re
import shutil
import sys

import gmsh
import meshio
import numpy
from harness import SCENES, Check, arguments, run

SCENE = SCENES / "foreign_meshes.yaml"
FORMATS = ("msh", "unv", "med", "cgns", "bdf", "inp", "vtk")
SERENDIPITY = ("unv", "bdf", "inp")  # gmsh writes incomplete elements into these
# Surfaces that the format names otherwise than the geometry: in .bdf and .vtk entities have numbers
NAMES = {
    "bdf": {"low": "volume_1", "high": "volume_2"},
    "vtk": {"low": "CellEntityIds:1", "high": "CellEntityIds:2", "bottom": "CellEntityIds:3", "top": "CellEntityIds:4",
            "left": "CellEntityIds:5", "front": "CellEntityIds:6"},
}
args = arguments()
check = Check()
place = pathlib.Path(args.out).resolve() / "meshes"
shutil.rmtree(place, ignore_errors=True)
place.mkdir(parents=True)


def write_all(order):
    """Writes the geometry's mesh in every format."""
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Verbosity", 0)
    gmsh.open(str(SCENES / "two_blocks_glued.geo"))
    gmsh.model.mesh.generate(3)
    for option in ("SaveGroupsOfElements", "SaveGroupsOfNodes"):
        gmsh.option.setNumber(f"Mesh.{option}", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    for ending in FORMATS:
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", ending in SERENDIPITY)
        gmsh.model.mesh.setOrder(1)
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(place / f"order{order}.{ending}"))
    gmsh.finalize()


def renamed(ending):
    """Overrides that name bodies and surfaces as the format does."""
    names = NAMES.get(ending, {})
    lists = {"bodies": ("volume", ("low", "high")), "supports": ("surface", ("bottom", "left", "front")),
             "loads": ("surface", ("top",))}
    overrides = [f"{section}.{k}.{key}={names[name]}" for section, (key, members) in lists.items()
                 for k, name in enumerate(members) if name in names]
    return overrides + ([f"probes.0.reaction={names['top']}"] if "top" in names else [])


def force(ending, order):
    overrides = [f"mesh.file={place}/order{order}.{ending}", *renamed(ending)]
    if ending == "bdf":  # six faces of the blocks by number
        overrides += ["supports=" + BDF_SUPPORTS, "loads.0.surface=surface_11", "probes.0.reaction=surface_11"]
    finished = run(args, SCENE, overrides=overrides, out=ending)
    return finished.summary()["probes"]["force"], finished.text


BDF_SUPPORTS = ("[{surface: surface_5, uz: 0}, {surface: surface_1, ux: 0}, {surface: surface_7, ux: 0}, "
                "{surface: surface_3, uy: 0}, {surface: surface_9, uy: 0}]")
for order in (1, 2):
    write_all(order)
    reference = run(args, SCENE, overrides=[f"mesh.order={order}"]).summary()["probes"]["force"]
    for ending in FORMATS:
        value, text = force(ending, order)
        check.near(f".{ending} of order {order}", value / reference, 1, 1e-11)
        if order == 2:
            check.holds(f".{ending}: completion is said", ("completed" in text) == (ending in SERENDIPITY))

# Meshes that gmsh has cut into partitions, whose elements are on entities of their own.
gmsh.initialize(readConfigFiles=False)
gmsh.option.setNumber("General.Verbosity", 0)
gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
gmsh.open(str(SCENES / "two_blocks_glued.geo"))
gmsh.model.mesh.generate(3)
gmsh.write(str(place / "whole.msh"))
for ghosts in (0, 1):
    gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", ghosts)
    gmsh.model.mesh.partition(3)
    for binary in (0, 1):
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(str(place / f"partitioned{ghosts}{binary}.msh"))
gmsh.option.setNumber("Mesh.PartitionSplitMeshFiles", 1)
gmsh.write(str(place / "split.msh"))
gmsh.finalize()
reference = run(args, SCENE, overrides=[f"mesh.file={place}/whole.msh"]).summary()["probes"]["force"]
for name in ("partitioned00", "partitioned01", "partitioned10", "partitioned11"):
    found = run(args, SCENE, overrides=[f"mesh.file={place}/{name}.msh"], out=name).summary()["probes"]["force"]
    check.near(f"{name}: the force of the whole mesh", found / reference, 1, 1e-11)
finished = run(args, SCENE, overrides=[f"mesh.file={place}/split_2.msh"], out="split", must=None)
check.holds("one of the files of a mesh that was split: exit 1 and a message",
            finished.status == 1 and "partition 1 of 3 is not in the file" in finished.text, finished.text[-300:])

# A mesh whose elements all have left-handed axes, as on structured grids of other programs.
sys.path.insert(0, str(SCENES.parent.parent / "scripts"))
from meshfiles.shapes import SHAPES, mirrored  # noqa: E402

gmsh.initialize(readConfigFiles=False)
for name, shape in SHAPES.items():
    if shape.dim < 2:
        continue
    _, _, _, n, places, _ = gmsh.model.mesh.getElementProperties(shape.number)
    places = numpy.column_stack([numpy.asarray(places).reshape(n, -1), numpy.ones(n)])
    image = numpy.linalg.lstsq(places, places[mirrored(name)], rcond=None)
    check.holds(f"{name}: its nodes in the other order are those of its mirror image",
                image[1].max(initial=0) < 1e-24 and abs(numpy.linalg.det(image[0]) + 1) < 1e-12)
gmsh.finalize()
for order in (1, 2):
    other = meshio.read(place / f"order{order}.vtk")
    other.points[:, 0] = other.points[:, 0].max() + other.points[:, 0].min() - other.points[:, 0]
    meshio.write(place / f"left{order}.vtk", other)
    reference = force("vtk", order)[0]
    finished = run(args, SCENE, overrides=[f"mesh.file={place}/left{order}.vtk", *renamed("vtk")], out="left")
    check.near(f"left-handed axes, order {order}", finished.summary()["probes"]["force"] / reference, 1, 1e-11)
    check.holds("that the nodes were put in the other order is said", "left-handed" in finished.text)


def deck(text=None, **overrides):
    """Runs a deck of parts; with a text, that of the deck."""
    file = place / "deck_parts.inp"
    shutil.copy(SCENES / "deck_part.inp", place)
    file.write_text(text or (SCENES / "deck_parts.inp").read_text())
    values = {"mesh.file": file, "bodies": "[{volume: low.cells, material: {law: linear, E: 100, nu: 0}}, "
              "{volume: high.cells, material: {law: linear, E: 100, nu: 0}}]", "supports":
              "[{surface: low.base, ux: 0, uy: 0, uz: 0}, {surface: high.base, ux: 0, uy: 0, uz: 0}]", **overrides}
    return run(args, SCENE, overrides=[f"{key}={value}" for key, value in values.items()], out="deck", must=None)


finished = deck()
check.holds("a deck with parts runs", finished.status == 0, finished.text[-500:] if finished.status else "")
check.near("its force: one block of height 1 is pressed", finished.summary()["probes"]["force"], -1, 1e-12)
meshes = len(list(pathlib.Path("out").glob("mesh-*.msh")))
deck()
check.holds("a mesh is converted once", len(list(pathlib.Path("out").glob("mesh-*.msh"))) == meshes)

WHOLE = (SCENES / "deck_part.inp").read_text()
for what, text, pattern in (
    ("wedges", WHOLE.replace("C3D8", "C3D6"), "C3D6 are not available; there are C3D4, C3D8"),
    ("a set that is not there", WHOLE.replace("*END PART", "*ELSET, ELSET=x\nnone\n*END PART") + "*INSTANCE, NAME=a, "
     "PART=block\n*END INSTANCE\n", "no set"),
    ("a file that is not there", "*INCLUDE, INPUT=none.inp\n", "cannot read .*none.inp"),
    ("too few nodes", WHOLE.replace("6, 7, 8", "6, 7"), r"deck_parts.inp:\d+: \*ELEMENT of type C3D8.*7 nodes, not 8"),
    ("a part that is not placed", WHOLE, "no nodes outside of parts"),
    ("beams alone", WHOLE.replace("C3D8", "B31") + "*INSTANCE, NAME=a, PART=block\n*END INSTANCE\n", "no elements"),
):
    finished = deck(text)
    check.holds(f"{what}: exit 1 and a message", finished.status == 1 and re.search(pattern, finished.text),
                finished.text.strip()[-300:])
broken = place / "broken.med"
broken.write_text("no MED file")
finished = run(args, SCENE, overrides=[f"mesh.file={broken}"], out="broken", must=None)
check.holds("a broken .med: exit 1 and a message", finished.status == 1 and "broken.med" in finished.text, finished.text)
hostile = place / "hostile.msh"
hostile.write_text(f'$MeshFormat\n2.2 0 8\n$EndMeshFormat\nSystemCall "touch {place}/done";\n')
finished = run(args, SCENE, overrides=[f"mesh.file={hostile}"], out="broken", must=None)
check.holds("a .msh with a command: it is not run", finished.status == 1 and not (place / "done").exists(),
            finished.text.strip()[-300:])
check.finish()
