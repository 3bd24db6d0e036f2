#!/usr/bin/python3
"""Runs the study of the four experiments afresh, compares its figures with gold values, appends them to the history and
draws their trends. Exit status: 0 all as it should be, 1 some figures drifted, 2 there is nothing to compare."""

import argparse
import json
import os
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path[:0] = [str(REPOSITORY / "inputs/nrl-2022/reproduce"), str(REPOSITORY / "regression/comparison")]

import history
from gold_values import Tolerances, compare, read_gold, update_gold
from measured import failures_of, figures_of

# Runs of a tenth of a second: their ratios tell little.
SMALL_AT_LEAST = 0.05


def begin(folder, reuse):
    """Removes what an earlier nightly run left, unless that one was interrupted or its results are to be used again."""
    import reproduce

    marker = folder / "unfinished"
    if not reuse and not marker.exists():
        for root in reproduce.roots(folder / "study"):
            shutil.rmtree(root, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    marker.touch()
    return marker


def measure(options, folder):
    """The summary of the study, which is run or resumed."""
    # What draws pictures takes a second to load, and most commands draw none.
    import reproduce

    marker = begin(folder, options.reuse)
    output = folder / "study"
    reproduce.run_studies(options.kiln, output, reproduce.SCALES["tiny"] if options.small else None, options.ranks)
    reproduce.write_page(output, "./dev nightly" + (" --small" if options.small else ""), output / "page")
    marker.unlink()
    return read_summary(folder)


def read_summary(folder):
    file = folder / "study/page/summary.json"
    if not file.exists():
        raise SystemExit(f"{file}: no nightly run has been here; `./dev nightly` runs one")
    return json.loads(file.read_text())


def facts_of(summary):
    return {key: summary["provenance"][key] for key in ("commit", "machine", "blas")}


def main():
    parser = argparse.ArgumentParser(prog="./dev nightly", description=__doc__)
    parser.add_argument("--small", action="store_true", help="a small study, in seconds, with gold values of its own")
    parser.add_argument("--reuse", action="store_true", help="run only what is missing or changed since the last time")
    parser.add_argument("--compare-only", action="store_true", help="compare the last run's figures, run nothing")
    parser.add_argument("--update-gold", action="store_true", help="take the last nightly run's figures as gold values")
    parser.add_argument("--reason", help="why they are expected to differ; goes into the gold file")
    parser.add_argument("--kiln", default=str(REPOSITORY / "build/release/kiln"), help="the built program")
    parser.add_argument("--ranks", type=int, help="of the study (2; small: 1)")
    parser.add_argument("--folder", type=pathlib.Path, help="of the results (build/nightly, build/nightly-small)")
    parser.add_argument("--history", type=pathlib.Path, help="file that a line is appended to (history.jsonl there)")
    parser.add_argument("--gold", type=pathlib.Path, help="gold values (regression/nightly/gold.json, gold-small.json)")
    options = parser.parse_args()
    folder = options.folder or pathlib.Path("build/nightly-small" if options.small else "build/nightly")
    gold_file = options.gold or HERE / ("gold-small.json" if options.small else "gold.json")
    options.ranks = options.ranks or (1 if options.small else min(2, os.cpu_count() or 1))
    if options.reason and not options.update_gold:
        parser.error("--reason goes with --update-gold")

    if options.update_gold:
        summary = read_summary(folder)
        update = update_gold(gold_file, figures_of(summary), options.reason, facts_of(summary))
        print(f"{gold_file}: {update['changed']} of {update['of']} gold values changed: {update['reason']}")
        return 0

    summary = read_summary(folder) if options.compare_only else measure(options, folder)
    figures = figures_of(summary)
    failure = None
    gold, drifts = {}, []
    try:
        gold = read_gold(gold_file)
        drifts = compare(gold, figures, Tolerances(at_least=SMALL_AT_LEAST if options.small else None))
    except SystemExit as error:
        # The run's figures are worth keeping all the same.
        failure = error
    print(f"{len(figures)} figures, {len(gold)} gold values, {len(drifts)} drifted")
    if not options.compare_only:
        import trends

        history_file = options.history or folder / "history.jsonl"
        history.append(history_file, history.line_of(facts_of(summary), figures, drifts))
        trends.write_trends(history.read(history_file), gold, drifts, folder / "trends")
        print(f"history: {history_file}; trends: {folder / 'trends' / 'index.html'}")
    for name, why in failures_of(summary).items():
        print(f"case {name} {why}")
    for drift in drifts:
        print(f"drifted: {drift}")
    if failure:
        print(f"nightly: {failure}", file=sys.stderr)
        return 2
    return 1 if drifts else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except SystemExit as error:
        if isinstance(error.code, str):
            print(f"nightly: {error.code}", file=sys.stderr)
            sys.exit(2)
        raise
