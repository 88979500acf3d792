"""results.vtkhdf shows VTK what it holds by steps, and tools that move: read by h5py as the format says, and by VTK's
own reader and PyVista where Python has them."""

import importlib.util
import pathlib

import h5py
import numpy

from harness import Check, arguments, run, SCENES

SCENE = """name: tools
mesh: {{file: {mesh}/square.geo, order: {order}, parameters: {{nx: 4, ny: 4, skew: 0}}}}
geometry: {geometry}
kinematics: small
bodies:
  - {{volume: block, material: {{law: linear, E: 1000, nu: 0.3}}}}
supports:
  - {{surface: x_min, ux: 0}}
  - {{surface: y_min, uy: 0}}
contact:
  - {{name: foot, slave: y_max, master: {tool}}}
stepping: {{control: fixed, initial: 0.05}}
"""
TOOLS = {
    "plane": ("plane_strain", 1, "{plane: {point: [0, 1], normal: [0, -1], motion: [{uy: -0.01}]}}"),
    "cylinder": ("plane_strain", 2, "{cylinder: {point: [0, 3], radius: 2, motion: [{uy: -0.01}]}}"),
    "sphere": ("axisymmetric", 1, "{sphere: {centre: [0, 3], radius: 2, motion: [{uy: -0.01}]}}"),
}
args = arguments()
check = Check()


def array(file, name, step):
    """A nodal array of a step, found as a reader of the format finds it."""
    part = file["VTKHDF"]
    first = part[f"Steps/PointDataOffsets/{name}"][step]
    return part[f"PointData/{name}"][first:first + part["NumberOfPoints"][0]]


def by_format(what, path):
    with h5py.File(path, "r") as file:
        part, steps = file["VTKHDF"], sorted(file["steps"])
        nodes, tool = len(file["mesh/nodes"]), next(iter(file["tools"].values()))
        check.holds(f"{what}: header",
                    part.attrs["Type"] == b"UnstructuredGrid" and list(part.attrs["Version"]) == [2, 0])
        check.holds(f"{what}: steps", part["Steps"].attrs["NSteps"] == len(steps) == len(part["Steps/Values"]) and
                    list(part["Steps/Values"]) == [file["steps"][step].attrs["t"] for step in steps], f"{len(steps)}")
        check.holds(f"{what}: points",
                    numpy.array_equal(part["Points"], numpy.vstack([file["mesh/nodes"], tool["nodes"]])))
        cells, ends = part["Connectivity"][()], part["Offsets"][()]
        check.holds(f"{what}: cells", ends[-1] == len(cells) and len(ends) == len(part["Types"]) + 1
                    and cells[:ends[len(file["mesh/block_0"])]].max() < nodes and cells[ends[-2]:].min() >= nodes
                    and set(part["CellData/body"]) == {0, 1})
        same = True
        for k, step in enumerate(steps):
            group = file["steps"][step]
            moved = group["tools"][tool.name.split("/")[-1]]
            same &= numpy.array_equal(array(file, "displacement", k)[:nodes], group["displacement"])
            same &= numpy.array_equal(array(file, "displacement", k)[nodes:], moved["displacement"])
            same &= numpy.array_equal(array(file, "stress", k)[:nodes], group["stress"])
            same &= numpy.array_equal(array(file, "stress_xy", k)[:nodes], group["stress"][:, 3])
            same &= numpy.array_equal(array(file, "pressure", k)[:nodes], group["pressure"])
            same &= numpy.array_equal(group["stress_yy"], group["stress"][:, 1])
        check.holds(f"{what}: arrays of {len(steps)} steps", same)
        moved = array(file, "displacement", len(steps) - 1)[nodes:]
        check.near(f"{what}: the tool's motion", moved, numpy.array([0, -0.01, 0]), 1e-14)


def by_vtk(what, path):
    """The largest displacement and stress of each step, as VTK reads them."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
    from vtkmodules.vtkIOHDF import vtkHDFReader
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    information = reader.GetOutputInformation(0)
    times = information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    good = True
    with h5py.File(path, "r") as file:
        for k, t in enumerate(times):
            information.Set(vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP(), t)
            reader.Update()
            data = reader.GetOutputDataObject(0).GetPointData()
            for name in ("displacement", "stress", "pressure"):
                good &= numpy.array_equal(vtk_to_numpy(data.GetArray(name)), array(file, name, k), equal_nan=True)
        good &= len(times) == len(file["steps"])
    check.holds(f"{what}: VTK reads the same", good)


def by_pyvista(what, path):
    """The grid of the last step with its arrays, and its bodies apart."""
    import pyvista
    grid = pyvista.read(path)
    with h5py.File(path, "r") as file:
        good = grid.n_points == file["VTKHDF/NumberOfPoints"][0] and grid["stress"].shape == (grid.n_points, 6)
        good &= set(file["VTKHDF/PointData"]) <= set(grid.point_data)
    parts = [grid.extract_cells(grid["body"] == body).n_cells for body in (0, 1)]
    check.holds(f"{what}: PyVista reads it, tools apart",
                good and min(parts) > 0 and sum(parts) == grid.n_cells, f"{parts}")


readers = [by_format]
for module, reader in (("vtkmodules.vtkIOHDF", by_vtk), ("pyvista", by_pyvista)):
    if importlib.util.find_spec(module.split(".")[0]):
        readers.append(reader)
    else:
        print(f"     {module.split('.')[0]} is not there to read the files as well (pip install vtk pyvista)")
for name, (geometry, order, tool) in TOOLS.items():
    scene = SCENES.parents[1] / "meshes"
    path = pathlib.Path(args.out).resolve() / f"{name}.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(SCENE.format(mesh=scene, geometry=geometry, order=order, tool=tool))
    directory = run(args, path, "-quiet", out=name).directory
    check.holds(f"{name}: second name",
                (directory / "results.vtkhdf").resolve() == (directory / "results.h5").resolve())
    for reader in readers:
        reader(name, directory / "results.vtkhdf")
(directory / "error.log").write_text("of an earlier run")
run(args, path, "-quiet", "-overwrite", out=name, overrides=["output.fields=[]"])
with h5py.File(directory / "results.vtkhdf", "r") as file:
    check.holds("no fields: steps all the same", file["VTKHDF/Steps"].attrs["NSteps"] > 1)
check.holds("no fields: the earlier run's files are gone", not (directory / "error.log").exists())
check.finish()
