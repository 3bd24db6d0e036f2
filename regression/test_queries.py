"""Many parameter points in one run: the answers are those of single runs, whatever the method and the number of ranks."""

import csv
import json

import h5py
import numpy as np

from harness import SMALL, KilnTest, main

POWERS = (18.0, 19.0, 20.0, 21.0, 22.0)
SPEEDS = (0.45, 0.5, 0.5, 0.55, 0.5)
POINTS = f"""
include: {SMALL}
reduction:
  windows: {{count: 3}}
  try_on: {{points: {{heat_source.power: [18 W, 22 W], heat_source.velocity.x: [0.45 m/s, 0.55 m/s]}}}}
queries:
  points:
    heat_source.power: [{", ".join(f"{power} W" for power in POWERS)}]
    heat_source.velocity.x: [{", ".join(f"{speed} m/s" for speed in SPEEDS)}]
  together: 2
"""


def table(path):
    with open(path, encoding="utf-8", newline="") as file:
        return [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)]


class QueriesTest(KilnTest):
    def prepare(self):
        (self.folder / "points.yaml").write_text(POINTS)
        (self.folder / "points.csv").write_text(
            "heat_source.velocity.x,heat_source.power [mW]\n"
            + "".join(f"{speed},{1e3 * power}\n" for power, speed in zip(POWERS, SPEEDS))
        )
        self.answer("train")

    def answer(self, command, *words, warnings=(), **how):
        outcome = self.kiln(command, "points.yaml", "--quiet", *words, **how)
        self.assertEqual((outcome.status, outcome.stdout), (0, ""), outcome.stderr)
        self.told(outcome, warnings)

    def answers(self, method, *overrides, **how):
        words = [word for override in overrides for word in ("--set", override)]
        self.answer("run", "--set", f"method.type={method}", *words, **how)
        return self.folder / "results" / method

    def single(self, method, power, speed):
        """Probes of a run of one point: a row a step, without step and time."""
        own = [] if method == "fom" else [f"method.file={self.folder}/results/reduction.h5"]
        self.solve(
            "run", f"method.type={method}", f"model.heat_source.power={power} W",
            f"model.heat_source.velocity=[{speed} m/s, 0 m/s]", *own, into="single",
        )
        with open(self.folder / "single" / method / "probes.csv", encoding="utf-8", newline="") as file:
            return np.array([[float(cell) for cell in row[2:]] for row in list(csv.reader(file))[1:]])

    def test_every_point_is_a_run_of_its_own(self):
        for method in ("gnat", "lspg", "fom"):
            with self.subTest(method=method):
                folder = self.answers(method)
                rows = table(folder / "queries.csv")
                with h5py.File(folder / "queries.h5") as file:
                    found = file["temperature"][:]
                    self.assertEqual(file["temperature"].attrs["unit"], "K")
                    self.assertEqual(file["parameters/heat_source.power"].attrs["unit"], "W")
                    np.testing.assert_array_equal(file["parameters/heat_source.power"][:], POWERS)
                    time = file["time"][:]
                    self.assertEqual(found.shape, (len(POWERS), len(time), 3))
                for point, (power, speed) in enumerate(zip(POWERS, SPEEDS)):
                    expected = self.single(method, power, speed)
                    np.testing.assert_allclose(found[point], expected, rtol=1e-12, atol=0.0)
                    row = rows[point]
                    self.assertEqual(
                        (row["point"], row["heat_source.power [W]"], row["heat_source.velocity.x [m/s]"], row["diverged"]),
                        (point, power, speed, 0),
                    )
                    self.assertEqual(row["path temperature highest [K]"], found[point, :, 0].max())
                    self.assertEqual(row["path temperature highest at [s]"], time[found[point, :, 0].argmax()])
                    self.assertEqual(row["deep temperature last [K]"], found[point, -1, 2])
                self.assertGreater(np.ptp(found[:, -1, 0]), 10.0, "the points differ")

    def test_the_answers_are_the_same_bits_on_any_number_of_ranks(self):
        for method in ("gnat", "fom"):
            folder = self.answers(method)
            alone = (folder / "queries.csv").read_bytes()
            with h5py.File(folder / "queries.h5") as file:
                history = file["temperature"][:]
            for ranks in (2, 3):
                with self.subTest(method=method, ranks=ranks):
                    self.answers(method, ranks=ranks)
                    self.assertEqual((folder / "queries.csv").read_bytes(), alone)
                    with h5py.File(folder / "queries.h5") as file:
                        np.testing.assert_array_equal(file["temperature"][:], history)

    def test_a_table_and_runs_one_by_one_give_the_same(self):
        expected = table(self.answers("gnat") / "queries.csv")
        (self.folder / "points.yaml").write_text(
            f"{{include: {SMALL}, reduction: {{windows: {{count: 3}}}}, queries: {{file: points.csv, together: 1}}}}\n"
        )
        found = table(self.answers("gnat") / "queries.csv")
        for one, other in zip(expected, found):
            for name, value in one.items():
                self.assertAlmostEqual(other[name], value, delta=1e-12 * abs(value), msg=name)

    def test_a_diverged_point_is_marked_and_stops_no_other(self):
        whole = table(self.answers("gnat") / "queries.csv")
        folder = self.answers("gnat", "queries.points={heat_source.power: [18 W, 1e300 W, 20 W], "
                                      "heat_source.velocity.x: [0.45 m/s, 0.5 m/s, 0.5 m/s]}", ranks=2,
                              warnings=["point 1: the errors that the training stated are not of these"])
        marked = table(folder / "queries.csv")
        self.assertEqual([row["diverged"] for row in marked], [0, 1, 0])
        self.assertEqual(marked[0], whole[0])
        self.assertEqual({**marked[2], "point": 2}, {**whole[2], "point": 2})
        self.assertTrue(np.isnan(marked[1]["path temperature last [K]"]))
        report = self.kiln("report", folder).stdout
        self.assertIn("1 of 3 points diverged", report)
        self.assertIn("step 1", report)

    def test_a_point_that_heats_nothing_is_told_whichever_rank_ran_it(self):
        for ranks in (1, 2):
            folder = self.answers("fom", "queries.points={heat_source.power: [20 W, 20 W, 0 W, 0 W]}", ranks=ranks,
                                  warnings=["point 2: the heat source has heated no particle"])
            warnings = json.loads((folder / "report.json").read_text())["run"]["warnings"]
            self.assertTrue(warnings[0].endswith("; and 1 more point"), warnings)

    def test_a_report_tells_no_count_that_is_of_one_point_only(self):
        self.single("gnat", 20, 0.5)
        self.single("fom", 20, 0.5)
        for method, counted in (("gnat", ("linearisations", "reduced_jacobian_reciprocal_condition")),
                                ("fom", ("jacobian_evaluations", "linear_iterations", "finite_difference_rates"))):
            one = json.loads((self.folder / "single" / method / "report.json").read_text())["method"]
            many = json.loads((self.answers(method) / "report.json").read_text())["method"]
            self.assertEqual(set(one) - set(many), set(counted))
        self.assertEqual(set(one["model"]) - set(many["model"]), {"mean_absorbed_watt"})

    def test_mistakes_are_told_with_their_places(self):
        for override, words in (
            ("queries.points={heat_source.powr: [1 W]}", ("no live parameter", "did you mean 'heat_source.power'?")),
            ("queries.points={heat_source.power: [1 m]}", ("'1 m' is a length", "a power in W")),
            ("queries.points={heat_source.width: [50 um, 0 um]}", ("'0 um' is not above 0", "a length in m above 0")),
            ("queries.points={heat_source.power: [1 W, -40 W]}", ("'-40 W' is below 0", "a power in W at least 0")),
            ("queries.file=points.csv", ("both points and file are given",)),
            ("time.newton.line_search=true", ("not offered to points that advance together", "queries.together: 1")),
        ):
            method = "gnat"
            outcome = self.kiln("run", "points.yaml", "--quiet", "--set", f"method.type={method}", "--set", override)
            with self.subTest(override=override):
                self.assertEqual(outcome.status, 2, outcome.stderr)
                for word in words:
                    self.assertIn(word, outcome.stderr)
        # Before the model is built, which knows the units.
        outcome = self.kiln("check", "points.yaml", "--set", "queries.points={heat_source.power: [1 W, 3 4, 1 Wx]}")
        self.assertEqual(outcome.status, 2)
        for word in ("queries.points.heat_source.power: '3 4' is not a number", "'Wx'", "a number, with a unit or without"):
            self.assertIn(word, outcome.stderr)
        outcome = self.kiln("run", "points.yaml", "--restart")
        self.assertEqual(outcome.status, 2)
        self.assertIn("without --restart", outcome.stderr)


if __name__ == "__main__":
    main()
