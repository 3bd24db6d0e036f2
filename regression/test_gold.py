"""`test_gold.py CASE` runs one case of cases/ on one rank, on two, and interrupted, each against its gold values."""

import os
import shutil
import sys
import unittest
from pathlib import Path

import gold
from harness import KilnTest

EVERY = 15  # steps between two checkpoints of the run that is killed at the second one


class CaseTest(KilnTest):
    case = None

    def succeed(self, command, *options, folder=None, **how):
        outcome = self.case.kiln(command, folder or self.folder, *options, **how)
        self.assertEqual((outcome.status, outcome.stdout, outcome.stderr), (0, "", ""), f"case {self.case.name}")

    def agrees(self, part, found, how):
        difference = self.case.difference(part, found, how)
        if difference:
            self.fail(difference)

    def found(self):
        found = self.folder / "found"
        gold.write_run(self.folder / "results", found)
        return found

    def test_one_rank(self):
        self.succeed("run")
        found = self.found()
        self.agrees("run", found, "one rank")
        self.agrees("solve.json", found, "one rank")

    def test_two_ranks(self):
        self.succeed("run", ranks=2)
        found = self.found()
        self.agrees("run", found, "two ranks")
        self.agrees("solve.json", found, "two ranks")

    def test_killed_on_one_rank_and_restarted_on_two(self):
        killer = {"LD_PRELOAD": os.environ["KILN_KILLER"], "KILN_KILL_AT": "checkpoint.h5:2"}
        # The sanitizers' own libraries would have to come first.
        killer["ASAN_OPTIONS"] = "verify_asan_link_order=0:" + os.environ.get("ASAN_OPTIONS", "")
        killed = self.case.kiln("run", self.folder, "--set", f"output.checkpoint.every={EVERY}", environment=killer)
        self.assertEqual((killed.status, killed.stderr), (-9, ""), f"case {self.case.name}: the run was to be killed")
        probes = next((self.folder / "results").glob("*/probes.csv")).read_text().splitlines()
        self.assertTrue(probes[-1].startswith(f"{2 * EVERY},"), "killed before its second checkpoint was there")
        self.succeed("run", "--restart", ranks=2)
        self.agrees("run", self.found(), f"killed after step {2 * EVERY}, restarted at {EVERY} on two ranks")


class FullOrderTest(CaseTest):
    pass


class ReducedTest(CaseTest):
    """Needs a reduction, which is trained once."""

    def prepare(self):
        self.succeed("train")

    def test_training(self):
        gold.write_training(self.folder / "results", self.folder / "found")
        self.agrees("training", self.folder / "found", "trained on one rank")

    def test_training_on_two_ranks(self):
        shutil.rmtree(self.folder / "results")
        self.succeed("train", ranks=2)
        gold.write_training(self.folder / "results", self.folder / "found")
        self.agrees("training", self.folder / "found", "trained on two ranks")
        self.succeed("run")
        self.agrees("run", self.found(), "trained on two ranks, run on one")


def main():
    if len(sys.argv) != 2 or not {"KILN", "KILN_KILLER"} <= set(os.environ):
        sys.exit(f"usage: KILN=… KILN_KILLER=… {Path(sys.argv[0]).name} CASE")
    CaseTest.case = gold.Case(sys.argv[1])
    kind = ReducedTest if CaseTest.case.is_trained() else FullOrderTest
    tests = unittest.defaultTestLoader.loadTestsFromTestCase(kind)
    result = unittest.TextTestRunner(verbosity=2).run(tests)
    sys.exit(not result.wasSuccessful())


if __name__ == "__main__":
    main()
