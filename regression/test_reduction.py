"""From the full-order run to the reduced ones by one line of the input, and what a reduction file may be used for."""

import json
import shutil
import subprocess

import h5py
import numpy as np
import pandas

from harness import HERE, SMALL, KilnTest, command, datasets, main

# Largest error of a probe's temperature against the full-order run, relative to the largest rise of any probe. The
# basis of 12 vectors was learnt from the same run, so its truncation (last singular value kept / largest: 2e-5) and
# Newton's tolerance (1e-6) bound what is left.
PROBE_BOUND = 5e-5
# Another power than the training's: outside the span of the snapshots, as materials depend on temperature.
OTHER_POWER_BOUND = 5e-3


class ReductionTest(KilnTest):
    def prepare(self):
        self.solve("run")
        self.solve("train")

    def probes(self, method, into="results"):
        return pandas.read_csv(self.folder / into / method / "probes.csv").filter(like="temperature").to_numpy()

    def test_methods_follow_the_full_order_run(self):
        full = self.probes("fom")
        self.assertGreater(full.max() - full.min(), 100.0, "the case heats its probes")
        for method in ("galerkin", "lspg", "gnat"):
            with self.subTest(method):
                self.solve("run", f"method.type={method}")
                reduced = self.probes(method)
                self.assertEqual(reduced.shape, full.shape)
                rise = np.abs(full - full[0]).max()
                self.assertLess(np.abs(reduced - full).max() / rise, PROBE_BOUND)
                self.assertGreater(np.abs(reduced - full).max(), 0.0, "another method was run than the full-order one")

    def test_reports(self):
        for method in ("galerkin", "lspg", "gnat"):
            self.solve("run", f"method.type={method}")
            with self.subTest(method):
                report = json.loads((self.folder / "results" / method / "report.json").read_text())
                self.assertEqual(report["run"]["method"], method)
                self.assertEqual(report["run"]["status"], "complete")
                self.assertEqual(report["run"]["steps"], 40)
                for key in ("residuals", "residuals_per_step", "iterations", "capped_steps"):
                    self.assertIn(key, report["solve"])
                for key in ("loop_wall_s", "loop_cpu_s", "total_wall_s", "setup_wall_s", "peak_memory_bytes"):
                    self.assertGreater(report["time"][key], 0.0)
                self.assertEqual(report["method"]["basis_rank"], 12)
        self.assertEqual(report["method"]["residual_rank"], 24)
        self.assertEqual(report["method"]["sampled"], 60)
        self.assertLess(report["method"]["sources"], report["method"]["full_order_particles"])
        training = json.loads((self.folder / "results" / "training" / "report.json").read_text())["training"]
        self.assertEqual([stage["name"] for stage in training["stages"]][0], "full-order run")
        self.assertGreater(training["sample_meshes"][0]["sigma_min"], 0.0)

    def test_data_files_count_by_content_and_not_by_place(self):
        there, elsewhere = self.folder / "there", self.folder / "elsewhere"
        shutil.copytree(HERE / "cases", there)

        def kiln(command, folder, method="gnat"):
            changes = (f"method.type={method}", "output.directory=moved")
            return self.kiln(command, folder / "gnat-cloud.yaml", *(w for c in changes for w in ("--set", c)), "--quiet")

        self.assertEqual(kiln("train", there).status, 0)
        there.rename(elsewhere)
        outcome = kiln("run", elsewhere)
        self.assertEqual(outcome.status, 0, outcome.stderr)
        lines = (elsewhere / "cloud.csv").read_text().splitlines()
        (elsewhere / "cloud.csv").write_text("\n".join([*lines[:-2], lines[-1], lines[-2]]) + "\n")
        for method in ("gnat", "lspg"):
            outcome = kiln("run", elsewhere, method)
            self.assertEqual(outcome.status, 2, outcome.stderr)
            self.assertIn("reduction.h5: was learnt from another file than model.particles.path: ", outcome.stderr)
            self.assertIn("elsewhere/cloud.csv; expected the data it was trained with; or train again", outcome.stderr)

    def test_reports_tell_which_reduction_was_read(self):
        shutil.copy(self.folder / "results" / "reduction.h5", self.folder / "copy.h5")
        reports = []
        for method in ("gnat", "lspg"):
            for into, words in (("results", ()), ("named", (f"method.file={self.folder / 'copy.h5'}",))):
                folder = self.solve("run", f"method.type={method}", *words, into=into, ranks=2) / method
                reports.append(json.loads((folder / "report.json").read_text()))
        seals = {report["method"]["reduction_seal"] for report in reports}
        self.assertEqual(len(seals), 1)
        for report in reports[1::2]:
            named = [entry for entry in report["inputs"] if entry["kind"] == "data"]
            self.assertEqual(named, [{"file": str(self.folder / "copy.h5"), "kind": "data", "seal": seals.pop()}])
            seals.add(named[0]["seal"])

    def test_gnat_is_the_same_on_any_number_of_ranks(self):
        self.solve("run", "method.type=gnat")
        alone = datasets(self.folder / "results" / "gnat" / "run.h5")
        reduction = (self.folder / "results" / "reduction.h5").read_bytes()
        for ranks in (2, 3):
            with self.subTest(ranks=ranks):
                into = f"ranks-{ranks}"
                (self.folder / into).mkdir()
                (self.folder / into / "reduction.h5").write_bytes(reduction)
                self.solve("run", "method.type=gnat", into=into, ranks=ranks)
                for name in ("run.h5", "probes.csv", "extremes.csv"):
                    # A reduced coordinate that passes through 0 counts as 1 K: the state is a sum of all of them.
                    compared = self.kiln("compare", f"results/gnat/{name}", f"{into}/gnat/{name}", "--floor", "1")
                    self.assertEqual(compared.status, 0, compared.stdout)
                other = datasets(self.folder / into / "gnat" / "run.h5")
                np.testing.assert_array_equal(other["particle"], alone["particle"])
                np.testing.assert_allclose(other["temperature"], alone["temperature"], rtol=1e-10, atol=0.0)

    def test_another_power_is_accepted(self):
        power = "model.heat_source.power=22 W"
        trained = self.probes("fom")
        self.solve("run", power)
        outside = "the training stated are not of these parameters: heat_source.power is 22 W, and 20 W in the training"
        self.solve("run", power, "method.type=gnat", warnings=[outside])
        report = json.loads((self.folder / "results/gnat/report.json").read_text())
        self.assertEqual(len(report["run"]["warnings"]), 1)
        self.assertIn(outside, report["run"]["warnings"][0])
        full, reduced = self.probes("fom"), self.probes("gnat")
        rise = np.abs(full - full[0]).max()
        self.assertLess(np.abs(reduced - full).max() / rise, OTHER_POWER_BOUND)
        self.assertGreater(np.abs(trained - full).max() / rise, 2.0 * OTHER_POWER_BOUND, "the bound tells powers apart")

    def test_a_data_file_that_changes_during_the_training(self):
        shutil.copytree(HERE / "cases", self.folder / "changing")
        cloud = self.folder / "changing/cloud.csv"
        words = command("train", self.folder / "changing/gnat-cloud.yaml", "--set", "output.directory=changing/results")
        with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as training:
            text = ""
            for line in training.stderr:
                text += line
                if "training, stage 2: " in line:
                    lines = cloud.read_text().splitlines()
                    cloud.write_text("\n".join([*lines[:-2], lines[-1], lines[-2]]) + "\n")
        self.assertEqual(training.returncode, 2, text)
        self.assertIn("was learnt from another file than model.particles.path: ", text)
        self.assertEqual(list((self.folder / "changing").rglob("reduction.h5")), [])

    def test_a_report_states_the_errors_of_the_training(self):
        training = json.loads((self.folder / "results/training/report.json").read_text())["training"]
        self.solve("run", "method.type=gnat")
        report = json.loads((self.folder / "results/gnat/report.json").read_text())
        self.assertEqual(report["method"]["trial"], training["trial"])
        self.assertGreater(training["trial"]["worst_query_error"], 0.0)
        self.assertNotIn("warnings", report["run"])
        held = report["observers"]["extremes"]["particles"]
        self.assertEqual((held, report["observers"]["extremes"]["every"]), (report["method"]["held"], 1))
        self.assertLess(held, report["method"]["full_order_particles"])

    def test_a_full_order_and_a_reduced_run_are_compared_on_the_particles_of_both(self):
        self.solve("run", "method.type=gnat")
        files = ("compare", self.solve("run", into="full") / "fom/run.h5", self.folder / "results/gnat/run.h5")
        outcome = self.kiln(*files, "--tolerance", 1e-4)
        self.assertEqual(outcome.status, 1)
        self.assertIn("FAULT /temperature has shape ", outcome.stdout)
        outcome = self.kiln(*files, "--tolerance", 1e-4, "--common")
        self.assertEqual(outcome.status, 0, outcome.stdout)
        self.assertRegex(outcome.stdout, r"ALONE 1728 and \d+ particles, \d+ of them common\n")
        self.assertEqual(self.kiln(*files, "--tolerance", 1e-9, "--common").status, 1)

    def test_points_that_were_tried_are_inside(self):
        points = "reduction.try_on={points: {heat_source.power: [24 W]}}"
        self.solve("train", points, into="tried")
        power = "model.heat_source.power={} W".format
        self.solve("run", points, power(22), "method.type=gnat", into="tried")
        self.solve("run", points, power(24), "method.type=lspg", into="tried")
        self.solve("run", points, power(24.1), "method.type=lspg", into="tried",
                   warnings=["heat_source.power is 24.1 W, and 20 to 24 W in the training"])
        queries = "queries={points: {heat_source.power: [19 W, 21 W, 25 W]}}"
        self.solve("run", points, queries, "method.type=gnat", into="tried",
                   warnings=["point 0: the errors that the training stated are not of these parameters"])
        report = json.loads((self.folder / "tried/gnat/report.json").read_text())
        self.assertTrue(report["run"]["warnings"][0].endswith("; and 1 more point"), report["run"]["warnings"])
        self.assertIn("reduction_seal", report["method"])

    def test_a_probe_is_never_moved_to_another_particle(self):
        with h5py.File(self.solve("run", "method.type=gnat") / "gnat/run.h5") as file:
            held, positions = set(file["particle"][:].tolist()), file["position"][:]
        with h5py.File(self.solve("run", into="full") / "fom/run.h5") as file:
            everywhere, temperatures = file["position"][:], file["temperature"][:]
        other = next(p for p in range(len(everywhere)) if p not in held and any(
            np.linalg.norm(everywhere[p] - position) < 1.01e-4 for position in positions))
        probe = "output.probes={{points: [{{name: other, position: [{:.6g}, {:.6g}, {:.6g}]}}]}}".format
        outcome = self.kiln("run", SMALL, "--set", "method.type=gnat", "--set", probe(*everywhere[other]), "--quiet")
        self.assertEqual(outcome.status, 2, outcome.stderr)
        self.assertIn("probe 'other' at ", outcome.stderr)
        self.assertIn("this method does not hold the particle nearest to it; expected ", outcome.stderr)
        # Half way to one that is held, both are nearest.
        beside = min(positions, key=lambda position: np.linalg.norm(position - everywhere[other]))
        outcome = self.kiln("run", SMALL, "--set", "method.type=gnat", "--set", probe(*(beside + everywhere[other]) / 2), "--quiet")
        self.assertEqual(outcome.status, 2, outcome.stderr)
        # On a particle that is held, or less than half a spacing away from one.
        place = positions[len(positions) // 2] + [0, 0, 0.4e-4 if positions[len(positions) // 2][2] < 4e-4 else -0.4e-4]
        self.solve("run", "method.type=gnat", probe(*place))
        places = json.loads((self.folder / "results/gnat/probes.json").read_text())
        nearest = int(np.argmin(np.linalg.norm(everywhere - place, axis=1)))
        self.assertEqual(places[0]["particle"], nearest)
        # A question of the training may lie anywhere.
        asked = "reduction.queries=[{position: [1.05 mm, 0.05 mm, 0.25 mm]}]"
        self.solve("train", asked, into="asked")
        self.solve("run", asked, "method.type=gnat", probe(1.05e-3, 0.05e-3, 0.25e-3), into="asked")
        place = json.loads((self.folder / "asked/gnat/probes.json").read_text())[0]
        distances = np.linalg.norm(everywhere - [1.05e-3, 0.05e-3, 0.25e-3], axis=1)
        self.assertAlmostEqual(distances[place["particle"]], distances.min(), delta=1e-12)
        told = pandas.read_csv(self.folder / "asked/gnat/probes.csv").filter(like="temperature").to_numpy()[-1, 0]
        self.assertLess(abs(told - temperatures[-1, place["particle"]]), 0.1)

    def test_nothing_is_known_of_later(self):
        for method in ("galerkin", "lspg", "gnat"):
            with self.subTest(method):
                self.solve("run", f"method.type={method}", "time.end=1 ms")
                refused = self.kiln("run", SMALL, "--set", f"method.type={method}", "--set", "time.end=2.05 ms")
                self.assertEqual((refused.status, refused.stdout), (2, ""))
                for word in ("results/reduction.h5", "trained to 0.002 s", "goes on to 0.00205 s"):
                    self.assertIn(word, refused.stderr)

    def test_another_model_is_refused_by_name(self):
        for override, words in (
            ("model.kernel=wendland c2", ("model.kernel", "cubic spline", "wendland c2")),
            ("model.smoothing_length=1.4", ("model.smoothing_length", "1.5", "1.4")),
            ("time.step=25 us", ("time.step", "5e-05", "2.5e-05")),
        ):
            with self.subTest(override):
                refused = self.kiln("run", SMALL, "--set", "method.type=gnat", "--set", override, ranks=2)
                self.assertEqual(refused.status, 2)
                self.assertEqual(refused.stdout, "")
                self.assertEqual(refused.stderr.count("results/reduction.h5"), 1, refused.stderr)
                for word in words:
                    self.assertIn(word, refused.stderr)
                self.assertFalse((self.folder / "results" / "gnat" / "run.h5").exists())


if __name__ == "__main__":
    main()
