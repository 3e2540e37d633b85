#!/usr/bin/env python3
"""Reads every .vtu, .vti and .pvd in a folder with the readers that viewers use.

    pip install vtk meshio
    cargo test -p finegrain-framework --test format_read_back
    python tests/read_back.py FOLDER

The test format_read_back says in its output where it leaves its files.

Prints what the readers found, and fails if a file cannot be read, if an array is not finite or has
another length than there are points, if the two readers disagree, or if a time series names a file
that is not there. Without vtk, only the .vtu files are read as grids.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy as np

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLUnstructuredGridReader
except ImportError:
    vtk_to_numpy = None


def check(path, points, arrays):
    """The arrays of one file: finite, and one value or vector for each point."""
    for name, values in arrays.items():
        assert len(values) == points, f"{path}: {name} has {len(values)} values, not {points}"
        assert np.isfinite(values).all(), f"{path}: {name} is not finite"
        ends = f"{values.min():g} .. {values.max():g}" if values.size else "no values"
        print(f"    {name!r}: {values.dtype} {values.shape}, {ends}")


def with_vtk(reader, path):
    """The grid that VTK's own reader makes of a file, its arrays and its time."""
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(path))
    reader.SetFileName(str(path))
    reader.Update()
    assert not errors, f"{path}: VTK cannot read it"
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = {
        data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
        for i in range(data.GetNumberOfArrays())
    }
    time = grid.GetFieldData().GetArray("TimeValue")
    return grid, arrays, time.GetValue(0) if time else None


def read_vtu(path):
    # meshio stumbles over any grid of no points; VTK reads it.
    empty = b'NumberOfPoints="0"' in path.read_bytes()
    mesh = None if empty else meshio.read(path)
    if mesh:
        vertices = sum(len(cells.data) for cells in mesh.cells if cells.type == "vertex")
        assert vertices == len(mesh.points), f"{path}: {vertices} vertices"
        assert np.isfinite(mesh.points).all(), f"{path}: points are not finite"
        print(f"  meshio: {len(mesh.points)} points")
        check(path, len(mesh.points), mesh.point_data)
    if vtk_to_numpy is None:
        return
    grid, arrays, time = with_vtk(vtkXMLUnstructuredGridReader(), path)
    print(f"  vtk: {grid.GetNumberOfPoints()} points, {grid.GetNumberOfCells()} cells, time {time}")
    check(path, grid.GetNumberOfPoints(), arrays)
    assert grid.GetNumberOfCells() == grid.GetNumberOfPoints()
    if mesh:
        assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), mesh.points)
        assert arrays.keys() == mesh.point_data.keys()
        for name, values in arrays.items():
            assert np.array_equal(values, mesh.point_data[name]), f"{path}: {name} differs"


def read_vti(path):
    if vtk_to_numpy is None:
        return
    grid, arrays, time = with_vtk(vtkXMLImageDataReader(), path)
    print(
        f"  vtk: dimensions {grid.GetDimensions()}, origin {grid.GetOrigin()}, "
        f"spacing {grid.GetSpacing()}, time {time}"
    )
    check(path, grid.GetNumberOfPoints(), arrays)


def read_pvd(path):
    root = ElementTree.parse(path).getroot()
    assert root.get("type") == "Collection"
    sets = root.findall("Collection/DataSet")
    times = [float(entry.get("timestep")) for entry in sets]
    assert np.isfinite(times).all() and times == sorted(times), f"{path}: times {times}"
    for time, entry in zip(times, sets):
        file = path.parent / entry.get("file")
        assert file.is_file(), f"{path}: no file {file}"
        if vtk_to_numpy is not None and file.suffix == ".vti":
            assert with_vtk(vtkXMLImageDataReader(), file)[2] == time, f"{file}: another time"
    print(f"  {len(sets)} files, times {times}")


READERS = {".vtu": read_vtu, ".vti": read_vti, ".pvd": read_pvd}


def main(folder):
    files = sorted(file for file in Path(folder).iterdir() if file.suffix in READERS)
    assert files, f"no .vtu, .vti or .pvd in {folder}"
    for file in files:
        print(file.name)
        READERS[file.suffix](file)
    print(f"{len(files)} files read{'' if vtk_to_numpy else ', without vtk'}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
