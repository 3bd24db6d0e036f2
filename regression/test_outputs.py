"""What Kiln leaves opens in the programs that users have, and what it prints can be fed back to it."""

import json
import os
import re
import shutil
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy as np
import pandas

from harness import SMALL, KilnTest, main

PARTICLES = 24 * 12 * 6
STEPS = [0, 10, 20, 30, 40]
COMMANDS = ("run", "train", "check", "list", "describe", "template", "compare", "report")
# Every registered component: one that a linker dropped, or that came unasked, shows here.
COMPONENTS = {
    "heat source": ["gaussian beam", "none", "uniform flux"],
    "kernel": ["cubic spline", "wendland c2"],
    "linear solver": ["bicgstab", "cg", "gmres"],
    "material": ["316L", "constant", "formula", "table"],
    "method": ["fom", "galerkin", "gnat", "lspg", "ptrom"],
    "model": ["sph heat", "vortex"],
    "observer": ["extremes", "fields", "probes"],
    "particles": ["file", "lattice"],
    "sampling": ["greedy"],
    "source clustering": ["among samples", "paper", "per row", "robust"],
    "time scheme": [
        "backward euler", "bdf2", "explicit euler", "heun", "linear multistep", "rk4", "ssp rk3", "trapezoidal",
    ],
    "trainer": ["procedure ii"],
    "vortex kernel": ["lamb-oseen", "rosenhead-moore"],
    "vortex sum": ["barnes-hut", "direct"],
    "vortices": ["file", "pair", "patches", "random patches", "shear layer"],
}


class RunFilesTest(KilnTest):
    def prepare(self):
        self.solve("run", ranks=2)

    def setUp(self):
        super().setUp()
        self.run_folder = self.folder / "results" / "fom"

    def test_run_file_in_h5py(self):
        with h5py.File(self.run_folder / "run.h5") as file:
            self.assertEqual(file["temperature"].shape, (len(STEPS), PARTICLES))
            np.testing.assert_array_equal(file["step"], STEPS)
            np.testing.assert_allclose(file["time"], np.array(STEPS) * 50e-6, rtol=1e-14)
            np.testing.assert_array_equal(file["particle"], np.arange(PARTICLES))
            np.testing.assert_array_equal(file["temperature"][0], 293.15)
            # x fastest, then y, then z, from the origin, at a spacing of 0.1 mm.
            x, y, z = np.meshgrid(np.arange(24), np.arange(12), np.arange(6), indexing="ij")
            lattice = 1e-4 * np.stack([axis.ravel(order="F") for axis in (x, y, z)], axis=1) - [0.0, 6e-4, 0.0]
            np.testing.assert_allclose(file["position"], lattice, rtol=0.0, atol=1e-15)
            for name, unit in (("temperature", "K"), ("position", "m"), ("time", "s")):
                self.assertEqual(file[name].attrs["unit"], unit)

    def test_provenance(self):
        with h5py.File(self.run_folder / "run.h5") as file:
            attributes = dict(file.attrs)
        self.assertRegex(attributes["commit"], r"^([0-9a-f]{12}(-dirty)?|unknown)$")
        self.assertEqual(attributes["ranks"], "2")
        self.assertEqual(attributes["method"], "fom")
        for key in ("kiln", "trilinos", "mpi", "hdf5", "blas", "compiler", "build_type", "build_flags", "date", "host"):
            self.assertTrue(attributes[key], key)
        checked = self.kiln("check", SMALL, "--set", "output.directory=results")
        self.assertEqual(attributes["input"], checked.stdout)

    def test_hashes_of_all_inputs(self):
        before = json.loads((self.run_folder / "report.json").read_text())["inputs"]
        self.assertEqual([entry["kind"] for entry in before], ["text"] * len(before))
        self.assertTrue(all(re.fullmatch("[0-9a-f]{32}", entry["xxh3"]) for entry in before), before)
        self.assertIn(Path(SMALL).name, [Path(entry["file"]).name for entry in before])
        text = Path(before[0]["file"]).read_text() + "# one more line\n"
        (self.folder / "changed.yaml").write_text(text)
        self.assertEqual(self.kiln("run", "changed.yaml", "--quiet", "--set", "output.directory=changed").status, 0)
        after = json.loads((self.folder / "changed/fom/report.json").read_text())["inputs"]
        self.assertNotEqual(after[0]["xxh3"], before[0]["xxh3"])

    def test_the_input_kept_in_the_run_file_gives_the_same_run(self):
        with h5py.File(self.run_folder / "run.h5") as file:
            (self.folder / "kept.yaml").write_text(file.attrs["input"])
        again = self.kiln("run", "kept.yaml", "--quiet", "--set", "output.directory=again", ranks=2)
        self.assertEqual((again.status, again.stderr), (0, ""))
        for name in ("run.h5", "probes.csv", "extremes.csv"):
            compared = self.kiln("compare", self.run_folder / name, f"again/fom/{name}", "--tolerance", 0)
            self.assertEqual(compared.status, 0, compared.stdout)

    def test_run_file_in_vtk(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOHDF import vtkHDFReader

        path = str(self.run_folder / "run.h5")
        reader = vtkHDFReader()
        self.assertEqual(reader.CanReadFile(path), 1)
        reader.SetFileName(path)
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual(grid.GetNumberOfCells(), PARTICLES)
        with h5py.File(path) as file:
            found = vtk_to_numpy(grid.GetPointData().GetArray("temperature"))
            np.testing.assert_array_equal(found, file["temperature"][-1])
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), file["position"])

    def test_xdmf(self):
        root = ElementTree.parse(self.run_folder / "run.xdmf").getroot()
        frames = root.findall("./Domain/Grid[@CollectionType='Temporal']/Grid")
        self.assertEqual(len(frames), len(STEPS))
        times = [float(frame.find("Time").get("Value")) for frame in frames]
        np.testing.assert_allclose(times, np.array(STEPS) * 50e-6, rtol=1e-14)
        for k, frame in enumerate(frames):
            for item in frame.iter("DataItem"):
                name, dataset = item.text.strip().split(":")
                self.assertEqual(name, "run.h5", "a path relative to the file itself")
                shape = tuple(int(size) for size in item.get("Dimensions").split())
                with h5py.File(self.run_folder / name) as file:
                    self.assertEqual(file[dataset].shape, shape, dataset)
            values = frame.find("./Attribute[@Name='temperature']/DataItem").text.strip().split(":")[1]
            with h5py.File(self.run_folder / "run.h5") as file:
                np.testing.assert_array_equal(file[values], file["temperature"][k])

    def test_tables_in_pandas(self):
        probes = pandas.read_csv(self.run_folder / "probes.csv", float_precision="round_trip")
        names = ["path", "side", "deep"]
        self.assertEqual(list(probes), ["step", "time [s]"] + [f"{name} temperature [K]" for name in names])
        np.testing.assert_array_equal(probes["step"], np.arange(41))
        np.testing.assert_allclose(probes["time [s]"], np.arange(41) * 50e-6, rtol=1e-14)
        extremes = pandas.read_csv(self.run_folder / "extremes.csv", float_precision="round_trip").set_index("step")
        places = {place["name"]: place for place in json.loads((self.run_folder / "probes.json").read_text())}
        self.assertEqual(list(places), names)
        with h5py.File(self.run_folder / "run.h5") as file:
            for frame, step in enumerate(STEPS):
                field = np.asarray(file["temperature"][frame])
                for name in names:
                    found = probes[f"{name} temperature [K]"][step]
                    self.assertEqual(found, field[places[name]["particle"]])
                self.assertEqual(extremes["largest temperature [K]"][step], field.max())
                self.assertEqual(extremes["smallest temperature [K]"][step], field.min())
                self.assertEqual(extremes["particle of largest temperature"][step], field.argmax())
                self.assertEqual(extremes["particle of smallest temperature"][step], field.argmin())

    def test_report(self):
        shown = self.kiln("report", "results/fom")
        self.assertEqual((shown.status, shown.stderr), (0, ""))
        self.assertEqual(shown.stdout, (self.run_folder / "report.txt").read_text())
        report = json.loads((self.run_folder / "report.json").read_text())
        self.assertEqual(report["run"]["status"], "complete")
        self.assertEqual(report["provenance"]["ranks"], 2)
        self.assertIn("kiln: rate", report["timers"]["table"])
        times = report["time"]
        parts = times["steps_wall_s"] + times["observers_wall_s"]
        self.assertTrue(0.9 * times["loop_wall_s"] < parts <= times["loop_wall_s"], times)

    def test_steps_that_were_left_unsolved_are_told(self):
        words = [w for o in ("time.newton.iterations=1", "time.newton.tolerance=1e-12") for w in ("--set", o)]
        outcome = self.kiln("run", SMALL, *words, "--set", "output.directory=capped", "--quiet", ranks=2)
        self.assertEqual((outcome.status, outcome.stdout), (0, ""))
        text = "40 of 40 steps were left unsolved at the cap of iterations"
        self.told(outcome, [text])
        report = json.loads((self.folder / "capped/fom/report.json").read_text())
        self.assertEqual(report["solve"]["capped_steps"], 40)
        self.assertGreater(report["solve"]["most_left"], 1e-12)
        self.assertTrue(report["run"]["warnings"][0].startswith(text))
        self.assertIn(text, (self.folder / "capped/fom/report.txt").read_text())
        outcome = self.kiln("train", SMALL, *words, "--set", "output.directory=capped", "--quiet")
        self.assertIn("warning: full order: 40 of 40 steps were left unsolved", outcome.stderr)

    def test_a_source_that_heats_nothing_is_told(self):
        self.solve("run", "model.heat_source.start=[1 m, 1 m]", into="missed", ranks=2,
                   warnings=["the heat source has heated no particle"])
        self.solve("run", into="met")
        absorbed = [json.loads((self.folder / f"{into}/fom/report.json").read_text())["method"]["model"]["mean_absorbed_watt"]
                    for into in ("missed", "met")]
        self.assertEqual(absorbed[0], 0.0)
        # The beam is as wide as a spacing and a half; printed as it stands in the report it would deposit π times as much.
        self.assertAlmostEqual(absorbed[1], 20.0, delta=2.0)

    def test_names_that_are_no_utf_8(self):
        name = os.fsdecode(b"caf\xe9.yaml")
        shutil.copy(SMALL, self.folder / name)
        outcome = self.kiln("run", name, "--set", "output.directory=named", "--quiet")
        self.assertEqual((outcome.status, outcome.stderr), (0, ""))
        self.assertIn("caf\ufffd.yaml", json.loads((self.folder / "named/fom/report.json").read_text())["run"]["input"])

    def test_nothing_else_is_left(self):
        expected = ["checkpoint.h5", "extremes.csv", "probes.csv", "probes.json", "report.json", "report.txt"]
        self.assertEqual(sorted(path.name for path in self.run_folder.iterdir()), expected + ["run.h5", "run.xdmf"])


class PrintedTest(KilnTest):
    def printed(self, *arguments):
        outcome = self.kiln(*arguments)
        self.assertEqual((outcome.status, outcome.stderr), (0, ""), arguments)
        self.assertTrue(outcome.stdout.strip(), arguments)
        return outcome.stdout

    def test_help_is_kilns_own(self):
        text = self.printed("--help")
        for command in COMMANDS:
            self.assertIn(f"\n  {command} ", text)
            own = self.printed(command, "--help")
            self.assertIn(f"kiln {command} [OPTIONS]", own)
            self.assertNotIn("Kokkos", text + own)

    def test_version(self):
        self.assertRegex(self.printed("--version"), r"\d+\.\d+\.\d+")

    def test_list_and_describe(self):
        listed = self.printed("list").splitlines()
        name, summary = listed[0].index("name"), listed[0].index("summary")
        components = {}
        for line in listed[1:]:
            components.setdefault(line[:name].strip(), []).append(line[name:summary].strip())
        self.assertEqual(components, COMPONENTS)
        for name in ("sph heat", "gnat", "lattice", "probes", "procedure ii", "gmres"):
            self.assertIn(name, self.printed("describe", name))
        self.assertIn("directory", self.printed("describe", "input"))
        self.assertIn("sph heat", self.printed("describe", "model"))

    def test_what_check_prints_is_an_input_that_prints_the_same(self):
        text = self.printed("check", SMALL)
        (self.folder / "checked.yaml").write_text(text)
        self.assertEqual(self.printed("check", "checked.yaml"), text)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["checked.yaml"], "check leaves nothing behind")

    def test_filled_template_passes_check(self):
        block = self.printed("template", "sph heat")
        values = {
            "particles": "{type: lattice, origin: [0 mm, 0 mm, 0 mm], size: [1 mm, 1 mm, 1 mm], count: [5, 5, 5]}",
            "material": "316L",
            "initial_temperature": "293.15 K",
            "heat_source": "none",
        }
        required = re.findall(r"^(\w+): +# required", block, re.MULTILINE)
        self.assertEqual(sorted(required), sorted(values))
        for key in required:
            block = re.sub(rf"^{key}: +#", f"{key}: {values[key]}  #", block, flags=re.MULTILINE)
        indented = "".join(f"  {line}\n" for line in block.splitlines())
        (self.folder / "filled.yaml").write_text(f"model:\n{indented}time: {{end: 1 ms, step: 0.1 ms}}\n")
        self.assertIn("type: sph heat", self.printed("check", "filled.yaml"))

    def test_templates(self):
        for name in ("input", "gnat", "lattice", "probes", "procedure ii", "gmres", "linear multistep"):
            self.assertIn("#", self.printed("template", name))

    def test_option_before_and_after_the_file(self):
        title = "title=Set twice"
        for words in (("--set", title, SMALL), (SMALL, "--set", title), (SMALL, f"--set={title}")):
            self.assertTrue(self.printed("check", *words).startswith("title: Set twice\n"))

    def test_loud_and_quiet(self):
        loud = self.kiln("run", SMALL)
        self.assertEqual(loud.status, 0)
        self.assertIn("step 40 of 40", loud.stderr)
        self.assertEqual(loud.stdout, (self.folder / "results" / "fom" / "report.txt").read_text())
        training = self.kiln("train", SMALL)
        self.assertEqual(training.status, 0)
        self.assertIn("training", training.stderr)
        self.solve("run")
        self.solve("train")


if __name__ == "__main__":
    main()
