"""A run that diverges says where and when, with status 3, and keeps its last good checkpoint."""

import json

import h5py
import numpy as np

from harness import SMALL, KilnTest, main

# An explicit step of 1 s is about a thousand times what is stable at this spacing: errors grow a thousandfold a step,
# until they overflow after about a hundred.
UNSTABLE = ("time.scheme=explicit euler", "time.step=1 s", "time.end=150 s")
PLACE = r"^step (\d+), t = (\S+) s, particle (\d+) at \((\S+), (\S+), (\S+)\) m: .*not finite.*\n\Z"


class DivergenceTest(KilnTest):
    def diverge(self, *overrides, ranks=1):
        words = [word for override in overrides for word in ("--set", override)]
        outcome = self.kiln("run", SMALL, "--quiet", *words, ranks=ranks)
        self.assertEqual((outcome.status, outcome.stdout), (3, ""), outcome.stderr)
        self.assertRegex(outcome.stderr, PLACE)
        return outcome.stderr

    def test_unstable_step(self):
        messages = []
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                message = self.diverge(*UNSTABLE, f"output.directory=ranks-{ranks}", ranks=ranks)
                messages.append(message)
                step, time = int(message.split()[1].rstrip(",")), float(message.split()[4])
                self.assertEqual(time, step * 1.0)
                self.assertGreater(step, 50)
                folder = self.folder / f"ranks-{ranks}" / "fom"
                report = json.loads((folder / "report.json").read_text())
                self.assertEqual(report["run"]["status"], "diverged: " + message.rstrip("\n"))
                self.assertEqual(report["solve"]["steps"], step - 1)
                self.assertEqual(report["solve"]["residuals"], step - 1)
                self.assertGreater(report["time"]["steps_wall_s"], 0.0)
                with h5py.File(folder / "checkpoint.h5") as checkpoint:
                    self.assertEqual(checkpoint.attrs["step"], (step - 1) // 5 * 5)
                    self.assertEqual(checkpoint["unknown"].shape[0], 1728)
                    self.assertTrue(np.isfinite(checkpoint["unknown"]).all())
                with h5py.File(folder / "run.h5") as run:
                    written = np.asarray(run["step"]) >= 0
                    self.assertTrue(np.isfinite(run["temperature"][written]).all())
                    self.assertTrue((run["step"][written] < step).all())
                    listed = (folder / "run.xdmf").read_text()
                    for frame in np.flatnonzero(written):
                        self.assertIn(f"/frame/temperature/{frame}<", listed)
                report_command = self.kiln("report", folder)
                self.assertEqual(report_command.status, 0)
                self.assertIn("diverged: step", report_command.stdout)
        self.assertEqual(*(message.split(",")[0] for message in messages), "the same step on any number of ranks")

    def test_particle_and_position_belong_together(self):
        self.solve("run", into="healthy")
        message = self.diverge("model.heat_source.power=1e300 W")
        particle = int(message.split("particle ")[1].split()[0])
        position = [float(x) for x in message.split("(")[1].split(")")[0].split(",")]
        with h5py.File(self.folder / "healthy" / "fom" / "run.h5") as run:
            np.testing.assert_allclose(run["position"][particle], position, rtol=1e-5, atol=1e-12)
        # Where the beam is at the first step: 25 µm beyond its start.
        np.testing.assert_allclose(position[:2], [0.425e-3, -0.03e-3], atol=0.1e-3)

    def test_divergence_at_the_first_step_keeps_the_earlier_checkpoint(self):
        checkpoint = self.solve("run") / "fom" / "checkpoint.h5"
        before = checkpoint.read_bytes()
        message = self.diverge("model.heat_source.power=1e300 W", ranks=2)
        self.assertTrue(message.startswith("step 1, t = 5e-05 s,"), message)
        self.assertEqual(checkpoint.read_bytes(), before)

    def test_the_checkpoint_goes_on_to_the_same_end(self):
        message = self.diverge(*UNSTABLE)
        words = [word for override in UNSTABLE for word in ("--set", override)]
        again = self.kiln("run", SMALL, "--quiet", "--restart", *words)
        self.assertEqual((again.status, again.stderr), (3, message))

    def test_reduced_run(self):
        self.solve("train")
        words = ("--set", "method.type=gnat", "--set", "model.heat_source.power=1e300 W")
        outcome = self.kiln("run", SMALL, "--quiet", *words)
        self.assertEqual((outcome.status, outcome.stdout), (3, ""), outcome.stderr)
        self.assertRegex(outcome.stderr, r"^warning: .*heat_source.power is 1e\+300 W.*\nstep 1, t = 5e-05 s\b.*not finite.*\n\Z")

    def test_training(self):
        outcome = self.kiln("train", SMALL, "--quiet", "--set", "model.heat_source.power=1e300 W")
        self.assertEqual((outcome.status, outcome.stdout), (3, ""), outcome.stderr)
        self.assertRegex(outcome.stderr, PLACE)
        self.assertFalse((self.folder / "results" / "reduction.h5").exists())


if __name__ == "__main__":
    main()
