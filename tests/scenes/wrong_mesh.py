"""Wrong meshes and directories: each ends with exit status 1 and one message that says what is wrong."""
import os
import pathlib
import re
import subprocess

from harness import Check, arguments, run, SCENES

MESHES = SCENES.parent.parent / "meshes"


def gmsh(name, *options):
    """A mesh of square.geo with gmsh options."""
    path = pathlib.Path(args.out).resolve() / name
    path.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run(["gmsh", str(MESHES / "square.geo"), "-2", "-nt", "1", "-o",
                    str(path), *options], check=True, stdout=subprocess.DEVNULL)
    return path


def refused(what, pattern, *overrides, options=(), out="run", keep=False, scene="wrong_mesh.yaml"):
    finished = run(args, SCENES / scene, *options, out=out, overrides=overrides, keep=keep, must=None)
    messages = [line for line in finished.text.splitlines() if line.startswith("burnish: ")]
    said = len(messages) == 1 and re.search(pattern, finished.text)
    check.holds(what, finished.status == 1 and said and "PETSC ERROR" not in finished.text,
                f"status {finished.status}: {finished.text.strip()[:300]}" if not said else messages[0])
    check.holds(f"{what}: nothing solved", not (finished.directory / "steps.csv").exists() or keep)


args = arguments()
check = Check()
good = gmsh("good.msh", "-format", "msh41")
text = good.read_text()

refused("missing mesh file", "nosuch.msh", "mesh.file=nosuch.msh")
refused("missing .geo file", "nosuch.geo", "mesh.file=nosuch.geo")
refused("missing surface", "nowhere.*x_min", "supports.0.surface=nowhere")
refused("missing volume", "no volume group .nothing.*block", "bodies.0.volume=nothing")
refused("plane mesh of a solid", "no volume group .block.*plane surface: allowed are geometry plane_strain", "geometry=solid")
refused("inverted element", "inverted", "mesh.parameters.invert=1")
refused("triangles with enhanced strains", "formulation: enhanced is for quad4 and hex8 only.*tri3",
        "mesh.parameters.tri=1", "bodies.0.formulation=enhanced")
serendipity = gmsh("serendipity.msh", "-format", "msh41", "-order", "2", "-setnumber",
                   "Mesh.SecondOrderIncomplete", "1")
refused("serendipity mesh", "SecondOrderIncomplete", f"mesh.file={serendipity}", "mesh.order=2")
truncated = good.with_name("truncated.msh")
truncated.write_text(text[: 2 * len(text) // 3])
refused("truncated mesh", "truncated.msh", f"mesh.file={truncated}")
empty = good.with_name("empty.msh")
count = int(re.search(r"\$PhysicalNames\n(\d+)", text)[1])
empty.write_text(text.replace(f"$PhysicalNames\n{count}\n", f'$PhysicalNames\n{count + 1}\n1 99 "hollow"\n'))
refused("empty contact surface", "hollow", f"mesh.file={empty}", "contact=[{name: pair, slave: hollow, master: x_max}]")
for where in ("supports=[{surface: hollow, ux: 0}]", "loads=[{surface: hollow, ux: 0.1}]",
              "loads=[{surface: hollow, force: [1, 0]}]", "probes=[{name: pull, reaction: hollow, component: x}]"):
    refused(f"empty surface: {where}", "'hollow' has no elements", f"mesh.file={empty}", where)
broken = good.with_name("broken.geo")
broken.write_text("Point(1) = {0, 0, 0;\n")
refused("a .geo that gmsh rejects", "broken.geo", f"mesh.file={broken}")
for name in ("folder.msh", "folder.geo"):
    good.with_name(name).mkdir(exist_ok=True)
    refused(f"a folder as mesh file: {name}", f"{name}.*no.* file", f"mesh.file={good.with_name(name)}")
refused("a hole opened at the axis", "axisymmetric geometry", "geometry=axisymmetric",
        "supports=[{surface: y_min, uy: 0}]", "loads=[{surface: x_min, ux: 0.1}]")
refused("surfaces that look away", "no face of 'lower_top' faces 'upper_top'", "contact.0.slave=upper_top",
        scene="contact_patch.yaml")
refused("a pair twice", "'again' is 'joint' once more",
        "contact.1={name: again, slave: upper_bottom, master: lower_top}", scene="contact_patch.yaml")
refused("a pair both ways", "slave and master swapped",
        "contact.1={name: back, slave: lower_top, master: upper_bottom}", scene="contact_patch.yaml")
hinge = run(args, SCENES / "hinge.yaml", "-check", out="hinge")
check.holds("bodies that share one node only are told of", "'low' and 'high' share 1 node" in hinge.text)
far = run(args, SCENES / "hinge.yaml", "-check", out="far", must=None,
          overrides=["loads=[{surface: floor, uy: -1000}]", "supports=[]"])
check.holds("a displacement in another unit is told of", "in the same unit of length?" in far.text)
sanitiser = os.environ.get("ASAN_OPTIONS", "")
os.environ[
    # PETSc itself keeps 32 bytes of a group of options that it leaves by an error
    "ASAN_OPTIONS"] = sanitiser + ":detect_leaks=0"
refused("a PETSc option that PETSc refuses", "Unable to find requested KSP type", options=("-ksp_type", "nosuch"))
os.environ["ASAN_OPTIONS"] = sanitiser
run(args, SCENES / "wrong_mesh.yaml", out="taken")
refused("another scene's results", "-overwrite", "bodies.0.material.E=2000", out="taken", keep=True)
run(args, SCENES / "wrong_mesh.yaml", "-overwrite", out="taken", overrides=["bodies.0.material.E=2000"], keep=True)
check.finish()
