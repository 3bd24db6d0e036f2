"""Runs the built command line the way a user does. The environment names the programs: KILN and MPIEXEC."""

import atexit
import functools
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
SMALL = HERE / "cases" / "small.yaml"
# How much longer a build with sanitizers or counters may take.
SLOWER = float(os.environ.get("KILN_SLOWER", "1"))

# What mpirun adds of its own when a rank ends with another status than 0.
MPIEXEC_NOTICE = re.compile(r"^-{40,}\n.*?^-{40,}\n", re.MULTILINE | re.DOTALL)


class Outcome:
    """Exit status and output of a command, without mpirun's own notices."""

    def __init__(self, status, stdout, stderr):
        self.status = status
        self.stdout = stdout
        self.stderr = MPIEXEC_NOTICE.sub("", stderr)


def command(*arguments, ranks=1):
    """The words of a command line; one rank needs no mpirun."""
    launcher = [os.environ.get("MPIEXEC", "mpiexec"), "-n", str(ranks)] if ranks > 1 else []
    return launcher + [os.environ["KILN"]] + [str(argument) for argument in arguments]


@functools.cache
def sessions():
    """The folder in which Open MPI keeps what it needs to know of runs that stand alone."""
    temporary = tempfile.TemporaryDirectory(prefix="kiln-sessions-")
    atexit.register(temporary.cleanup)
    return temporary.name


def alone():
    """Environment of a run of one rank that starts without Open MPI's daemon, which takes longer than most runs of tests.

    Nothing tells two such runs apart, so that each needs a session folder of its own and no shared memory."""
    return {
        "OMPI_MCA_ess_singleton_isolated": "1",
        "OMPI_MCA_orte_tmpdir_base": tempfile.mkdtemp(dir=sessions()),
        "OMPI_MCA_pml": "ob1",
        "OMPI_MCA_btl": "self",
    }


def kiln(folder, *arguments, ranks=1, environment=None, **how):
    """Runs kiln in a folder."""
    environment = {**(alone() if ranks == 1 else {}), **(environment or {})}
    return program(folder, *command(*arguments, ranks=ranks), environment=environment, **how)


def program(folder, *words, timeout=60, environment=None):
    """Runs a program in a folder; `environment` adds to this process's own."""
    done = subprocess.run(
        [str(word) for word in words],
        cwd=folder,
        env={**os.environ, **(environment or {})},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        timeout=timeout * SLOWER,
    )
    return Outcome(done.returncode, done.stdout, done.stderr)


class KilnTest(unittest.TestCase):
    """A test with a temporary folder of its own, in which kiln runs."""

    prepared = None

    def prepare(self):
        """Fills the folder that each test of a class gets its own copy of; called once a class."""

    def setUp(self):
        shared = type(self)
        if shared.prepared is None:
            shared.prepared = self.folder = self.temporary_folder(shared.addClassCleanup)
            self.prepare()
        self.folder = self.temporary_folder(self.addCleanup)
        shutil.copytree(shared.prepared, self.folder, dirs_exist_ok=True)

    def temporary_folder(self, add_cleanup):
        temporary = tempfile.TemporaryDirectory(prefix="kiln-regression-")
        add_cleanup(temporary.cleanup)
        return Path(temporary.name)

    def kiln(self, *arguments, **how):
        return kiln(self.folder, *arguments, **how)

    def solve(self, command, *overrides, into="results", ranks=1, options=(), warnings=()):
        """`kiln run` or `kiln train` of the small case, which must succeed in silence but for these warnings."""
        words = [word for override in overrides for word in ("--set", override)]
        outcome = self.kiln(
            command, SMALL, *words, "--set", f"output.directory={into}", "--quiet", *options, ranks=ranks
        )
        self.assertEqual((outcome.status, outcome.stdout), (0, ""), (overrides, outcome.stderr))
        self.told(outcome, warnings)
        return self.folder / into

    def told(self, outcome, warnings):
        """The standard error output is a warning for each of these texts, which it holds, and nothing else."""
        lines = outcome.stderr.splitlines()
        self.assertEqual(len(lines), len(warnings), outcome.stderr)
        for line, text in zip(lines, warnings):
            self.assertTrue(line.startswith("warning: "), line)
            self.assertIn(text, line)


def digests(folder):
    """Name → SHA-256 of all files below a folder."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(Path(folder).rglob("*"))
        if path.is_file()
    }


def datasets(path):
    """Name → array of all datasets of an HDF5 file, under each of their names."""
    found = {}

    def walk(group, prefix):
        for name, item in group.items():
            if isinstance(item, h5py.Group):
                walk(item, f"{prefix}{name}/")
            else:
                found[prefix + name] = np.asarray(item)

    with h5py.File(path) as file:
        walk(file, "")
    return found


def main():
    if "KILN" not in os.environ:
        sys.exit("set KILN to the path of the built kiln program")
    unittest.main(verbosity=2)
