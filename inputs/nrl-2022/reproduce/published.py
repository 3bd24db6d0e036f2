"""The report's own figures, from report.yaml, and why ours differ, from reasons.yaml."""

import pathlib

import yaml

HERE = pathlib.Path(__file__).resolve().parent


class Published:
    def __init__(self):
        self.facts = yaml.safe_load((HERE / "report.yaml").read_text())
        self.reasons = {name: " ".join(text.split()) for name, text in
                        yaml.safe_load((HERE / "reasons.yaml").read_text()).items()}

    @staticmethod
    def _row(rows, experiment, setting):
        case = {"published_case_1": 1, "published_case_2": 2}.get(setting)
        return next((row for row in rows if row["experiment"] == experiment and row["case"] == case), None)

    def reduction(self, experiment, setting):
        """Table 2's row, or None where the report has no such setting."""
        return self._row(self.facts["reductions"], experiment, setting)

    def saving(self, table, experiment, setting):
        """The row of `best_wall_time` (Table 4) or `best_cpu_hours` (Table 5), or None."""
        return self._row(self.facts[table]["rows"], experiment, setting)

    def figure(self, number):
        """What the report's text says of a figure."""
        return " ".join(self.facts["figures"][number].split())

    def of_experiment(self, experiment):
        """What summary.json states of the report beside our figures."""
        def without_place(row):
            return row and {key: value for key, value in row.items() if key not in ("experiment", "case")}

        settings = ("published_case_1", "published_case_2")
        return {
            **{setting: without_place(self.reduction(experiment, setting)) for setting in settings},
            "best_wall_time": {
                "full_order_cores": self.facts["best_wall_time"]["full_order_cores"],
                **without_place(self.saving("best_wall_time", experiment, "published_case_1")),
            },
            "best_cpu_hours": {
                "full_order_cores": self.facts["best_cpu_hours"]["full_order_cores"],
                **without_place(self.saving("best_cpu_hours", experiment, "published_case_1")),
            },
            "worst_probe_error_percent_of_all_experiments": self.facts["worst_probe_error"]["percent"],
        }
