"""results.xdmf shows what results.h5 holds, for every element: read as text, and in the full set by ParaView's three
readers where pvpython is installed."""
import json
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree

import h5py
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
if args.by == "paraview" and shutil.which("pvpython"):
    as_paraview(files, expected, check)
elif args.by == "paraview" and not check.failed:
    print(
        "     skipped: there is no pvpython here to ask (Debian: apt install python3-paraview); as text results.xdmf "
        "is right"
    )
    sys.exit(77)
check.finish()
