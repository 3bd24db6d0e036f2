"""An input file may come from anywhere: it writes below the folder Kiln was started in, and nowhere else, unless the command
line says so."""

from harness import SMALL, KilnTest, digests, main


class OutsideTest(KilnTest):
    def prepare(self):
        text = SMALL.read_text()
        for name in ("start", "outside"):
            (self.folder / name).mkdir()
        (self.folder / "start" / "small.yaml").write_text(text.replace("end: 2 ms", "end: 100 us"))

    def setUp(self):
        super().setUp()
        self.start, self.outside = self.folder / "start", self.folder / "outside"
        self.text = (self.start / "small.yaml").read_text()

    def within(self, *arguments, **how):
        """Runs kiln in `start`."""
        home, self.folder = self.folder, self.start
        try:
            return self.kiln(*arguments, **how)
        finally:
            self.folder = home

    def directory(self, directory):
        (self.start / "small.yaml").write_text(self.text.replace("directory: results", f"directory: {directory}"))

    def refused(self, *words, commands=("run", "train", "check"), ranks=(1,)):
        before = digests(self.folder)
        for command in commands:
            for count in ranks:
                outcome = self.within(command, "small.yaml", ranks=count)
                with self.subTest(command=command, message=outcome.stderr):
                    self.assertEqual((outcome.status, outcome.stdout), (2, ""))
                    self.assertEqual(outcome.stderr.count("\n"), 1)
                    for word in ("small.yaml:", "output.directory: ", "--allow-outside", *words):
                        self.assertIn(word, outcome.stderr)
                    self.assertEqual(digests(self.folder), before)

    def allowed(self, *options, command="run", file="small.yaml"):
        outcome = self.within(command, file, "--quiet", *options)
        self.assertEqual((outcome.status, outcome.stderr), (0, ""))

    def test_absolute(self):
        self.directory(self.outside)
        self.refused("is an absolute folder", ranks=(1, 2))
        self.allowed("--allow-outside")
        self.assertTrue((self.outside / "fom" / "run.h5").is_file())

    def test_dots(self):
        for directory in ("../outside", "results/../../outside", ".."):
            self.directory(directory)
            self.refused("leads out of the current folder")
        self.directory("results/../other")
        self.allowed()
        self.assertTrue((self.start / "other" / "fom" / "run.h5").is_file())

    def test_links_on_the_way(self):
        (self.start / "link").symlink_to(self.outside)
        (self.start / "results").mkdir()
        for name in ("fom", "training"):
            (self.start / "results" / name).symlink_to(self.outside)
        for directory in ("link", "link/deeper", "link/../outside"):
            self.directory(directory)
            self.refused("through a symbolic link")
        self.directory("results")
        self.refused("results/", "a symbolic link")
        self.allowed("--allow-outside")

    def test_links_in_the_place_of_files(self):
        run_folder = self.start / "results" / "fom"
        run_folder.mkdir(parents=True)
        (self.outside / "precious").write_text("precious\n")
        link = run_folder / "run.h5"
        for target in ("precious", "not-there"):
            link.unlink(missing_ok=True)
            link.symlink_to(self.outside / target)
            self.refused("results/fom/run.h5 is a symbolic link")
        link.unlink()
        reduction = self.start / "results" / "reduction.h5"
        reduction.symlink_to(self.outside / "precious")
        self.refused("results/reduction.h5 is a symbolic link")
        reduction.unlink()
        # A link that stays inside is nobody's business.
        (self.start / "elsewhere").mkdir()
        (self.start / "results" / "kept").symlink_to(self.start / "elsewhere")
        self.allowed()

    def test_the_command_line_is_the_users_own_word(self):
        self.allowed("--set", f"output.directory={self.outside}")
        self.allowed("--set", "output.directory=../outside/again")
        self.assertTrue((self.outside / "fom" / "run.h5").is_file())
        self.assertTrue((self.outside / "again" / "fom" / "run.h5").is_file())

    def test_the_input_itself_may_lie_outside(self):
        (self.outside / "small.yaml").write_text(self.text)
        self.allowed(file="../outside/small.yaml")
        self.assertTrue((self.start / "results" / "fom" / "run.h5").is_file())

    def test_studies(self):
        study = self.start / "study.yaml"
        study.write_text(f"output: {self.outside}\ncases: [{{name: a, input: small.yaml}}]\n")
        outcome = self.within("study", "study.yaml")
        self.assertEqual((outcome.status, outcome.stdout), (2, ""))
        self.assertIn("study.yaml:1:9: output: ", outcome.stderr)
        self.assertEqual(list(self.outside.iterdir()), [])
        self.allowed("--set", "output=inside", command="study", file="study.yaml")
        self.allowed("--allow-outside", command="study", file="study.yaml")
        self.assertTrue((self.outside / "study.json").is_file())


if __name__ == "__main__":
    main()
