"""Every component and every choice that Kiln offers is run by at least one case, and every case has gold values."""

import re
from concurrent.futures import ThreadPoolExecutor

import gold
from harness import HERE, KilnTest, main

# Choices whose answers are compared with something better than gold values.
ELSEWHERE = {("input", "grid"): "unit_tests/framework/queries: points of a run with many; test_queries.py: single runs"}
COMMENT = re.compile(r"\A# \S.*\n")


class CasesTest(KilnTest):
    @classmethod
    def setUpClass(cls):
        cls.cases = [gold.Case(name) for name in gold.names()]
        # The method is looked up as it is written: `checked` is full order.
        with ThreadPoolExecutor(4) as pool:
            checked = list(pool.map(lambda case: case.checked, cls.cases))
        cls.used = "".join(checked + [case.input.read_text() for case in cls.cases])

    def printed(self, *arguments):
        outcome = self.kiln(*arguments)
        self.assertEqual((outcome.status, outcome.stderr), (0, ""), arguments)
        return outcome.stdout.splitlines()

    def uses(self, key, value):
        return re.search(rf"\b{re.escape(key)}: {re.escape(value)}\s*(#.*|\}}.*|,.*)?$", self.used, re.MULTILINE)

    def components(self):
        header, *lines = self.printed("list")
        name, summary = header.index("name"), header.index("summary")
        return [(line[:name].strip(), line[name:summary].strip()) for line in lines]

    def test_every_component_has_a_case(self):
        components = self.components()
        self.assertGreater(len(components), 20)
        without = [
            f"{category} '{name}'"
            for category, name in components
            if not self.uses("type", name)
        ]
        self.assertEqual(without, [], "no file of regression/cases uses these; ./dev gold writes a case's gold values")

    def test_every_choice_has_a_case(self):
        without, count = [], 0
        components = ["input"] + [name for _, name in self.components()]
        with ThreadPoolExecutor(4) as pool:
            described = list(pool.map(lambda component: self.printed("describe", component), components))
        for component, lines in zip(components, described):
            header = None
            for line in lines:
                # A name may stand in several categories: each has a table, and a blank line lies between.
                if not line or re.match(r"\s*key\s+type\s.*values", line):
                    header = line
                if not header or line == header:
                    continue
                key, kind = line.split()[0], line[header.index("type") :].split("  ")[0]
                if kind not in ("choice", "true/false") or (component, key) in ELSEWHERE:
                    continue
                values = re.split(r" \| ", line[header.index("values") :].split("  ")[0])
                for value in ["true", "false"] if kind == "true/false" else values:
                    count += 1
                    if not self.uses(key, value):
                        without.append(f"{component}: {key}: {value}")
        self.assertGreater(count, 15)
        self.assertEqual(without, [], "no file of regression/cases makes these choices")

    def test_every_case_has_gold_values_and_says_what_it_covers(self):
        self.assertEqual(sorted(path.name for path in (HERE / "gold").iterdir()), gold.names())
        for case in self.cases:
            with self.subTest(case.name):
                self.assertRegex(case.input.read_text(), COMMENT)
                facts = case.facts()
                self.assertTrue(facts["updates"], "who wrote the gold values, and why")
                for update in facts["updates"]:
                    self.assertTrue(all(update[key] for key in ("date", "reason", "commit")))
                for part in facts["tolerances"]:
                    self.assertTrue((case.gold / part).exists(), part)
                self.assertEqual("training" in facts["tolerances"], case.is_trained())

    def test_no_words_are_used_by_chance(self):
        # A negative control of the two tests above.
        self.assertFalse(self.uses("type", "wendland c4"))
        self.assertFalse(self.uses("jacobian", "sparse matrix"))
        self.assertTrue(self.uses("type", "wendland c2"))


if __name__ == "__main__":
    main()
