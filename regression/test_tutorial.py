"""docs/tutorial-plugin.md, followed to the letter by a newcomer who has nothing but an installed Kiln: the files it shows are
written into an empty folder and its commands run there, one after the other.

The environment names the build to install: KILN_BUILD; and CMAKE."""

import hashlib
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
import pandas

from harness import HERE, main, program

TUTORIAL = HERE.parent / "docs" / "tutorial-plugin.md"
EXAMPLE = HERE.parent / "unit_tests" / "plugin" / "reaction_diffusion"
FILE = re.compile(r"^`([^`\n]+)`:\n\n```\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMMANDS = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def final_state(run_folder):
    """x in m and u at the last moment, by particle."""
    with h5py.File(run_folder / "run.h5") as file:
        order = np.argsort(file["particle"][:])
        return file["position"][:][order, 0], file["density"][-1][order], float(file["time"][-1])


def closed_form(x, time):
    """The front of Ablowitz and Zeppetella (1979) for the values in front.yaml."""
    diffusivity, growth, start = 1e-6, 1.0, 25e-3
    speed = 5.0 * np.sqrt(diffusivity * growth / 6.0)
    return (1.0 + np.exp((x - start - speed * time) * np.sqrt(growth / (6.0 * diffusivity)))) ** -2.0


def error(a, b):
    return float(np.linalg.norm(a - b) / np.linalg.norm(b))


class TutorialTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="kiln-tutorial-")
        cls.addClassCleanup(temporary.cleanup)
        root = Path(temporary.name)
        cls.prefix, cls.folder = root / "prefix", root / "empty"
        cls.folder.mkdir()
        install = program(root, os.environ["CMAKE"], "--install", os.environ["KILN_BUILD"], "--prefix", cls.prefix)
        assert install.status == 0, install.stderr
        text = TUTORIAL.read_text()
        cls.files = dict(FILE.findall(text))
        for name, content in cls.files.items():
            (cls.folder / name).write_text(content)
        script = "set -euxo pipefail\n" + "".join(COMMANDS.findall(text))
        cls.outcome = program(
            cls.folder, "bash", "-c", script, timeout=500,
            environment={
                "PATH": f"{cls.prefix}/bin:{os.environ['PATH']}",
                "CMAKE_PREFIX_PATH": str(cls.prefix),
                "CMAKE_GENERATOR": "Ninja",
            },
        )

    def test_every_command_succeeds(self):
        self.assertEqual(self.outcome.status, 0, self.outcome.stdout + self.outcome.stderr)
        library = "libreaction_diffusion.so"
        # Where the list says the model comes from, and the report of the installed plugin.
        self.assertRegex(self.outcome.stdout, rf"Fisher's equation on a rod +{self.folder.resolve()}/build/{library}\n")
        installed = next(self.prefix.resolve().glob(f"lib*/**/kiln/plugins/{library}"))
        digest = hashlib.sha256(installed.read_bytes()).hexdigest()
        self.assertRegex(self.outcome.stdout, rf"{installed}, sha256 +{digest}\n")

    def test_the_files_shown_are_those_of_the_example(self):
        self.assertEqual(self.files, {path.name: path.read_text() for path in EXAMPLE.iterdir()})
        self.assertLess(self.files["ReactionDiffusion.cpp"].count("\n"), 120)
        self.assertNotIn("jacobian", self.files["ReactionDiffusion.cpp"].lower())

    def test_the_package_knows_nothing_of_the_build(self):
        places = [str(Path(os.environ["KILN_BUILD"]).resolve()), str(HERE.parent) + "/"]
        for path in self.prefix.rglob("*.cmake"):
            for place in places:
                self.assertNotIn(place, path.read_text(), path)
        for name in ("bin/kiln", "lib/libkiln.so"):
            path = next(path for pattern in (name, name.replace("lib/", "lib/*/")) for path in self.prefix.glob(pattern))
            dynamic = subprocess.run(["readelf", "-d", path], capture_output=True, text=True, check=True).stdout
            for place in places:
                self.assertNotIn(place, dynamic)
        linked = subprocess.run(["ldd", self.prefix / "bin" / "kiln"], capture_output=True, text=True, check=True).stdout
        (library,) = re.findall(r"libkiln\.so => (\S+)", linked)
        self.assertTrue(Path(library).resolve().is_relative_to(self.prefix.resolve()), library)

    def test_full_order_against_the_closed_form(self):
        x, u, time = final_state(self.folder / "results" / "fom")
        self.assertEqual((len(x), time), (300, 5.0))
        # Second differences: (Δx)²/12 of the fourth derivative over 5 s.
        self.assertLess(np.abs(u - closed_form(x, time)).max(), 5e-4)
        # The front has moved, by far more than that.
        self.assertGreater(np.abs(u - closed_form(x, 0.0)).max(), 0.5)

    def test_reduced_against_full_order(self):
        _, full, _ = final_state(self.folder / "results" / "fom")
        for method in ("galerkin", "lspg"):
            _, reduced, _ = final_state(self.folder / "results" / method)
            self.assertLess(error(reduced, full), 1e-5, method)
        self.compare_probes("results", "gnat")

    def compare_probes(self, results, method):
        full, reduced = (
            pandas.read_csv(self.folder / results / name / "probes.csv", comment="#").to_numpy()[:, -2:]
            for name in ("fom", method)
        )
        self.assertEqual(full.shape, (101, 2))
        self.assertLess(np.abs(reduced - full).max(), 1e-5, method)
        # A reduction that stood still would be this far off.
        self.assertGreater(np.abs(full - full[0]).max(), 0.4)

    def test_two_ranks(self):
        self.compare_probes("two-ranks", "gnat")
        for name in ("fom", "gnat"):
            one, two = (
                pandas.read_csv(self.folder / results / name / "probes.csv", comment="#").to_numpy()
                for results in ("results", "two-ranks")
            )
            self.assertLess(np.abs(one - two).max(), 1e-6)


if __name__ == "__main__":
    main()
