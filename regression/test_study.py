"""`kiln study`: a matrix of cases that keeps what is complete, resumes what was interrupted and outlives failures."""

import fcntl
import json
import os
import re
import shutil
import signal
import subprocess
import time

import pandas

from harness import HERE, SMALL, KilnTest, command, datasets, digests, main

STUDY = HERE / "study.yaml"
NAMES = ["power-10", "power-20", "trained"] + [
    f"reduced/{method}-{tolerance}" for method in ("gnat", "lspg") for tolerance in ("1e-3", "1e-6")
]
# Slow enough that the beam stays on the part, long enough that a kill comes in the middle.
LONG = {"model.heat_source.velocity": "[0.1 m/s, 0 m/s]", "time.end": "10 ms", "output.checkpoint.every": "4"}
UNSTABLE = {"time.scheme": "explicit euler", "time.step": "1 s", "time.end": "150 s"}


def state(folder):
    """Digest and moment of writing of every file but the study's own table."""
    folder = folder.resolve()
    return {
        name: (digest, (folder / name).stat().st_mtime_ns)
        for name, digest in digests(folder).items()
        if name != "study.json"
    }


class StudyTest(KilnTest):
    def study(self, file=STUDY, *options, status=0, ranks=1):
        outcome = self.kiln("study", file, *options, ranks=ranks)
        self.assertEqual(outcome.status, status, outcome.stderr + outcome.stdout)
        return outcome

    def write(self, *cases, file="study.yaml"):
        """A study of these cases (name, command, set, needs) of the small input."""
        shutil.copy(SMALL, self.folder / "small.yaml")
        blocks = []
        for name, command, changes, *needs in cases:
            block = {"name": name, "input": "small.yaml", "command": command, "set": changes}
            blocks.append(block | ({"needs": needs[0]} if needs else {}))
        # JSON is YAML.
        (self.folder / file).write_text(json.dumps({"output": "study", "cases": blocks}, indent=1))
        return file

    def listed(self, file, ranks=1):
        """The states that --list shows."""
        return [line[:11].strip() for line in self.study(file, "--list", ranks=ranks).stdout.splitlines()]

    def table(self):
        return pandas.read_json(self.folder / "study" / "study.json", dtype=False).set_index("name")

    def statuses(self):
        return self.table()["status"].to_dict()

    def same_results(self, alone, folder):
        for name in ("probes.csv", "extremes.csv", "probes.json", "run.xdmf"):
            self.assertEqual((alone / name).read_bytes(), (folder / name).read_bytes(), name)
        left, right = datasets(alone / "run.h5"), datasets(folder / "run.h5")
        self.assertEqual(sorted(left), sorted(right))
        for name, values in left.items():
            self.assertEqual(values.tobytes(), right[name].tobytes(), name)

    def check_matrix(self, ranks):
        outcome = self.study(ranks=ranks)
        self.assertIn("7 cases: 7 complete (0 of them kept), 0 failed, 0 skipped", outcome.stdout)
        lines = outcome.stderr.splitlines()
        self.assertEqual(len(lines), 7, outcome.stderr)
        for number, (line, name) in enumerate(zip(lines, NAMES), start=1):
            self.assertRegex(line, rf"^\[{number}/7\] {name} .* s  done, .* left$")

        table = self.table()
        self.assertEqual(list(table.index), NAMES)
        self.assertEqual(set(table["status"]), {"complete"})
        self.assertTrue((table["seconds"] > 0.0).all())
        self.assertEqual(table.loc["reduced/lspg-1e-3", ["method", "tolerance"]].to_list(), ["lspg", "1e-3"])
        for name, row in table.iterrows():
            self.assertEqual(row["folder"], f"study/{name}")
            self.assertTrue((self.folder / row["report"]).is_file(), row["report"])

        # Whatever ran before in the same process, a case leaves what a lone run leaves.
        alone = self.solve("run", into="alone", ranks=ranks) / "fom"
        self.same_results(alone, self.folder / "study/power-20/fom")
        changes = ("method.type=gnat", f"method.file={self.folder / 'study/trained/reduction.h5'}")
        reduced = self.solve("run", *changes, into="alone", ranks=ranks) / "gnat"
        self.same_results(reduced, self.folder / "study/reduced/gnat-1e-6/gnat")
        calls = [
            re.search(r"kiln: rate: .*\[(\d+)\]", json.loads((folder / "report.json").read_text())["timers"]["table"])[1]
            for folder in (alone, self.folder / "study/power-20/fom")
        ]
        self.assertEqual(*calls, "the timers are those of this run alone")

        before = state(self.folder / "study")
        again = self.study(ranks=ranks)
        self.assertEqual(again.stderr.count("complete, kept"), 7, again.stderr)
        self.assertIn("7 complete (7 of them kept)", again.stdout)
        self.assertEqual(state(self.folder / "study"), before)
        self.assertTrue((self.table()["seconds"] == table["seconds"]).all())

    def test_matrix(self):
        self.check_matrix(1)

    def test_matrix_on_two_ranks(self):
        self.check_matrix(2)
        # On another number of ranks nothing is the same to the bit.
        self.assertEqual(self.listed(STUDY), ["to do"] * 7)

    def kill_when(self, reached, file, ranks=1):
        """Starts the study and kills its processes once that is so."""
        process = subprocess.Popen(
            command("study", file, ranks=ranks),
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        deadline = time.monotonic() + 30.0
        while not reached():
            self.assertIsNone(process.poll(), "the study ended before it could be killed")
            self.assertLess(time.monotonic(), deadline, "the moment to kill it did not come")
            time.sleep(0.001)
        children = f"/proc/{process.pid}/task/{process.pid}/children"
        with open(children, encoding="ascii") as list_of_ranks:
            for rank in [int(child) for child in list_of_ranks.read().split()] if ranks > 1 else [process.pid]:
                os.kill(rank, signal.SIGKILL)
        self.assertNotEqual(process.wait(timeout=30), 0)

    def check_interruption(self, ranks):
        file = self.write(("first", "run", {}), ("long", "run", LONG), ("last", "run", {"method.type": "fom"}))
        long = self.folder / "study/long/fom"
        self.kill_when((long / "checkpoint.h5").exists, file, ranks)
        self.assertFalse((long / "report.json").exists())
        self.assertFalse((self.folder / "study/last").exists())
        self.assertEqual(self.listed(file, ranks=ranks), ["complete", "interrupted", "to do"])
        before = state(self.folder / "study/first")

        outcome = self.study(file, ranks=ranks)
        self.assertIn("[1/3] first           complete, kept", outcome.stderr)
        self.assertEqual(state(self.folder / "study/first"), before)
        self.assertEqual(self.table()["continued"].to_dict(), {"first": False, "long": True, "last": False})
        self.assertGreater(json.loads((long / "report.json").read_text())["run"]["first_step"], 0)
        changes = [f"{key}={value}" for key, value in LONG.items()]
        self.same_results(self.solve("run", *changes, into="alone", ranks=ranks) / "fom", long)

    def test_interruption(self):
        self.check_interruption(1)

    def test_interruption_on_two_ranks(self):
        self.check_interruption(2)

    def test_interrupted_case_of_another_input_starts_anew(self):
        file = self.write(("long", "run", LONG))
        checkpoint = self.folder / "study/long/fom/checkpoint.h5"
        self.kill_when(checkpoint.exists, file)
        # The checkpoint's model, time and method are the same, so that it alone could not tell.
        file = self.write(("long", "run", LONG | {"output.checkpoint.every": "1000"}))
        self.assertIn("to do        long  changed: input", self.kiln("study", file, "--list").stdout)
        record = self.folder / "study/long/case.json"
        first = json.loads(record.read_text())
        self.kill_when(lambda: json.loads(record.read_text())["identity"] != first["identity"], file)
        # Nor is it taken for one of the second start, which was killed before its own.
        self.assertEqual(self.listed(file), ["interrupted"])
        self.study(file)
        self.assertEqual(self.table()["continued"].to_dict(), {"long": False})
        report = json.loads((self.folder / "study/long/fom/report.json").read_text())
        self.assertEqual(report["run"]["first_step"], 0)

    def check_failure(self, ranks):
        online = {"method.type": "gnat", "method.file": "{needs}/reduction.h5"}
        file = self.write(
            ("first", "run", {}),
            ("unstable", "run", UNSTABLE),
            ("overheated", "train", {"model.heat_source.power": "1e300 W"}),
            ("needing", "run", online, "overheated"),
            ("last", "run", {"model.heat_source.power": "10 W"}),
        )
        outcome = self.study(file, status=1, ranks=ranks)
        self.assertIn("5 cases: 2 complete (0 of them kept), 2 failed, 1 skipped", outcome.stdout)
        self.assertRegex(outcome.stderr, r"\[2/5\] unstable .* failed: step \d+, t = .*")
        self.assertRegex(outcome.stderr, r"\[4/5\] needing .* skipped: needs overheated \(failed\)")
        table = outcome.stderr[outcome.stderr.index("\nfailed ") + 1 :].splitlines()
        self.assertEqual([line.split()[:2] for line in table],
                         [["failed", "unstable"], ["failed", "overheated"], ["skipped", "needing"]])
        rows = self.table()
        self.assertEqual(rows["status"].to_list(), ["complete", "failed", "failed", "skipped", "complete"])
        self.assertRegex(rows.loc["unstable", "message"], r"^step \d+, t = ")
        self.assertEqual(rows.loc["first", "message"], "")

        # Failed cases are tried again, the others are kept; with the cause gone, those that need them run.
        kept = {name: state(self.folder / "study" / name) for name in ("first", "last")}
        again = self.study(file, status=1, ranks=ranks)
        self.assertIn("2 complete (2 of them kept), 2 failed, 1 skipped", again.stdout)
        file = self.write(
            ("first", "run", {}),
            ("unstable", "run", {}),
            ("overheated", "train", {}),
            ("needing", "run", online, "overheated"),
            ("last", "run", {"model.heat_source.power": "10 W"}),
        )
        self.study(file, ranks=ranks)
        self.assertEqual(set(self.statuses().values()), {"complete"})
        self.assertEqual(kept, {name: state(self.folder / "study" / name) for name in ("first", "last")})

    def test_failure(self):
        self.check_failure(1)

    def test_failure_on_two_ranks(self):
        self.check_failure(2)

    def test_data_file_that_became_bad(self):
        # A reduction from elsewhere that a case is pointed to: no mistake of the input, an error of the run.
        (self.folder / "reduction.h5").write_text("no HDF5 at all\n")
        bad = {"method.type": "gnat", "method.file": str(self.folder / "reduction.h5")}
        file = self.write(("bad", "run", bad), ("good", "run", {}))
        outcome = self.study(file, status=1)
        self.assertIn("reduction.h5", outcome.stderr)
        self.assertEqual(self.statuses(), {"bad": "failed", "good": "complete"})
        # Its contents are part of what the case depends on.
        (self.folder / "reduction.h5").write_text("still no HDF5\n")
        self.assertIn("changed: data files", self.kiln("study", file, "--list").stdout)

    def test_changed_input(self):
        cases = self.folder / "cases"
        cases.mkdir()
        shutil.copy(SMALL, cases)
        study = self.folder / "study.yaml"
        shutil.copy(STUDY, study)
        self.study(study)
        before = {name: state(self.folder / "study" / name) for name in NAMES}
        study.write_text(study.read_text().replace("    command: train\n", "    command: train\n    set: {title: Another}\n"))
        listed = self.kiln("study", study, "--list").stdout
        self.assertIn("to do        trained            changed: input", listed)
        self.assertEqual(listed.count("needs trained (to do)"), 4, listed)
        self.assertIn("7 complete (2 of them kept)", self.study(study).stdout)
        for name in NAMES:
            unchanged = state(self.folder / "study" / name) == before[name]
            self.assertEqual(unchanged, name.startswith("power"), name)
        # A change of the shared input concerns all.
        text = (cases / "small.yaml").read_text()
        (cases / "small.yaml").write_text(text.replace("end: 2 ms", "end: 1 ms"))
        self.assertEqual(self.listed(study), ["to do"] * 7)

    def test_lost_results(self):
        file = self.write(("a", "run", {}), ("b", "run", {"title": "b"}))
        self.study(file)
        (self.folder / "study/b/fom/run.h5").unlink()
        self.assertIn("to do        b  its results are gone", self.kiln("study", file, "--list").stdout)
        self.assertIn("2 complete (1 of them kept)", self.study(file).stdout)
        (self.folder / "study/a/case.json").write_text("{")
        self.assertIn("2 complete (1 of them kept)", self.study(file).stdout)

    def test_mistakes_are_told_before_anything_runs(self):
        file = self.write(
            ("good", "run", {}),
            ("typo", "run", {"model.kernl": "wendland c2"}),
            ("outside", "run", {"output.probes.points.0.position": "[0, -5 mm, 0]"}),
            ("trained", "train", {}),
            ("online", "run", {"method.type": "gnat", "method.file": "{needs}/reductoin.h5"}, "trained"),
        )
        before = digests(self.folder)
        for ranks in (1, 2):
            outcome = self.study(file, status=2, ranks=ranks)
            lines = outcome.stderr.splitlines()
            self.assertEqual(len(lines), 2, outcome.stderr)
            self.assertRegex(lines[0], r"^study.yaml:\d+:\d+: cases.1.set.model.kernl \(case 'typo'\): .*'kernel'")
            self.assertRegex(lines[1], r"^study.yaml:\d+:\d+: cases.4.set.method.file \(case 'online'\): .*no such file")
            self.assertEqual((outcome.stdout, digests(self.folder)), ("", before))
        # What only the components see.
        file = self.write(("good", "run", {}), ("outside", "run", {"output.probes.points.0.position": "[0, -5 mm, 0]"}))
        before = digests(self.folder)
        outcome = self.study(file, status=2)
        self.assertRegex(outcome.stderr, r"^study.yaml:\d+:\d+: .*case 'outside'.*outside")
        self.assertEqual(digests(self.folder), before)

    def test_mistakes_of_a_needed_case_and_of_those_that_need_it(self):
        online = {"method.type": "gnat", "method.file": "{needs}/reduction.h5"}
        file = self.write(
            ("trained", "train", {"model.kernl": "wendland c2"}),
            ("online", "run", online | {"time.stp": "1 us"}, "trained"),
        )
        lines = self.study(file, status=2).stderr.splitlines()
        self.assertEqual(len(lines), 2, lines)
        self.assertIn("cases.0.set.model.kernl (case 'trained')", lines[0])
        self.assertIn("cases.1.set.time.stp (case 'online')", lines[1])

    def test_a_reduced_case_may_use_a_jacobian_that_full_order_lacks(self):
        shutil.copy(HERE / "cases/vortex-gnat.yaml", self.folder)
        shutil.copy(HERE / "cases/vortex-patches.yaml", self.folder)
        sparse = {"method.type": "lspg", "method.file": "{needs}/reduction.h5", "time.newton.jacobian": "sparse"}
        cases = [
            {"name": "trained", "command": "train"},
            {"name": "reduced", "command": "run", "needs": "trained", "set": sparse},
            {"name": "full", "command": "run", "set": {"method.type": "fom", "time.newton.jacobian": "sparse"}},
        ]
        cases = [case | {"input": "vortex-gnat.yaml"} for case in cases]
        (self.folder / "study.yaml").write_text(json.dumps({"output": "study", "cases": cases[:2]}))
        self.assertIn("2 complete", self.study("study.yaml").stdout)
        (self.folder / "study.yaml").write_text(json.dumps({"output": "study", "cases": cases}, indent=1))
        outcome = self.study("study.yaml", status=2)
        self.assertRegex(
            outcome.stderr,
            r"^study.yaml:\d+:\d+: cases.2.set.time.newton.jacobian \(case 'full'\): .*VortexModel does not offer",
        )

    def test_missing_input_file(self):
        file = self.write(("good", "run", {}))
        (self.folder / "small.yaml").unlink()
        outcome = self.study(file, status=2)
        self.assertRegex(outcome.stderr, r"^study.yaml:\d+:\d+: cases.0.input \(case 'good'\): small.yaml: .*no such file")
        self.assertFalse((self.folder / "study").exists())

    def test_one_mistake_of_a_shared_input_is_told_once(self):
        file = self.write(("a", "run", {}), ("b", "run", {}), ("c", "train", {}))
        path = self.folder / "small.yaml"
        path.write_text(path.read_text().replace("kernel: cubic", "kernl: cubic"))
        outcome = self.study(file, status=2)
        self.assertEqual(outcome.stderr.count("\n"), 1, outcome.stderr)
        self.assertRegex(outcome.stderr, r"^small.yaml:\d+:\d+: model.kernl")

    def test_list_and_only(self):
        self.assertEqual(self.listed(STUDY), ["to do"] * 7)
        self.assertEqual(list(self.folder.iterdir()), [], "nothing is made")
        outcome = self.study(STUDY, "--only", "*gnat*", "--only", "power-10")
        self.assertIn("7 cases: 4 complete (0 of them kept), 0 failed, 0 skipped, 3 not selected", outcome.stdout)
        wanted = {"power-10", "trained", "reduced/gnat-1e-3", "reduced/gnat-1e-6"}
        self.assertEqual({name for name, status in self.statuses().items() if status == "complete"}, wanted)
        wrong = self.study(STUDY, "--only", "gnta", status=2)
        self.assertIn("--only gnta: no case has such a name", wrong.stderr)

    def test_folder_in_use(self):
        file = self.write(("a", "run", {}))
        (self.folder / "study").mkdir()
        with open(self.folder / "study" / "run.lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            outcome = self.study(file, status=2)
        self.assertIn("in use by another run", outcome.stderr)
        self.assertFalse((self.folder / "study/a").exists())

    def test_quiet(self):
        outcome = self.study(self.write(("a", "run", {})), "--quiet", "--set", "output=elsewhere")
        self.assertEqual((outcome.stdout, outcome.stderr), ("", ""))
        self.assertTrue((self.folder / "elsewhere/a/fom/run.h5").exists())
        failing = self.study(self.write(("a", "run", UNSTABLE)), "--quiet", status=1)
        self.assertEqual((failing.stdout, failing.stderr.count("\n")), ("", 1))
        self.assertTrue(failing.stderr.startswith("failed   a  step "), failing.stderr)

    def test_describe_and_template(self):
        description = self.kiln("describe", "study").stdout
        self.assertRegex(description, r"command +choice +run +run \| train")
        template = self.kiln("template", "study").stdout
        for key in ("output:", "- name:", "for:", "input:", "command: run", "set:", "needs:"):
            self.assertIn(key, template)


if __name__ == "__main__":
    main()
