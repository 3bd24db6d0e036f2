"""What the command line says of mistakes: status 2, once on standard error, on any number of ranks, nothing touched.

Each kind of mistake (command line, input, data file, output folder) runs on more than one rank once; mpirun takes more
than a second to end a failed run, so not all of them do."""

import fcntl
import re
import subprocess

from harness import HERE, SMALL, KilnTest, command, digests, main

STACK_TRACE = re.compile(r"terminate|what\(\)|Aborted|[Bb]acktrace|Segmentation|unforeseen|did not foresee")


class MessagesTest(KilnTest):
    def prepare(self):
        # Results of an earlier run, which no mistake may change.
        self.solve("run")

    def wrong(self, *arguments, lines, words, ranks=(1,)):
        """Runs a command line; `lines` is how long the message is, and each word stands in it."""
        before = digests(self.folder)
        for count in ranks:
            outcome = self.kiln(*arguments, ranks=count)
            with self.subTest(ranks=count, message=outcome.stderr):
                self.assertEqual(outcome.status, 2)
                self.assertEqual(outcome.stdout, "")
                self.assertEqual(outcome.stderr.count("\n"), lines)
                for word in words:
                    self.assertIn(word, outcome.stderr)
                self.assertNotRegex(outcome.stderr, STACK_TRACE)
                self.assertEqual(digests(self.folder), before)
        return outcome.stderr

    def edited(self, *edits):
        """The small case with some of its text replaced."""
        text = SMALL.read_text()
        for old, new in edits:
            self.assertEqual(text.count(old), 1, old)
            text = text.replace(old, new)
        (self.folder / "case.yaml").write_text(text)
        return text

    def place(self, text, word):
        """line:column of a word's first letter, as editors count."""
        before = text[: text.index(word)]
        return f"case.yaml:{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}: "

    # Standard output

    def test_full_standard_output(self):
        for words in (("list",), ("check", SMALL), ("report", "results/fom")):
            with self.subTest(words), open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run(
                    command(*words), cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True, check=False
                )
                self.assertEqual(done.returncode, 2)
                self.assertEqual(done.stderr, "standard output: cannot be written: No space left on device\n")

    # Command line

    def test_no_command(self):
        self.wrong(lines=2, words=("A subcommand is required", "--help"), ranks=(1, 2))

    def test_unknown_command(self):
        self.wrong("frobnicate", lines=2, words=("no command 'frobnicate'", "run, train, study, check", "--help"))

    def test_misspelt_command(self):
        self.wrong("tran", SMALL, lines=2, words=("no command 'tran'", "did you mean 'train'?"))

    def test_unknown_option(self):
        self.wrong("run", SMALL, "--frob", lines=2, words=("--frob", "--help"))

    def test_missing_file_name(self):
        for command in ("run", "train", "check"):
            self.wrong(command, lines=2, words=("FILE is required",))

    def test_missing_name(self):
        self.wrong("describe", lines=2, words=("NAME is required",))

    def test_set_without_value(self):
        self.wrong("run", SMALL, "--set", "time.step", lines=1, words=("--set time.step", "no '='", "path.to.key=value"))

    def test_set_unknown_key(self):
        self.wrong("run", SMALL, "--set", "time.stp=1 us", lines=1, words=("--set time.stp", "did you mean 'step'?"))

    def test_unknown_component(self):
        self.wrong("describe", "wendlad c2", lines=1, words=("'wendlad c2'", "did you mean 'wendland c2'?"))
        self.wrong("template", "sphheat", lines=1, words=("'sphheat'", "did you mean 'sph heat'?"))

    def test_report_of_a_folder_without_one(self):
        self.wrong("report", ".", lines=1, words=("report.json", "No such file"))
        self.wrong("report", "nowhere", lines=1, words=("nowhere/report.json", "No such file"), ranks=(2,))

    def test_compare_with_a_missing_file(self):
        self.wrong("compare", "results/fom", "nowhere", lines=2, words=("nowhere", "does not exist"), ranks=(1, 2))
        self.wrong("compare", "nowhere.h5", "results/fom/run.h5", lines=2, words=("nowhere.h5", "does not exist"))

    def test_compare_with_a_bad_tolerance(self):
        for value in ("-1", "nan", "inf", "1e-6x"):
            words = (f"'{value}'", "finite number of at least 0")
            self.wrong("compare", "results", "results", f"--tolerance={value}", lines=2, words=("--tolerance",) + words)

    # Input files

    def test_file_that_is_not_there(self):
        self.wrong("run", "nowhere.yaml", lines=1, words=("nowhere.yaml", "no such file"), ranks=(1, 3))

    def test_file_that_is_a_folder(self):
        self.wrong("run", "results", lines=1, words=("results", "folder"))

    def test_empty_file(self):
        (self.folder / "case.yaml").write_text("")
        self.wrong("run", "case.yaml", lines=1, words=("case.yaml", "empty"))

    def test_broken_yaml(self):
        text = self.edited(("count: [24, 12, 6]", "count: [24, 12, 6"))
        message = self.wrong("run", "case.yaml", lines=1, words=())
        self.assertRegex(message, r"^case\.yaml:\d+:\d+: ")
        line = int(message.split(":")[1])
        self.assertLessEqual(abs(line - text[: text.index("[24, 12, 6")].count("\n") - 1), 2)

    def test_misspelt_key(self):
        text = self.edited(("kernel: cubic", "kernl: cubic"))
        words = (self.place(text, "kernl"), "model.kernl: ", "did you mean 'kernel'?")
        # The key that is missing now is named as well.
        self.assertIn("kernl", self.wrong("run", "case.yaml", lines=1, words=words))

    def test_two_mistakes_in_the_order_of_the_file(self):
        text = self.edited(("power: 20 W", "power: twenty"), ("refresh: 10", "refresh: 2.5"))
        message = self.wrong("check", "case.yaml", lines=2, words=(), ranks=(1, 2))
        first, second = message.splitlines()
        self.assertTrue(first.startswith(self.place(text, "twenty") + "model.heat_source.power: "), first)
        self.assertTrue(second.startswith(self.place(text, "2.5") + "time.newton.refresh: "), second)

    def test_not_a_number(self):
        text = self.edited(("width: 0.15 mm", "width: .nan"))
        self.wrong("run", "case.yaml", lines=1, words=(self.place(text, ".nan") + "model.heat_source.width", "not finite"))

    def test_negative_step(self):
        text = self.edited(("step: 50 us", "step: -50 us"))
        self.wrong("run", "case.yaml", lines=1, words=(self.place(text, "-50 us") + "time.step", "not above 0"))

    def test_wrong_unit(self):
        text = self.edited(("power: 20 W", "power: 20 kg"))
        self.wrong("run", "case.yaml", lines=1, words=(self.place(text, "20 kg") + "model.heat_source.power", "kg", "W"))

    def test_wrong_length_of_a_list(self):
        text = self.edited(("count: [24, 12, 6]", "count: [24, 12]"))
        self.wrong("run", "case.yaml", lines=1, words=(self.place(text, "[24, 12]") + "model.particles.count", "3"))

    def test_end_between_two_steps(self):
        text = self.edited(("end: 2 ms", "end: 2.01 ms"))
        words = (self.place(text, "2.01 ms") + "time.end", "40.2 steps", "whole number of steps")
        self.wrong("run", "case.yaml", lines=1, words=words)
        self.wrong("train", "case.yaml", lines=1, words=words)

    def test_missing_block(self):
        text = SMALL.read_text()
        (self.folder / "case.yaml").write_text(text[: text.index("time:\n")] + text[text.index("method:") :])
        self.wrong("run", "case.yaml", lines=1, words=("case.yaml", "time", "missing"))

    def test_plugin_without_a_name(self):
        self.wrong("check", SMALL, "--set", 'plugins=[""]', lines=1, words=["plugins.0", "an empty text is given"])

    def test_more_windows_than_snapshots(self):
        words = ["reduction.windows.count", "41 windows are more than the 40 snapshots", "at most 40"]
        self.wrong("train", SMALL, "--set", "reduction.windows.count=41", lines=1, words=words)

    def test_a_training_that_cannot_be_is_told_before_it_runs(self):
        few = "10 particles with 1 component each cannot determine 24 residual modes"
        for changes, *words in (
            (["sampling.samples=10"], "sampling.samples: ", few),
            (["sampling.samples=1729"], "sampling.samples: ", "1729 particles are asked for"),
            (["sampling.seeds=[5, 1728]"], "sampling.seeds.1: ", "there is no particle 1728"),
            (["basis.rank=41", "residual_basis.rank=41", "sampling.samples=60"], "basis.rank: ", "41 basis vectors are more than the 40"),
            (["snapshots.hold=8"], "basis.rank: ", "12 basis vectors are more than the 8 snapshots that are held"),
            (["clustering={type: robust}"], "clustering: ", "is no source of row"),
        ):  # fmt: skip
            sets = [word for change in changes for word in ("--set", f"reduction.{change}")]
            for command in ("check", "train"):
                self.wrong(command, SMALL, *sets, lines=1, words=words)

    def test_training_without_a_reduction_block(self):
        text = SMALL.read_text()
        (self.folder / "case.yaml").write_text(text[: text.index("reduction:\n")] + text[text.index("output:") :])
        self.wrong("train", "case.yaml", lines=1, words=("case.yaml", "no block 'reduction'"))

    def test_probes_outside_the_part(self):
        text = self.edited(
            ("[0.6 mm, -0.1 mm, 0.5 mm]", "[0.6 mm, -5 mm, 0.5 mm]"), ("[0.8 mm, 0 mm, 0.1 mm]", "[0.8, 0, 0.1]")
        )
        message = self.wrong("run", "case.yaml", lines=2, words=("'path'", "'deep'", "outside"), ranks=(1, 2))
        self.assertNotIn("'side'", message)
        first, second = message.splitlines()
        self.assertTrue(first.startswith(self.place(text, "[0.6 mm, -5 mm")), first)
        self.assertTrue(second.startswith(self.place(text, "[0.8, 0, 0.1]")), second)

    def test_unknown_method(self):
        words = ("method.type", "'gant'", "fom, galerkin, gnat, lspg", "did you mean 'gnat'?")
        self.wrong("run", SMALL, "--set", "method.type=gant", lines=1, words=words)

    def test_a_difference_in_celsius(self):
        words = ("model.table.step: '1 degC' counts from a zero of its own", "expected")
        self.wrong("check", SMALL, "--set", "model.table.step=1 degC", lines=1, words=words)

        lacking = ("time.newton.jacobian: ", "VortexModel does not offer")
        for command in ("check", "train"):
            self.wrong(command, HERE / "cases/vortex-gnat.yaml", "--set", "time.newton.jacobian=sparse", lines=1, words=lacking)
        # In several windows a rank is a cap, which may be more than any of them holds.
        caps = ("windows={steps: 2}", "basis.rank=10", "residual_basis.rank=14", "sampling.samples=10")
        outcome = self.kiln("check", SMALL, *(word for cap in caps for word in ("--set", f"reduction.{cap}")))
        self.assertEqual((outcome.status, outcome.stderr), (0, ""))

    def test_a_range_that_ends_before_it_begins(self):
        words = ("model.particles.radius: ", "the least, 0.5, is above the largest, 0.2")
        random = HERE / "cases" / "vortex-random.yaml"
        self.wrong("check", random, "--set", "model.particles.radius=[0.5 m, 20 cm]", lines=1, words=words)

    def test_a_heat_source_that_heats_nothing(self):
        rows = [f"{i % 3 * 1e-4},{i // 3 % 3 * 1e-4},{i // 9 * 1e-4}\n" for i in range(27)]
        table = self.folder / "particles.csv"
        table.write_text("x,y,z\n" + "".join(rows))
        particles = f"model.particles={{type: file, path: {table}, spacing: 0.1 mm, volume: 0.027 mm^3}}"
        words = ("model.heat_source", "a gaussian beam heats no particle", "column 'area'", "heat_source: none")
        self.wrong("check", SMALL, "--set", particles, lines=1, words=words, ranks=(1, 2))
        inside = "output.probes.points=[{name: corner, position: [0 m, 0 m, 0 m]}]"
        nothing = self.kiln("check", SMALL, *("--set", particles, "--set", "model.heat_source=none", "--set", inside,
                                             "--set", "reduction.sampling.samples=24"))
        self.assertEqual((nothing.status, nothing.stderr), (0, ""))

    # Data and output files

    def test_jacobian_that_the_model_lacks(self):
        vortices = (HERE / "cases" / "vortex-file.yaml", "--set", "output.directory=results")
        words = ("VortexModel", "rate_jacobian_matrix", "time.newton.jacobian: finite difference")
        for command in ("check", "run"):
            self.wrong(command, *vortices, "--set", "time.newton.jacobian=sparse", lines=1, words=words)

    def test_no_reduction_file(self):
        for method, ranks in (("galerkin", 1), ("lspg", 1), ("gnat", 2)):
            words = ("results/reduction.h5", "no such file", "kiln train")
            self.wrong("run", SMALL, "--set", f"method.type={method}", lines=1, words=words, ranks=(ranks,))

    def test_reduction_file_that_is_something_else(self):
        (self.folder / "results" / "reduction.h5").write_bytes((self.folder / "results/fom/run.h5").read_bytes())
        self.wrong("run", SMALL, "--set", "method.type=gnat", lines=1, words=("results/reduction.h5",))
        (self.folder / "results" / "reduction.h5").write_text("no HDF5 at all\n")
        self.wrong("run", SMALL, "--set", "method.type=gnat", lines=1, words=("results/reduction.h5",))

    def test_particle_file_that_is_not_there(self):
        particles = "model.particles={type: file, path: nowhere.csv, spacing: 0.1 mm}"
        self.wrong("run", SMALL, "--set", particles, lines=1, words=("nowhere.csv",))

    def test_output_folder_that_is_a_file(self):
        (self.folder / "taken").write_text("a file\n")
        self.wrong("run", SMALL, "--set", "output.directory=taken", lines=1, words=("taken/fom", "cannot be made"), ranks=(2,))
        self.wrong("train", SMALL, "--set", "output.directory=taken", lines=1, words=("taken", "cannot be made"))
        (self.folder / "half").mkdir()
        (self.folder / "half" / "fom").write_text("a file\n")
        self.wrong("run", SMALL, "--set", "output.directory=half", lines=1, words=("half/fom", "not a folder"))

    def test_folder_in_the_place_of_an_output_file(self):
        # Found at the first step, after the folder was taken: other files may be new, the folder stands.
        folder = self.folder / "results" / "fom"
        (folder / "probes.csv").unlink()
        (folder / "probes.csv").mkdir()
        outcome = self.kiln("run", SMALL, "--quiet", ranks=2)
        self.assertEqual((outcome.status, outcome.stdout), (2, ""), outcome.stderr)
        self.assertEqual(outcome.stderr.count("\n"), 1, outcome.stderr)
        self.assertIn("probes.csv", outcome.stderr)

    def test_folder_in_use(self):
        with open(self.folder / "results" / "fom" / "run.lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.wrong("run", SMALL, lines=1, words=("results/fom", "in use by another run"), ranks=(1, 2))


if __name__ == "__main__":
    main()
