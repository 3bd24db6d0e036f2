"""Negative controls of `kiln compare`: a comparison that cannot fail would prove nothing in the other tests."""

import shutil

import h5py

from harness import KilnTest, main


class CompareTest(KilnTest):
    def prepare(self):
        self.solve("run", into="a")

    def setUp(self):
        super().setUp()
        shutil.copytree(self.folder / "a", self.folder / "b")
        self.b = self.folder / "b" / "fom"

    def differs(self, *words, options=(), unreadable=None):
        compared = self.kiln("compare", "a/fom", "b/fom", *options)
        self.assertEqual(compared.status, 2 if unreadable else 1, compared.stdout)
        if unreadable:
            self.assertTrue(compared.stderr.startswith(unreadable + ": "), compared.stderr)
            self.assertEqual(compared.stderr.count("\n"), 1)
        else:
            self.assertEqual(compared.stderr, "")
        for word in words:
            self.assertIn(word, compared.stdout)
        self.assertRegex(compared.stdout, r"different: \d+ numbers compared\n\Z")

    def same(self, *options):
        compared = self.kiln("compare", "a/fom", "b/fom", *options)
        self.assertEqual((compared.status, compared.stderr), (0, ""), compared.stdout)
        self.assertRegex(compared.stdout, r"same: [1-9]\d* numbers compared\n\Z")

    def perturb(self, frame, particle, factor):
        with h5py.File(self.b / "run.h5", "r+") as file:
            file["temperature"][frame, particle] *= factor

    def test_copies_are_the_same(self):
        self.same("--tolerance", 0)

    def test_one_value_of_one_frame(self):
        self.perturb(3, 100, 1.0 + 1e-6)
        with h5py.File(self.b / "run.h5") as file:
            x, y, z = file["position"][100]
        self.differs("DIFFERS run.h5:/temperature", f"frame 3, t = 0.0015 s, particle 100 at ({x:.6g}, {y:.6g}, {z:.6g})")
        self.same("--tolerance", 1e-5)

    def test_a_tolerance_of_one_field(self):
        self.perturb(3, 100, 1.0 + 1e-6)
        self.same("--field", "run.h5:/temperature=1e-5")
        self.same("--field", "probes.csv:*=0", "--field", "*:/temp*=1e-9,1e6")
        options = ("--field", "run.h5:/temperature=1e-7", "--tolerance", 1)
        self.differs("particle 100", "1 beyond 1e-07", options=options)
        options = ("--field", "run.h5:/temprature=1", "--tolerance", 1)
        self.differs("no field is called 'run.h5:/temprature'", options=options)

    def test_a_tolerance_that_is_none(self):
        for text in ("temperature", "=1e-5", "temperature=", "temperature=-1", "temperature=nan", "temperature=1e-5,x"):
            compared = self.kiln("compare", "a/fom", "b/fom", "--field", text)
            self.assertEqual((compared.status, compared.stdout), (2, ""), text)
            self.assertIn(f"--field {text}", compared.stderr)
            self.assertIn("FIELDS=TOLERANCE", compared.stderr)

    def test_one_value_by_one_bit(self):
        self.perturb(4, 7, 1.0 + 2.0**-52)
        self.same()
        self.differs("particle 7", options=("--tolerance", 0))

    def test_not_a_number(self):
        self.perturb(2, 5, float("nan"))
        self.differs("frame 2", "particle 5", "nan", options=("--tolerance", 1, "--floor", 1e9))

    def test_missing_field(self):
        with h5py.File(self.b / "run.h5", "r+") as file:
            del file["temperature"]
        self.differs("FAULT run.h5:/temperature is missing in b/fom/run.h5")

    def test_another_shape(self):
        with h5py.File(self.b / "run.h5", "r+") as file:
            temperature = file["temperature"][:, :-1]
            del file["temperature"]
            file["temperature"] = temperature
        self.differs("/temperature has shape 5 × 1728 and 5 × 1727")

    def test_missing_file(self):
        (self.b / "probes.csv").unlink()
        self.differs("FAULT probes.csv is missing in b/fom")

    def test_truncated_table(self):
        lines = (self.b / "probes.csv").read_text().splitlines(keepends=True)
        (self.b / "probes.csv").write_text("".join(lines[:-1]))
        self.differs("probes.csv")

    def test_table_value(self):
        text = (self.b / "extremes.csv").read_text()
        changed = text.replace("\n10,0.0005,", "\n10,0.0006,")
        self.assertNotEqual(changed, text)
        (self.b / "extremes.csv").write_text(changed)
        self.differs("DIFFERS extremes.csv:time [s]", "step = 10")

    def test_damaged_file(self):
        (self.b / "run.h5").write_bytes((self.b / "run.h5").read_bytes()[:3000])
        self.differs("FAULT b/fom/run.h5", unreadable="b/fom/run.h5")

    def test_empty_folders(self):
        shutil.rmtree(self.b)
        self.b.mkdir()
        self.differs("is missing in b/fom")
        shutil.rmtree(self.folder / "a" / "fom")
        (self.folder / "a" / "fom").mkdir()
        self.differs("nothing was compared")


if __name__ == "__main__":
    main()
