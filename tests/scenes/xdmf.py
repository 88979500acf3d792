"""results.xdmf and bodies.xdmf show what results.h5 holds, for every element: the first one read as text, and in the
full set by ParaView's three readers where pvpython is installed, the second one by meshio."""
import json
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree

import h5py
import meshio
import numpy

from harness import Check, arguments, run, SCENES

PLANE = [
    "geometry=plane_strain", "supports=[{surface: x_min, ux: 0}, {surface: y_min, uy: 0}]",
    "loads=[{surface: y_max, uy: -0.1}]"
]
SOLID = [
    "supports=[{surface: x_min, ux: 0}, {surface: y_min, uy: 0}, {surface: z_min, uz: 0}]",
    "loads=[{surface: y_max, uy: -0.1}]"
]
FLAT = [
    "geometry=plane_strain", "mesh.parameters.solid=0",
    "supports=[{surface: lower_bottom, uy: 0}, {surface: symmetry_x, ux: 0}]"
]
STEPS = "stepping={control: fixed, initial: 0.5}"
# Runs: scene, overrides. Two bodies in contact of each order and dimension, then one of simplices.
RUNS = {
    "hex27": ("contact_patch.yaml", ["mesh.order=2"]),
    "quad4": ("contact_patch.yaml", FLAT),
    "hex8": ("contact_patch.yaml", []),
    "quad9": ("contact_patch.yaml", ["mesh.order=2", *FLAT]),
    "tri3": ("patch_plane.yaml", ["mesh.parameters.tri=1", *PLANE]),
    "tri6": ("patch_plane.yaml", ["mesh.parameters.tri=1", "mesh.order=2", *PLANE, "geometry=axisymmetric"]),
    "tet4": ("patch.yaml", ["mesh.parameters.tet=1", *SOLID]),
    "tet10": ("patch.yaml", ["mesh.parameters.tet=1", "mesh.order=2", *SOLID]),
}
VTK = {"tri3": 5, "quad4": 9, "tet4": 10, "hex8": 12, "tri6": 22, "tet10": 24, "quad9": 28, "hex27": 29}  # cell types
NODES = {
    "Triangle": 3,
    "Triangle_6": 6,
    "Quadrilateral": 4,
    "Quadrilateral_9": 9,
    "Tetrahedron": 4,
    "Tetrahedron_10": 10,
    "Hexahedron": 8,
    "Hexahedron_27": 27
}


# Two bodies, one of triangles and one of quadrilaterals
TWO_TYPES = """For k In {0:1}
  p = 4 * k + 1;
  Point(p) = {0, k, 0};  Point(p + 1) = {1, k, 0};  Point(p + 2) = {1, k + 1, 0};  Point(p + 3) = {0, k + 1, 0};
  Line(p) = {p, p + 1};  Line(p + 1) = {p + 1, p + 2};  Line(p + 2) = {p + 2, p + 3};  Line(p + 3) = {p + 3, p};
  Curve Loop(k + 1) = {p : p + 3};
  Plane Surface(k + 1) = {k + 1};
  Physical Surface(Sprintf("body_%g", k)) = {k + 1};
EndFor
Transfinite Curve {1 : 8} = 4;
Transfinite Surface {1, 2};
Recombine Surface {2};
Physical Curve("bottom") = {1};
Physical Curve("top") = {7};
"""
BODIES = "bodies=[" + ", ".join(f"{{volume: body_{k}, material: {{law: linear, E: 1000, nu: 0.3}}}}"
                                for k in (0, 1)) + "]"
MESHIO = {"tri3": "triangle", "quad4": "quad", "tet4": "tetra", "hex8": "hexahedron", "tri6": "triangle6",
          "tet10": "tetra10", "quad9": "quad9", "hex27": "hexahedron27"}


def two_types(directory):
    """The overrides of a run whose bodies have elements of different types."""
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "two_types.geo").write_text(TWO_TYPES)
    held = ", ".join(f"{{surface: {name}, ux: 0, uy: 0}}" for name in ("bottom", "top"))
    return [f"mesh={{file: {(directory / 'two_types.geo').resolve()}}}", "geometry=plane_strain", "kinematics=small",
            BODIES, f"supports=[{held}]", STEPS,
            "loads=[{volume: body_0, body_force: [1, 0]}, {volume: body_1, body_force: [2, 0]}]"]


def as_meshio(directory, what, check):
    """meshio reads times, cells and displacements as they are."""
    with h5py.File(directory / "results.h5", "r") as file:
        cells = {MESHIO[name[6:]]: table[()] for name, table in file["mesh"].items() if name[6:] in MESHIO}
        nodes = file["mesh/nodes"][()]
        steps = [(float(step.attrs["t"]), step["displacement"][()]) for _, step in sorted(file["steps"].items())]
    with meshio.xdmf.TimeSeriesReader(directory / "bodies.xdmf") as reader:
        points, blocks = reader.read_points_cells()
        read = [reader.read_data(k) for k in range(reader.num_steps)]
    found = {}
    for block in blocks:
        found.setdefault(block.type, []).append(block.data)
    same = found.keys() == cells.keys() and all(
        numpy.array_equal(numpy.unique(numpy.concatenate(found[name]), axis=0), numpy.unique(table, axis=0))
        for name, table in cells.items())
    check.holds(f"meshio, {what}: nodes and cells", same and numpy.array_equal(points, nodes), f"{list(found)}")
    check.holds(f"meshio, {what}: steps", [t for t, _, _ in read] == [t for t, _ in steps] and all(
        numpy.array_equal(data["displacement"], u) for (_, data, _), (_, u) in zip(read, steps)), f"{len(read)}")


def item(element, directory):
    """Values of a DataItem, by h5py."""
    shape = tuple(int(n) for n in element.get("Dimensions").split())
    name, path = element.text.split(":")
    with h5py.File(directory / name, "r") as file:
        values = file[path][()]
    assert values.shape == shape, f"{element.text}: {values.shape} instead of {shape}"
    return values


def as_text(directory, element, check):
    """Every DataItem is there with the shape it claims; times, cells and nodal arrays are those of results.h5."""
    grids = xml.etree.ElementTree.parse(directory / "results.xdmf").getroot().find("Domain/Grid").findall("Grid")
    blocks = []
    with h5py.File(directory / "results.h5", "r") as file:
        times = [float(grid.find("Time").get("Value")) for grid in grids]
        check.holds(f"{element}: times", times == [float(step.attrs["t"]) for _, step in sorted(file["steps"].items())])
        cells = len(file[f"mesh/cells_{element}"])
        points = len(file["mesh/nodes"])
    for grid in grids:
        count = 0
        for block in grid.findall("Grid"):
            topology = block.find("Topology")
            ids = item(topology[0], directory)
            count += len(ids)
            shape = (int(topology.get("NumberOfElements")), NODES[topology.get("TopologyType")])
            good = ids.shape == shape and ids.min() >= 0 and ids.max() < points
            check.holds(f"{element}: {block.get('Name')}", good
                        and item(block.find("Geometry")[0], directory).shape == (points, 3))
            sums = {
                attribute.get("Name"): float(numpy.nansum(item(attribute[0], directory)))
                for attribute in block.findall("Attribute")
            }
            blocks.append((len(ids), sums))
        check.holds(f"{element}: all cells at t = {grid.find('Time').get('Value')}", count == cells)
    return times, blocks


def as_paraview(files, expected, check):
    """The same times, blocks, cell types and sums of arrays; nodes in VTK's order: middle nodes in the middle of VTK's
    edges and faces, positive volumes."""
    reader = pathlib.Path(__file__).with_name("xdmf_paraview.py")
    line = ["pvpython", "--force-offscreen-rendering", str(reader), *map(str, files.values())]
    finished = subprocess.run(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    lines = [json.loads(line) for line in finished.stdout.splitlines() if line.startswith("{")]
    check.holds("pvpython", finished.returncode == 0 and len(lines) == 3 * len(files),
                "" if finished.returncode == 0 else finished.stderr[-1000:])
    names = {str(file): element for element, file in files.items()}
    for line in lines:
        element = names[line["file"]]
        times, blocks = expected[element]
        what = f"ParaView, {line['reader']}, {element}"
        check.holds(f"{what}: times", numpy.allclose(line["times"], times, rtol=1e-12))
        check.holds(f"{what}: blocks", [block["cells"] for block in line["blocks"]] == [cells for cells, _ in blocks])
        check.holds(f"{what}: cell types", all(block["types"] == [VTK[element]] for block in line["blocks"]))
        check.near(f"{what}: middle nodes", max(block["off_middle"] for block in line["blocks"]), 0,
                   1e-9)  # the sides of all elements are straight
        check.holds(f"{what}: volumes", min(block["least_volume"] for block in line["blocks"]) > 0)
        for block, (_, sums) in zip(line["blocks"], blocks):
            if block["sums"].keys() != sums.keys() or not numpy.allclose([block["sums"][name] for name in sums],
                                                                         list(sums.values()), rtol=1e-9, atol=1e-9):
                check.holds(f"{what}: arrays", False, f"{block['sums']} instead of {sums}")


args = arguments(("elements", "names of RUNS apart by -, or all"), ("by", "who reads the file", ["text", "paraview"]))
check = Check()
chosen = list(RUNS) if args.elements == "all" else args.elements.split("-")
files, expected = {}, {}
for element in chosen:
    scene, overrides = RUNS[element]
    directory = run(args, SCENES / scene, "-quiet", out=element, overrides=[*overrides, STEPS]).directory
    files[element] = directory / "results.xdmf"
    expected[element] = as_text(directory, element, check)
    as_meshio(directory, element, check)
directory = pathlib.Path(args.out) / "two_types"
run(args, SCENES / "patch_plane.yaml", "-quiet", out="two_types/run", overrides=two_types(directory))
as_meshio(directory / "run", "triangles and quadrilaterals", check)
if args.by == "paraview" and shutil.which("pvpython"):
    as_paraview(files, expected, check)
elif args.by == "paraview" and not check.failed:
    print(
        "     skipped: there is no pvpython here to ask (Debian: apt install python3-paraview); as text results.xdmf "
        "is right"
    )
    sys.exit(77)
check.finish()
