"""Reads run.h5 and run.xdmf, as unit_tests/framework/files/RunFileTest.cpp leaves them, the way users' programs do:
h5py, VTK's vtkHDFReader, and the XDMF 3 library that ParaView reads with."""

import os
import re
import sys

import h5py
import numpy as np

PARTICLES = 60
STEPS = [0, 2, 4]
TIME_STEP = 0.25
IDS = np.arange(PARTICLES)
POSITIONS = 1e-6 * (IDS[:, None] + 0.1 * np.arange(3)[None, :])


def temperature(step):
    return 293.15 + IDS / 3.0 + 100.0 * step


def enthalpy(step):
    return -1.0 * IDS - 1000.0 * step


def equal(found, expected, what):
    np.testing.assert_array_equal(found, expected, err_msg=what)


def check_h5py(path):
    with h5py.File(path) as file:
        equal(file["particle"], IDS, "particle")
        equal(file["position"], POSITIONS, "position")
        equal(file["time"], [step * TIME_STEP for step in STEPS] + [np.nan], "time")
        equal(file["step"], STEPS + [-1], "step")
        for name, values in (("temperature", temperature), ("enthalpy", enthalpy)):
            expected = np.array([values(step) for step in STEPS] + [np.full(PARTICLES, np.nan)])
            equal(file[name], expected, name)
            for k in range(4):
                equal(file[f"frame/{name}/{k}"], expected[k], f"frame/{name}/{k}")
        units = [file[name].attrs["unit"] for name in ("temperature", "enthalpy", "position", "time")]
        equal(units, ["K", "J/kg", "m", "s"], "units")
        equal(file.attrs["input"], 'a: <1 & "2">', "input")
        equal(file.attrs["kiln"], "0.1.0", "kiln")


def check_vtk(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    equal(reader.CanReadFile(path), 1, "vtkHDFReader.CanReadFile")
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    equal(grid.GetNumberOfCells(), PARTICLES, "VTK cells")
    equal([grid.GetCellType(i) for i in range(PARTICLES)], [1] * PARTICLES, "VTK cell types")
    equal([grid.GetCell(i).GetPointId(0) for i in range(PARTICLES)], IDS, "VTK cells' points")
    equal(vtk_to_numpy(grid.GetPoints().GetData()), POSITIONS, "VTK points")
    for name, values in (("temperature", temperature(4)), ("enthalpy", enthalpy(4)), ("particle", IDS)):
        equal(vtk_to_numpy(grid.GetPointData().GetArray(name)), values, "VTK " + name)


def xdmf_library():
    """Debian's python3-xdmf: its Python layer does not import, and its compiled layer misses functions of libXdmf that
    nobody calls. Binding lazily, and calling the compiled layer directly, gets at the reader all the same."""
    sys.setdlopenflags(os.RTLD_LAZY | os.RTLD_GLOBAL)
    from xdmf import __Xdmf as model
    from xdmf import __XdmfCore as core

    return model, core


def check_xdmf(path):
    model, core = xdmf_library()

    def values(array):
        core.XdmfArray_read(array)
        return np.array(core.XdmfArray_getValuesString(array).split(), dtype=float)

    domain = model.XdmfReader_read(model.XdmfReader_New(), path)
    equal(model.XdmfDomain_getNumberGridCollections(domain), 1, "XDMF collections")
    collection = model.XdmfDomain_getGridCollection(domain, 0)
    equal(model.XdmfDomain_getNumberUnstructuredGrids(collection), len(STEPS), "XDMF grids")
    for k, step in enumerate(STEPS):
        grid = model.XdmfDomain_getUnstructuredGrid(collection, k)
        equal(model.XdmfTime_getValue(model.XdmfGrid_getTime(grid)), step * TIME_STEP, "XDMF time")
        geometry = model.XdmfUnstructuredGrid_getGeometry(grid)
        equal(model.XdmfGeometry_getNumberPoints(geometry), PARTICLES, "XDMF points")
        equal(values(geometry).reshape(-1, 3), POSITIONS, "XDMF positions")
        topology = model.XdmfUnstructuredGrid_getTopology(grid)
        equal(values(topology), IDS, "XDMF topology")
        equal(model.XdmfTopology_getNumberElements(topology), PARTICLES, "XDMF cells")
        found = {}
        for i in range(model.XdmfGrid_getNumberAttributes(grid)):
            attribute = model.XdmfGrid_getAttribute(grid, i)
            found[model.XdmfAttribute_getName(attribute)] = values(attribute)
        equal(sorted(found), ["enthalpy", "temperature"], "XDMF attributes")
        equal(found["temperature"], temperature(step), "XDMF temperature")
        equal(found["enthalpy"], enthalpy(step), "XDMF enthalpy")


def check_relative(path):
    with open(path, encoding="utf-8") as file:
        places = set(re.findall(r">([^<>\s]+):/", file.read()))
    equal(sorted(places), ["run.h5"], "XDMF's file names")


if __name__ == "__main__":
    folder = os.path.abspath(sys.argv[1])
    check_h5py(os.path.join(folder, "run.h5"))
    check_vtk(os.path.join(folder, "run.h5"))
    check_relative(os.path.join(folder, "run.xdmf"))
    check_xdmf(os.path.join(folder, "run.xdmf"))
    print("read back:", folder)
