"""Runs the fuzzers of unit_tests/fuzz for a time, from seeds that the corpus of broken files gives.

fuzz.py [MINUTES] [--build FOLDER] [--only NAME] [--found FOLDER] [--summary FILE]"""

import argparse
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from hostile import files, inputs

NAMES = ("yaml", "particles", "reduction", "checkpoint")
HERE = Path(__file__).resolve().parent
FOUND = HERE / "hostile" / "found"

LONGEST = {"yaml": 8192, "particles": 65536, "reduction": 400_000, "checkpoint": 100_000}
# Words and signs that chance finds late.
DICTIONARY = (
    "include", "model", "type", "sph heat", "particles", "lattice", "file", "time", "scheme", "backward euler", "method", "output",
    "queries", "points", "probes", "!!str", "&a", "*a", "<<", ": ", "- ", "? ", "|", ">", "---", "...", "{", "}", "[", "]", " um", " W/(m K)",
    "1e999", ".nan", "-.inf", "0x1", "\\x00", "\\xef\\xbb\\xbf", "x,y,z,volume,area", "KILNSEAL",
)  # fmt: skip


def write_seeds(name, folder, sound):
    folder.mkdir(parents=True, exist_ok=True)
    number = 0

    def add(data):
        nonlocal number
        if len(data) <= LONGEST[name]:
            (folder / f"seed-{number}").write_bytes(data)
            number += 1

    if name == "yaml":
        for path in [*(files.ROOT / "regression" / "cases").glob("*.yaml"), *(files.ROOT / "inputs" / "nrl-2022").glob("*.yaml")]:
            add(path.read_bytes())
        for case in inputs.cases(every=16):
            if not case.name.startswith("cases/small.yaml: ") or "100 MB" in case.name:
                continue
            with tempfile.TemporaryDirectory() as temporary:
                broken = Path(temporary)
                (broken / "cases").mkdir()
                file = broken / "cases" / "small.yaml"
                shutil.copy(files.CASES / "small.yaml", file)
                case.write(broken)
                if file.is_file() and not file.is_symlink():
                    add(file.read_bytes())
    elif name == "particles":
        for kind, file in ((0, "cloud.csv"), (0, "bare-cloud.csv"), (2, "probes.csv"), (1, "cloud.h5")):
            path = next(sound.rglob(file), files.CASES / file)
            add(bytes([kind]) + path.read_bytes())
            add(bytes([kind]) + path.read_bytes()[:600])
    else:
        file = files.REDUCTION if name == "reduction" else files.CHECKPOINT
        for first in (0, 1):
            add(bytes([first]) + (sound / file).read_bytes())
        # One edit of every kind to every part.
        for part in range(80):
            for kind in range(0, 63, 5):
                for number_bits in (0, 7, 0x7FF8000000000000, 2**62, 2**64 - 5):
                    if (part + kind + number_bits) % 7 == 0:
                        add(bytes([8 + part % 2]) + struct.pack("<BHBQ", kind, part, 0, number_bits))


def build(folder):
    log = folder / "build.log"
    folder.mkdir(parents=True, exist_ok=True)
    source = HERE.parent / "unit_tests" / "fuzz"
    with open(log, "w", encoding="utf-8") as out:
        for words in (
            ["cmake", "-S", str(source), "-B", str(folder), "-G", "Ninja", "-DCMAKE_C_COMPILER=clang", "-DCMAKE_CXX_COMPILER=clang++"],
            ["cmake", "--build", str(folder)],
        ):
            if subprocess.run(words, stdout=out, stderr=subprocess.STDOUT, check=False).returncode != 0:
                sys.exit(f"the fuzzers could not be built (log: {log})")


def run(name, folder, sound, seconds):
    """Executions, and the files of what was found."""
    corpus, found = folder / "corpus" / name, folder / "found" / name
    write_seeds(name, corpus, sound)
    shutil.rmtree(found, ignore_errors=True)
    found.mkdir(parents=True)
    dictionary = folder / "dictionary"
    dictionary.write_text("".join(f'"{word}"\n'.replace("\\\\", "\\") for word in DICTIONARY))
    words = [
        str(folder / f"fuzz_{name}"), f"-max_total_time={seconds}", "-timeout=10", "-rss_limit_mb=2048", f"-max_len={LONGEST[name]}",
        f"-artifact_prefix={found}/", f"-dict={dictionary}", "-print_final_stats=1", "-detect_leaks=0", "-seed=20220504", str(corpus),
    ]  # fmt: skip
    environment = {
        **os.environ, "KILN_FUZZ_SOUND": str(sound), "OPENBLAS_NUM_THREADS": "1",
        # MPI and Trilinos keep what they allocate; a size that cannot be is an error to be told, not a finding.
        "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1:detect_odr_violation=0",
    }  # fmt: skip
    log = folder / f"{name}.log"
    with open(log, "w", encoding="utf-8", errors="replace") as out:
        status = subprocess.run(words, stdout=out, stderr=subprocess.STDOUT, env=environment, check=False).returncode
    text = log.read_text(encoding="utf-8", errors="replace")
    executed = re.findall(r"number_of_executed_units:\s+(\d+)", text) or re.findall(r"^#(\d+)", text, re.MULTILINE)
    findings = sorted(path for path in found.iterdir() if path.is_file())
    return int(executed[-1]) if executed else 0, findings, status, log


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("minutes", nargs="?", type=float, default=4.0, help="for all fuzzers together")
    parser.add_argument("--build", type=Path, default=HERE.parent / "build" / "fuzz")
    parser.add_argument("--only", choices=NAMES)
    parser.add_argument("--kiln", default=os.environ.get("KILN"))
    parser.add_argument("--summary", type=Path)
    options = parser.parse_args()
    if options.kiln is None:
        sys.exit("set KILN to the path of the built kiln program, or give --kiln")
    build(options.build)
    names = [options.only] if options.only else NAMES
    counts = {"fuzz_executions": 0, "crashes": 0, "hangs": 0}
    with tempfile.TemporaryDirectory(prefix="kiln-fuzz-") as temporary:
        sound = Path(temporary)
        files.prepare(sound, os.path.abspath(options.kiln))
        for name in names:
            executed, findings, status, log = run(name, options.build, sound, max(1, round(60 * options.minutes / len(names))))
            counts["fuzz_executions"] += executed
            counts["hangs"] += sum(path.name.startswith("timeout") for path in findings)
            counts["crashes"] += sum(path.name.startswith(("crash", "oom")) for path in findings)
            print(f"{name}: {executed} executions, {len(findings)} findings", flush=True)
            if status != 0 and not findings:
                sys.exit(f"{name}: the fuzzer ended with status {status} (log: {log})")
            for path in findings:
                kept = FOUND / name / path.name
                kept.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, kept)
                print(f"    {kept.relative_to(HERE.parent)} (log: {log})")
    if options.summary:
        options.summary.write_text(json.dumps(counts, indent=2) + "\n")
    sys.exit(1 if counts["crashes"] + counts["hangs"] else 0)


if __name__ == "__main__":
    main()
