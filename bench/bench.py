"""Drives the sections of ./dev bench and merges their figures into build/bench/bench.json and one table.

A section is a file bench/sections/NAME.py with a line of documentation and `figures(bench)`, which returns a list of
`{name, value, unit, low, high, runs}`: the median, the least and the most of all runs, and how many there were. A section
with `only_on_request = True` runs when it is named (or --NAME is given). Sections that did not run keep the figures that an
earlier call left.
"""
import argparse
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/release"
FOLDER = ROOT / "build/bench"
# What sections share, and what reads the files of runs.
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "regression/comparison")]
# valgrind 3.19 stops at AVX-512.
INSTRUCTIONS_BUILD = ROOT / "build/instructions"


class Bench:
    """What a section gets: its folder, the options, and how to run a program of bench/."""

    def __init__(self, options):
        self.options = options
        self.folder = FOLDER
        self.kiln = BUILD / "kiln"
        self.inputs = ROOT / "inputs"
        self.machine = {}

    def program(self, name, *arguments, ranks=1):
        """Runs build/release/bench/NAME ARGUMENTS… FOLDER and returns the figures of FOLDER/<first argument>.json."""
        output = self.folder / f"{arguments[0]}.json"
        output.unlink(missing_ok=True)
        self.run(["mpirun", "-n", str(ranks), str(BUILD / "bench" / name), *arguments, str(self.folder)])
        content = json.loads(output.read_text())
        if not self.machine:
            self.machine = content["machine"]
        return content["figures"]

    def count_instructions(self, name, what):
        """Instructions of callgrind between the program's own marks, and the pairs they were for."""
        if not (INSTRUCTIONS_BUILD / "build.ninja").exists():
            self.run(["cmake", "-S", str(ROOT), "-B", str(INSTRUCTIONS_BUILD), "-G", "Ninja", "-DKILN_NATIVE=OFF",
                      "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-march=x86-64-v3", "-DKILN_TESTS=OFF"])
        self.run(["cmake", "--build", str(INSTRUCTIONS_BUILD), "--target", name])
        counts = []
        for repeats in (1, 3):
            text = self.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={self.folder}/{what}.callgrind",
                             str(INSTRUCTIONS_BUILD / "bench" / name), what, str(self.folder), str(repeats)])
            collected = re.search(r"Collected : (\d+)", text)
            pairs = re.search(r"pairs (\d+)", text)
            if not collected or not pairs:
                sys.exit(f"bench: callgrind of {name} {what}: no count in its output:\n{text[-2000:]}")
            counts.append((int(collected[1]), int(pairs[1])))
        # Set-up is the same in both runs.
        return counts[1][0] - counts[0][0], counts[1][1] - counts[0][1]

    def run(self, command):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT)
        if done.returncode != 0:
            sys.exit(f"bench: {' '.join(command)}: exit status {done.returncode}\n{done.stdout[-4000:]}")
        return done.stdout


def load_sections():
    sections = {}
    for file in sorted((ROOT / "bench/sections").glob("*.py")):
        spec = importlib.util.spec_from_file_location(file.stem, file)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        sections[file.stem] = module
    return sections


def arguments(sections):
    lines = "\n".join(f"  {name:10} {module.__doc__.strip()}" for name, module in sections.items())
    parser = argparse.ArgumentParser(prog="./dev bench", description=f"sections:\n{lines}",
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sections", nargs="*", metavar="SECTION", help="which ones to run; all but those on request")
    parser.add_argument("--scale", action="store_true", help="the section 'scale' only")
    parser.add_argument("--ptrom", action="store_true", help="the section 'ptrom' only")
    parser.add_argument("--instructions", action="store_true", help="count instructions too (fom), by valgrind")
    options = parser.parse_args()
    for name in ("scale", "ptrom"):
        if getattr(options, name):
            options.sections.append(name)
    for name in options.sections:
        if name not in sections:
            parser.error(f"no section '{name}'; expected: {', '.join(sections)}")
    if not options.sections:
        options.sections = [name for name, module in sections.items() if not getattr(module, "only_on_request", False)]
    return options


def table(machine, figures):
    load = os.getloadavg()[0]
    print(f"{machine.get('processor')}, {machine.get('cores')} cores, load {load:.1f}; {machine.get('compiler')} "
          f"{machine.get('build_flags')}")
    print(f"BLAS {machine.get('blas')} ({machine.get('blas_threads')} threads); {machine.get('mpi')}; "
          f"commit {machine.get('commit')}; {machine.get('date')}\n")
    print(f"{'':42} {'median':>10} {'low':>10} {'high':>10}  runs")
    for figure in figures:
        print(f"{figure['name']:42} {figure['value']:10.4g} {figure['low']:10.4g} {figure['high']:10.4g}  "
              f"{figure['runs']:4} {figure['unit']}")


def keep(bench, path, new):
    """Puts new figures in the place of those of the same names."""
    names = {figure["name"] for figure in new}
    old = json.loads(path.read_text()) if path.exists() else {"machine": {}, "figures": []}
    kept = [figure for figure in old["figures"] if figure["name"] not in names]
    machine = bench.machine or old["machine"]
    # Other figures of the file may come from earlier builds.
    for figure in new:
        figure["commit"] = machine.get("commit")
    path.write_text(json.dumps({"machine": machine, "figures": kept + new}, indent=1) + "\n")
    return machine


def main():
    sections = load_sections()
    options = arguments(sections)
    FOLDER.mkdir(parents=True, exist_ok=True)
    bench = Bench(options)
    path = FOLDER / "bench.json"
    new = []
    for name in options.sections:
        print(f"bench: {name}: {sections[name].__doc__.strip()}", file=sys.stderr)
        found = sections[name].figures(bench)
        # Sections take minutes: what is measured stays, whatever happens to the next.
        machine = keep(bench, path, found)
        new += found
    table(machine, new)
    print(f"\nall figures: {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
