"""Everything that is tried against Kiln's robustness, whole: all broken inputs and data files, twenty kills, fuzzing.

soak.py [--minutes MINUTES] [--kiln PROGRAM]   (of fuzzing; the rest takes about ten minutes)"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--minutes", type=float, default=20.0, help="of fuzzing")
    parser.add_argument("--kills", type=int, default=20, help="at random moments, and as many again while files are written")
    parser.add_argument("--kiln", required=True)
    parser.add_argument("--killer", help="the library that kills a run while it writes")
    parser.add_argument("--folder", type=Path, default=HERE.parent / "build" / "soak")
    options = parser.parse_args()
    kiln = Path(options.kiln).resolve()
    killer = options.killer or kiln.parent / "regression" / "libkiln_kill_while_writing.so"
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    environment = {
        **os.environ, "KILN": str(kiln), "KILN_KILLER": str(killer), "KILN_KILLS": str(options.kills), "MPIEXEC": "mpirun",
        "KILN_FAULTS_SUMMARY": str(folder / "faults.json"), "OMPI_MCA_mpi_yield_when_idle": "1", "OPENBLAS_NUM_THREADS": "1",
    }  # fmt: skip
    start = time.monotonic()
    failed = []

    def stage(name, *words):
        print(f"== {name}", flush=True)
        done = subprocess.run([sys.executable, "-B", *map(str, words)], cwd=HERE, env=environment, check=False)
        if done.returncode != 0:
            failed.append(name)

    def counts(name):
        path = folder / f"{name}.json"
        return json.loads(path.read_text()) if path.exists() else {}

    for name in ("inputs", "files", "faults", "fuzz"):
        (folder / f"{name}.json").unlink(missing_ok=True)
    stage("broken inputs", "test_hostile.py", "inputs", "--least", 300, "--keep", folder / "bad", "--summary", folder / "inputs.json")
    stage("broken data files", "test_hostile.py", "files", "--least", 100, "--keep", folder / "bad", "--summary", folder / "files.json")
    stage("faults", "test_faults.py")
    stage("fuzzing", "fuzz.py", options.minutes, "--summary", folder / "fuzz.json")
    parts = {name: counts(name) for name in ("inputs", "files", "faults", "fuzz")}
    summary = {
        "inputs_tried": parts["inputs"].get("tried", 0),
        "files_tried": parts["files"].get("tried", 0),
        "kills_survived": parts["faults"].get("kills_survived", 0),
        "fuzz_executions": parts["fuzz"].get("fuzz_executions", 0),
        "crashes": sum(part.get("crashes", 0) for part in parts.values()),
        "hangs": sum(part.get("hangs", 0) for part in parts.values()),
        "failed": failed,
        "seconds": round(time.monotonic() - start),
    }
    (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    for name, value in summary.items():
        print(f"{name.replace('_', ' '):16} {', '.join(value) or 'none' if name == 'failed' else value}")
    sys.exit(1 if failed or summary["crashes"] or summary["hangs"] else 0)


if __name__ == "__main__":
    main()
