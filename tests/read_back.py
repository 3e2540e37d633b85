#!/usr/bin/env python3
"""Reads every .vtu, .vti and .pvd in a folder with the readers that viewers use.

    pip install vtk meshio
    cargo test -p finegrain-framework --test format_read_back
    python tests/read_back.py FOLDER [HISTORY COLUMN ARRAY]

The test format_read_back says in its output where it leaves its files.

Prints what the readers found, and fails if a file cannot be read, if an array is not finite or has
another length than there are points, if the two readers disagree, if a time series names a file
that is not there, or if what was read is not what was written: the formulas of format_read_back, the
numbers of particles, each once, and, where a history of the same run is named, the sum of an array over
all points, which is in a column of it for the time of each file. Without vtk, only the .vtu files are
read as grids.
"""

import csv
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


# What format_read_back writes: a value or vector for point number i.
WRITTEN = {
    "particles.vtu": {
        "density": lambda i: 1000 + i,
        "velocity": lambda i: np.stack([3 * i, 3 * i + 1, 3 * i + 2], axis=1),
        "force": lambda i: np.stack([0.1 * i, -1.0 * i, 0.0 * i], axis=1),
        "id": lambda i: i + 2**40,
        "cell": lambda i: 3 * i,
        "a<b & \"c\" > 'd' \u03c1": lambda i: i % 2,
    },
    "grid.vti": {
        "pressure": lambda i: np.sqrt(i),
        "velocity": lambda i: np.stack([i, -1.0 * i, 0.5 + 0 * i], axis=1),
    },
}


def check(path, points, arrays):
    """The arrays of one file: finite, one value or vector for each point, and as written."""
    for name, formula in WRITTEN.get(path.name, {}).items():
        assert np.array_equal(arrays[name], formula(np.arange(points))), f"{path}: {name} differs"
    if "identity" in arrays:
        numbers = np.sort(arrays["identity"])
        assert np.array_equal(numbers, np.arange(points)), f"{path}: not every particle once"
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


def check_sums(folder, history, column, array):
    """The sum of an array over all points of every grid, against what the run itself has summed up."""
    with open(folder / history) as file:
        sums = {float(row["time"]): float(row[column]) for row in csv.DictReader(file)}
    grids = sorted(folder.glob("*.vti"))
    assert grids, f"no .vti in {folder}"
    for path in grids:
        _, arrays, time = with_vtk(vtkXMLImageDataReader(), path)
        total = arrays[array].sum()
        assert np.isclose(total, sums[time], rtol=1e-12), f"{path}: {total}, not {sums[time]}"
    print(f"{len(grids)} sums of {array} as in {history}")


READERS = {".vtu": read_vtu, ".vti": read_vti, ".pvd": read_pvd}


def main(folder, *history):
    files = sorted(file for file in Path(folder).iterdir() if file.suffix in READERS)
    assert files, f"no .vtu, .vti or .pvd in {folder}"
    for file in files:
        print(file.name)
        READERS[file.suffix](file)
    if history and vtk_to_numpy is not None:
        check_sums(Path(folder), *history)
    print(f"{len(files)} files read{'' if vtk_to_numpy else ', without vtk'}")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 5):
        sys.exit(__doc__)
    main(*sys.argv[1:])
