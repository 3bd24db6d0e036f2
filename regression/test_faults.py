"""What goes wrong around a run: it is killed, the disk is full, folders cannot be written or vanish, a rank dies, it is
told to stop. A clear error, no hang, and the last good checkpoint intact, from which a run goes on bit by bit.

KILN_KILLS is how often a run is killed at random (4; ./dev soak: 20). Counts go to KILN_FAULTS_SUMMARY if that is set."""

import contextlib
import errno
import json
import os
import random
import resource
import shutil
import signal
import stat
import subprocess
import time
import unittest

import h5py

from harness import SLOWER, SMALL, KilnTest, command, datasets, main
from hostile.runner import CRASH

KILLS = int(os.environ.get("KILN_KILLS", "4"))
SEED = 20220503

STEPS = 200


def case(steps):
    """Changes of small.yaml: the beam stays on the part for as many steps."""
    return ("model.heat_source.velocity=[0.1 m/s, 0 m/s]", f"time.end={steps / 20} ms", "output.checkpoint.every=4")


# Long enough that a kill comes in the middle.
CASE = case(STEPS)

survived = 0


def overrides(*values):
    return [word for value in values for word in ("--set", value)]


class FaultTest(KilnTest):
    steps = STEPS

    def start(self, *values, into="results", ranks=1, options=(), environment=None, **how):
        words = command("run", SMALL, *overrides(*case(self.steps), *values, f"output.directory={into}"), "--quiet", *options, ranks=ranks)
        return subprocess.Popen(
            words, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
            env={**os.environ, **(environment or {})}, start_new_session=True, **how,
        )  # fmt: skip

    def ended(self, process, seconds=60):
        """Status and message of a process that must end in that time."""
        try:
            out, err = process.communicate(timeout=seconds * SLOWER)
        except subprocess.TimeoutExpired:
            # The ranks of an mpirun that is killed would live on.
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            self.fail(f"still running after {seconds * SLOWER:g} s")
        self.assertEqual(out, "")
        return process.returncode, err

    def saved_step(self, folder):
        try:
            with h5py.File(folder / "checkpoint.h5") as file:
                return int(file.attrs["step"])
        except FileNotFoundError:
            return None

    def wait_for_checkpoint(self, process, folder, step=1):
        deadline = time.monotonic() + 30.0 * SLOWER
        while (self.saved_step(folder) or 0) < step:
            self.assertIsNone(process.poll(), "the run ended too early")
            self.assertLess(time.monotonic(), deadline, "no checkpoint came")
            time.sleep(0.001)

    def refused(self, process, *words, status=2, seconds=60):
        found, message = self.ended(process, seconds)
        self.assertEqual(found, status, message)
        self.assertNotRegex(message, CRASH)
        for word in words:
            self.assertIn(word, message)
        return message

    def undisturbed(self, ranks=1):
        return self.solve("run", *case(self.steps), into="undisturbed", ranks=ranks) / "fom"

    def readable(self, folder):
        """Every file that a run left under its own name can be read."""
        for path in folder.iterdir():
            if path.suffix == ".h5":
                datasets(path)
            elif path.suffix == ".json":
                json.loads(path.read_text())
            elif path.suffix == ".csv":
                self.assertTrue(path.read_text().startswith("step,"), path)

    def same_end(self, undisturbed, folder):
        for name in ("run.h5", "checkpoint.h5"):
            left, right = datasets(undisturbed / name), datasets(folder / name)
            self.assertEqual(sorted(left), sorted(right))
            for dataset, values in left.items():
                self.assertEqual(values.tobytes(), right[dataset].tobytes(), f"{name}: {dataset}")
        for name in ("probes.csv", "extremes.csv", "probes.json"):
            self.assertEqual((undisturbed / name).read_bytes(), (folder / name).read_bytes(), name)

    def goes_on(self, undisturbed, into="results", ranks=1):
        """Continues a run that was ended, or begins anew where it had no checkpoint yet, and compares its end."""
        folder = self.folder / into / "fom"
        options = ("--restart",) if (folder / "checkpoint.h5").exists() else ()
        self.solve("run", *case(self.steps), into=into, ranks=ranks, options=options)
        self.same_end(undisturbed, folder)


class KillTest(FaultTest):
    def survive(self, undisturbed, into, ranks=1):
        global survived
        folder = self.folder / into / "fom"
        if folder.exists():
            self.readable(folder)
        self.goes_on(undisturbed, into, ranks)
        self.assertFalse(list(folder.glob("*.partial")))
        survived += 1
        shutil.rmtree(self.folder / into)

    def survive_killing(self, name, variable, number, undisturbed):
        with self.subTest(**{variable: f"{name}:{number}"}):
            environment = {"LD_PRELOAD": os.environ["KILN_KILLER"], variable: f"{name}:{number}"}
            process = self.start(into="killed", environment=environment)
            self.assertEqual(self.ended(process)[0], -signal.SIGKILL)
            self.assertTrue((self.folder / "killed" / "fom" / f"{name}.partial").exists())
            self.survive(undisturbed, "killed")

    def test_at_random_moments(self):
        undisturbed = self.undisturbed()
        whole = float("inf")
        for _ in range(2):
            begin = time.monotonic()
            self.solve("run", *CASE, into="timed")
            whole = min(whole, time.monotonic() - begin)
        chance = random.Random(SEED)
        killed = 0
        # The machine may be faster by the time of a kill: a run that has ended is none, and another one is taken.
        for k in range(8 * KILLS):
            into = f"killed-{k}"
            with self.subTest(kill=k):
                process = self.start(into=into)
                time.sleep(whole * chance.uniform(0.02, 0.98))
                process.kill()
                was_killed = process.wait() == -signal.SIGKILL
                process.communicate()
                if not was_killed:
                    shutil.rmtree(self.folder / into)
                    continue
                self.survive(undisturbed, into)
                killed += 1
                if killed == KILLS:
                    return
        self.fail(f"{killed} of {KILLS} runs could be killed before they ended")

    def test_while_a_checkpoint_is_written(self):
        undisturbed = self.undisturbed()
        chance = random.Random(SEED)
        in_place = [("KILN_KILL_AT", chance.randrange(1, STEPS // 4)) for _ in range(max(1, KILLS // 4))]
        in_writing = [("KILN_KILL_IN", chance.randrange(1, 300)) for _ in range(max(2, KILLS // 2))]
        for variable, number in in_place + in_writing:
            self.survive_killing("checkpoint.h5", variable, number, undisturbed)

    def test_while_the_run_file_is_made(self):
        undisturbed = self.undisturbed()
        self.survive_killing("run.h5", "KILN_KILL_AT", 1, undisturbed)
        for number in range(1, 1 + max(3, KILLS // 2)):
            self.survive_killing("run.h5", "KILN_KILL_IN", number, undisturbed)

    def test_again_and_again(self):
        # One run that is killed at each of its starts comes to the same end.
        undisturbed = self.undisturbed()
        step = 0
        while step < STEPS // 2:
            process = self.start(options=("--restart",) if step else ())
            self.wait_for_checkpoint(process, self.folder / "results" / "fom", step + 20)
            process.kill()
            process.communicate()
            step = self.saved_step(self.folder / "results" / "fom")
        self.survive(undisturbed, "results")


class RankTest(FaultTest):
    def children(self, parent):
        with open(f"/proc/{parent}/task/{parent}/children", encoding="ascii") as file:
            return [int(child) for child in file.read().split()]

    def alive(self, process):
        try:
            with open(f"/proc/{process}/stat", encoding="ascii") as file:
                return file.read().rsplit(")", maxsplit=1)[1].split()[0] != "Z"
        except FileNotFoundError:
            return False

    def await_the_end_of(self, processes):
        """A rank of a slower build may take a moment longer to end than mpirun, which has killed it."""
        deadline = time.monotonic() + 5.0 * (SLOWER - 1.0)
        while left := [process for process in processes if self.alive(process)]:
            self.assertLess(time.monotonic(), deadline, f"still alive: {left}")
            time.sleep(0.01)

    def test_a_killed_rank_ends_all(self):
        undisturbed = self.undisturbed(ranks=2)
        for victim in range(2):
            with self.subTest(rank=victim):
                process = self.start(ranks=2, into=f"rank-{victim}")
                self.wait_for_checkpoint(process, self.folder / f"rank-{victim}" / "fom", 8)
                ranks = self.children(process.pid)
                self.assertEqual(len(ranks), 2)
                os.kill(ranks[victim], signal.SIGKILL)
                status, _ = self.ended(process, 20)
                self.assertNotEqual(status, 0)
                self.await_the_end_of(ranks)
                self.readable(self.folder / f"rank-{victim}" / "fom")
                self.goes_on(undisturbed, f"rank-{victim}", ranks=2)


class StopTest(FaultTest):
    def stop(self, number, ranks=1, into="results"):
        """The signal comes with the second checkpoint, however fast the run is; of several ranks, to the first alone."""
        environment = {
            "LD_PRELOAD": os.environ["KILN_KILLER"], "KILN_STOP_AT": "checkpoint.h5:2", "KILN_STOP_SIGNAL": str(int(number))
        }  # fmt: skip
        status, message = self.ended(self.start(ranks=ranks, into=into, environment=environment), 20)
        message = "".join(line + "\n" for line in message.splitlines() if " came: stopped" in line)
        self.assertEqual(status, 4, message)
        self.assertRegex(message, rf"^{signal.Signals(number).name} came: stopped after step \d+ of {self.steps}, t = \S+ s; ")
        return int(message.split("after step ")[1].split()[0]), message

    def test_leaves_a_checkpoint_of_its_last_step(self):
        undisturbed = self.undisturbed()
        for number in (signal.SIGTERM, signal.SIGINT):
            into = f"stopped-{number}"
            step, message = self.stop(number, into=into)
            folder = self.folder / into / "fom"
            self.assertEqual(self.saved_step(folder), step)
            self.assertIn("checkpoint.h5 holds that step: go on with kiln run --restart", message)
            self.assertIn(message.strip(), json.loads((folder / "report.json").read_text())["run"]["status"])
            self.assertFalse((folder / "run.lock").exists())
            self.readable(folder)
            self.goes_on(undisturbed, into)

    def test_on_two_ranks(self):
        # They ask each other four times a second.
        self.steps = 16 * STEPS
        undisturbed = self.undisturbed(ranks=2)
        step, _ = self.stop(signal.SIGTERM, ranks=2)
        self.assertEqual(self.saved_step(self.folder / "results" / "fom"), step)
        self.goes_on(undisturbed, ranks=2)

    def test_without_checkpoints(self):
        text = SMALL.read_text().replace("  checkpoint: {every: 5}\n", "")
        (self.folder / "bare.yaml").write_text(text)
        # Nothing tells how far it is: it must take much longer than the signal.
        words = command("run", "bare.yaml", *overrides(*case(40 * STEPS)[:2]), "--quiet")
        process = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", start_new_session=True)
        probes = self.folder / "results" / "fom" / "probes.csv"
        while not probes.exists():
            time.sleep(0.001)
        time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        self.refused(process, "SIGTERM came", "no block output.checkpoint", status=4)

    def stopped_once_locked(self, lock, *words):
        process = subprocess.Popen(
            command(*words, "--quiet"), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", start_new_session=True,
        )  # fmt: skip
        while not lock.exists():
            self.assertIsNone(process.poll(), "it ended too early")
            time.sleep(0.001)
        process.send_signal(signal.SIGTERM)
        self.refused(process, "SIGTERM came", status=4)

    def test_training_leaves_nothing(self):
        self.stopped_once_locked(self.folder / "results" / "training" / "run.lock", "train", SMALL, *overrides(*CASE))
        self.assertFalse((self.folder / "results").exists())

    def test_a_run_that_has_not_begun(self):
        self.stopped_once_locked(self.folder / "results" / "fom" / "run.lock", "run", SMALL, *overrides(*CASE))
        self.assertEqual(self.saved_step(self.folder / "results" / "fom"), 1)

    def test_queries_leave_nothing(self):
        powers = ", ".join(f"{40 + k} W" for k in range(200))
        (self.folder / "queries.yaml").write_text(
            f"include: {SMALL}\nqueries:\n  points:\n    heat_source.power: [{powers}]\n  together: 8\n"
        )
        self.solve("train", *CASE)
        for method in ("fom", "gnat"):
            folder = self.folder / "results" / method
            with self.subTest(method=method):
                self.stopped_once_locked(
                    folder / "run.lock", "run", "queries.yaml", *overrides(*CASE, f"method.type={method}")
                )
                self.assertFalse(folder.exists())

    def test_a_study_goes_on_later(self):
        (self.folder / "study.yaml").write_text(
            f"output: study\ncases:\n- {{name: a, input: {SMALL}, set: {{time.end: 10 ms, output.checkpoint.every: '4', "
            "model.heat_source.velocity: ['0.1 m/s', '0 m/s']}}\n- {name: b, input: " + str(SMALL) + "}\n"
        )
        process = subprocess.Popen(
            command("study", "study.yaml", "--quiet"), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", start_new_session=True,
        )
        folder = self.folder / "study" / "a" / "fom"
        self.wait_for_checkpoint(process, folder, 8)
        process.send_signal(signal.SIGTERM)
        self.refused(process, "SIGTERM came", "checkpoint.h5 holds that step", status=4)
        self.assertFalse((self.folder / "study" / "b").exists())
        self.assertIn("interrupted", self.kiln("study", "study.yaml", "--list").stdout)
        step = self.saved_step(folder)
        again = self.kiln("study", "study.yaml", "--quiet")
        self.assertEqual((again.status, again.stderr), (0, ""))
        self.assertEqual(json.loads((folder / "report.json").read_text())["run"]["first_step"], step)


@contextlib.contextmanager
def small_disk(folder, size):
    """A file system of that many bytes; raises SkipTest where none can be mounted."""
    done = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise unittest.SkipTest(f"no file system can be mounted here: {done.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


class DiskTest(FaultTest):
    def fill(self, path):
        """Takes all room that is left."""
        with contextlib.suppress(OSError), open(path, "wb", buffering=0) as file:
            while True:
                file.write(bytes(4096))

    def test_too_small_from_the_start(self):
        disk = self.folder / "disk"
        disk.mkdir()
        for ranks in (1, 2):
            with small_disk(disk, 65536), self.subTest(ranks=ranks):
                process = self.start(into="disk", ranks=ranks)
                message = self.refused(process, "disk/fom", seconds=30)
                self.assertRegex(message, "No space left|cannot be")

    def test_full_while_it_runs(self):
        disk = self.folder / "disk"
        disk.mkdir()
        undisturbed = self.undisturbed()
        with small_disk(disk, 2 << 20):
            process = self.start(into="disk")
            self.wait_for_checkpoint(process, disk / "fom", 8)
            self.fill(disk / "filled")
            self.refused(process, "disk/fom", seconds=30)
            self.assertGreaterEqual(self.saved_step(disk / "fom"), 8)
            self.readable(disk / "fom")
            (disk / "filled").unlink()
            self.goes_on(undisturbed, "disk")

    def test_a_limit_on_the_size_of_files(self):
        # run.h5 takes its room at the start; 100 kB are not enough for it. MPI's own exchange must not need a large file.
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

        process = self.start(preexec_fn=limit, environment={"PMIX_MCA_gds": "hash"})
        self.refused(process, "results/fom/run.h5", os.strerror(errno.EFBIG), seconds=30)
        self.assertEqual(list((self.folder / "results" / "fom").glob("run.h5*")), [])

    def test_a_limit_that_comes_while_it_runs(self):
        undisturbed = self.undisturbed()
        process = self.start()
        self.wait_for_checkpoint(process, self.folder / "results" / "fom", 8)
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (2000, 2000))
        self.refused(process, "results/fom/", seconds=30)
        self.assertGreaterEqual(self.saved_step(self.folder / "results" / "fom"), 8)
        self.goes_on(undisturbed)


class FolderTest(FaultTest):
    def as_nobody(self):
        """What keeps root from being root: permissions do not hold it back."""
        if os.geteuid() != 0:
            return {}
        program = os.environ["KILN"]
        done = subprocess.run([program, "--version"], user=65534, group=65534, capture_output=True, check=False, cwd="/")
        if done.returncode != 0:
            self.skipTest(f"the user nobody cannot run {program}")
        os.chmod(self.folder, 0o755)
        return {"user": 65534, "group": 65534, "environment": {"HOME": "/nonexistent", "TMPDIR": "/tmp", "PMIX_MCA_gds": "hash"}}

    def test_read_only(self):
        nobody = self.as_nobody()
        folder = self.folder / "closed"
        folder.mkdir()
        folder.chmod(stat.S_IRUSR | stat.S_IXUSR | stat.S_IROTH | stat.S_IXOTH)
        self.refused(self.start(into="closed", **nobody), "closed/fom", os.strerror(errno.EACCES))
        self.assertEqual(list(folder.iterdir()), [])

    def test_read_only_while_it_runs(self):
        nobody = self.as_nobody()
        open_folder = self.folder / "open"
        open_folder.mkdir()
        open_folder.chmod(0o777)
        process = self.start(into="open", **nobody)
        folder = open_folder / "fom"
        self.wait_for_checkpoint(process, folder, 8)
        folder.chmod(0o555)
        self.refused(process, "open/fom", os.strerror(errno.EACCES))
        folder.chmod(0o755)
        self.assertGreaterEqual(self.saved_step(folder), 8)
        self.readable(folder)

    def test_vanished(self):
        process = self.start()
        folder = self.folder / "results"
        self.wait_for_checkpoint(process, folder / "fom", 8)
        folder.rename(self.folder / "elsewhere")
        self.refused(process, "results/fom", os.strerror(errno.ENOENT))
        # What was there went with it, whole.
        self.assertGreaterEqual(self.saved_step(self.folder / "elsewhere" / "fom"), 8)
        self.readable(self.folder / "elsewhere" / "fom")

    def test_removed(self):
        process = self.start()
        self.wait_for_checkpoint(process, self.folder / "results" / "fom", 8)
        shutil.rmtree(self.folder / "results", ignore_errors=True)
        shutil.rmtree(self.folder / "results", ignore_errors=True)
        self.refused(process, "results/fom")

    def test_the_second_run_is_refused(self):
        first = self.start("time.end=500 ms")
        self.wait_for_checkpoint(first, self.folder / "results" / "fom", 8)
        for ranks in (1, 2):
            second = self.start(ranks=ranks)
            self.refused(second, "results/fom", "in use by another run", f"process {first.pid} on ", seconds=30)
        first.kill()
        first.communicate()
        self.readable(self.folder / "results" / "fom")

    def test_a_killed_runs_lock_holds_nobody_back(self):
        process = self.start()
        self.wait_for_checkpoint(process, self.folder / "results" / "fom", 8)
        process.kill()
        process.communicate()
        self.assertTrue((self.folder / "results" / "fom" / "run.lock").exists())
        self.goes_on(self.undisturbed())


def tearDownModule():
    if "KILN_FAULTS_SUMMARY" in os.environ:
        with open(os.environ["KILN_FAULTS_SUMMARY"], "w", encoding="utf-8") as file:
            json.dump({"kills_survived": survived}, file)


if __name__ == "__main__":
    main()
