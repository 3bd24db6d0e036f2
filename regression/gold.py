"""Gold values: what each case of cases/ must give, as text that a diff can show.

Every file of cases/ is a case. Its gold values stand in gold/CASE:

    run/            where and what the state is: fields of the last frame, probes, extremes
    solve.json      how it was reached: steps, residuals, iterations, sizes of the reduction and of its sample mesh
    training/       what training learnt, for a case that needs a reduction: singular values, sampled particles
    gold.json       tolerances, and who changed the values when, at which commit and why

`gold.py CASE… --reason TEXT` runs cases and writes what they give as their gold values.
"""

import argparse
import csv
import datetime
import functools
import json
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

import h5py

import harness
from harness import HERE

# Fields that none of gold.json's own tolerances name are counts, ids, times and places. Times and places are written
# with 12 digits, the last of which may round either way.
TOLERANCE = 1e-11

# What a new case starts from, per part of its gold values: `kiln compare --field` of each.
DEFAULT_TOLERANCES = {
    "run": ["*temperature [K]=1e-9", "* [m]=1e-9,1e-6"],
    "solve.json": [],
    "training": ["*relative singular value=1e-9,1", "*largest singular value=1e-9", "* [m]=1e-9,1e-6"],
}

# Numbers of a report that tell how a solution was reached and that neither machine nor hour changes.
COUNTS = {
    "run": ["steps"],
    "solve": ["residuals", "iterations", "capped_steps"],
    "method": [
        "linear_iterations", "jacobian_evaluations", "linearisations",
        "time_windows", "basis_rank", "residual_rank", "sampled", "sources", "queried",
    ],
}


class Case:
    """One input file of cases/."""

    def __init__(self, name):
        self.name = name
        self.input = HERE / "cases" / f"{name}.yaml"
        self.gold = HERE / "gold" / name
        if not self.input.exists():
            raise ValueError(f"there is no case '{name}'; expected one of: {', '.join(names())}")

    @functools.cached_property
    def checked(self):
        """The input with all defaults, as `kiln check` prints it; full order, as others ask for their reduction."""
        outcome = harness.kiln(HERE, "check", self.input, "--set", "method={type: fom}")
        if outcome.status != 0:
            raise RuntimeError(f"case {self.name}: kiln check: {outcome.stderr}")
        return outcome.stdout

    def is_trained(self):
        return re.search(r"^reduction:", self.checked, re.MULTILINE) is not None

    def facts(self):
        path = self.gold / "gold.json"
        return json.loads(path.read_text()) if path.exists() else {"tolerances": DEFAULT_TOLERANCES, "updates": []}

    def kiln(self, command, folder, *options, **how):
        """`kiln run` or `kiln train` of the case, its results below `folder`."""
        return harness.kiln(
            folder, command, self.input, "--set", "output.directory=results", "--quiet", *options, **how
        )

    def compare(self, part, found):
        """`kiln compare` of one part of the gold values with what was found."""
        tolerances = self.facts()["tolerances"].get(part, DEFAULT_TOLERANCES[part])
        fields = [word for tolerance in tolerances for word in ("--field", tolerance)]
        return harness.kiln(
            HERE, "compare", self.gold / part, Path(found) / part, "--tolerance", TOLERANCE, *fields
        )

    def difference(self, part, found, how):
        """What differs, with its place; nothing if found/PART agrees. `how` tells how it was found."""
        outcome = self.compare(part, found)
        if outcome.status == 0:
            return ""
        lines = [line for line in outcome.stdout.splitlines() if not line.startswith("same ")]
        lines.insert(0, f"case {self.name}, {how}: {part} is not as regression/gold has it (gold and found)")
        return "\n  ".join(lines + outcome.stderr.splitlines())


def names():
    """All cases."""
    return sorted(path.stem for path in (HERE / "cases").glob("*.yaml"))


def write_table(columns, rows, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [columns] + [[f"{value:.12g}" for value in row] for row in rows]
    path.write_text("".join(",".join(line) + "\n" for line in lines))


def read_table(path):
    with open(path, encoding="utf-8", newline="") as file:
        columns, *rows = csv.reader(file)
    return columns, [[float(cell) for cell in row] for row in rows]


def write_run(results, found):
    """What a run left in results/METHOD, as gold values in found/run and found/solve.json."""
    folder = next(report.parent for report in results.glob("*/report.json") if report.parent.name != "training")
    with h5py.File(folder / "run.h5") as file:
        names = ["particle", "x [m]", "y [m]", "z [m]"]
        columns = [file["particle"][:], *file["position"][:].T]
        for name, item in file.items():
            if isinstance(item, h5py.Dataset) and item.shape == (len(file["time"]), len(columns[0])):
                label = f"{name} [{item.attrs['unit']}]"
                # Of particles that move, x and y are the state as well.
                names.append(f"last {label}" if label in names else label)
                columns.append(item[-1])
    write_table(names, sorted(zip(*columns)), found / "run" / "field.csv")
    write_table(*read_table(folder / "probes.csv"), found / "run" / "probes.csv")
    names, rows = read_table(folder / "extremes.csv")
    # Which particle has the largest of nearly equal values, round-off decides.
    kept = [k for k, name in enumerate(names) if not name.startswith("particle of ")]
    extremes = [[row[k] for k in kept] for row in rows]
    write_table([names[k] for k in kept], extremes, found / "run" / "extremes.csv")
    report = json.loads((folder / "report.json").read_text())
    counts = {key: report[part][key] for part, keys in COUNTS.items() for key in keys if key in report[part]}
    (found / "solve.json").write_text(json.dumps(counts, indent=2) + "\n")


def write_training(results, found):
    """What training left in results/, as gold values in found/training."""
    bases = {"basis": [], "residual_basis": []}
    samples = []
    with h5py.File(results / "reduction.h5") as file:
        places = dict(zip(file["particles/ids"][:], file["particles/positions"][:]))
        for window in range(len(file["windows"])):
            group = file[f"windows/{window}"]
            basis, mesh = group["basis"], group["sample_mesh"]
            values = {
                "basis": basis["singular_values"][: basis.attrs["rank"]],
                "residual_basis": mesh["residual_singular_values"][: mesh.attrs["residual_rank"]],
            }
            for name, kept in values.items():
                bases[name] += [(window, vector, kept[0], value / kept[0]) for vector, value in enumerate(kept)]
            samples += [(window, row, *places[row]) for row in sorted(mesh["rows"][:])]
    for name, rows in bases.items():
        columns = ["window", "vector", "largest singular value", "relative singular value"]
        write_table(columns, rows, found / "training" / f"{name}.csv")
    write_table(["window", "particle", "x [m]", "y [m]", "z [m]"], samples, found / "training" / "samples.csv")


def succeed(outcome, what):
    if outcome.status != 0:
        raise RuntimeError(f"{what}: exit status {outcome.status}\n{outcome.stderr}")


def find(case, folder):
    """Trains where the case asks for it, runs the case on one rank, and leaves its values in folder/found."""
    found = folder / "found"
    if case.is_trained():
        succeed(case.kiln("train", folder), f"training {case.name}")
        write_training(folder / "results", found)
    succeed(case.kiln("run", folder), f"running {case.name}")
    write_run(folder / "results", found)
    return found


def default_tolerances(part, found):
    """Those of DEFAULT_TOLERANCES that name a field which the case has: `kiln compare` takes others for misspelt."""
    if part == "solve.json":
        return DEFAULT_TOLERANCES[part]
    columns = [name for table in (found / part).glob("*.csv") for name in read_table(table)[0]]
    fields = {tolerance: tolerance.partition("=")[0].lstrip("*") for tolerance in DEFAULT_TOLERANCES[part]}
    return [tolerance for tolerance, end in fields.items() if any(name.endswith(end) for name in columns)]


def update(case, reason):
    """Writes what the case gives now as its gold values."""
    facts = case.facts()
    with tempfile.TemporaryDirectory(prefix="kiln-gold-") as temporary:
        found = find(case, Path(temporary))
        report = next(path for path in Path(temporary).glob("results/*/report.json") if path.parent.name != "training")
        provenance = json.loads(report.read_text())["provenance"]
        parts = sorted(path.name for path in found.iterdir())
        known = facts["tolerances"] if facts["updates"] else {}
        facts["tolerances"] = {part: known.get(part, default_tolerances(part, found)) for part in parts}
        shutil.rmtree(case.gold, ignore_errors=True)
        shutil.copytree(found, case.gold)
    made_by = {key: provenance[key] for key in ("commit", "compiler", "build_flags", "openblas", "processor")}
    today = datetime.date.today().isoformat()
    facts["updates"].append({"date": today, "reason": reason, **made_by})
    (case.gold / "gold.json").write_text(json.dumps(facts, indent=2) + "\n")


def main():
    parser = argparse.ArgumentParser(description="Writes what cases give now as their gold values.")
    parser.add_argument("cases", metavar="CASE", nargs="+", help="a file of regression/cases, or 'all'")
    parser.add_argument("--reason", required=True, help="why the values change; gold.json keeps it")
    words = parser.parse_args()
    if len(words.reason.split()) < 3:
        parser.error("--reason: say in a few words why the values change")
    if "KILN" not in os.environ:
        parser.error("set KILN to the path of the built kiln program")
    try:
        cases = [Case(name) for name in (names() if words.cases == ["all"] else words.cases)]
        for case in cases:
            update(case, words.reason)
            print(f"gold/{case.name} written")
    except (ValueError, RuntimeError) as error:
        sys.exit(f"gold: {error}")


if __name__ == "__main__":
    main()
