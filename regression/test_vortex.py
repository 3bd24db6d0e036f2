"""The inputs of inputs/vortex, as a user runs them."""

import json
import math

import h5py
import numpy as np
import pandas

from harness import HERE, KilnTest, main

INPUTS = HERE.parent / "inputs" / "vortex"

ERRORS_CASE = """\
title: five vortices
model:
  type: vortex
  particles: {type: file, path: vortices.csv}
  kernel: {type: rosenhead-moore, core_radius: 0.2 m}
time: {end: 2 s, step: 0.05 s, scheme: trapezoidal, newton: {tolerance: 1e-8, jacobian: matrix free}}
method: {type: fom}
reduction:
  type: procedure ii
  basis: {rank: 3}
  residual_basis: {rank: 4}
  sampling: {type: greedy, samples: 4}
output:
  directory: results
  probes: {points: [{name: first, position: [SHIFT m, SHIFT m, 0 m]}]}
"""


class VortexInputsTest(KilnTest):
    def run_input(self, name, *settings, into, ranks=1):
        words = [word for setting in (f"output.directory={into}", *settings) for word in ("--set", setting)]
        outcome = self.kiln("run", INPUTS / f"{name}.yaml", "--quiet", *words, ranks=ranks)
        self.assertEqual((outcome.status, outcome.stdout, outcome.stderr), (0, "", ""))
        return self.folder / into / "fom"

    def test_all_pass_check(self):
        names = sorted(path.stem for path in INPUTS.glob("*.yaml"))
        self.assertEqual(names, ["pair", "projection-tree", "two-patches"])
        for name in names:
            checked = self.kiln("check", INPUTS / f"{name}.yaml")
            self.assertEqual((checked.status, checked.stderr), (0, ""))
            self.assertIn(f"results/vortex/{name}", checked.stdout)

    def test_pair_turns_once(self):
        folder = self.run_input("pair", into="pair", ranks=2)
        probes = pandas.read_csv(folder / "probes.csv")
        strong, weak = (
            np.stack([probes[f"{name} {axis} [m]"] for axis in "xy"], axis=1) for name in ("strong", "weak")
        )
        separation = weak - strong
        np.testing.assert_allclose(np.hypot(*separation.T), 1.0, atol=1e-5)
        # The centre of circulation stays.
        np.testing.assert_allclose(2.0 * strong + weak, [[-0.5, 0.0]] * len(strong), atol=1e-6)
        angles = np.unwrap(np.arctan2(separation[:, 1], separation[:, 0]))
        angular_velocity = 3.0 / (2.0 * math.pi * 1.01)
        np.testing.assert_allclose(angles, angular_velocity * probes["time [s]"], atol=2e-3)
        self.assertGreater(angles[-1], 2.0 * math.pi)

    def test_two_patches_by_either_sum(self):
        small = ("model.particles.count=400", "model.kernel.core_radius=0.2 m", "time.end=2 s")
        direct = self.run_input("two-patches", *small, into="direct", ranks=2)
        tree = self.run_input("two-patches", *small, "model.sum={type: barnes-hut, opening: 0.3}", into="tree")
        with h5py.File(direct / "run.h5") as a, h5py.File(tree / "run.h5") as b:
            self.assertEqual(a["x"].attrs["unit"], "m")
            start, exact, found = ([file[axis][frame] for axis in "xy"] for file, frame in ((a, 0), (a, -1), (b, -1)))
            np.testing.assert_array_equal(np.transpose(start), a["position"][:, :2])
            number = len(a["particle"])
        moved = np.max(np.hypot(*np.subtract(exact, start)))
        error = np.max(np.hypot(*np.subtract(found, exact)))
        self.assertGreater(moved, 0.3)
        self.assertLess(error, 1e-3 * moved)
        self.assertGreater(error, 0.0)
        report = json.loads((direct / "report.json").read_text())
        self.assertEqual(report["method"]["model"]["pairs"], number * (number - 1))

    def test_training_states_errors_that_know_no_origin(self):
        """Of the same vortices far away, whose coordinates are large beside all that they move."""
        stated = []
        for shift in (0.0, 1000.0):
            rows = [(0.0, 0.0, 1.5), (1.0, 0.2, 1.0), (-0.7, 0.9, 0.8), (0.3, -1.1, -0.6), (1.4, 1.2, 0.4)]
            table = "".join(f"{x + shift},{y + shift},{circulation}\n" for x, y, circulation in rows)
            (self.folder / "vortices.csv").write_text("x,y,circulation\n" + table)
            (self.folder / "case.yaml").write_text(ERRORS_CASE.replace("SHIFT", str(shift)))
            trained = self.kiln("train", "case.yaml", "--quiet")
            self.assertEqual((trained.status, trained.stdout), (0, ""), trained.stderr)
            report = json.loads((self.folder / "results" / "training" / "report.json").read_text())
            stated.append(report["training"]["trial"]["worst_query_error"])
        self.assertGreater(stated[0], 1e-4)
        self.assertAlmostEqual(stated[1] / stated[0], 1.0, delta=0.01)


if __name__ == "__main__":
    main()
