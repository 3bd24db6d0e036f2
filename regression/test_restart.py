"""A run that is killed and restarted leaves, bit by bit, what an undisturbed one leaves."""

import json
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np

from harness import SMALL, KilnTest, command, datasets, digests, main
from hostile.seal import seal

# Slow enough that the beam stays on the part, long enough that a kill comes in the middle.
CASE = ("model.heat_source.velocity=[0.1 m/s, 0 m/s]", "output.checkpoint.every=4")
END = {"fom": "time.end=10 ms", "gnat": "time.end=20 ms", "ptrom": "time.end=20 ms"}
STEPS = {"fom": 200, "gnat": 400, "ptrom": 400}


class RestartTest(KilnTest):
    def prepare(self):
        clustering = "reduction.clustering={type: per row, clusters: 8}"
        self.solve("train", *CASE, END["gnat"], clustering, into="trained")

    def overrides(self, method):
        return CASE + (END[method], f"method.type={method}")

    def saved_step(self, folder):
        """The step of the checkpoint there, which is replaced in one stroke; None before the first."""
        try:
            with h5py.File(folder / "checkpoint.h5") as file:
                return int(file.attrs["step"])
        except FileNotFoundError:
            return None

    def kill_after(self, step, method, into, ranks):
        """Starts a run and kills its processes as soon as a checkpoint of that step or a later one stands there."""
        words = [word for override in self.overrides(method) for word in ("--set", override)]
        process = subprocess.Popen(
            command("run", SMALL, *words, "--set", f"output.directory={into}", "--quiet", ranks=ranks),
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        folder = self.folder / into / method
        deadline = time.monotonic() + 30.0
        while (self.saved_step(folder) or 0) < step:
            self.assertIsNone(process.poll(), "the run ended before it could be killed")
            self.assertLess(time.monotonic(), deadline, "no checkpoint came")
            time.sleep(0.001)
        for rank in self.children(process.pid) if ranks > 1 else [process.pid]:
            os.kill(rank, signal.SIGKILL)
        self.assertNotEqual(process.wait(timeout=30), 0)
        self.assertFalse((folder / "report.json").exists(), "the run had ended by itself")
        saved = self.saved_step(folder)
        self.assertGreaterEqual(saved, step)
        self.assertLess(saved, STEPS[method])
        return saved

    def children(self, parent):
        with open(f"/proc/{parent}/task/{parent}/children", encoding="ascii") as file:
            return [int(child) for child in file.read().split()]

    def same_bits(self, a, b):
        for name in ("run.h5", "checkpoint.h5"):
            compared = self.kiln("compare", a / name, b / name, "--tolerance", 0)
            self.assertEqual(compared.status, 0, compared.stdout)
        for name in ("probes.csv", "extremes.csv", "probes.json"):
            self.assertEqual((a / name).read_bytes(), (b / name).read_bytes(), name)
        for name in ("run.h5", "checkpoint.h5"):
            left, right = datasets(a / name), datasets(b / name)
            self.assertEqual(sorted(left), sorted(right))
            for dataset, values in left.items():
                self.assertEqual(values.dtype, right[dataset].dtype, dataset)
                self.assertEqual(values.tobytes(), right[dataset].tobytes(), f"{name}: {dataset}")
        left, right = (json.loads((folder / "report.json").read_text())["solve"] for folder in (a, b))
        self.assertEqual(left, right, "the counts are the whole run's")
        for attribute in ("identity", "step", "time"):
            with h5py.File(a / "checkpoint.h5") as left, h5py.File(b / "checkpoint.h5") as right:
                self.assertEqual(left.attrs[attribute], right.attrs[attribute])

    def check(self, method, moments, ranks):
        self.provide_reduction("undisturbed")
        undisturbed = self.solve("run", *self.overrides(method), into="undisturbed", ranks=ranks) / method
        state = datasets(undisturbed / "run.h5")["temperature"]
        self.assertGreater(np.abs(state[-1] - state[-2]).max(), 0.0, "the state still changes at the end")
        for moment in moments:
            with self.subTest(method=method, moment=moment, ranks=ranks):
                into = f"killed-{moment}"
                self.provide_reduction(into)
                self.kill_after(moment, method, into, ranks)
                self.solve("run", *self.overrides(method), into=into, ranks=ranks, options=("--restart",))
                self.same_bits(undisturbed, self.folder / into / method)

    def provide_reduction(self, into):
        (self.folder / into).mkdir()
        shutil.copy(self.folder / "trained" / "reduction.h5", self.folder / into)

    def test_full_order(self):
        self.check("fom", (4, 100), ranks=1)

    def test_full_order_on_two_ranks(self):
        self.check("fom", (60,), ranks=2)

    def test_gnat(self):
        self.check("gnat", (200,), ranks=1)

    def test_gnat_on_two_ranks(self):
        self.check("gnat", (100,), ranks=2)

    def test_ptrom(self):
        self.check("ptrom", (150,), ranks=2)

    def test_a_reduction_learnt_anew(self):
        self.provide_reduction("again")
        self.solve("run", *self.overrides("gnat"), into="again")
        self.solve("run", *self.overrides("gnat"), into="again", options=("--restart",))
        # As many coordinates as before, but not the same ones.
        self.solve("train", *CASE, END["gnat"], "reduction.sampling.samples=50", into="again")
        words = [word for override in self.overrides("gnat") for word in ("--set", override)]
        for ranks in (1, 2):
            outcome = self.kiln("run", SMALL, *words, "--set", "output.directory=again", "--restart", "--quiet", ranks=ranks)
            self.assertEqual((outcome.status, outcome.stdout), (2, ""), outcome.stderr)
            self.assertIn("again/gnat/checkpoint.h5", outcome.stderr)
            self.assertIn("the run began with reduction", outcome.stderr)

    def test_data_changed_since(self):
        shutil.copy(SMALL, self.folder / "own.yaml")
        table = self.folder / "steel.csv"
        shutil.copy(Path(SMALL).parent / "steel.csv", table)

        def run(*options):
            words = ("--set", "model.material={type: table, path: steel.csv}", "--set", "output.directory=own")
            return self.kiln("run", "own.yaml", "--quiet", *words, *options)

        self.assertEqual(run().status, 0)
        self.assertEqual(run("--restart").status, 0)
        *rows, last = table.read_text().splitlines()
        cells = last.split(",")
        cells[-1] = str(float(cells[-1]) + 1.0)
        table.write_text("\n".join([*rows, ",".join(cells)]) + "\n")
        outcome = run("--restart")
        self.assertEqual(outcome.status, 2, outcome.stderr)
        self.assertIn("is the checkpoint of another run", outcome.stderr)
        self.assertIn("steel.csv", outcome.stderr)

    def test_killed_twice(self):
        undisturbed = self.solve("run", *self.overrides("fom"), into="undisturbed") / "fom"
        self.kill_after(20, "fom", "killed", 1)
        # A run that starts anew in the same folder, and is killed as well, leaves nothing of the first one behind.
        (self.folder / "killed" / "fom" / "checkpoint.h5").unlink()
        self.kill_after(60, "fom", "killed", 1)
        self.solve("run", *self.overrides("fom"), into="killed", options=("--restart",))
        self.same_bits(undisturbed, self.folder / "killed" / "fom")

    def test_finished_run(self):
        finished = self.solve("run") / "fom"
        shutil.copytree(finished, self.folder / "copy")
        self.solve("run", options=("--restart",))
        self.same_bits(self.folder / "copy", finished)

    def refused(self, *words, overrides=(), ranks=1):
        before = digests(self.folder)
        options = [word for override in overrides for word in ("--set", override)]
        outcome = self.kiln("run", SMALL, "--restart", "--quiet", *options, ranks=ranks)
        self.assertEqual((outcome.status, outcome.stdout), (2, ""), outcome.stderr)
        self.assertEqual(outcome.stderr.count("results/fom/checkpoint.h5"), 1, outcome.stderr)
        self.assertEqual(outcome.stderr.count("\n"), 1, outcome.stderr)
        for word in words:
            self.assertIn(word, outcome.stderr)
        self.assertEqual(digests(self.folder), before)

    def test_no_checkpoint(self):
        self.refused("No such file")

    def test_checkpoint_of_another_run(self):
        self.solve("run")
        self.refused("another run", "power: 20", "power: 3", overrides=("model.heat_source.power=3 W",), ranks=2)
        self.refused("another run", "end: 0.002", "end: 0.003", overrides=("time.end=3 ms",))

    def test_other_rows_in_the_tables(self):
        self.solve("run")
        elsewhere = "output.probes.points.0.position=[0.7 mm, -0.1 mm, 0.5 mm]"
        self.refused("another run", "0.0006", "0.0007", overrides=(elsewhere,))
        self.refused("another run", "every: 1", "every: 7", overrides=("output.extremes.every=7",), ranks=2)

    def test_a_killed_run_leaves_no_report_of_an_earlier_one(self):
        folder = self.solve("run", *self.overrides("fom"), into="killed") / "fom"
        self.assertTrue((folder / "report.txt").exists())
        (folder / "checkpoint.h5").unlink()
        self.kill_after(20, "fom", "killed", 1)
        self.assertFalse((folder / "report.txt").exists())

    def test_truncated_checkpoint(self):
        checkpoint = self.solve("run") / "fom" / "checkpoint.h5"
        whole = checkpoint.read_bytes()
        for size in (0, 100, len(whole) // 2, len(whole) - 1):
            with self.subTest(size=size):
                checkpoint.write_bytes(whole[:size])
                self.refused()

    def test_checkpoint_that_is_no_hdf5_file(self):
        checkpoint = self.solve("run") / "fom" / "checkpoint.h5"
        checkpoint.write_text("step: 20\n")
        self.refused()

    def test_checkpoint_without_its_state(self):
        checkpoint = self.solve("run") / "fom" / "checkpoint.h5"
        with h5py.File(checkpoint, "r+") as file:
            del file["unknown"]
        self.refused("carries no seal")
        seal(checkpoint)
        self.refused("unknown", ranks=2)


if __name__ == "__main__":
    main()
