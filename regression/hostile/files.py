"""Broken data files: particle and material tables, reductions, checkpoints, run files, reports. The same ones each time.

Damage of two kinds: bytes that change, which a seal or a parser must notice, and changes by someone who knows the format
(another shape, type or value under a seal of its own), which the reader's own checks must notice."""

import json
import os
import random
import re
import shutil
import struct
import subprocess
from pathlib import Path

import h5py
import numpy as np

from .inputs import HERE, ROOT
from .runner import Case
from .seal import content, seal

SEED = 20220502
CASES = ROOT / "regression" / "cases"
SHORT = ("--set", "time.end=300 us")

REDUCTION = "results/reduction.h5"
RUN = "results/fom"
CHECKPOINT = f"{RUN}/checkpoint.h5"

GNAT = ["run", "gnat.yaml", *SHORT, "--quiet"]
LSPG = ["run", "lspg.yaml", *SHORT, "--quiet"]
OFTEN = ("--set", "output.checkpoint.every=3", "--set", "output.fields.every=2")
RESTART = ["run", "tiny.yaml", *SHORT, *OFTEN, "--quiet", "--restart"]
CLOUD = ["check", "cloud.yaml"]
CLOUD_H5 = ["check", "cloud-h5.yaml"]
TABLE = ["check", "table.yaml"]
QUERIES = ["check", "points.yaml"]
COMPARE = ["compare", RUN, "other/fom"]
REPORT = ["report", RUN]


def prepare(folder, kiln):
    """Inputs and sound data files of every kind, which each case gets a copy of."""
    for name in ("tiny", "galerkin", "gnat", "lspg", "cloud", "table"):
        shutil.copy(CASES / f"{name}.yaml", folder)
    for name in ("cloud.csv", "steel.csv"):
        shutil.copy(CASES / name, folder)

    def run(*words):
        done = subprocess.run([kiln, *words], cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{words}: {done.stderr}")

    # Training and runs alike are short: what is tested is how files are read.
    run("train", "galerkin.yaml", *SHORT, "--quiet", "--set", "reduction.basis.rank=4", "--set", "reduction.residual_basis.rank=5")
    run("run", "tiny.yaml", *SHORT, *OFTEN, "--quiet")
    shutil.copytree(folder / "results", folder / "other")
    other = ("--set", "model.kernel=wendland c2", "--set", "output.directory=wendland")
    run("train", "galerkin.yaml", *SHORT, "--quiet", *other, "--set", "reduction.basis.rank=4", "--set", "reduction.residual_basis.rank=5")
    shutil.rmtree(folder / "wendland" / "training")
    rows = np.loadtxt(folder / "cloud.csv", delimiter=",", skiprows=2)
    with h5py.File(folder / "cloud.h5", "w") as file:
        for index, name in enumerate(("x", "y", "z", "volume", "area")):
            file[name] = rows[:, index]
    (folder / "cloud-h5.yaml").write_text(
        "include: tiny.yaml\nmodel:\n  particles: {type: file, path: cloud.h5, spacing: 0.1 mm}\n"
    )
    (folder / "points.csv").write_text("heat_source.power [mW],heat_source.width\n20000,1.5e-4\n21000,1.5e-4\n")
    (folder / "points.yaml").write_text("include: tiny.yaml\nqueries: {file: points.csv}\n")


def changed(file, change):
    """Writes what `change` makes of a file's bytes."""

    def write(folder):
        path = folder / file
        path.write_bytes(change(path.read_bytes()))

    return write


def edited(file, change, sealed=True):
    """Lets `change` edit an HDF5 file; seals it again, so that only its contents are wrong."""

    def write(folder):
        path = folder / file
        path.write_bytes(content(path.read_bytes()))
        with h5py.File(path, "r+") as opened:
            change(opened)
        if sealed:
            seal(path)

    return write


def flip(data, place, bit):
    data = bytearray(data)
    data[place % len(data)] ^= 1 << bit
    return bytes(data)


def byte_cases(file, arguments, size, chance, flips):
    """Damage to bytes of a sealed file; any of it must be noticed."""
    place = re.escape(file) + ": "

    def case(what, change):
        return Case(f"{file}: {what}", changed(file, change), arguments, place)

    yield case("zero bytes", lambda data: b"")
    for part in (1, 8, 96, 512, 2048, size // 4, size // 2, 3 * size // 4, size - 4096, size - 41, size - 40, size - 1):
        yield case(f"cut after {part} bytes", lambda data, part=part: data[:part])
    for k in range(flips):
        # The first bytes are HDF5's own; the last the seal's.
        low, high = [(0, 96), (96, 4096), (size - 400, size)][k] if k < 3 else (0, size)
        where, bit = chance.randrange(low, high), chance.randrange(8)
        yield case(f"bit {bit} of byte {where} flipped", lambda data, where=where, bit=bit: flip(data, where, bit))
    yield case("a page of zeros", lambda data: data[: size // 2] + bytes(4096) + data[size // 2 + 4096 :])
    yield case("a page twice", lambda data: data[: size // 2] + data[size // 2 - 4096 :])
    yield case("two pages exchanged", lambda data: data[:4096] + data[8192:12288] + data[4096:8192] + data[12288:])
    yield case("something appended", lambda data: data + b"x")
    yield case("its own beginning appended", lambda data: data + data[:1000])
    yield case("binary rubbish", lambda data: bytes(random.Random(SEED).randrange(256) for _ in range(9999)))
    yield case("rubbish behind a signature", lambda data: data[:8] + bytes(random.Random(1).randrange(256) for _ in range(9999)))
    yield case("a text", lambda data: b"step,time\n1,2\n")
    yield case("line ends changed by a transfer", lambda data: data.replace(b"\n", b"\r\n"))
    yield case("no seal", content)
    huge = struct.pack("<Q", 2**63)
    yield case("a seal of a huge file", lambda data: data[:-32] + huge + data[-24:])
    yield case("a seal of very many parts", lambda data: data[:-24] + huge + data[-16:])


def datasets_of(path):
    found = []
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None)
    return found


def replace(file, name, values, **how):
    attributes = dict(file[name].attrs)
    del file[name]
    dataset = file.create_dataset(name, data=values, **how) if values is not None else file.create_dataset(name, **how)
    for key, value in attributes.items():
        dataset.attrs[key] = value


def dataset_changes(values):
    """(what is wrong, change of one dataset in an open file) for any dataset that is read."""
    is_real = values.dtype.kind == "f"
    yield "missing", lambda file, name: file.__delitem__(name)
    yield "a group in its place", lambda file, name: (file.__delitem__(name), file.create_group(name))
    yield "a text in its place", lambda file, name: replace(file, name, "none")
    yield "another type", lambda file, name: replace(file, name, values.astype("i8" if is_real else "f8"))
    yield "complex numbers", lambda file, name: replace(file, name, values.astype("c16"))
    yield "one row less", lambda file, name: replace(file, name, values[:-1])
    yield "a dimension more", lambda file, name: replace(file, name, values[..., None])
    yield "a single value", lambda file, name: replace(file, name, values.flat[0])
    yield "no value", lambda file, name: replace(file, name, values[:0])
    yield "a null dataspace", lambda file, name: replace(file, name, h5py.Empty(values.dtype))
    yield "declared, never written", lambda file, name: replace(file, name, None, shape=values.shape, dtype=values.dtype)
    huge = (2**40, *values.shape[1:])
    yield "a huge shape", lambda file, name: replace(file, name, None, shape=huge, dtype=values.dtype, chunks=True)
    large = (2**28, *values.shape[1:])
    yield "a large shape", lambda file, name: replace(file, name, None, shape=large, dtype=values.dtype, compression="gzip")
    yield "a link to nothing", lambda file, name: (file.__delitem__(name), file.__setitem__(name, h5py.SoftLink("/nowhere")))
    yield "a link to itself", lambda file, name: (file.__delitem__(name), file.__setitem__(name, h5py.SoftLink("/" + name)))
    yield "a link to another file", lambda file, name: (
        file.__delitem__(name), file.__setitem__(name, h5py.ExternalLink("elsewhere.h5", "/x")),
    )  # fmt: skip
    if is_real:
        for what, value in (("NaN", np.nan), ("infinity", np.inf)):
            def put(file, name, value=value):
                file[name][(-1,) * values.ndim] = value

            yield f"{what} in it", put
    elif name_like_ids(values):
        yield "an id below 0", lambda file, name: replace(file, name, np.sort(np.append(values[1:], -5)))
        yield "an id beyond all", lambda file, name: replace(file, name, np.append(values[:-1], 2**62))
        yield "an id twice", lambda file, name: replace(file, name, np.append(values[:-1], values[-2]))
        yield "ids in another order", lambda file, name: replace(file, name, values[::-1])


def name_like_ids(values):
    return values.ndim == 1 and len(values) > 1 and (np.diff(values) > 0).all()


def contents_cases(file, arguments, sound, names, attributes, sealed=True, skip=()):
    """Changes by someone who knows the format: of each dataset, and of each attribute (object, name, is a number)."""
    place = re.escape(file) + ": "
    with h5py.File(sound, "r") as opened:
        arrays = {name: np.asarray(opened[name]) for name in names}
    for name, values in arrays.items():
        for what, change in dataset_changes(values):
            if (name, what) in skip:
                continue
            yield Case(
                f"{file} {name}: {what}", edited(file, lambda opened, name=name, change=change: change(opened, name), sealed),
                arguments, place,
            )  # fmt: skip
    wrong = {"a list": [1.0, 2.0], "a text of another kind": b"\xff\xfe", "a huge number": 2**62, "below 0": -7, "NaN": np.nan}
    for owner, name, is_number in attributes:
        def without(opened, owner=owner, name=name):
            del opened[owner].attrs[name]

        yield Case(f"{file} {owner} @{name}: missing", edited(file, without, sealed), arguments, place)
        for what, value in wrong.items():
            if (f"@{name}", what) in skip:
                continue
            if not is_number and what != "a list":
                # Of a text, any number is another type.
                what, value = "a number", 5

            def put(opened, owner=owner, name=name, value=value):
                opened[owner].attrs[name] = value

            yield Case(f"{file} {owner} @{name}: {what}", edited(file, put, sealed), arguments, place)
            if what == "a number":
                break


def reduction_cases(sound, chance):
    path = sound / REDUCTION
    size = path.stat().st_size
    yield from byte_cases(REDUCTION, GNAT, size, chance, 60)
    mesh = "windows/0/sample_mesh"
    names = ["particles/ids", "particles/positions", "particles/reference", "particles/modes", f"{mesh}/rows", f"{mesh}/sources",
             f"{mesh}/gappy_operator", f"{mesh}/model/rows", f"{mesh}/model/sources", f"{mesh}/model/offsets",
             f"{mesh}/model/neighbours", f"{mesh}/model/weights", f"{mesh}/model/heated_areas", f"{mesh}/model/masses",
             f"{mesh}/model/positions", f"{mesh}/model/material/properties"]  # fmt: skip
    attributes = [("/", "components", True), ("/", "particles", True), ("/", "format", False), ("/", "format_version", True),
                  ("/", "model_input", False), ("/", "model_hash", False), ("windows/0", "end", True),
                  ("windows/0/basis", "rank", True), (mesh, "residual_rank", True), ("time", "step", True),
                  ("time", "scheme", False), (f"{mesh}/model/material", "from", True), (f"{mesh}/model/material", "step", True)]  # fmt: skip
    # A mesh whose sources are fewer than the model's is what the model says, and windows may end at any time.
    skip = {("@end", "a huge number"), ("@particles", "a huge number")}
    missing_one = {(f"{mesh}/sources", what) for what in ("one row less",)}
    yield from contents_cases(REDUCTION, GNAT, path, names, attributes, skip=skip | missing_one)
    yield from contents_cases(REDUCTION, LSPG, path, ["reference", "windows/0/basis/modes"], [])

    def case(what, change, arguments=GNAT):
        return Case(f"{REDUCTION}: {what}", edited(REDUCTION, change), arguments, re.escape(REDUCTION) + ": ")

    for group in ("windows", "particles", "time", "parameters", "data_files", "windows/0", "windows/0/basis", mesh, f"{mesh}/model",
                  f"{mesh}/model/material"):  # fmt: skip
        yield case(f"no group {group}", lambda file, group=group: file.__delitem__(group))
        yield case(f"a dataset instead of the group {group}", lambda file, group=group: (
            file.__delitem__(group), file.__setitem__(group, 1.0)))  # fmt: skip
    yield case("a window of another name", lambda file: file.move("windows/0", "windows/first"))
    yield case("a window that is a circle", lambda file: file["windows"].__setitem__("1", file["windows"]))
    bomb = "a: &a [x, x, x, x]\n" + "".join(f"b{i}: &b{i} [{', '.join([f'*b{i - 1}' if i else '*a'] * 9)}]\n" for i in range(12))
    for what, text in {
        "a model that is no YAML": "a: [", "a model of exploding aliases": bomb, "a model of brackets": "[" * 100000,
        "a model that is empty": "", "a model of another type": "type: vortex\n",
    }.items():  # fmt: skip
        def put(file, text=text):
            import xxhash

            file.attrs["model_input"] = text
            file.attrs["model_hash"] = f"{xxhash.xxh3_128_intdigest(text.encode()):032x}"

        yield case(what, put)
    for what, source in {
        "another model's": "wendland/reduction.h5", "a checkpoint": CHECKPOINT, "a run file": f"{RUN}/run.h5", "particles": "cloud.h5",
        "a table": "steel.csv",
    }.items():  # fmt: skip
        for arguments, method in ((GNAT, "gnat"), (LSPG, "lspg")):
            yield Case(
                f"{REDUCTION}: {what}, for {method}",
                lambda folder, source=source: shutil.copy(folder / source, folder / REDUCTION), arguments, re.escape(REDUCTION),
            )  # fmt: skip
    yield Case(f"{REDUCTION}: a folder", lambda folder: ((folder / REDUCTION).unlink(), (folder / REDUCTION).mkdir()), GNAT, REDUCTION)
    yield Case(f"{REDUCTION}: missing", lambda folder: (folder / REDUCTION).unlink(), GNAT, REDUCTION)


def checkpoint_cases(sound, chance):
    path = sound / CHECKPOINT
    yield from byte_cases(CHECKPOINT, RESTART, path.stat().st_size, chance, 40)
    with h5py.File(path, "r") as file:
        scheme = [f"scheme/{name}" for name in file["scheme"]]
    attributes = [("/", "format", True), ("/", "identity", False), ("/", "step", True), ("method", "jacobian_age", True),
                  ("method", "jacobian_time", True)]  # fmt: skip
    # An age only says when the Jacobian is next formed, and a time when it was: none below 0 is special but −1.
    skip = {("@jacobian_time", "below 0"), ("@jacobian_time", "a huge number")}
    yield from contents_cases(CHECKPOINT, RESTART, path, ["unknown", "method/jacobian_state", *scheme], attributes, skip=skip)
    for what, source in {"a reduction": REDUCTION, "a run file": f"{RUN}/run.h5", "a table": "cloud.csv"}.items():
        yield Case(
            f"{CHECKPOINT}: {what}", lambda folder, source=source: shutil.copy(folder / source, folder / CHECKPOINT), RESTART,
            re.escape(CHECKPOINT),
        )  # fmt: skip
    yield Case(f"{CHECKPOINT}: of another run", lambda folder: None, [*RESTART, "--set", "model.heat_source.power=5 W"], re.escape(CHECKPOINT))
    for name in ("probes.csv", "extremes.csv", "run.h5"):
        target = f"{RUN}/{name}"
        yield Case(f"{target}: missing at a restart", lambda folder, target=target: (folder / target).unlink(), RESTART, re.escape(target))
    for what, change in {
        "other columns": lambda data: b"a,b\n" + data.split(b"\n", 1)[1], "rubbish": lambda data: bytes(range(256)) * 3,
        "rubbish in a row": lambda data: data.replace(b"\n2,", b"\n\x00\xff,", 1), "a cell less": lambda data: re.sub(rb"\n2,[^,]*,", b"\n2,", data, count=1),
    }.items():  # fmt: skip
        yield Case(f"{RUN}/probes.csv: {what} at a restart", changed(f"{RUN}/probes.csv", change), RESTART, r"probes\.csv")


def open_file_cases(sound, chance):
    """HDF5 files without a seal: particles of a user's own, and run files, which grow while a run goes on."""
    for file, arguments in (("cloud.h5", CLOUD_H5), ("other/fom/run.h5", COMPARE), (f"{RUN}/run.h5", RESTART)):
        size = (sound / file).stat().st_size
        place = re.escape(file)
        for part in (0, 1, 8, 96, 512, 1024, size // 2, size - 1):
            yield Case(f"{file}: cut after {part} bytes", changed(file, lambda data, part=part: data[:part]), arguments, place)
        yield Case(f"{file}: a text", changed(file, lambda data: b"x,y,z\n1,2,3\n"), arguments, place)
        yield Case(f"{file}: rubbish behind a signature", changed(
            file, lambda data: data[:8] + bytes(random.Random(2).randrange(256) for _ in range(9999))), arguments, place)  # fmt: skip
        # What a flipped bit does to numbers, or to bytes that nobody reads, no reader can know.
        for k in range(60):
            where, bit = chance.randrange(8, 2048 if k % 3 else size), chance.randrange(8)
            yield Case(
                f"{file}: bit {bit} of byte {where} flipped",
                changed(file, lambda data, where=where, bit=bit: flip(data, where, bit)),
                arguments, ".", statuses=(2, 0, 1, 3), counted=False,
            )  # fmt: skip
    # The number of particles is the file's own to say, and an area may be 0.
    skip = {("y", "one row less"), ("z", "one row less"), ("volume", "missing")} - {("y", "one row less"), ("z", "one row less")}
    skip |= {("area", "missing")}
    for name in ("x", "y", "z", "volume", "area"):
        yield from contents_cases("cloud.h5", CLOUD_H5, sound / "cloud.h5", [name], [], sealed=False,
                                  skip=skip | {("volume", "missing")})  # fmt: skip

    def values(change):
        return edited("cloud.h5", change, sealed=False)

    for what, change in {
        "a volume of 0": lambda file: file["volume"].__setitem__(5, 0.0), "a volume below 0": lambda file: file["volume"].__setitem__(5, -1e-12),
        "an area below 0": lambda file: file["area"].__setitem__(5, -1e-12), "a particle far away": lambda file: file["x"].__setitem__(5, 1.0),
        "a particle very far away": lambda file: file["x"].__setitem__(5, 1e300), "two particles at one place": lambda file: [
            file[name].__setitem__(5, file[name][6]) for name in "xyz"],
        "metres taken for millimetres": lambda file: [file[name].__setitem__(slice(None), 1e3 * file[name][:]) for name in "xyz"],
        "a volume that underflows": lambda file: file["volume"].__setitem__(5, 5e-324),
        "values outside the file": lambda file: (file.__delitem__("x"), file.create_dataset(
            "x", shape=(490,), dtype="f8", external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)])),
        "values of another file": lambda file: virtual(file),
    }.items():  # fmt: skip
        yield Case(f"cloud.h5: {what}", values(change), CLOUD_H5, r"cloud|particles")


def virtual(file):
    del file["x"]
    layout = h5py.VirtualLayout(shape=(490,), dtype="f8")
    layout[:] = h5py.VirtualSource("elsewhere.h5", "x", shape=(490,))
    file.create_virtual_dataset("x", layout)


def table_changes(header):
    """(what is wrong) → change of a table with that header."""
    def change_row(data, change):
        lines = data.split(b"\n")
        row = next(i for i, line in enumerate(lines) if line.startswith(header)) + 1
        lines[row] = change(lines[row])
        return b"\n".join(lines)

    def cells(change, column=0):
        def of_row(row):
            parts = row.split(b",")
            parts[column] = change
            return b",".join(parts)

        return lambda data: change_row(data, of_row)

    return {
        "empty": lambda data: b"", "a line end alone": lambda data: b"\n", "comments alone": lambda data: b"# nothing\n",
        "no header": lambda data: b"\n".join(l for l in data.split(b"\n") if not l.startswith(header)),
        "a header alone": lambda data: next(l for l in data.split(b"\n") if l.startswith(header)) + b"\n",
        "a column of another name": lambda data: data.replace(header, b"colour" + header[1:], 1),
        "a column twice": lambda data: data.replace(header, header + b"," + header.split(b",")[0], 1),
        "a cell less": lambda data: change_row(data, lambda row: row.split(b",", 1)[1]),
        "a cell more": lambda data: change_row(data, lambda row: row + b",1"),
        "an empty cell": cells(b""), "a word": cells(b"wide"), "NaN": cells(b"nan"), "infinity": cells(b"-inf"), "too large": cells(b"1e999"),
        "a decimal comma": cells(b"0,5"), "semicolons": lambda data: data.replace(b",", b";"), "a unit": cells(b"3 mm"),
        "hexadecimal": cells(b"0x10"), "Arabic digits": cells("١٢".encode()), "a NUL byte": cells(b"1\x002"), "an escape": cells(b"\x1b[31m1"),
        "bytes that are no text": cells(b"\xff\xfe"), "binary rubbish": lambda data: bytes(range(256)) * 40,
        "UTF-16": lambda data: data.decode().encode("utf-16"), "a very long line": lambda data: data + b"1" * 5_000_000 + b"\n",
        "very many cells": lambda data: data + b"1," * 10_000_000 + b"\n", "a very long header": lambda data: b"x" * 10_000_000,
        "NUL bytes alone": lambda data: bytes(100_000), "a page of NUL bytes": lambda data: data[:40] + bytes(4096) + data[40:],
    }  # fmt: skip


def table_cases():
    """Tables of numbers: particles, materials, points of queries."""
    for file, arguments, header in (("cloud.csv", CLOUD, b"x,y,z,volume,area"), ("steel.csv", TABLE, b"temperature,conductivity,specific heat,density"),
                                    ("points.csv", QUERIES, b"heat_source")):  # fmt: skip
        place = re.escape(file)

        for what, change in table_changes(header).items():
            yield Case(f"{file}: {what}", changed(file, change), arguments, place)
        yield Case(f"{file}: a folder", lambda folder, file=file: ((folder / file).unlink(), (folder / file).mkdir()), arguments, place)
        yield Case(f"{file}: missing", lambda folder, file=file: (folder / file).unlink(), arguments, place)
        yield Case(f"{file}: a device", lambda folder, file=file: ((folder / file).unlink(), (folder / file).symlink_to("/dev/zero")), arguments, place)
        yield Case(f"{file}: a pipe", lambda folder, file=file: ((folder / file).unlink(), os.mkfifo(folder / file)), arguments, place)
        yield Case(f"{file}: an HDF5 file", lambda folder, file=file: shutil.copy(folder / "cloud.h5", folder / file), arguments, place)

    def lines(file, change):
        return changed(file, lambda data: b"\n".join(change(data.split(b"\n"))))

    yield Case("steel.csv: falling temperatures", lines("steel.csv", lambda rows: [*rows[:2], *rows[2:][::-1]]), TABLE, "steel")
    yield Case("steel.csv: a temperature twice", lines("steel.csv", lambda rows: [*rows[:3], rows[2], *rows[3:]]), TABLE, "steel")
    yield Case("steel.csv: a conductivity below 0", changed("steel.csv", lambda data: data.replace(b"250,13.5", b"250,-13.5")), TABLE, "material")
    yield Case("steel.csv: a density of 0", changed("steel.csv", lambda data: data.replace(b"7950", b"0")), TABLE, "material")
    yield Case("cloud.csv: a particle twice", lines("cloud.csv", lambda rows: [*rows[:3], rows[2], *rows[3:]]), CLOUD, "particles")
    yield Case("cloud.csv: one particle", lines("cloud.csv", lambda rows: rows[:3]), CLOUD, "particle")
    yield Case("cloud.csv: a particle far away", changed("cloud.csv", lambda data: data + b"9,9,9,1e-12,0\n"), CLOUD, "particle")
    yield Case("cloud.csv: a negative volume", changed("cloud.csv", lambda data: data + b"0.001,0,0.0001,-1e-12,0\n"), CLOUD, "cloud.csv")


def result_cases():
    """Tables, reports and what compare reads beside HDF5."""
    def deep(opening, closing):
        return lambda data: opening * 200_000 + closing * 200_000

    for file in (f"{RUN}/report.json",):
        changes = {
            "empty": lambda data: b"", "cut": lambda data: data[: len(data) // 2], "binary rubbish": lambda data: bytes(range(256)) * 9,
            "a list": lambda data: b"[1, 2]", "a number": lambda data: b"5", "a text": lambda data: b'"report"', "null": lambda data: b"null",
            "deep lists": deep(b"[", b"]"), "deep objects": deep(b'{"a":', b"}"), "deep and cut": lambda data: b"[" * 3_000_000,
            "bytes that are no text": lambda data: data.replace(b"a", b"\xff", 1), "two objects": lambda data: data + data,
            "NUL bytes": lambda data: bytes(5000),
        }  # fmt: skip
        for what, change in changes.items():
            yield Case(f"{file}: {what}", changed(file, change), REPORT, re.escape(file))
    for file in ("other/fom/probes.csv", "other/fom/extremes.csv", "other/fom/report.json", "other/fom/probes.json"):
        changes = {
            "empty": lambda data: b"", "binary rubbish": lambda data: bytes(range(256)) * 9, "cut": lambda data: data[: 2 * len(data) // 3].rstrip(b"0123456789"),
            "a very long line": lambda data: data + b"1," * 3_000_000, "NUL bytes": lambda data: bytes(9000),
        }  # fmt: skip
        if file.endswith("json"):
            changes["deep lists"] = deep(b"[", b"]")
        for what, change in changes.items():
            yield Case(f"{file}: {what}", changed(file, change), COMPARE, re.escape(file), statuses=(1, 2))


def odd_reports():
    """Reports that are objects but not as Kiln writes them: shown as far as they can be."""
    odd = {"run": {"unit": 5, "title": [1, {"unit": {}}]}, "unit": {"unit": ""}, "": {"": ""}, "x_s": None, "y": [[[]]], "z": "a\n\nb"}
    yield Case("control: an odd report", lambda folder: (folder / RUN / "report.json").write_text(json.dumps(odd)), REPORT, "",
               statuses=(0, 2), counted=False)  # fmt: skip


def controls():
    def nothing(_):
        pass

    for name, arguments in {"gnat": GNAT, "lspg": LSPG, "cloud": CLOUD, "HDF5 cloud": CLOUD_H5, "table": TABLE, "queries": QUERIES,
                            "compare": COMPARE, "report": REPORT, "restart": RESTART}.items():  # fmt: skip
        yield Case(f"control: {name}", nothing, arguments, "", statuses=(0,), counted=False)
    yield Case("control: sealed anew", lambda folder: (seal(folder / REDUCTION), seal(folder / CHECKPOINT)), GNAT, "",
               statuses=(0,), counted=False)  # fmt: skip


def found():
    """What a fuzzer found, kept in found/: its first byte says what the others are."""
    kinds = (("cloud.csv", CLOUD), ("cloud.h5", CLOUD_H5), ("points.csv", QUERIES))
    for path in sorted((HERE / "found" / "particles").glob("*")):
        data = path.read_bytes()
        file, arguments = kinds[data[0] % 3]
        yield Case(f"found: {path.name}", changed(file, lambda _, data=data: data[1:]), arguments, ".", statuses=(0, 2))
    for name, file, arguments in (("reduction", REDUCTION, GNAT), ("checkpoint", CHECKPOINT, RESTART)):
        for path in sorted((HERE / "found" / name).glob("*")):
            data = path.read_bytes()
            if data[0] < 8:
                yield Case(f"found: {path.name}", changed(file, lambda _, data=data: data[1:]), arguments, re.escape(file))


def cases(sound, every=1, seed=SEED):
    """All cases, or each `every`-th; `sound` is the folder that prepare() filled."""
    chance = random.Random(seed)
    many = [*reduction_cases(sound, chance), *checkpoint_cases(sound, chance), *open_file_cases(sound, chance), *table_cases(),
            *result_cases()]  # fmt: skip
    random.Random(SEED).shuffle(many)
    return [*controls(), *odd_reports(), *found(), *many[::every]]
