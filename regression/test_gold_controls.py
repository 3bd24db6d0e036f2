"""Negative controls of the gold values: what is wrong in them, or in what Kiln computes, must fail, and say where."""

import json
import re
import shutil

import gold
import harness
from harness import HERE, KilnTest, main


class ControlsTest(KilnTest):
    """Works on a copy of one case, its gold values and what it gives."""

    def prepare(self):
        shutil.copytree(HERE / "cases", self.folder / "cases")
        shutil.copytree(HERE / "gold" / "gnat", self.folder / "gold" / "gnat")
        gold.find(self.case(), self.folder)

    def case(self, name="gnat"):
        case = gold.Case(name)
        case.gold = self.folder / "gold" / name
        return case

    def setUp(self):
        super().setUp()
        self.gold = self.folder / "gold" / "gnat"

    def compared(self, part):
        return self.case().compare(part, self.folder / "found")

    def fails(self, part, *words):
        outcome = self.compared(part)
        self.assertIn(outcome.status, (1, 2), outcome.stdout)
        for word in words:
            self.assertIn(word, outcome.stdout + outcome.stderr)

    def edit(self, file, line, column, change, folder=None):
        """Changes one cell of a table, of the gold values if no other folder is named; line 1 is the header."""
        path = (folder or self.gold) / file
        lines = [row.split(",") for row in path.read_text().splitlines()]
        lines[line - 1][column] = change(lines[line - 1][column])
        path.write_text("".join(",".join(row) + "\n" for row in lines))
        return lines[line - 1]

    def perturb(self, file, line, column, relative=1e-6):
        return self.edit(file, line, column, lambda cell: f"{float(cell) * (1.0 + relative):.15g}")

    def test_untouched_gold_values_agree(self):
        for part in ("run", "solve.json", "training"):
            outcome = self.compared(part)
            self.assertEqual((outcome.status, outcome.stderr), (0, ""), outcome.stdout)
            self.assertRegex(outcome.stdout, r"same: [1-9]\d* numbers compared\n\Z")

    def test_perturbed_field(self):
        particle, x, y, z, _ = self.perturb("run/field.csv", 100, 4)
        place = f"line 100, particle = {particle}"
        for name, value in (("x [m]", x), ("y [m]", y), ("z [m]", z)):
            place += f", {name} = {float(value):.6g}"
        self.fails("run", "DIFFERS field.csv:temperature [K]", ", 1 beyond 1e-09; worst 1e-06 relative", place)

    def test_perturbed_probe(self):
        step, time, *_ = self.perturb("run/probes.csv", 12, 3)
        self.fails("run", "DIFFERS probes.csv:side temperature [K]", f"line 12, step = {step}, time [s] = {time}")

    def test_perturbed_extreme(self):
        self.perturb("run/extremes.csv", 30, 2)
        self.fails("run", "DIFFERS extremes.csv:largest temperature [K]", "line 30, step = 28")

    def test_a_perturbation_below_the_tolerance_agrees(self):
        self.perturb("run/field.csv", 100, 4, 1e-10)
        self.assertEqual(self.compared("run").status, 0)

    def test_moved_particle(self):
        self.edit("run/field.csv", 100, 1, lambda x: str(float(x) + 1e-6))
        self.fails("run", "DIFFERS field.csv:x [m]", "line 100")

    def test_perturbed_count(self):
        path = self.gold / "solve.json"
        counts = json.loads(path.read_text())
        counts["residuals"] += 1
        path.write_text(json.dumps(counts))
        self.fails("solve.json", "DIFFERS residuals", "1 beyond 1e-11")

    def test_another_sample(self):
        self.edit("training/samples.csv", 5, 1, lambda particle: str(int(particle) + 1))
        self.fails("training", "DIFFERS samples.csv:particle", "line 5")

    def test_perturbed_singular_value(self):
        self.perturb("training/basis.csv", 4, 3)
        self.fails("training", "DIFFERS basis.csv:relative singular value", "line 4")

    def test_not_a_number(self):
        self.edit("run/field.csv", 9, 4, lambda _: "nan")
        self.fails("run", "DIFFERS field.csv:temperature [K]", "worst inf relative: nan and", "line 9")

    def test_not_a_number_on_both_sides(self):
        for folder in (self.gold, self.folder / "found"):
            self.edit("run/field.csv", 9, 4, lambda _: "nan", folder)
        self.fails("run", "DIFFERS field.csv:temperature [K]", "nan and nan")

    def test_missing_gold(self):
        for part in ("run", "solve.json", "training"):
            with self.subTest(part):
                path = self.gold / part
                shutil.rmtree(path) if path.is_dir() else path.unlink()
                self.fails(part, str(path), "does not exist")

    def test_missing_file(self):
        (self.gold / "run" / "probes.csv").unlink()
        self.fails("run", f"FAULT probes.csv is missing in {self.gold / 'run'}")

    def test_missing_result(self):
        (self.folder / "found" / "run" / "field.csv").unlink()
        self.fails("run", f"FAULT field.csv is missing in {self.folder / 'found' / 'run'}")

    def test_emptied_gold(self):
        for path in (self.gold / "run").iterdir():
            path.unlink()
        self.fails("run", "field.csv is missing in", "nothing was compared")

    def test_emptied_files(self):
        for emptied, words in (("", ("is empty",)), ("particle,x [m],y [m],z [m],temperature [K]\n", ("has 0 rows",))):
            with self.subTest(emptied):
                (self.gold / "run" / "field.csv").write_text(emptied)
                self.fails("run", "FAULT", "field.csv", *words)
        (self.gold / "solve.json").write_text("{}")
        self.fails("solve.json", "residuals is missing on the first side", "nothing was compared")

    def test_emptied_on_both_sides(self):
        for folder in (self.gold, self.folder / "found"):
            (folder / "run" / "field.csv").write_text("particle,x [m],y [m],z [m],temperature [K]\n")
        self.fails("run", "FAULT nothing was compared of", "field.csv")

    def test_missing_field(self):
        path = self.gold / "run" / "field.csv"
        path.write_text(re.sub(r",[^,\n]*$", "", path.read_text(), flags=re.MULTILINE))
        self.fails("run", "FAULT", "field.csv have different columns")

    def test_another_shape(self):
        path = self.gold / "run" / "field.csv"
        path.write_text("".join(path.read_text().splitlines(keepends=True)[:-1]))
        self.fails("run", "FAULT", "field.csv has", "rows")

    def test_misspelt_tolerance(self):
        path = self.gold / "gold.json"
        path.write_text(path.read_text().replace("*temperature [K]", "*temprature [K]"))
        self.fails("run", "no field is called '*temprature [K]'")

    def test_one_per_cent_more_conductivity_in_a_formula(self):
        self.one_per_cent("formula", "9.2 + 0.0175*u - 2e-6*u^2", "1.01*(9.2 + 0.0175*u - 2e-6*u^2)")

    def test_one_per_cent_more_in_one_coefficient_of_a_formula(self):
        self.one_per_cent("formula", "9.2 + 0.0175*u", "9.2 + 0.017675*u")

    def one_per_cent(self, name, old, new):
        case = self.case(name)
        shutil.copytree(HERE / "gold" / name, case.gold)
        text = case.input.read_text()
        self.assertEqual(text.count(old), 1)
        case.input = self.folder / "cases" / f"{name}.yaml"
        case.input.write_text(text.replace(old, new))
        (self.folder / "changed").mkdir()
        found = gold.find(case, self.folder / "changed")
        text = case.difference("run", found, "one rank")
        self.assertRegex(text, rf"^case {name}, one rank: run is not as regression/gold has it")
        place = r"relative: \S+ and \S+ at line \d+, particle = \d+, x \[m\] = "
        self.assertRegex(text, r"DIFFERS field\.csv:temperature \[K\] .* " + place)
        self.assertRegex(text, r"DIFFERS probes\.csv:path temperature \[K\] .* step = \d+, time \[s\] = ")


class UpdateTest(KilnTest):
    """`gold.py` writes nothing without a reason."""

    def update(self, *words):
        return harness.program(self.folder, "/usr/bin/python3", "-B", HERE / "gold.py", *words)

    def test_refused(self):
        before = harness.digests(HERE / "gold")
        for words, message in (
            (("tiny",), "--reason"),
            (("tiny", "--reason", ""), "say in a few words why"),
            (("tiny", "--reason", "update"), "say in a few words why"),
            (("no-such-case", "--reason", "a good reason indeed"), "there is no case 'no-such-case'"),
            (("--reason", "a good reason indeed"), "CASE"),
        ):
            with self.subTest(words):
                outcome = self.update(*words)
                self.assertNotEqual(outcome.status, 0)
                self.assertIn(message, outcome.stderr)
        self.assertEqual(harness.digests(HERE / "gold"), before)


if __name__ == "__main__":
    main()
