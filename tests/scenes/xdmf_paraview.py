"""For xdmf.py, under pvpython: what ParaView's three readers make of the files on the command line, a line of JSON for
each reader and file."""
import json
import math
import sys

from paraview import servermanager, simple, vtk
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality

READERS = {
    "XDMF Reader": lambda file: simple.XDMFReader(FileNames=[file]),
    "Xdmf3 Reader S": lambda file: simple.Xdmf3ReaderS(FileName=[file]),
    "Xdmf3 Reader T": lambda file: simple.Xdmf3ReaderT(FileName=[file]),
}


def leaves(data):
    """The grids below a composite data set."""
    if isinstance(data, vtk.vtkMultiPieceDataSet):
        return [data.GetPiece(i) for i in range(data.GetNumberOfPieces())]
    if isinstance(data, vtk.vtkMultiBlockDataSet):
        return [leaf for i in range(data.GetNumberOfBlocks()) for leaf in leaves(data.GetBlock(i))]
    return [data]


def off_middle(grid):
    """How far the last node of VTK's edges and nine-noded faces lies from the mean of their corners, over the edge's
    length; largest of all cells."""
    worst = 0
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        parts = [(cell.GetEdge(i), 2)
                 for i in range(cell.GetNumberOfEdges())] + [(cell.GetFace(i), 4)
                                                             for i in range(cell.GetNumberOfFaces())]
        for part, corners in parts:
            ids = [part.GetPointId(i) for i in range(part.GetNumberOfPoints())]
            if len(ids) == (3 if corners == 2 else 9):
                points = [grid.GetPoint(i) for i in ids]
                middle = [sum(point[i] for point in points[:corners]) / corners for i in range(3)]
                worst = max(worst, math.dist(points[-1], middle) / math.dist(points[0], points[1]))
    return worst


def least_volume(grid):
    """Of the cells as VTK measures them, signed by their corners: area in the plane, counted positive anticlockwise."""
    quality = vtkMeshQuality()
    quality.SetInputData(corners_only(grid))
    quality.SetTriangleQualityMeasureToArea()
    quality.SetQuadQualityMeasureToArea()
    quality.SetTetQualityMeasureToVolume()
    quality.SetHexQualityMeasureToVolume()
    quality.Update()
    return quality.GetOutput().GetCellData().GetArray("Quality").GetRange()[0]


def corners_only(grid):
    """The same cells of first order: VTK's quality measures know no others."""
    first = {
        5: (5, 3),
        22: (5, 3),
        9: (9, 4),
        28: (9, 4),
        10: (10, 4),
        24: (10, 4),
        12: (12, 8),
        29: (12, 8)
    }  # cell type -> first-order type, corners
    linear = vtk.vtkUnstructuredGrid()
    linear.SetPoints(grid.GetPoints())
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        kind, n = first[cell.GetCellType()]
        linear.InsertNextCell(kind, n, [cell.GetPointId(i) for i in range(n)])
    return linear


def sums(grid):
    """Of every nodal array, without its NaN."""
    data, result = grid.GetPointData(), {}
    for a in range(data.GetNumberOfArrays()):
        array = data.GetArray(a)
        values = (value for i in range(array.GetNumberOfTuples()) for value in array.GetTuple(i))
        result[array.GetName()] = math.fsum(value for value in values if not math.isnan(value))
    return result


for name, reader in READERS.items():
    for file in sys.argv[1:]:
        source = reader(file)
        source.UpdatePipelineInformation()
        values = source.TimestepValues
        times = list(values) if hasattr(values, "__len__") else [values]
        blocks = []
        for t in times:
            source.UpdatePipeline(t)
            for grid in leaves(servermanager.Fetch(source)):
                types = sorted({grid.GetCellType(c) for c in range(grid.GetNumberOfCells())})
                measures = {"off_middle": off_middle(grid), "least_volume": least_volume(grid)}
                blocks.append({"cells": grid.GetNumberOfCells(), "types": types, "sums": sums(grid), **measures})
        print(json.dumps({"reader": name, "file": file, "times": times, "blocks": blocks}), flush=True)
        simple.Delete(source)
