"""The cases of the finished studies, found by their names: what ran, whether it is complete, and its run folder."""

import dataclasses
import functools
import json
import pathlib
import re

import h5py
import numpy as np

from run_folder import RunFolder
from summary import compare_runs, run_figures

SETTINGS = ("published_case_1", "published_case_2", "kiln")
SETTING_TITLES = {"published_case_1": "Case 1", "published_case_2": "Case 2", "kiln": "Kiln"}
METHODS = ("ptrom", "gnat", "lspg", "galerkin")
METHOD_TITLES = {"fom": "full order", "ptrom": "PTROM", "gnat": "GNAT", "lspg": "LSPG", "galerkin": "Galerkin"}

NAME = re.compile(
    r"experiment-(?P<experiment>\d+)/(?:full-order|(?:kiln|published-(?P<case>\d+))/"
    r"(?P<method>training|ptrom|gnat|lspg|galerkin)(?P<printed>-as-printed)?(?:-(?P<tolerance>[0-9.e-]+))?)$"
)


@dataclasses.dataclass(frozen=True)
class Case:
    """One row of a study.json. `setting` is None of a full-order run; `printed`: factors anew in every iteration."""

    name: str
    experiment: int
    setting: str | None
    method: str
    tolerance: str | None
    printed: bool
    status: str
    message: str
    seconds: float
    folder: pathlib.Path
    run_name: str

    @property
    def complete(self):
        return self.status == "complete"

    @property
    def key(self):
        """Its name among the cases of one experiment and setting, e.g. gnat-1e-3."""
        return self.name.rsplit("/", 1)[1]

    @property
    def title(self):
        return METHOD_TITLES.get(self.method, self.method) + (", as printed" if self.printed else "")

    @functools.cached_property
    def run(self):
        return RunFolder(self.folder / self.run_name)

    @functools.cached_property
    def times(self):
        return run_figures(self.run)


def read_cases(root):
    """The cases of one study's folder; none if it never ran. Throws SystemExit for a name that it cannot place."""
    root = pathlib.Path(root)
    if not (root / "study.json").exists():
        return []
    cases = []
    for row in json.loads((root / "study.json").read_text()):
        place = NAME.match(row["name"])
        if place is None:
            raise SystemExit(f"{root / 'study.json'}: no case of the four experiments is named '{row['name']}'")
        full_order = place["method"] is None
        published = f"published_case_{place['case']}" if place["case"] else "kiln"
        cases.append(
            Case(
                name=row["name"],
                experiment=int(place["experiment"]),
                setting=None if full_order else published,
                method=place["method"] or "fom",
                tolerance=place["tolerance"],
                printed=place["printed"] is not None,
                status=row["status"],
                message=(row.get("message") or "").strip(),
                seconds=row.get("seconds") or 0.0,
                folder=root / row["name"],
                run_name=pathlib.Path(row["report"]).parent.name,
            )
        )
    return cases


class Results:
    """All cases of the main study and of the further ones, which repeat some of them on other numbers of ranks."""

    def __init__(self, main, further=()):
        self.main = pathlib.Path(main)
        self.cases = read_cases(main)
        if not self.cases:
            raise SystemExit(f"{self.main}: holds no study.json; run the study first")
        self.further = [case for root in further for case in read_cases(root)]
        self.experiments = sorted({case.experiment for case in self.cases})
        self._summaries = {}

    def find(self, experiment, setting=None, method=None):
        """Cases of the main study in its order; without trainings unless asked for."""
        return [
            case
            for case in self.cases
            if case.experiment == experiment
            and case.setting == setting
            and (case.method == method if method else case.method != "training")
        ]

    def full_order(self, experiment):
        """The complete full-order run that the reduced ones are compared with, or None."""
        return next((case for case in self.find(experiment, None, "fom") if case.complete), None)

    def reduction_file(self, experiment, setting):
        """The file that the training of this setting left, or None."""
        trained = [case for case in self.find(experiment, setting, "training") if case.complete]
        return trained[0].folder / "reduction.h5" if trained else None

    def summary(self, case):
        """compare_runs() of a complete reduced case with its full-order run, or None where one of them is missing."""
        full = self.full_order(case.experiment)
        file = self.reduction_file(case.experiment, case.setting)
        if not case.complete or full is None or file is None:
            return None
        if case.folder not in self._summaries:
            self._summaries[case.folder] = compare_runs(full.run, case.run, file)
        return self._summaries[case.folder]

    def tolerance(self, case):
        """As the study names it; the cases that it does not vary have the full-order run's. Empty if that is missing."""
        full = self.full_order(case.experiment)
        if case.tolerance is None and full is not None:
            return np.format_float_scientific(full.run.report["method"]["tolerance"], trim="-", exp_digits=1)
        return case.tolerance or ""

    def best_gnat(self, experiment, setting):
        return self.best(experiment, setting, "gnat")

    def best(self, experiment, setting, method):
        """The complete case of a method that saves most wall time, or None."""
        found = [case for case in self.find(experiment, setting, method) if not case.printed and self.summary(case)]
        return max(found, key=lambda case: self.summary(case)["speedup"]["wall"] or 0.0, default=None)

    def over_ranks(self, case):
        """Ranks → the figures of this case's complete runs on that many, from all studies; none of continued ones."""
        everything = [other for other in self.cases + self.further
                      if other.name == case.name and other.complete and other.times["wall_s"] is not None]
        return {other.times["ranks"]: other.times for other in reversed(everything)}


def reduction_figures(file):
    """Ranks and sampled particles of a reduction: the largest over its time windows, as a run's report tells them."""
    with h5py.File(file) as reduction:
        windows = list(reduction["windows"].values())
        particles = int(reduction.attrs["particles"])
        meshes = [window["sample_mesh"] for window in windows]
        sampled = max(len(mesh["rows"]) for mesh in meshes)
        others = max(len(np.setdiff1d(mesh["sources"][:], mesh["rows"][:])) for mesh in meshes)
        active = max(len(np.union1d(mesh["sources"][:], mesh["rows"][:])) for mesh in meshes)
        return {
            "time_windows": len(windows),
            "basis_rank": max(int(window["basis"].attrs["rank"]) for window in windows),
            "residual_rank": max(int(mesh.attrs["residual_rank"]) for mesh in meshes),
            "sampled": sampled,
            "sources": others,
            "potp": 100 * active / particles,
            "particles": particles,
        }


def material_table(file):
    """Temperature in K, and conductivity, specific heat and density as the model of a reduction tabulates them."""
    with h5py.File(file) as reduction:
        first = min(reduction["windows"], key=int)
        material = reduction[f"windows/{first}/sample_mesh/model/material"]
        values = material["properties"][:]
        temperatures = material.attrs["from"] + material.attrs["step"] * np.arange(len(values))
        return temperatures, values
