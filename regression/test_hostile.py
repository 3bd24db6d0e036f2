"""Broken inputs and broken data files end soon, with status 2 and a message that names the place, and leave nothing.

test_hostile.py inputs|files [--every N] [--jobs N] [--keep FOLDER] [--only REGEX] [--summary FILE]"""

import argparse
import json
import os
import re
import sys
import tempfile
from pathlib import Path

from hostile import files, inputs, runner

# Of a child of a broken case: one core is what a fixed part of the corpus may take.
ENVIRONMENT = {"OPENBLAS_NUM_THREADS": "1"}


def prepared(part, kiln, folder):
    if part == "inputs":
        inputs.prepare(folder)
    else:
        files.prepare(folder, kiln)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("part", choices=("inputs", "files"))
    parser.add_argument("--every", type=int, default=1, help="a fixed part: each so-manyth case")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", help="where the broken files of cases that end badly go")
    parser.add_argument("--only", help="cases whose names match this regular expression")
    parser.add_argument("--least", type=int, default=0, help="fewer cases than this are a failure")
    parser.add_argument("--summary", help="where the counts go, as JSON")
    options = parser.parse_args()
    os.environ.update(ENVIRONMENT)
    kiln = os.environ.get("KILN") or sys.exit("set KILN to the path of the built kiln program")
    with tempfile.TemporaryDirectory(prefix="kiln-hostile-") as temporary:
        shared = Path(temporary)
        prepared(options.part, kiln, shared)
        cases = inputs.cases(options.every) if options.part == "inputs" else files.cases(shared, options.every)
        if options.only:
            cases = [case for case in cases if re.search(options.only, case.name)]
        totals = runner.try_all(kiln, cases, shared, options.jobs, keep=options.keep)
    if options.summary:
        counts = {
            "tried": totals.tried,
            "crashes": totals.crashes,
            "hangs": totals.hangs,
            "ended_badly": len(totals.failures),
            "longest_cpu_seconds": totals.longest_cpu_seconds,
            "largest_bytes": totals.largest_bytes,
        }
        Path(options.summary).write_text(json.dumps(counts, indent=2) + "\n")
    if totals.tried < options.least:
        sys.exit(f"only {totals.tried} broken cases were tried, expected {options.least} or more")
    sys.exit(1 if totals.failures else 0)


if __name__ == "__main__":
    main()
