#!/usr/bin/python3
"""Runs the studies behind the results page, resuming what is there, and writes the page beside them.

usage: reproduce.py [--quick | --tiny] [--output FOLDER] [--kiln PROGRAM] [--ranks N] [--page-only] [--publish [FOLDER]]
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
sys.path.insert(0, str(REPOSITORY / "regression" / "comparison"))

import smaller_study
from page import Page
from published import Published
from results import Results

STUDIES = {"": "study.yaml", "-one-rank": "study-one-rank.yaml"}
SCALES = {"quick": smaller_study.QUICK, "tiny": smaller_study.TINY}


def roots(output):
    """Folders of the main study and of the one-rank study."""
    return [pathlib.Path(f"{output}{suffix}") for suffix in STUDIES]


def study_file(suffix, output, scale):
    """The study as it stands in inputs/, or one scaled or placed elsewhere, written beside its output."""
    file = HERE.parent / STUDIES[suffix]
    if scale is None and str(output) == "build/reproduce":
        return file
    study = smaller_study.relocate(smaller_study.read_study(file), output)
    if scale is not None:
        study = smaller_study.shrink(study, scale)
    return smaller_study.write_study(study, pathlib.Path(f"{output}{suffix}.yaml"))


def run_study(kiln, file, ranks):
    """Exit status of `kiln study`; 1 says that some of its cases failed, which the page tells."""
    print(f"== {file}, {ranks} rank{'s' if ranks > 1 else ''}", file=sys.stderr, flush=True)
    environment = dict(os.environ)
    if sys.stderr.isatty():
        # mpirun hides the terminal from its ranks.
        environment["KILN_PROGRESS"] = "bar"
    launcher = [os.environ.get("MPIEXEC", "mpirun"), "-n", str(ranks)] if ranks > 1 else []
    # Where the study writes is this command's own word.
    words = [*launcher, kiln, "study", str(file), "--allow-outside"]
    return subprocess.run(words, env=environment, check=False).returncode


def run_studies(kiln, output, scale, ranks):
    """Both studies; the second uses what the first trained. Throws SystemExit for one that did not get to its end."""
    for suffix in STUDIES:
        status = run_study(kiln, study_file(suffix, output, scale), 1 if suffix == "-one-rank" else ranks)
        if status not in (0, 1):
            raise SystemExit(f"{STUDIES[suffix]} ended with status {status}; started again, it goes on where it was")


def write_page(output, command, folder):
    main, *further = roots(output)
    results = Results(main, further)
    Page(results, Published(), command, folder).write()
    return results


def publish(page, folder):
    """Copies the page, its figures and summary.json; files of an earlier page go."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.png"):
        old.unlink()
    for file in [page / "README.md", page / "index.html", page / "summary.json", *sorted(page.glob("*.png"))]:
        shutil.copy(file, folder / file.name)


def main():
    parser = argparse.ArgumentParser(prog="./dev reproduce", description=__doc__.split("\n")[0])
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quick", action="store_true", help="a coarser lattice and fewer steps: minutes")
    size.add_argument("--tiny", action="store_true", help="the smallest that still shows everything: seconds")
    parser.add_argument("--output", help="folder of the study (build/reproduce)")
    parser.add_argument("--kiln", default=str(REPOSITORY / "build/release/kiln"), help="the built program")
    parser.add_argument("--ranks", type=int, default=min(2, os.cpu_count() or 1), help="of the study (2)")
    parser.add_argument("--page-only", action="store_true", help="write the page from what has been run")
    parser.add_argument("--publish", nargs="?", const="docs/results", metavar="FOLDER",
                        help="copy page, figures and summary.json there (docs/results)")
    options = parser.parse_args()
    chosen = next((name for name in SCALES if getattr(options, name)), None)
    output = pathlib.Path(options.output or "build/reproduce" + (f"-{chosen}" if chosen else ""))
    if not options.page_only:
        run_studies(options.kiln, output, SCALES.get(chosen), options.ranks)
    command = "./dev reproduce" + (f" --{chosen}" if chosen else "")
    results = write_page(output, command, output / "page")
    print(f"page: {output / 'page' / 'index.html'}")
    failed = [case.name for case in results.cases if case.status == "failed"]
    if failed:
        print(f"{len(failed)} cases failed, as the page says: {', '.join(failed)}")
    if options.publish:
        publish(output / "page", pathlib.Path(options.publish))
        print(f"published: {options.publish}")


if __name__ == "__main__":
    main()
