"""scripts/render.py and scripts/plot.py draw every kind of run without a display: what is nearer hides what is behind,
fields have their colours, a cut has the areas and the values that it must have."""
import os
import subprocess
import sys

import matplotlib.image
import numpy
import PIL.Image

from harness import Check, arguments, run, SCENES

SCRIPTS = SCENES.parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))
from burnish.meshview import read_cells, read_skin  # noqa: E402
from burnish.raster import Canvas, View  # noqa: E402
from burnish.section import Cut  # noqa: E402

PLANE = [
    "geometry=plane_strain", "mesh.parameters.solid=0",
    "supports=[{surface: lower_bottom, uy: 0}, {surface: symmetry_x, ux: 0}]"
]
BENT = [
    "supports=[{surface: x_min, ux: 0}, {surface: y_min, uy: 0}, {surface: z_min, uz: 0}]",
    "loads=[{surface: y_max, uy: -0.1}]"
]
STEPS = "stepping={control: fixed, initial: 0.5}"
# Runs: scene, overrides, area of the outer faces' triangles before it deforms
RUNS = {
    "solid": ("contact_patch.yaml", ["mesh.order=2"], None),
    "plane": ("contact_patch.yaml", PLANE, None),
    "tet10": ("patch.yaml", ["mesh.order=2", "mesh.parameters.tet=1", *BENT], 2 * (2 * 1 + 1 * 1.5 + 1.5 * 2)),
    "hex8": ("patch.yaml", BENT, 2 * (2 * 1 + 1 * 1.5 + 1.5 * 2)),
    "tet4": ("patch.yaml", ["mesh.parameters.tet=1", *BENT], 2 * (2 * 1 + 1 * 1.5 + 1.5 * 2)),
    "hex27": ("patch.yaml", ["mesh.order=2", *BENT], 2 * (2 * 1 + 1 * 1.5 + 1.5 * 2)),
}


def depth(check):
    """Two squares: the nearer one, half as wide, hides the other one behind it from either side."""
    far = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=float)
    near, faces = far * 0.5 + [0, 0, 1], numpy.array([[0, 1, 2], [0, 2, 3]])
    for azimuth, share in ((0, 0.25), (180, 0)):
        view = View(azimuth, 0)
        canvas = Canvas(view, [-1, -1, -1], [1, 1, 1], 200)
        for corners, colour in ((near, [1, 0, 0]), (far, [0, 0, 1])):
            canvas.triangles(corners, faces,
                             lambda v, colour=colour: numpy.broadcast_to(numpy.array(colour, dtype=float), (len(v), 3)),
                             numpy.zeros(4))
        image = canvas.image()
        check.near(f"share of the smaller square from {azimuth} degrees", numpy.mean(image[:, :, 0] > image[:, :, 2]),
                   share, 0.01)


def area(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2


def section(check, name, path):
    """A box of 2 x 1 x 1.5 is cut at two places: areas of the section and of what is left of the skin, and a linear
    field on the section."""
    skin = read_skin(path)
    for axis, at, size, rest in ((1, 0.3, 2 * 1.5, 2 * 1.5 + 0.3 * 2 * (2 + 1.5)),
                                 (0, 1.0, 1 * 1.5, 1 * 1.5 + 2 * (1 + 1.5))):
        field = skin.nodes @ [1, 2, 3]
        cut = Cut(skin.nodes, field, skin.nodes[:, axis] - at)
        left, parents, _ = cut.triangles(skin.triangles)
        faces = numpy.concatenate([cut.section(kind, cells) for kind, cells, _ in read_cells(path)])
        points, values = cut.all()
        check.near(f"{name}: section at {'xyz'[axis]} = {at}", area(points, faces), size, 1e-9)
        check.near(f"{name}: skin that is left", area(points, left), rest, 1e-9)
        check.near(f"{name}: field on the section", values[faces], points[faces] @ [1, 2, 3], 1e-9)
        check.holds(f"{name}: parts of the skin", len(left) == len(parents) and parents.max() < len(skin.triangles))


def script(name, *words):
    environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    line = [sys.executable, "-W", "error::RuntimeWarning", str(SCRIPTS / name), *map(str, words)]
    return subprocess.run(line, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def drawn(check, what, finished, files, colours):
    """The script names its files; each picture has that many different colours at least."""
    good = finished.returncode == 0 and finished.stdout.split() == [str(file) for file in files]
    check.holds(f"{what}: {', '.join(file.name for file in files)}", good, finished.stdout[-500:])
    for file in files if finished.returncode == 0 else []:
        image = matplotlib.image.imread(file)
        found = len(numpy.unique((255 * image[:, :, :3]).astype(int).reshape(-1, 3), axis=0))
        check.holds(f"{what}: colours in {file.name}", found >= colours, f"{found}")


args = arguments(("runs", "names of RUNS apart by -"))
check = Check()
depth(check)
for name in args.runs.split("-"):
    scene, overrides, surface = RUNS[name]
    folder = run(args, SCENES / scene, "-quiet", out=name, overrides=[*overrides, STEPS]).directory
    contact = "contact" in scene
    skin = read_skin(folder / "results.h5")
    if surface:
        check.near(f"{name}: area of the skin", area(skin.nodes, skin.triangles), surface, 1e-9 * surface)
        section(check, name, folder / "results.h5")
    small = ("--width", 300)
    drawn(check, name, script("render.py", folder, *small),
          [folder / "von_mises.png"] + [folder / "pressure.png"] * contact, 100)
    drawn(check, name, script("plot.py", folder), [folder / "steps.png"], 20)
    gif = folder / "uy.gif"
    drawn(check, name, script("render.py", folder, "--field", "uy", "--mirror", "xz", "--animate", "-o", gif, *small),
          [gif], 50)
    with PIL.Image.open(gif) as animation:
        check.holds(f"{name}: frames of uy.gif", animation.n_frames == 2, f"{animation.n_frames}")
    more = [*(["--cut", "y=0.6"] if not skin.plane else []), "--undeformed", *(["--arrows"] if contact else [])]
    drawn(check, f"{name}: {' '.join(more)}",
          script("render.py", folder, "--field", "pressure" if contact else "uy", *more, "-o", folder / "more.png",
                 *small), [folder / "more.png"], 50)
    wrong = (["--cut", "y=0"], "no section") if skin.plane else (["--cut", "y=0", "--view=0,0"], "from its side")
    for words, said in (wrong, (["--cut", "q=0"], "allowed: x, y or z")):
        refused = script("render.py", folder, *words)
        check.holds(f"{name}: {' '.join(words)} is refused", refused.returncode and said in refused.stdout,
                    refused.stdout[-200:])
    if not contact:
        refused = script("render.py", folder, "--arrows")
        check.holds(f"{name}: no tractions", refused.returncode == 1 and "no contact tractions" in refused.stdout,
                    refused.stdout[-200:])
    refused = script("render.py", folder, "--step", 2)
    check.holds(f"{name}: a step that is not there", refused.returncode == 1 and "steps 0 to 1" in refused.stdout,
                refused.stdout[-200:])
check.finish()
