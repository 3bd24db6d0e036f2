"""`./dev nightly` on its small study: what drifts is told, what is missing is told, updates have a reason."""

import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

REGRESSION = pathlib.Path(__file__).resolve().parent
REPOSITORY = REGRESSION.parent
NIGHTLY = REGRESSION / "nightly"
sys.path[:0] = [str(NIGHTLY)]

import gold_values
import history
import trends
from measured import KINDS, figures_of, kind_of

GNAT_ERROR = "experiment-1/kiln/gnat/worst_probe_error_percent"
PEAK = "experiment-1/full-order/peak_kelvin"
SAVING = "experiment-1/kiln/gnat/speedup/wall"
RANK = "experiment-1/published_case_1/reduction/basis_rank"


class NightlyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="kiln-nightly-")
        cls.addClassCleanup(temporary.cleanup)
        cls.whole = pathlib.Path(temporary.name)
        cls.interrupted = cls.kill_after_the_first_cases(cls.whole)
        cls.first = cls.call(cls.whole)
        cls.updated = cls.call(cls.whole, "--update-gold", "--reason", "The first values")

    @classmethod
    def words(cls, folder, *options):
        return [
            sys.executable, "-B", str(NIGHTLY / "nightly.py"), "--small", "--kiln", os.environ["KILN"],
            "--folder", str(folder / "nightly"), "--gold", str(folder / "gold.json"), *options,
        ]

    @classmethod
    def call(cls, folder, *options):
        words = cls.words(folder, *options)
        return subprocess.run(words, capture_output=True, encoding="utf-8", check=False, timeout=240)

    @classmethod
    def kill_after_the_first_cases(cls, folder):
        """When the first training is complete, the study is killed; returns what was complete then."""
        experiment = folder / "nightly/study/experiment-1"
        record = experiment / "kiln/training/case.json"
        process = subprocess.Popen(cls.words(folder), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   start_new_session=True)
        deadline = time.monotonic() + 120
        while not (record.exists() and json.loads(record.read_text())["status"] == "complete"):
            if process.poll() is not None or time.monotonic() > deadline:
                raise AssertionError("the nightly run ended, or took too long, before it could be killed")
            time.sleep(0.005)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return {path: path.stat().st_mtime_ns for path in (record, experiment / "full-order/case.json")}

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="kiln-nightly-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "nightly/study/page").mkdir(parents=True)
        shutil.copy(self.whole / "nightly/study/page/summary.json", self.summary_file)
        shutil.copy(self.whole / "gold.json", self.gold_file)

    @property
    def summary_file(self):
        return self.folder / "nightly/study/page/summary.json"

    @property
    def gold_file(self):
        return self.folder / "gold.json"

    def figures(self):
        return figures_of(json.loads(self.summary_file.read_text()))

    def change_gold(self, **changes):
        """name=function of the gold value, or None to remove it."""
        content = json.loads(self.gold_file.read_text())
        for name, change in changes.items():
            if change is None:
                del content["figures"][name]
            else:
                content["figures"][name] = change(content["figures"][name])
        self.gold_file.write_text(json.dumps(content))

    def drifts(self):
        """What `--compare-only` prints as drifted; its exit status must go with that."""
        outcome = self.call(self.folder, "--compare-only")
        lines = [line for line in outcome.stdout.splitlines() if line.startswith("drifted: ")]
        self.assertEqual(outcome.returncode, 1 if lines else 0, outcome.stderr)
        return lines

    def test_interrupted_study_resumes(self):
        self.assertTrue(self.interrupted)
        for path, written in self.interrupted.items():
            self.assertEqual(path.stat().st_mtime_ns, written, f"{path} was made anew")
        self.assertIn("complete, kept", self.first.stderr)
        self.assertFalse((self.whole / "nightly/unfinished").exists())

    def test_next_run_begins_afresh(self):
        sys.path[:0] = [str(REPOSITORY / "inputs/nrl-2022/reproduce"), str(REPOSITORY / "regression/comparison")]
        from nightly import begin

        left = self.folder / "nightly/study/experiment-1"
        for reuse, unfinished, kept in ((True, False, True), (False, True, True), (False, False, False)):
            left.mkdir(parents=True, exist_ok=True)
            marker = self.folder / "nightly/unfinished"
            marker.touch() if unfinished else marker.unlink(missing_ok=True)
            self.assertEqual(begin(self.folder / "nightly", reuse), marker)
            self.assertEqual((left.exists(), marker.exists()), (kept, True), (reuse, unfinished))

    def test_first_run_without_gold_values(self):
        self.assertEqual(self.first.returncode, 2, self.first.stderr)
        self.assertIn("there are no gold values", self.first.stderr)

    def test_history_line(self):
        line, = history.read(self.whole / "nightly/history.jsonl")
        self.assertEqual(list(line), ["date", "commit", "machine", "blas", *KINDS, "drifted"])
        self.assertEqual({name: value for kind in KINDS for name, value in line[kind].items()}, self.figures())
        for name in (GNAT_ERROR, PEAK, SAVING, RANK):
            self.assertIn(name, line[kind_of(name)])
        history.append(self.whole / "copy.jsonl", line)
        with (self.whole / "copy.jsonl").open("a") as stream:
            stream.write('{"cut short')
        history.append(self.whole / "copy.jsonl", line)
        self.assertEqual(history.read(self.whole / "copy.jsonl"), [line, line])

    def test_every_case_is_watched(self):
        figures = self.figures()
        for setting, cases in (
            ("kiln", ["gnat", "lspg", "galerkin"]),
            ("published_case_2", [f"{m}-{t}" for m in ("gnat", "lspg", "galerkin") for t in ("1e-3", "1e-2")]),
            ("published_case_1", ["gnat-as-printed-1e-3"]),
        ):
            for case in cases:
                for measure in ("field_l2_error_percent", "peak_kelvin", "residuals_per_step", "speedup/cpu"):
                    self.assertIn(f"experiment-1/{setting}/{case}/{measure}", figures)
        self.assertFalse([name for name in figures if name.endswith("_s")], "seconds are not compared")

    def test_nothing_drifted(self):
        self.assertEqual(self.updated.returncode, 0, self.updated.stderr)
        self.assertEqual(self.drifts(), [])

    def test_drift_is_told(self):
        found = self.figures()
        self.change_gold(**{PEAK: lambda value: value * 1.00001, GNAT_ERROR: lambda value: value * 3})
        lines = self.drifts()
        self.assertEqual(len(lines), 2, lines)
        peak = next(line for line in lines if PEAK in line)
        self.assertIn(f"gold {found[PEAK] * 1.00001:.6g}, found {found[PEAK]:.6g}, allowed ", peak)

    def test_within_the_tolerance(self):
        self.change_gold(**{PEAK: lambda value: value * (1 + 5e-7), RANK: lambda value: value + 1})
        self.assertEqual(self.drifts(), [])

    def test_missing_figure(self):
        summary = json.loads(self.summary_file.read_text())
        case = summary["experiments"]["1"]["kiln"]["cases"]["gnat"]
        case.update(status="failed", message="step 7: diverged")
        self.summary_file.write_text(json.dumps(summary))
        outcome = self.call(self.folder, "--compare-only")
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("case experiment-1/kiln/gnat failed: step 7: diverged", outcome.stdout)
        self.assertRegex(outcome.stdout, rf"drifted: {GNAT_ERROR}: gold \S+, found missing")

    def test_figure_without_gold_value(self):
        self.change_gold(**{RANK: None})
        line, = self.drifts()
        self.assertIn(f"{RANK}: gold missing", line)

    def test_no_number(self):
        for bad in (math.nan, math.inf):
            for name in (GNAT_ERROR, SAVING, PEAK):
                with self.subTest(bad=bad, name=name):
                    found = self.figures() | {name: bad}
                    drift, = gold_values.compare(self.figures(), found, gold_values.Tolerances())
                    self.assertEqual(drift.name, name)
        self.change_gold(**{PEAK: lambda value: math.nan})
        outcome = self.call(self.folder, "--compare-only")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("expected a finite number", outcome.stderr)

    def test_no_gold_value_at_all(self):
        self.gold_file.write_text('{"updates": [], "figures": {}}')
        outcome = self.call(self.folder, "--compare-only")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("holds no figures", outcome.stderr)

    def test_ratios_are_bounded_from_below_and_seconds_are_not(self):
        summary = json.loads(self.summary_file.read_text())
        before = figures_of(summary)
        case = summary["experiments"]["1"]["kiln"]["cases"]["gnat"]
        for run in (case["fom"], case["gnat"]):
            run["wall_s"] *= 1000
            run["cpu_s"] *= 1000
        self.assertEqual(figures_of(summary), before)
        tolerances = gold_values.Tolerances()
        for factor, drifted in ((0.4, True), (0.6, False), (100.0, False)):
            case["speedup"]["wall"] = factor * before[SAVING]
            names = [drift.name for drift in gold_values.compare(before, figures_of(summary), tolerances)]
            self.assertEqual(names, [SAVING] if drifted else [], factor)

    def test_every_figure_has_a_tolerance_with_a_reason(self):
        for name in self.figures():
            self.assertGreater(len(gold_values.Tolerances().rule(name)["reason"]), 20, name)

    def test_update_needs_a_reason(self):
        before = self.gold_file.read_bytes()
        for options in ((), ("--reason", "  ")):
            outcome = self.call(self.folder, "--update-gold", *options)
            self.assertEqual(outcome.returncode, 2)
            self.assertIn("--reason", outcome.stderr)
        self.assertEqual(self.gold_file.read_bytes(), before)

    def test_update_records_its_reason(self):
        self.change_gold(**{PEAK: lambda value: value + 1})
        outcome = self.call(self.folder, "--update-gold", "--reason", "Another beam")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertIn("1 of ", outcome.stdout)
        content = json.loads(self.gold_file.read_text())
        self.assertEqual([update["reason"] for update in content["updates"]], ["The first values", "Another beam"])
        commit = json.loads(self.summary_file.read_text())["provenance"]["commit"]
        self.assertEqual((content["updates"][1]["commit"], content["updates"][1]["changed"]), (commit, 1))
        self.assertRegex(content["updates"][1]["date"], r"^\d{4}-\d\d-\d\dT")
        self.assertEqual(self.drifts(), [])

    def test_trends(self):
        lines = history.read(self.whole / "nightly/history.jsonl")
        drift = gold_values.Drift(PEAK, 1.0, 2.0, "nothing")
        lines.append(lines[0] | {"drifted": [PEAK]})
        trends.write_trends(lines, self.figures(), [drift], self.folder / "trends")
        page = (self.folder / "trends/README.md").read_text()
        self.assertIn(f"- {drift}", page)
        pictures = {path.name for path in (self.folder / "trends").glob("*.png")}
        for measure in ("basis-rank", "sampled", "field-l2-error-percent", "peak-kelvin", "speedup-wall"):
            self.assertIn(f"experiment-1-{measure}.png", pictures)
        for name in pictures:
            self.assertIn(f"({name})", page)


if __name__ == "__main__":
    if "KILN" not in os.environ:
        sys.exit("set KILN to the path of the built kiln program")
    unittest.main(verbosity=2)
