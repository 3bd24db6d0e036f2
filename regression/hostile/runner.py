"""Runs broken cases and judges how each ends: soon, in little memory, with status 2, in words, and leaving nothing."""

import concurrent.futures
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

from harness import SLOWER, alone

CPU_SECONDS = 5.0 * SLOWER
# A busy machine makes a run wait; a run that takes longer than this hangs.
WALL_SECONDS = 30.0 * SLOWER
MEMORY_BYTES = (1 << 30) * SLOWER  # sanitizers take memory, too
LONGEST_MESSAGE = 60  # lines
PROGRESS_SECONDS = 30.0  # between two lines of progress

CRASH = re.compile(
    r"terminate called|what\(\)|Aborted|[Bb]acktrace|Segmentation|Process received signal|did not foresee|"
    r"AddressSanitizer|runtime error|HDF5-DIAG|Teuchos::|std::|/framework/|\.[ch]pp:\d"
)
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f]")


@dataclass
class Case:
    """A broken file and the command line that meets it. `write` breaks it in the case's own folder."""

    name: str
    write: Callable[[Path], None]
    arguments: list
    place: str  # a regular expression that the message matches: file and line, or file
    statuses: tuple = (2,)
    stdin: bytes = b""
    counted: bool = True  # False: a control, or damage that no reader can tell from data


@dataclass
class Verdict:
    case: Case
    problem: str = ""
    status: int = 0
    crashed: bool = False
    hung: bool = False
    message: str = ""
    seconds: float = 0.0
    bytes: int = 0


@dataclass
class Totals:
    tried: int = 0
    crashes: int = 0
    hangs: int = 0
    longest_cpu_seconds: float = 0.0
    largest_bytes: int = 0
    failures: list = field(default_factory=list)


def contents(folder):
    """What lies below a folder: files by their hashes, folders, links and others by their kind."""
    found = {}
    for path in sorted(Path(folder).rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_symlink() or not path.exists():
            found[name] = "link"
        elif path.is_file():
            with open(path, "rb") as file:
                found[name] = hashlib.file_digest(file, "sha256").hexdigest() if path.stat().st_size < 1 << 24 else "large"
        else:
            found[name] = "folder" if path.is_dir() else "other"
    return found


def run_limited(words, folder, stdin=b"", wall=WALL_SECONDS):
    """Status (negative: a signal), standard output and error, CPU seconds, peak bytes, whether it had to be killed."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err, tempfile.TemporaryFile() as given:
        given.write(stdin)
        given.seek(0)
        environment = {**os.environ, **alone()}
        process = subprocess.Popen(
            words, cwd=folder, env=environment, stdin=given, stdout=out, stderr=err, start_new_session=True
        )
        hung = threading.Event()

        def end():
            hung.set()
            os.killpg(process.pid, signal.SIGKILL)

        timer = threading.Timer(wall, end)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        cpu = usage.ru_utime + usage.ru_stime
        return process.returncode, out.read(1 << 20), err.read(1 << 20), cpu, usage.ru_maxrss * 1024, hung.is_set()


def judge(case, outcome, before, after):
    status, out, err, cpu, memory, hung = outcome
    verdict = Verdict(case, status=status, seconds=cpu, bytes=memory, hung=hung)
    text = err.decode("utf-8", "replace")
    verdict.message = text
    verdict.crashed = not hung and (status < 0 or status > 128)
    if hung:
        verdict.problem = f"still running after {WALL_SECONDS:g} s"
    elif verdict.crashed:
        verdict.problem = f"died by signal {-status if status < 0 else status - 128}"
    elif status not in case.statuses:
        verdict.problem = f"status {status}, expected {' or '.join(map(str, case.statuses))}"
    elif cpu > CPU_SECONDS:
        verdict.problem = f"{cpu:.1f} s of processor time"
    elif memory > MEMORY_BYTES:
        verdict.problem = f"{memory / 2**20:.0f} MiB of memory"
    elif status == 2:
        if not text.strip():
            verdict.problem = "no message"
        elif not re.search(case.place, text):
            verdict.problem = f"the message does not name {case.place}"
        elif CRASH.search(text):
            verdict.problem = f"the message speaks of the program's inside: {CRASH.search(text).group()!r}"
        elif CONTROL.search(text) or "\ufffd" in text:
            verdict.problem = "the message holds bytes that are no text"
        elif text.count("\n") > LONGEST_MESSAGE or max(map(len, text.splitlines())) > 4000:
            verdict.problem = "the message is very long"
        elif out and "compare" not in case.arguments:
            verdict.problem = f"something on standard output: {out[:80]!r}"
        elif before != after:
            verdict.problem = f"left or changed: {sorted(set(before.items()) ^ set(after.items()))[:3]}"
    return verdict


def try_case(kiln, case, shared):
    """Runs one case in a copy of the folder `shared`."""
    with tempfile.TemporaryDirectory(prefix="kiln-hostile-") as temporary:
        folder = Path(temporary)
        shutil.copytree(shared, folder, dirs_exist_ok=True, symlinks=True)
        case.write(folder)
        before = contents(folder)
        outcome = run_limited([kiln, *map(str, case.arguments)], folder, case.stdin)
        return judge(case, outcome, before, contents(folder))


def try_all(kiln, cases, shared, jobs=2, out=sys.stdout, keep=None):
    """Runs all cases; prints those that end badly and a line of counts. `keep`: where the broken files of these go."""
    totals = Totals()
    start = told = time.monotonic()
    names = [case.name for case in cases]
    doubled = {name for name in names if names.count(name) > 1}
    if doubled:
        raise ValueError(f"cases of the same name: {sorted(doubled)}")
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        verdicts = pool.map(lambda case: try_case(kiln, case, shared), cases)
        for number, verdict in enumerate(verdicts, start=1):
            if time.monotonic() - told > PROGRESS_SECONDS:
                told = time.monotonic()
                left = (told - start) / number * (len(cases) - number)
                print(f"{number} of {len(cases)} tried, {len(totals.failures)} ended badly, about {left / 60:.0f} min left",
                      file=sys.stderr, flush=True)  # fmt: skip
            totals.tried += verdict.case.counted
            totals.crashes += verdict.crashed
            totals.hangs += verdict.hung
            totals.longest_cpu_seconds = max(totals.longest_cpu_seconds, verdict.seconds)
            totals.largest_bytes = max(totals.largest_bytes, verdict.bytes)
            if not verdict.problem:
                continue
            totals.failures.append(verdict)
            shown = "\n    ".join(verdict.message.splitlines()[:4])
            print(f"BAD {verdict.case.name}: {verdict.problem}\n    {shown}", file=out, flush=True)
            if keep is not None:
                target = Path(keep) / re.sub(r"[^\w.-]+", "_", verdict.case.name)
                shutil.rmtree(target, ignore_errors=True)
                shutil.copytree(shared, target, symlinks=True)
                verdict.case.write(target)
    print(
        f"{totals.tried} broken, {len(cases) - totals.tried} others; {len(totals.failures)} ended badly, "
        f"{totals.crashes} crashes, {totals.hangs} hangs; at most {totals.longest_cpu_seconds:.2f} s of processor time and "
        f"{totals.largest_bytes / 2**20:.0f} MiB; {time.monotonic() - start:.0f} s in all",
        file=out,
        flush=True,
    )
    return totals
