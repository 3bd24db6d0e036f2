"""The same studies on a coarser lattice and with longer steps: for `./dev reproduce --quick` and for tests."""

import json
import pathlib

import yaml


class Scale:
    """What a smaller study changes in every case. The beam is as wide as the lattice can carry. A short run has few
    snapshots, of which the report's residual energy would keep fewer modes than the basis has."""

    published = {"reduction.residual_basis.energy": "99.999 %"}

    def __init__(self, count, step, steps, width, experiments=(1, 2, 3, 4)):
        self.experiments = list(experiments)
        self.changes = {
            "model.particles.count": str(list(count)),
            "model.heat_source.width": width,
            "time.step": step,
            "output.fields.every": str(steps // 5),
            "output.checkpoint.every": str(steps // 2),
        }


QUICK = Scale(count=(50, 25, 7), step="10 us", steps=400, width="80 um")
TINY = Scale(count=(24, 12, 6), step="40 us", steps=100, width="150 um", experiments=(1,))


def read_study(file):
    """A study file as it is, with the paths of its inputs made absolute."""
    file = pathlib.Path(file)
    study = yaml.safe_load(file.read_text())
    for case in study["cases"]:
        case["input"] = str((file.parent / case["input"]).resolve())
    return study


def relocate(study, output):
    """The study with its results, and those of other studies that it reads, below another folder than build/."""
    absolute = str(pathlib.Path(output).resolve())
    text = json.dumps(study).replace("../../build/reproduce", absolute)
    study = json.loads(text)
    study["output"] = study["output"].replace("build/reproduce", str(output), 1)
    return study


def write_study(study, file):
    file.parent.mkdir(parents=True, exist_ok=True)
    # JSON is YAML.
    file.write_text(json.dumps(study, indent=1) + "\n")
    return file


def shrink(study, scale):
    """The study with every case scaled, without the experiments that the scale leaves out."""
    cases = []
    for case in study["cases"]:
        case["set"] = {**case.get("set", {}), **scale.changes}
        if "/published-" in case["name"]:
            case["set"].update(scale.published)
        case["for"]["experiment"] = [e for e in case["for"]["experiment"] if e in scale.experiments]
        if case["for"]["experiment"]:
            cases.append(case)
    study["cases"] = cases
    return study
