"""Components from shared libraries, named in the input or on the command line. KILN_PLUGINS names the folder of those built
from unit_tests/plugin/."""

import hashlib
import json
import os
import re
import shutil
import struct
import unittest
from pathlib import Path

from harness import SMALL, KilnTest, datasets, main

PLUGINS = Path(os.environ.get("KILN_PLUGINS", "."))
EVERY_CATEGORY = PLUGINS / "libevery_category.so"
# Component of the plugin → the built-in one it is the same as.
TWINS = {
    "plugin model": "sph heat",
    "plugin kernel": "cubic spline",
    "plugin material": "316L",
    "plugin particles": "lattice",
    "plugin heat source": "uniform flux",
    "plugin scheme": "backward euler",
    "plugin solver": "gmres",
    "plugin method": "fom",
    "plugin_observer": "extremes",
    "plugin sampling": "greedy",
    "plugin clustering": "per row",
    "plugin trainer": "procedure ii",
}
VORTEX_TWINS = {
    "plugin vortices": "patches",
    "plugin vortex kernel": "rosenhead-moore",
    "plugin vortex sum": "barnes-hut",
}
CASE = """\
title: every category
PLUGINS
model:
  type: plugin model
  particles: {type: plugin particles, origin: [0 m, 0 m, 0 m], size: [1.1 mm, 0.7 mm, 0.5 mm], count: [12, 8, 6]}
  smoothing_length: 1.5
  kernel: plugin kernel
  material: plugin material
  initial_temperature: 293.15 K
  heat_source: {type: plugin heat source, flux: 1e7 W/m^2}
time:
  end: 1 ms
  step: 50 us
  scheme: plugin scheme
  newton: {tolerance: 1e-6, jacobian: sparse, refresh: 5, linear_solver: {type: plugin solver}}
method: {type: plugin method}
reduction:
  type: plugin trainer
  basis: {rank: 3}
  residual_basis: {rank: 4}
  sampling: {type: plugin sampling, samples: 20}
  clustering: {type: plugin clustering, clusters: 8}
output:
  directory: results
  fields: {every: 10}
  plugin_observer: {every: 1}
"""

VORTEX_CASE = """\
title: every category of vortices
PLUGINS
model:
  type: vortex
  particles:
    type: plugin vortices
    patches: [{centre: [0 m, 0 m], radius: 0.5 m, circulation: 1 m^2/s}]
    count: 200
  kernel: {type: plugin vortex kernel, core_radius: 0.2 m}
  sum: {type: plugin vortex sum, opening: 0.7}
time: {end: 1 s, step: 0.1 s, scheme: rk4}
output:
  directory: results
  fields: {every: 5}
"""


def case(plugins="plugins: [libevery_category.so]", text=CASE):
    return text.replace("PLUGINS", plugins)


class PluginsTest(KilnTest):
    def write(self, text, name="case.yaml"):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def works(self, *arguments, **how):
        outcome = self.kiln(*arguments, **how)
        self.assertEqual((outcome.status, outcome.stderr), (0, ""), arguments)
        return outcome.stdout

    def refused(self, *arguments, words, lines=1, ranks=(1,), **how):
        for count in ranks:
            outcome = self.kiln(*arguments, ranks=count, **how)
            with self.subTest(ranks=count, message=outcome.stderr):
                self.assertEqual((outcome.status, outcome.stdout), (2, ""))
                self.assertEqual(outcome.stderr.count("\n"), lines)
                for word in words:
                    self.assertIn(word, outcome.stderr)


class LoadingTest(PluginsTest):
    def test_list_says_where_each_component_comes_from(self):
        plain = self.works("list")
        self.assertNotIn("plugin", plain)
        with_plugin = self.works("list", "--plugin", EVERY_CATEGORY)
        origins = {line.rsplit("  ", 1)[1] for line in plain.splitlines()[1:]}
        self.assertEqual(origins, {"built in"})
        found = {}
        for line in with_plugin.splitlines()[1:]:
            category, name, _, origin = re.split(r" {2,}", line)
            found.setdefault(origin, {})[name] = category
        self.assertEqual(set(found), {"built in", str(EVERY_CATEGORY.resolve())})
        names = found[str(EVERY_CATEGORY.resolve())]
        self.assertEqual(set(names), {name.replace("_", " ") for name in TWINS | VORTEX_TWINS})
        # One of every category there is.
        self.assertEqual(sorted(names.values()), sorted(set(found["built in"].values())))

    def test_describe_and_template(self):
        said = self.works("describe", "plugin heat source", "--plugin", EVERY_CATEGORY)
        self.assertIn(f"from {EVERY_CATEGORY.resolve()}", said)
        self.assertIn("W/m^2", said)
        self.assertIn("flux:", self.works("template", "plugin heat source", "--plugin", EVERY_CATEGORY))
        self.refused("describe", "plugin heat source", words=("no component or category 'plugin heat source'",))

    def test_every_category_gives_the_bits_of_its_built_in_twin(self):
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case())
        text = case("")
        for name, twin in TWINS.items():
            self.assertIn(name, text)
            text = text.replace(name, twin)
        self.write(text.replace("directory: results", "directory: twins"), "twins.yaml")
        for ranks in (1, 2):
            for command in ("run", "train"):
                self.works(command, "case.yaml", "--quiet", ranks=ranks)
                self.works(command, "twins.yaml", "--quiet", ranks=ranks)
            for method in ("gnat", "ptrom"):
                self.works("run", "case.yaml", "--quiet", "--set", f"method.type={method}", ranks=ranks)
                self.works("run", "twins.yaml", "--quiet", "--set", f"method.type={method}", ranks=ranks)
            for mine, theirs in (("plugin method", "fom"), ("gnat", "gnat"), ("ptrom", "ptrom")):
                for file in ("run.h5", "extremes.csv"):
                    compared = self.works(
                        "compare", f"results/{mine}/{file}", f"twins/{theirs}/{file}", "--tolerance", "0"
                    )
                    self.assertTrue(compared)
            mine, theirs = (datasets(self.folder / where / "reduction.h5") for where in ("results", "twins"))
            self.assertEqual(set(mine), set(theirs))
            for name, values in mine.items():
                self.assertEqual(values.tobytes(), theirs[name].tobytes(), name)

    def test_every_category_of_vortices_gives_the_bits_of_its_built_in_twin(self):
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case(text=VORTEX_CASE))
        text = case("", VORTEX_CASE)
        for name, twin in VORTEX_TWINS.items():
            self.assertIn(name, text)
            text = text.replace(name, twin)
        self.write(text.replace("directory: results", "directory: twins"), "twins.yaml")
        for ranks in (1, 2):
            self.works("run", "case.yaml", "--quiet", ranks=ranks)
            self.works("run", "twins.yaml", "--quiet", ranks=ranks)
            self.works("compare", "results/fom/run.h5", "twins/fom/run.h5", "--tolerance", "0")

    def test_the_report_names_the_plugins_with_their_sha256(self):
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case())
        path = self.folder / "libevery_category.so"
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        queries = (
            *("--set", "queries.points={heat_source.flux: [1e7 W/m^2, 2e7 W/m^2]}"),
            *("--set", "output.probes={points: [{name: centre, position: [0 m, 0 m, 0 m]}]}"),
        )
        for command, folder, words in (
            ("run", "plugin method", ()),
            ("train", "training", ()),
            ("run", "plugin method", queries),
        ):
            self.works(command, "case.yaml", "--quiet", *words, ranks=2)
            report = json.loads((self.folder / "results" / folder / "report.json").read_text())
            self.assertEqual(report["plugins"], [{"name": str(path.resolve()), "sha256": digest}])
            self.assertIn("case.yaml", [Path(entry["file"]).name for entry in report["inputs"]])
        self.assertIn(digest, self.works("report", "results/training"))

    def test_a_run_without_plugins_reports_none(self):
        report = json.loads((self.solve("run") / "fom" / "report.json").read_text())
        self.assertNotIn("plugins", report)

    def test_keys_of_plugins_are_checked_as_all_others(self):
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case().replace("flux: 1e7 W/m^2", "flux: 1e7 W, fluks: 1"))
        self.refused("check", "case.yaml", lines=2, words=("case.yaml:10:", "fluks: unknown key", "'1e7 W' is a power"))

    def test_loaded_only_if_named(self):
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case(""))
        environment = {"KILN_PLUGIN_PATH": str(PLUGINS)}
        outcome = self.kiln("check", "case.yaml", environment=environment)
        self.assertEqual(outcome.status, 2)
        self.assertIn("there is no model 'plugin model'", outcome.stderr.replace("no choice", ""))
        self.works("check", "case.yaml", "--plugin", EVERY_CATEGORY)


class SearchTest(PluginsTest):
    def setUp(self):
        super().setUp()
        (self.folder / "inputs").mkdir()

    def checks(self, plugins, path=None, **how):
        self.write(case(plugins), "inputs/case.yaml")
        return self.works("check", "inputs/case.yaml", environment={"KILN_PLUGIN_PATH": path or ""}, **how)

    def test_beside_the_input_that_names_it(self):
        shutil.copy(EVERY_CATEGORY, self.folder / "inputs")
        merged = self.checks("plugins: [libevery_category.so]", ranks=2)
        self.assertIn(f"{(self.folder / 'inputs').resolve()}/libevery_category.so", merged)
        # The input that names it is included from elsewhere.
        self.write("include: inputs/case.yaml\n", "above.yaml")
        self.works("check", "above.yaml")

    def test_by_a_relative_and_an_absolute_path(self):
        (self.folder / "built").mkdir()
        shutil.copy(EVERY_CATEGORY, self.folder / "built")
        self.checks("plugins: [../built/libevery_category.so]")
        self.checks(f"plugins: [{EVERY_CATEGORY}]")

    def test_in_the_folders_of_the_variable(self):
        self.checks("plugins: [libevery_category.so]", path=f"{self.folder}/nowhere:{PLUGINS}")

    def test_twice_is_once(self):
        shutil.copy(EVERY_CATEGORY, self.folder / "inputs")
        (self.folder / "inputs" / "link.so").symlink_to("libevery_category.so")
        self.write(case("plugins: [libevery_category.so, link.so]"), "inputs/case.yaml")
        self.works("check", "inputs/case.yaml", "--plugin", "inputs/libevery_category.so")

    def test_by_an_override_beside_the_input(self):
        shutil.copy(EVERY_CATEGORY, self.folder / "inputs")
        self.write(case(""), "inputs/case.yaml")
        self.works("check", "inputs/case.yaml", "--set", "plugins=[libevery_category.so]")

    def test_not_found(self):
        # Neither the current folder nor an empty entry of the variable, which others take for it, is looked at.
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case(), "inputs/case.yaml")
        here = self.folder.resolve()
        self.refused(
            "check", "inputs/case.yaml", ranks=(1, 2), environment={"KILN_PLUGIN_PATH": f":{here}/nowhere:"},
            words=(
                "inputs/case.yaml:2:11: plugins.0: libevery_category.so: there is no such plugin; expected one of: ",
                f"{here}/inputs/libevery_category.so, {here}/nowhere/libevery_category.so, ",
                "/kiln/plugins/libevery_category.so\n",
            ),
        )
        self.refused("list", "--plugin", "nothing.so", words=("--plugin: nothing.so: there is no such plugin",))

    def test_no_list_of_names(self):
        self.write(case("plugins: libevery_category.so"), "inputs/case.yaml")
        outcome = self.kiln("check", "inputs/case.yaml")
        self.assertEqual(outcome.status, 2)
        self.assertIn("did you mean '[libevery_category.so]'?", outcome.stderr)


class RefusedTest(PluginsTest):
    def refuses(self, library, *words, ranks=(1,)):
        self.refused("list", "--plugin", library, words=(str(library), *words), ranks=ranks)

    def test_built_against_another_kiln(self):
        version = re.search(r"kiln (\S+)", self.works("--version"))[1]
        self.refuses(
            PLUGINS / "libother_kiln.so",
            "was built against Kiln 0.0.9 (headers 0123456789ab, compiler 4.2.1, Trilinos 12.0)",
            f"and this is Kiln {version} (headers ",
            ranks=(1, 2),
        )

    def test_no_plugin_of_kiln(self):
        self.refuses(PLUGINS / "libno_tag.so", "is no plugin of Kiln", "KILN_PLUGIN()")

    def test_no_shared_library(self):
        for name, content in (("text.so", b"plugins are code\n"), ("empty.so", b""), ("script.so", b"#!/bin/sh\n")):
            (self.folder / name).write_bytes(content)
            self.refuses(self.folder / name, "is no shared library")
        (self.folder / "folder.so").mkdir()
        self.refuses(self.folder / "folder.so", "there is no such plugin")

    def test_cut_short(self):
        whole = EVERY_CATEGORY.read_bytes()
        cut = self.folder / "cut.so"
        # What only a debugger reads stands behind all segments that are loaded; nobody misses it.
        table, entry, count = struct.unpack_from("<Q", whole, 32)[0], *struct.unpack_from("<HH", whole, 54)
        headers = [whole[table + i * entry : table + (i + 1) * entry] for i in range(count)]
        loaded = max(sum(struct.unpack_from("<Q", header, at)[0] for at in (8, 32)) for header in headers)
        for size in (4, 63, 64, 500, loaded // 10, loaded // 2, loaded - 1):
            cut.write_bytes(whole[:size])
            self.refuses(cut, "is cut short")

    def test_missing_symbol(self):
        self.refuses(PLUGINS / "libmissing_symbol.so", "cannot be loaded: ", "a_function_nobody_has", ranks=(1, 2))

    def test_throws_while_it_is_loaded(self):
        self.refuses(PLUGINS / "libfailing_initialiser.so", "no licence for this machine", ranks=(1, 2))

    def test_registers_a_name_that_exists(self):
        self.refuses(
            PLUGINS / "libtaken_name.so",
            "kernel 'cubic spline' is registered twice: ",
            "physics/sph/Kernel.cpp:",
            "TakenName.cpp:",
            ranks=(1, 2),
        )

    def test_two_plugins_with_the_same_names(self):
        copy = self.folder / "copy.so"
        shutil.copy(EVERY_CATEGORY, copy)
        self.refused(
            "list", "--plugin", EVERY_CATEGORY, "--plugin", copy,
            words=("kernel 'plugin kernel' is registered twice", f"{EVERY_CATEGORY.resolve()} (", f"{copy.resolve()} ("),
        )

    def test_forbidden(self):
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case())
        for command in ("run", "train", "check"):
            self.refused(command, "case.yaml", "--no-plugins", words=("case.yaml:2:11: plugins.0: ", "--no-plugins forbids"))
        self.refused("run", "case.yaml", "--no-plugins", words=("--no-plugins forbids",), ranks=(2,))
        self.refused("list", "--no-plugins", "--plugin", EVERY_CATEGORY, lines=2, words=("--no-plugins", "--plugin"))
        self.works("check", SMALL, "--no-plugins")
        self.write(f"output: study\ncases: [{{name: a, input: case.yaml}}]\n", "study.yaml")
        self.refused("study", "study.yaml", "--no-plugins", words=("--no-plugins forbids",))
        self.assertFalse((self.folder / "results").exists() or (self.folder / "study").exists())

    def test_a_study_starts_again_when_a_plugin_changed(self):
        shutil.copy(EVERY_CATEGORY, self.folder)
        self.write(case())
        self.write("output: study\ncases: [{name: a, input: case.yaml}]\n", "study.yaml")
        self.works("study", "study.yaml", "--quiet")
        self.assertIn("complete", self.works("study", "study.yaml", "--list"))
        with open(self.folder / "libevery_category.so", "ab") as library:
            library.write(b"\0")
        self.assertNotIn("complete", self.works("study", "study.yaml", "--list"))


if __name__ == "__main__":
    if not EVERY_CATEGORY.is_file():
        raise SystemExit("set KILN_PLUGINS to the folder of the built test plugins")
    main()
