"""Pages and JSON Schema say what the specifications say, and the schema takes every shipped input and refuses mistakes."""

import copy
import difflib
import json
import re

import jsonschema
import yaml

from harness import HERE, KilnTest, main

ROOT = HERE.parent
DOCS = ROOT / "docs"
# Meant to be included, and no inputs by themselves.
FRAGMENTS = ("part", "kiln", "published-1", "published-2")


def loaded(text):
    """YAML as an editor's language server reads it: YAML 1.2, in which 1e-3 is a number and `on` a text."""
    return yaml.load(text, Loader=Yaml12)


class Yaml12(yaml.SafeLoader):
    yaml_implicit_resolvers = {
        first: [(tag, rule) for tag, rule in rules if tag not in ("tag:yaml.org,2002:float", "tag:yaml.org,2002:timestamp")]
        for first, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }


Yaml12.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?\Z"), list("-+0123456789.")
)


class SchemaTest(KilnTest):
    def setUp(self):
        super().setUp()
        self.schema = self.printed("schema")

    def printed(self, *words):
        outcome = self.kiln(*words)
        self.assertEqual((outcome.status, outcome.stderr), (0, ""))
        return json.loads(outcome.stdout)

    def problems(self, document, schema=None):
        validator = jsonschema.Draft7Validator(schema or self.schema)
        return [f"{'.'.join(map(str, error.absolute_path))}: {error.message[:300]}" for error in validator.iter_errors(document)]

    def inputs(self):
        folders = (ROOT / "inputs" / "nrl-2022", HERE / "cases")
        return [path for folder in folders for path in sorted(folder.glob("*.yaml")) if not path.name.startswith("study")]

    def test_the_pages_are_up_to_date(self):
        self.kiln("reference", "reference")
        fresh = {path.name: path.read_text() for path in (self.folder / "reference").iterdir()}
        kept = {path.name: path.read_text() for path in (DOCS / "reference").glob("*")}
        fresh["kiln.schema.json"] = self.kiln("schema").stdout
        kept["kiln.schema.json"] = (DOCS / "kiln.schema.json").read_text()
        for name in sorted({*fresh, *kept}):
            lines = difflib.unified_diff(kept.get(name, "").splitlines(), fresh.get(name, "").splitlines(), "docs", "sources", lineterm="")
            self.assertEqual(fresh.get(name), kept.get(name), f"run ./dev reference: {name}\n" + "\n".join(list(lines)[:20]))

    def test_every_component_has_its_place_on_a_page(self):
        listed = [line.split("  ")[0] for line in self.kiln("list").stdout.splitlines()[1:]]
        for category in set(listed):
            page = (DOCS / "reference" / f"{category.replace(' ', '_')}.md").read_text()
            names = re.findall(r"^## (.+)$", page, re.MULTILINE)
            self.assertEqual(len(names), listed.count(category), category)
            index = (DOCS / "reference" / "index.md").read_text()
            for name in names:
                self.assertIn(f"`{name}`", index)

    def test_the_schema_is_one(self):
        for kind in ("input", "study"):
            schema = self.printed("schema", kind)
            jsonschema.Draft7Validator.check_schema(schema)
            # Each reference leads somewhere.
            wanted = set(re.findall(r'"#/definitions/([^"]+)"', json.dumps(schema)))
            self.assertEqual(wanted, set(schema["definitions"]))

    def test_takes_every_shipped_input_as_it_is_written(self):
        paths = self.inputs()
        self.assertGreater(len(paths), 50)
        for path in paths:
            document = loaded(path.read_text())
            if path.stem in FRAGMENTS:
                document["include"] = "others.yaml"
            self.assertEqual(self.problems(document), [], path)

    def test_takes_every_shipped_input_as_it_is_merged(self):
        taken = 0
        for path in self.inputs():
            if path.stem in FRAGMENTS:
                continue
            # What a reduced method reads is not there before training; which method it is changes nothing else.
            changes = ["method={type: fom}", "output.probes.tolerance=1 m", "plugins=[]"]
            if "vortex" not in str(path.relative_to(HERE.parent)):
                changes.append("model.particles={type: lattice, origin: [0, 0, 0], size: [1 mm, 0.5 mm, 0.5 mm], "
                               "count: [12, 8, 8], placement: cells}")
            outcome = self.kiln("check", path, *(word for change in changes for word in ("--set", change)))
            self.assertEqual((outcome.status, outcome.stderr), (0, ""), path)
            self.assertEqual(self.problems(loaded(outcome.stdout)), [], path)
            taken += 1
        self.assertGreater(taken, 40)

    def test_takes_shipped_studies(self):
        schema = self.printed("schema", "study")
        for path in (HERE / "study.yaml", *sorted((ROOT / "inputs" / "nrl-2022").glob("study*.yaml"))):
            self.assertEqual(self.problems(loaded(path.read_text()), schema), [], path)
        broken = loaded((HERE / "study.yaml").read_text())
        broken["cases"][0]["comand"] = "train"
        self.assertNotEqual(self.problems(broken, schema), [])

    def test_refuses_mistakes(self):
        sound = loaded((HERE / "cases" / "small.yaml").read_text())
        self.assertEqual(self.problems(sound), [])

        def refused(word, *path, value=None, remove=False, add=None):
            document = copy.deepcopy(sound)
            block = document
            for key in path[:-1]:
                block = block[key]
            if remove:
                del block[path[-1]]
            elif add is not None:
                block[path[-1]][add] = value
            else:
                block[path[-1]] = value
            problems = self.problems(document)
            self.assertNotEqual(problems, [], (path, value))
            self.assertTrue(any(word in problem for problem in problems), (word, problems))

        # A misspelt key, at each depth.
        refused("modle", "time", add="modle", value=1)
        document = {**sound, "modle": sound["model"]}
        del document["model"]
        self.assertTrue(any("modle" in problem for problem in self.problems(document)))
        refused("powr", "model", "heat_source", add="powr", value=5)
        refused("kernl", "model", add="kernl", value="cubic spline")
        refused("evry", "output", "fields", add="evry", value=5)
        # A wrong type, unit, range or length.
        refused("forty", "model", "heat_source", "power", value="forty")
        refused("20 kg", "model", "heat_source", "power", value="20 kg")
        refused("-3", "model", "heat_source", "power", value=-3)
        refused("2.5", "time", "newton", "refresh", value=2.5)
        refused("[24, 12]", "model", "particles", "count", value=[24, 12])
        refused("diagnal", "time", "newton", "jacobian", value="diagnal")
        refused("[1]", "time", "step", value=[1])
        refused("fom", "method", "type", value="fomm")
        refused("None", "time", "end", value=None)
        # Something that is missing.
        refused("heat_source", "model", "heat_source", "power", remove=True)
        refused("time", "time", remove=True)
        refused("type", "model", "type", remove=True)

    def test_takes_what_may_be_left_out_or_written_otherwise(self):
        sound = loaded((HERE / "cases" / "small.yaml").read_text())

        def taken(*path, value):
            document = copy.deepcopy(sound)
            block = document
            for key in path[:-1]:
                block = block[key]
            block[path[-1]] = value
            self.assertEqual(self.problems(document), [], (path, value))
            (self.folder / "case.yaml").write_text(yaml.safe_dump(document))
            outcome = self.kiln("check", "case.yaml")
            self.assertEqual(outcome.status, 0, outcome.stderr)

        taken("model", "heat_source", "power", value=20)
        taken("model", "heat_source", "power", value="20 J/s")
        taken("model", "heat_source", "power", value="2e4 mW")
        taken("model", "heat_source", "width", value="150 µm")
        taken("model", "kernel", value={"type": "wendland c2"})
        taken("method", value="fom")
        taken("output", "extremes", value=None)
        taken("time", "newton", value=None)
        taken("title", value=5)

    def test_every_default_and_choice_of_the_schema_is_taken(self):
        """Each definition's own defaults obey it."""
        for name, definition in self.schema["definitions"].items():
            for key, entry in definition["properties"].items():
                if "default" in entry:
                    schema = {**{k: v for k, v in entry.items() if k != "default"}, "definitions": self.schema["definitions"]}
                    self.assertEqual(self.problems(entry["default"], schema), [], (name, key))


if __name__ == "__main__":
    main()
