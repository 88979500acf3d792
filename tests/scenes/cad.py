"""Geometry of CAD programs as a mesh file: two parts of a STEP and a BREP file are meshed and pressed together, surfaces
are named by points, by their bodies and by the labels of the file, also where an assembly has moved the part; sizes are
kept; what cannot be taken is refused by name, with the code; a file is meshed once, and again when it changes."""
import pathlib
import re
import shutil
import subprocess
import sys

import gmsh
from harness import SCENES, Check, arguments, run

ROOT = SCENES.parent.parent
SCENE = SCENES / "cad.yaml"
SURFACES = {"bottom": "point: [0.5, 0.5, 0]", "top": "point: [0.5, 0.5, 2]", "low": "point: [0.5, 0.5, 1], body: volume_1",
            "high": "point: [0.5, 0.5, 1], body: volume_2"}
args = arguments()
check = Check()
place = pathlib.Path(args.out).resolve() / "cad"
shutil.rmtree(place, ignore_errors=True)
place.mkdir(parents=True)


def write_blocks(height):
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Verbosity", 0)
    for z in (0, 1):
        gmsh.model.occ.addBox(0, 0, z, 1, 1, 1 if z else height)
    gmsh.model.occ.synchronize()
    for ending in ("step", "brep"):
        gmsh.write(str(place / f"blocks.{ending}"))
    gmsh.clear()
    gmsh.model.occ.addRectangle(0, 0, 0.5, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.write(str(place / "sheet.brep"))
    gmsh.finalize()


def listed(surfaces):
    return "mesh.surfaces=[" + ", ".join(f"{{name: {name}, {how}}}" for name, how in surfaces.items()) + "]"


def pressed(file="blocks.step", surfaces=None, edits=(), must=0, options=()):
    return run(args, SCENE, *options, overrides=[f"mesh.file={place}/{file}", listed({**SURFACES, **(surfaces or {})}),
                                                 *edits], must=must, out="run")


def meshes():
    return {path.name for path in pathlib.Path("out").glob("mesh-*.msh")}


write_blocks(1)
for ending in ("step", "brep"):
    check.near(f".{ending}: force of bars in series", pressed(f"blocks.{ending}").summary()["probes"]["force"], -1, 1e-3)
there = meshes()
pressed()
check.holds("a file is meshed once", meshes() == there)
coarse = pressed().summary()["elements"]
check.holds("a smaller size makes more elements",
            pressed(surfaces={"top": "point: [0.5, 0.5, 2], size: 0.1"}).summary()["elements"] > 2 * coarse)
check.holds("order 2 is the default", "of order 2" in pressed(edits=("mesh={file: %s/blocks.step, size: 0.6, %s}" % (
    place, listed(SURFACES).replace("mesh.surfaces=", "surfaces: ")), ), options=("-check", )).text)

for what, file, surfaces, edits, pattern in (
    ("a point far from all", "blocks.step", {"top": "point: [0.5, 0.5, 2.3]"}, (),
     r"'top'.*is 0.3 away from the nearest surface 'surface_\d+'"),
    ("a point of two bodies", "blocks.step", {"low": "point: [0.5, 0.5, 1]"}, (), "is on 2 surfaces.*or `body`"),
    ("a point on an edge", "blocks.step", {"top": "point: [0.5, 0, 2]"}, (), "is on 2 surfaces"),
    ("a body that is not there", "blocks.step", {"low": "point: [0.5, 0.5, 1], body: lid"}, (), "no body 'lid'; there"),
    ("a label that is not there", "blocks.step", {"lid": "size: 0.1"}, (), "no surface of this name; there are"),
    ("too many elements", "blocks.step", {}, ("mesh.size=1e-3", ), "some .* elements, as the model is 1 x 1 x 2 large"),
    ("no solids", "sheet.brep", {}, (), "has no volumes.*allowed: solids"),
    ("no STEP file", "broken.step", {}, (), "gmsh cannot read it|has no volumes"),
):
    (place / "broken.step").write_text("no STEP file")
    finished = pressed(file, surfaces, edits, None, ("-check", ))
    check.holds(f"{what}: exit 1, message and code", finished.status == 1 and "[B124]" in finished.text and
                re.search(pattern, finished.text, re.DOTALL), finished.text.strip()[-400:])
for what, edits, pattern in (("size of another mesh", ("mesh={file: x.msh, size: 1}", ), "is for geometry of CAD programs"),
                             ("parameters", ("mesh.parameters={n: 1}", ), "is for a .geo file"),
                             ("a surface without a point", ("mesh.surfaces=[{name: a}]", ), "neither a point")):
    finished = run(args, SCENE, "-check", overrides=edits, must=None, out="run")
    check.holds(f"{what}: exit 1 and message", finished.status == 1 and pattern in finished.text, finished.text[-300:])

write_blocks(0.9)
finished = pressed(surfaces={"low": "point: [0.5, 0.5, 0.9]"}, must=None, options=("-check", ))
check.holds("a changed file is meshed anew", meshes() != there and finished.status == 0, finished.text[-300:])


def names(file):
    """The bodies and surfaces of a file: all names, in lists."""
    text = subprocess.run([sys.executable, ROOT / "scripts/convert_mesh.py", file, "--list"], capture_output=True,
                          text=True, check=True).stdout
    return [line.split(": ")[0].split(None, 1)[1].split(" = ") for line in text.splitlines()
            if line.startswith(("body", "surface"))], text


found, text = names(ROOT / "meshes/saddle.step")
check.holds("parts and labels of a STEP file", ["volume_1", "saddle"] in found and
            ["surface_8", "saddle.groove", "groove"] in found and ["surface_9", "shaft.mantle", "mantle"] in found, text)
# Files of other people's making that come with gmsh: how many bodies and surfaces, and a name
for file, bodies, surfaces, name in (("examples/boolean/as1-tu-203.stp", 18, 160, "nut & & 256.8"),
                                     ("examples/boolean/component8.step", 1, 21, "Rhino Product"),
                                     ("examples/api/step_boundary_colors.stp", 1, 6, "volume_1"),
                                     ("examples/api/step_header_data.stp", 1, 1, "volume_1")):
    file = ROOT / "build/venv/share/doc/gmsh" / file
    if file.exists():
        found, text = names(file)
        counts = [sum(words[0].startswith(kind) for words in found) for kind in ("volume_", "surface_")]
        check.holds(f"{file.name}: bodies and surfaces", counts == [bodies, surfaces] and
                    any(name in words for words in found), f"{counts}\n{text[:300]}")
moved = (ROOT / "meshes/saddle.step").read_text()
swapped = place / "swapped.step"
swapped.write_text(moved.replace("'groove'", "''").replace("'mantle'", "'skin'"))
check.holds("another label", ["surface_9", "shaft.skin", "skin"] in names(swapped)[0])
check.finish()
