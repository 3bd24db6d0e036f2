"""`./dev reproduce --tiny`: the page has every table; its numbers are those recomputed from the files of the runs."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np
import pandas

REPOSITORY = pathlib.Path(__file__).resolve().parents[1]
INPUTS = REPOSITORY / "inputs/nrl-2022"
sys.path[:0] = [str(INPUTS / "reproduce"), str(REPOSITORY / "regression/comparison")]

import figures
import page
import tables
from published import Published
from results import Results, material_table

TITLES = [
    "In short", "Cases without figures", "Table 2: ranks and sampled particles", "Errors and times of every case",
    "Table 4: savings in wall time", "Table 5: savings in CPU hours", "Algorithm 1 as printed", "Figures",
]
FOLDERS = {"Case 1": "published-1", "Case 2": "published-2", "Kiln": "kiln"}


def section(text, title):
    return text.split(f"## {title}\n")[1].split("\n## ")[0]


def rows(text, title):
    """The table of a section: column title → cell, row by row."""
    lines = [line for line in section(text, title).splitlines() if line.startswith("|")]
    header, _, *body = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines]
    return [dict(zip([title.strip() for title in header], row)) for row in body]


class ReproduceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="kiln-reproduce-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.study = cls.folder / "study"
        cls.outcome = subprocess.run(
            [sys.executable, "-B", INPUTS / "reproduce/reproduce.py", "--tiny", "--ranks", "1", "--output", cls.study,
             "--kiln", os.environ["KILN"], "--publish", cls.folder / "published"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", check=False, timeout=240,
        )
        if cls.outcome.returncode != 0:
            raise AssertionError(cls.outcome.stderr)
        cls.text = (cls.study / "page/README.md").read_text()
        cls.summary = json.loads((cls.study / "page/summary.json").read_text())
        cls.published = Published()

    def report(self, case, method):
        return json.loads((self.study / "experiment-1" / case / method / "report.json").read_text())

    def worst_probe_error(self, case, method):
        """Eq. 35, without the code of the page."""
        full = pandas.read_csv(self.study / "experiment-1/full-order/fom/probes.csv").iloc[:, 2:].to_numpy()
        reduced = pandas.read_csv(self.study / "experiment-1" / case / method / "probes.csv").iloc[:, 2:].to_numpy()
        return 100 * np.max(np.abs((reduced - full) / full))

    def test_every_part_is_there(self):
        self.assertEqual(re.findall(r"^## (.*)$", self.text, re.MULTILINE), TITLES)
        for number in range(2, 11):
            if number in (6, 7, 8):
                continue  # of experiments that the tiny study leaves out
            self.assertIn(f"Fig. {number}:", self.text)
        self.assertNotIn("not drawn", self.text)
        pictures = re.findall(r"\]\((.*\.png)\)", self.text)
        self.assertEqual(sorted(pictures), sorted(path.name for path in (self.study / "page").glob("*.png")))
        html = (self.study / "page/index.html").read_text()
        self.assertEqual(html.count("<table>"), 1 + 6)
        for word in ("machine", "BLAS", "build", "commit", "command", "ranks"):
            self.assertRegex(self.text, rf"\| {word} \| \S")
        self.assertIn(self.summary["provenance"]["commit"], self.text)
        self.assertIn("1,728 particles, 100 steps; the report has 70,000 and 1,000: a smaller study", self.text)

    def test_published_is_a_copy(self):
        names = sorted(path.name for path in (self.study / "page").iterdir())
        self.assertEqual(sorted(path.name for path in (self.folder / "published").iterdir()), names)
        for name in names:
            self.assertEqual((self.folder / "published" / name).read_bytes(), (self.study / "page" / name).read_bytes())

    def test_ranks_are_those_of_the_reduction_files(self):
        table = rows(self.text, TITLES[2])
        self.assertEqual([row["setting"] for row in table], list(FOLDERS))
        for row, case in zip(table, FOLDERS.values()):
            with h5py.File(self.study / f"experiment-1/{case}/training/reduction.h5") as file:
                windows = list(file["windows"].values())
                self.assertEqual(int(row["rank Φ"]), max(w["basis/modes"].shape[1] for w in windows))
                self.assertEqual(int(row["rank Φ_r"]), max(w["sample_mesh/gappy_operator"].shape[0] for w in windows))
                self.assertEqual(int(row["n_p"]), max(len(w["sample_mesh/rows"]) for w in windows))
                active = max(len(w["sample_mesh/sources"]) for w in windows)
                self.assertEqual(int(row["n_p"]) + int(row["n_s"]), active)
                self.assertAlmostEqual(float(row["POTP, %"]), 100 * active / (24 * 12 * 6), delta=0.01)
                self.assertEqual(int(row["windows"]), len(windows))
        self.assertEqual([row["rank Φ, report"] for row in rows(self.text, TITLES[2])], ["148", "421", "–"])
        self.assertEqual(rows(self.text, TITLES[2])[0]["POTP, %, report"], "11.64")

    def test_errors_and_times_are_those_of_the_runs(self):
        table = rows(self.text, TITLES[3])
        self.assertEqual(len(table), 1 + 2 * 6 + 1 + 4)
        for row in table[1:]:
            folder = FOLDERS[row["setting"]]
            method = row["method"].split(",")[0].lower()
            printed = "-as-printed" if "as printed" in row["method"] else ""
            case = f"{folder}/{method}" + ("" if folder == "kiln" else f"{printed}-{row['tolerance']}")
            report, full = self.report(case, method), self.report("full-order", "fom")
            with self.subTest(case=case):
                self.assertEqual(row["state"], "complete")
                error = self.worst_probe_error(case, method)
                self.assertAlmostEqual(float(row["probe error, % of K"]) / error, 1, delta=6e-3)
                self.assertAlmostEqual(float(row["wall, s"]) / report["time"]["loop_wall_s"], 1, delta=6e-3)
                saving = full["time"]["loop_cpu_s"] / report["time"]["loop_cpu_s"]
                self.assertAlmostEqual(float(row["CPU saving"].replace(",", "")) / saving, 1, delta=6e-3)

    def test_field_error(self):
        # Galerkin's frames hold its coordinates; its state by the basis, and the error, without the page's code.
        with h5py.File(self.study / "experiment-1/published-1/training/reduction.h5") as file:
            modes, reference = file["windows/0/basis/modes"][:], file["reference"][:].ravel()
        with h5py.File(self.study / "experiment-1/published-1/galerkin-1e-2/galerkin/run.h5") as file:
            reduced = reference + file["coordinates"][:] @ modes.T
        with h5py.File(self.study / "experiment-1/full-order/fom/run.h5") as file:
            full = file["temperature"][:]
        expected = 100 * np.linalg.norm(reduced - full) / np.linalg.norm(full - full[0])
        found = self.summary["experiments"]["1"]["published_case_1"]["cases"]["galerkin-1e-2"]["field_l2_error_percent"]
        self.assertAlmostEqual(found / expected, 1.0, delta=1e-9)

    def test_savings(self):
        for title, measure, report in ((TITLES[4], "loop_wall_s", "1.7683"), (TITLES[5], "loop_cpu_s", "0.51210")):
            table = rows(self.text, title)
            self.assertEqual([row["method"] for row in table],
                             2 * ["GNAT", "LSPG", "Galerkin"] + ["PTROM", "GNAT", "LSPG", "Galerkin"])
            self.assertEqual([row["SWT, report"] for row in table], [report] + 9 * [""])
            full = self.report("full-order", "fom")["time"]
            row = next(row for row in table if (row["setting"], row["method"]) == ("Case 2", "LSPG"))
            times = [self.report(f"published-2/lspg-{tolerance}", "lspg")["time"] for tolerance in ("1e-3", "1e-2")]
            best = min(times, key=lambda seconds: seconds[measure])
            self.assertAlmostEqual(float(row["SWT"]) / (full["loop_wall_s"] / best["loop_wall_s"]), 1, delta=6e-3)
            self.assertAlmostEqual(float(row["SCPUH"]) / (full["loop_cpu_s"] / best["loop_cpu_s"]), 1, delta=6e-3)
            self.assertEqual(row["cores"], "1 against 1")

    def test_as_printed(self):
        row, = rows(self.text, TITLES[6])
        seconds = self.report("published-1/gnat-as-printed-1e-3", "gnat")["time"]["loop_wall_s"]
        self.assertAlmostEqual(float(row["wall, s, as printed"]) / seconds, 1, delta=6e-3)

    def test_summary(self):
        entry = self.summary["experiments"]["1"]
        demo = {"title", "fom", "gnat", "speedup", "probes", "worst_probe_error_percent", "commit", "machine", "blas"}
        for setting, count in (("kiln", 4), ("published_case_1", 7), ("published_case_2", 6)):
            block = entry[setting]
            self.assertLessEqual(demo, set(block))
            self.assertEqual(len(block["cases"]), count)
            self.assertEqual(block["gnat"], block["cases"][block["case"]]["gnat"])
            gnat = [case for name, case in block["cases"].items() if re.fullmatch(r"gnat(-1e-\d)?", name)]
            self.assertEqual(block["speedup"]["wall"], max(case["speedup"]["wall"] for case in gnat))
        self.assertEqual(entry["report"]["best_wall_time"]["wall"], 1.7683)
        self.assertEqual(entry["report"]["published_case_2"]["basis_rank"], 421)

    def test_report_figures_agree_with_each_other(self):
        rows = self.published.facts["reductions"]
        self.assertEqual(len(rows), 8)
        strange = []
        for row in rows:
            self.assertEqual(row["sampled"], row["residual_rank"])
            if abs(100 * (row["sampled"] + row["sources"]) / 70000 - row["potp"]) > 0.0051:
                strange.append((row["experiment"], row["case"]))
        # As printed; the page says so.
        self.assertEqual(strange, [(1, 2), (2, 2)])
        self.assertIn("11.87 and 12.35", self.published.reasons["sources"])

    def test_material_curves_are_the_printed_formulas(self):
        temperature, values = material_table(self.study / "experiment-1/kiln/training/reduction.h5")
        for u, properties in (
            (300.0, [13.961, 498.824, 7954.42522]),
            (2000.0, [18.968, 769.855, 6791.096]),
            (4000.0, [21.6465, 769.855, 6124.72]),
        ):
            np.testing.assert_allclose(values[np.searchsorted(temperature, u)], properties, rtol=1e-12)

    def broken(self, change):
        """The page of a study whose table of cases says otherwise."""
        folder = self.folder / "broken"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for path in self.study.iterdir():
            if path.name.startswith("experiment"):
                (folder / path.name).symlink_to(path)
        table = json.loads((self.study / "study.json").read_text())
        (folder / "study.json").write_text(json.dumps([row for row in table if change(row) is not False]))
        results = Results(folder)
        return results, page.summary_of(results, self.published)

    def test_failed_case_stands_there_with_its_message(self):
        def fail(row):
            if row["name"].startswith("experiment-1/kiln/gnat"):
                row.update(status="failed", message="step 3, t = 1.2e-05 s: the residual | grew\nmore")

        results, summary = self.broken(fail)
        message = "failed: step 3, t = 1.2e-05 s: the residual | grew"
        frame = tables.accuracy(results)
        row = frame[(frame["setting"] == "Kiln") & (frame["method"] == "GNAT")].iloc[0]
        self.assertEqual((row["state"], row["wall, s"]), (message, ""))
        self.assertIn(message.replace("|", "\\|"), tables.as_markdown(frame))
        savings = tables.savings(results, self.published, "best_wall_time")
        row = savings[(savings["setting"] == "Kiln") & (savings["method"] == "GNAT")].iloc[0]
        self.assertEqual(row["SWT"], message)
        self.assertIn("experiment-1/kiln/gnat", page.unfinished(results))
        self.assertEqual(summary["experiments"]["1"]["kiln"]["cases"]["gnat"]["status"], "failed")
        self.assertNotIn("speedup", summary["experiments"]["1"]["kiln"])
        self.assertIsNotNone(figures.reduced_surface(results, self.folder / "pictures", "kiln"))

    def test_continued_runs_stand_without_times(self):
        # Its report tells the seconds of its last part only.
        folder = self.folder / "continued"
        shutil.copytree(self.study, folder)
        file = folder / "experiment-1/published-2/lspg-1e-3/lspg/report.json"
        report = json.loads(file.read_text())
        report["run"]["first_step"] = 90
        report["time"]["loop_wall_s"] /= 1000.0
        report["time"]["loop_cpu_s"] /= 1000.0
        file.write_text(json.dumps(report))
        results = Results(folder)
        frame = tables.accuracy(results)
        frame = frame[(frame["setting"] == "Case 2") & (frame["method"] == "LSPG")].set_index("tolerance")
        times = ["wall, s", "CPU, s", "wall saving", "CPU saving"]
        self.assertEqual(list(frame.loc["1e-3", times]), 4 * [tables.NOT_IN_REPORT])
        self.assertEqual(frame.loc["1e-3", "state"], "complete, continued: no times")
        self.assertNotIn(tables.NOT_IN_REPORT, list(frame.loc["1e-2", times]))
        self.assertGreater(float(frame.loc["1e-3", "probe error, % of K"]), 0.0)
        for table, column, measure in (("best_wall_time", "SWT", "loop_wall_s"), ("best_cpu_hours", "SCPUH", "loop_cpu_s")):
            savings = tables.savings(results, self.published, table)
            row = savings[(savings["setting"] == "Case 2") & (savings["method"] == "LSPG")].iloc[0]
            full, whole = self.report("full-order", "fom"), self.report("published-2/lspg-1e-2", "lspg")
            saving = full["time"][measure] / whole["time"][measure]
            self.assertAlmostEqual(float(str(row[column]).replace(",", "")) / saving, 1, delta=6e-3)
        cases = page.summary_of(results, self.published)["experiments"]["1"]["published_case_2"]["cases"]
        self.assertEqual(set(cases["lspg-1e-3"]["speedup"].values()), {None})

    def test_missing_cases_are_not_run(self):
        results, _ = self.broken(lambda row: "as-printed" not in row["name"] and "published-2" not in row["name"])
        self.assertEqual(tables.as_printed(results, self.published).iloc[0]["wall, s, as printed"], "not run")
        self.assertEqual(tables.reductions(results, self.published).iloc[1]["rank Φ"], "not run")
        savings = tables.savings(results, self.published, "best_cpu_hours")
        self.assertEqual(set(savings[savings["setting"] == "Case 2"]["SWT"]), {"not run"})

    def test_failed_full_order_run(self):
        def fail(row):
            if row["name"].endswith("full-order"):
                row.update(status="failed", message="it diverged")

        results, summary = self.broken(fail)
        self.assertEqual(tables.accuracy(results).iloc[0]["state"], "failed: it diverged")
        self.assertNotIn("full_order", summary["experiments"]["1"])
        self.assertIsNone(figures.probe_error_curves(results, self.folder / "pictures", 1))


if __name__ == "__main__":
    if "KILN" not in os.environ:
        sys.exit("set KILN to the path of the built kiln program")
    unittest.main(verbosity=2)
