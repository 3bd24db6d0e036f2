"""The history of nightly runs: a JSON line each."""

import datetime
import json
import pathlib

from measured import KINDS, kind_of


def line_of(facts, figures, drifts):
    """What one nightly run leaves: when, of what, all figures by kind, and the names of those that drifted."""
    by_kind = {kind: {} for kind in KINDS}
    for name, value in figures.items():
        by_kind[kind_of(name)][name] = value
    date = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    return {"date": date, **facts, **by_kind, "drifted": [drift.name for drift in drifts]}


def append(file, line):
    file = pathlib.Path(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    before = file.read_bytes() if file.exists() else b""
    # A line that a kill cut short must not swallow this one.
    ending = b"" if not before or before.endswith(b"\n") else b"\n"
    with file.open("ab") as stream:
        stream.write(ending + json.dumps(line).encode() + b"\n")


def read(file):
    """All whole lines, oldest first."""
    lines = []
    for text in pathlib.Path(file).read_text().splitlines():
        try:
            lines.append(json.loads(text))
        except json.JSONDecodeError:
            continue
    return lines
