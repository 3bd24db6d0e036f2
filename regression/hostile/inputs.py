"""Broken input files: every shipped one, with one thing wrong. The same ones each time, for a seed."""

import os
import random
import re
import shutil
import socket
from pathlib import Path

import yaml

from .runner import Case

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SEED = 20220501

# What is broken → the command that meets it. Files that others include are met through one of these.
FOLDERS = {
    "nrl-2022": ROOT / "inputs" / "nrl-2022",
    "vortex": ROOT / "inputs" / "vortex",
    "cases": ROOT / "regression" / "cases",
}
THROUGH = {
    "nrl-2022/part.yaml": "nrl-2022/experiment-1.yaml",
    "nrl-2022/kiln.yaml": "nrl-2022/experiment-1.yaml",
    "nrl-2022/published-1.yaml": "nrl-2022/experiment-1-published-1.yaml",
    "nrl-2022/published-2.yaml": "nrl-2022/experiment-1-published-2.yaml",
}

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?( *[a-zA-Z%][\w/^() -]*)?")
INTEGER = re.compile(r"[+-]?\d+")
# Keys whose value may not be below 0.
NOT_NEGATIVE = {
    "power", "width", "step", "end", "size", "count", "every", "tolerance", "iterations", "refresh", "rank", "samples",
    "smoothing_length", "initial_temperature", "spacing", "samples_per_mode", "together", "hold",
}  # fmt: skip
# Keys that take any number, though a shipped input has a whole one there without a unit.
ANY_NUMBER = {"waves", "samples_per_mode", "circulation_scale"}
REQUIRED = {
    "model", "time", "model.type", "model.particles", "model.particles.type", "model.particles.count",
    "model.particles.size", "model.particles.origin", "model.material", "model.initial_temperature", "time.end",
    "time.step", "model.heat_source", "model.heat_source.type", "model.heat_source.width", "cases", "output.probes.points",
}  # fmt: skip


def prepare(folder):
    """All shipped inputs with what they name, as the folder that each case gets a copy of."""
    for name, source in FOLDERS.items():
        (folder / name).mkdir()
        for path in sorted(source.iterdir()):
            if path.suffix in (".yaml", ".csv"):
                shutil.copy(path, folder / name)
    shutil.copy(ROOT / "regression" / "study.yaml", folder)


def shipped():
    """Name → command line of every shipped input."""
    found = {}
    for name, folder in FOLDERS.items():
        for path in sorted(folder.glob("*.yaml")):
            file = f"{name}/{path.name}"
            study = path.name.startswith("study")
            found[file] = ["study", file, "--list"] if study else ["check", THROUGH.get(file, file)]
    found["study.yaml"] = ["study", "study.yaml", "--list"]
    return found


class Leaf:
    """A scalar of a YAML text with its key's path and both spans."""

    def __init__(self, path, node, key=None, in_flow=False):
        self.path = path
        self.text = node.value
        self.span = (node.start_mark.index, node.end_mark.index)
        self.line = node.start_mark.line + 1
        self.key = key
        self.in_flow = in_flow

    @property
    def name(self):
        return next((part for part in reversed(self.path) if not part.isdigit()), "")

    @property
    def is_free(self):
        """Whether the user's own names and values stand here, which are judged later or never."""
        return bool({"for", "set"} & set(self.path)) or self.path[:2] == ("queries", "points")


def leaves(text):
    found, blocks = [], []

    def walk(node, path, key, in_flow):
        if isinstance(node, yaml.ScalarNode):
            found.append(Leaf(path, node, key, in_flow))
        elif isinstance(node, yaml.SequenceNode):
            for index, item in enumerate(node.value):
                walk(item, (*path, str(index)), None, in_flow or node.flow_style)
        else:
            for name, value in node.value:
                inner = (*path, name.value)
                blocks.append((inner, name, value, in_flow or node.flow_style))
                walk(value, inner, name, in_flow or node.flow_style)

    walk(yaml.compose(text), (), None, False)
    return found, blocks


def replaced(text, span, new):
    return text[: span[0]] + new + text[span[1] :]


def broken_values(leaf):
    """(what is wrong, text in the value's place)"""
    yield "wrong type", "[1, {a: b}]"
    yield "a block", "{no such key: {deeper: 1}}"
    if not NUMBER.fullmatch(leaf.text) or leaf.name in ("material", "title", "name"):
        return
    yield "wrong unit", "3 kg m^5"
    yield "NaN", ".nan"
    yield "infinity", "-.inf"
    yield "beyond double precision", "1e999"
    yield "a word", "forty"
    yield "a decimal comma", '"5,3"'
    yield "hexadecimal", "0x1F"
    yield "other digits", "١٢"
    yield "an empty text", '""'
    yield "two numbers", '"3 4"'
    if INTEGER.fullmatch(leaf.text) and leaf.name not in ANY_NUMBER:
        yield "a fraction", "2.5"
        yield "beyond an integer", "99999999999"
    if leaf.name in NOT_NEGATIVE:
        yield "negative", "-" + leaf.text.lstrip("+-")


def leaf_cases(file, arguments, text):
    found, blocks = leaves(text)

    def case(what, broken, place):
        return Case(f"{file}: {what}", lambda folder: (folder / file).write_text(broken), arguments, place)

    here = re.escape(file)
    for leaf in found:
        if leaf.is_free or leaf.path[0] == "plugins":
            continue
        path = ".".join(leaf.path)
        for what, new in broken_values(leaf):
            yield case(f"{path}: {what}", replaced(text, leaf.span, new), rf"{here}:{leaf.line}:\d+: ")
        if leaf.name in ("type", "scheme", "kernel", "jacobian", "normalisation", "boundary", "placement", "energy_of"):
            misspelt = leaf.text + leaf.text[-1]
            yield case(f"{path}: misspelt choice", replaced(text, leaf.span, misspelt), rf"{here}:{leaf.line}:\d+: .*{leaf.name}")
    for path, key, value, in_flow in blocks:
        if {"for", "set"} & set(path[:-1]) or path[:2] == ("queries", "points") and len(path) > 2:
            continue
        name = key.value
        misspelt = name[:-1] + name[-1] + "e" if len(name) < 3 else name[0] + name[2] + name[1] + name[3:] + "q"
        span = (key.start_mark.index, key.end_mark.index)
        line = rf"{here}:\d+:\d+: " if name == "type" else rf"{here}:{key.start_mark.line + 1}:\d+: .*(unknown key|no live parameter)"
        yield case(f"{'.'.join(path)}: misspelt key", replaced(text, span, misspelt), line)
        lines = text.splitlines(keepends=True)
        first, last = key.start_mark.line, max(key.start_mark.line + 1, value.end_mark.line)
        begins_line = not text[text.rfind("\n", 0, span[0]) + 1 : span[0]].strip()
        if in_flow or not begins_line:
            continue
        if isinstance(value, yaml.ScalarNode):
            doubled = "".join(lines[: first + 1] + [lines[first]] + lines[first + 1 :])
            yield case(f"{'.'.join(path)}: doubled key", doubled, rf"{here}:{first + 2}:\d+: .*duplicate key")
        if ".".join(path) in REQUIRED and "include" not in text.split("model:")[0]:
            without = "".join(lines[:first] + lines[last:])
            yield case(f"{'.'.join(path)}: missing", without, r"\.yaml(:\d+:\d+)?: .*missing")


def texts(text, chance):
    """(what is wrong, bytes of the whole file)"""
    data = text.encode()
    at = chance.randrange(len(data) // 4, 3 * len(data) // 4)
    while data[at - 1 : at] != b"\n":
        at += 1
    yield "empty", b""
    yield "comments only", b"# nothing\n# at all\n"
    yield "null", b"null\n"
    yield "a list", b"- " + data.split(b"\n")[0] + b"\n- b\n"
    yield "a single value", b"just words\n"
    yield "NUL bytes", data[:at] + b"\0" * 7 + data[at:]
    yield "NUL bytes alone", b"\0" * 1000
    yield "binary rubbish", bytes(chance.randrange(256) for _ in range(5000))
    yield "binary rubbish inside", data[:at] + bytes(chance.randrange(128, 256) for _ in range(100)) + data[at:]
    yield "an executable's beginning", b"\x7fELF\x02\x01\x01" + bytes(200)
    yield "UTF-16", text.encode("utf-16")
    yield "UTF-32", text.encode("utf-32-be")
    yield "Latin-1", data[:at] + "# größer\n".encode("latin-1") + data[at:]
    yield "a mark of byte order inside", data[:at] + b"\xef\xbb\xbftitle: x\n" + data[at:]
    yield "overlong UTF-8", data[:at] + b"# \xc0\xaf\n" + data[at:]
    yield "a surrogate", data[:at] + b"# \xed\xa0\x80\n" + data[at:]
    yield "an escape sequence", data[:at] + b"title: \x1b[31mred\n" + data[at:]
    yield "a tab as indentation", data + b"extra:\n\tkey: 1\n"
    yield "a directive", b"%YAML 9.9\n---\n" + data
    yield "a second document", data + b"---\n" + data
    yield "an unknown tag", data + b"extra: !!python/object/apply:os.system [ls]\n"
    yield "an own tag", data + b"extra: !mine 5\n"
    yield "an open quote", data + b'extra: "never closed\n'
    yield "an open single quote", data + b"extra: 'never closed\n"
    yield "an open bracket", data + b"extra: [1, 2\n"
    yield "an open brace", data + b"extra: {a: 1\n"
    yield "a bracket too many", data + b"extra: [1, 2]]\n"
    yield "a key without a colon", data + b"extra\n"
    yield "a value without a space", data + b"extra:5\n"
    yield "two colons", data + b"extra: a: b\n"
    yield "less indentation", b"   title: x\n" + data
    yield "an alias that is not there", data + b"extra: *nobody\n"
    yield "an alias of itself", data + b"extra: &a [*a]\n"
    yield "an alias of itself as a block", data + b"extra: &a {b: *a}\n"
    yield "a merge of itself", data + b"extra: &a\n  <<: *a\n"
    yield "a merge of a value", data + b"extra:\n  <<: 5\n"
    bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n"
    bomb += "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 12))
    yield "aliases that explode", data + bomb.encode()
    maps = "m0: &m0 {x: 1}\n" + "".join(f"m{i}: &m{i} {{a: *m{i - 1}, b: *m{i - 1}}}\n" for i in range(1, 40))
    yield "blocks of aliases that explode", data + maps.encode()
    yield "deep brackets", data + b"extra: " + b"[" * 100000 + b"]" * 100000 + b"\n"
    yield "deep braces", data + b"extra: " + b"{a: " * 100000 + b"1" + b"}" * 100000 + b"\n"
    yield "deep dashes", data + b"extra:\n  " + b"- " * 50000 + b"1\n"
    yield "deep blocks", data + b"".join(b" " * i + b"k:\n" for i in range(300))
    yield "deep complex keys", data + b"? " * 50000 + b"1\n"
    yield "a key that is a list", data + b"? [a, b]\n: c\n"
    yield "a key that is a block", data + b"? {a: b}\n: c\n"
    yield "very many keys", data + b"".join(b"key%d: 1\n" % i for i in range(200000))
    yield "very many unknown keys", data + b"".join(b"kex%d: 1\n" % i for i in range(4000))
    yield "very many values", data + b"extra: [" + b"1," * 1000000 + b"1]\n"
    yield "a very long line", data + b"extra: " + b"x" * 3000000 + b"\n"
    yield "a very long key", data + b"k" * 3000000 + b": 1\n"
    yield "a very long number", data + b"extra: " + b"9" * 1000000 + b"\n"
    yield "a very long comment", data + b"# " + b"x" * 17000000 + b"\n"
    yield "NUL by an escape", data + b'output: {directory: "results\\0/../.."}\n'
    yield "itself included", b"include: %FILE%\n" + data
    yield "no file included", data + b"include:\n"
    yield "a folder included", data + b"include: .\n"
    yield "a missing file included", data + b"include: nowhere/at-all.yaml\n"
    yield "a device included", data + b"include: /dev/zero\n"
    yield "a block included", data + b"include: {a: b}\n"
    yield "a list of lists included", data + b"include: [[a]]\n"
    yield "NUL in an included name", data + b'include: "a\\0b"\n'
    yield "a very long name included", data + b"include: " + b"a" * 5000 + b"\n"
    yield "binary rubbish included", data + b"include: ../rubbish.bin\n"


def text_cases(file, arguments, text, seed):
    for what, _ in texts(text, random.Random(seed)):

        def write(folder, what=what):
            # Made anew, since all of them together are large.
            data = next(data for name, data in texts(text, random.Random(seed)) if name == what)
            (folder / "rubbish.bin").write_bytes(bytes(range(256)) * 8)
            (folder / file).write_bytes(data.replace(b"%FILE%", file.rsplit("/", maxsplit=1)[-1].encode()))

        # A text that no YAML parser may see stops the reading of the file; its name is always told.
        place = rf"{re.escape(file)}:\d+:\d+: |{re.escape(file)}: "
        if what == "binary rubbish included":
            # There the fault lies, unless a second `include` is found first.
            place += r"|rubbish\.bin:1:1: "
        if what == "a very long comment":
            # Told where the file is included, if it is.
            place += rf"|:\d+:\d+: include: the file is longer than 16 MiB: {re.escape(file)}$"
        yield Case(f"{file}: {what}", write, arguments, place)


def others():
    """What is no regular file, names that are no files, and values that only the building of a run finds wrong."""
    small = "cases/small.yaml"

    def put(make):
        def write(folder):
            (folder / small).unlink()
            make(folder / small)

        return write

    def a_socket(path):
        listener = socket.socket(socket.AF_UNIX)
        here = os.open(path.parent, os.O_RDONLY)
        listener.bind(f"/proc/self/fd/{here}/{path.name}")
        listener.close()
        os.close(here)

    def repeat(path, start, piece, times):
        with open(path, "wb") as file:
            file.write(start)
            for _ in range(times):
                file.write(piece)

    def nothing(_):
        pass

    check = ["check", small]
    kinds = {
        "a folder": lambda path: path.mkdir(),
        "a pipe": os.mkfifo,
        "a socket": a_socket,
        "a link to nothing": lambda path: path.symlink_to("nowhere"),
        "a link to itself": lambda path: path.symlink_to(path.name),
        "a device of zeros": lambda path: path.symlink_to("/dev/zero"),
        "a device of chance": lambda path: path.symlink_to("/dev/urandom"),
        "no file": nothing,
        "100 MB in a line": lambda path: repeat(path, b"title: ", b"x" * 1_000_000, 100),
        "100 MB of keys": lambda path: repeat(path, b"", b"".join(b"key%d: 1\n" % i for i in range(80_000)), 100),
        "100 MB of brackets": lambda path: repeat(path, b"", b"[" * 1_000_000, 100),
    }
    for what, make in kinds.items():
        yield Case(f"{small}: {what}", put(make), check, re.escape(small))
    for name in ("", "no\nwhere.yaml", "a" * 300 + ".yaml", "/proc/self/mem", "/", "nowhere/../small.yaml", "\x1b[31m.yaml"):
        yield Case(f"the name {name[:20]!r}", nothing, ["check", name], r"[a-zA-Z/]")

    values = {
        "model.particles.count=[100000, 100000, 100000]": "count",
        "model.particles.count=[2000000000, 2, 2]": "count",
        "model.particles.count=[60000, 60000, 2]": "count",
        "model.particles.count=[0, 12, 6]": "count",
        "model.particles.count=[1, 12, 6]": "count",
        "model.particles.size=[1e300 m, 1 m, 1 m]": "model",
        "model.particles.size=[1e-300 m, 1 m, 1 m]": "model",
        "model.particles.origin=[1e300 m, 0, 0]": "model.particles",
        "model.smoothing_length=1e300": "model.smoothing_length",
        "model.smoothing_length=1e-300": "model",
        "model.smoothing_length=1000": "model.smoothing_length",
        "model.smoothing_length=0.1": "model.particles",
        "model.table.step=1e-9 K": "table",
        "model.table.step=1e300 K": "table",
        "model.table={from: 500 K, to: 400 K}": "table",
        "time.end=1e300 s": "time.end",
        "time.end=1e-300 s": "time.end",
        "time.step=1e-300 s": "time.end",
        "time.step=1 s": "time.end",
        "time.scheme=explicit": "time.scheme",
        "time.scheme={type: linear multistep, alpha: [], beta: []}": "time.scheme",
        "time.scheme={type: linear multistep, alpha: [0, 0], beta: [1, 0]}": "time.scheme",
        "time.scheme={type: linear multistep, alpha: [1, -1], beta: [1]}": "time.scheme",
        "model.material={type: formula, conductivity: '((((', specific_heat: 1, density: 1}": "conductivity",
        "model.material={type: formula, conductivity: 1/0, specific_heat: 1, density: 1}": "material",
        "model.material={type: formula, conductivity: 0-u, specific_heat: 1, density: 1}": "material",
        "model.material={type: formula, conductivity: system(1), specific_heat: 1, density: 1}": "conductivity",
        "model.material={type: formula, conductivity: '', specific_heat: 1, density: 1}": "conductivity",
        "model.material={type: table, path: /dev/zero}": "material.path",
        "model.material={type: table, path: .}": "material.path",
        "model.material={type: table, path: nowhere.csv}": "material.path",
        "model.particles={type: file, path: /dev/urandom, spacing: 1 mm}": "particles.path",
        "model.boundary=mirrored": "boundary",
        "output.probes.points=[]": "output.probes.points",
        "output.probes.points=[{name: a, position: [9, 9, 9]}]": "output.probes.points",
        "output.probes.points=[{name: a, position: [0.6 mm, 0, 0]}, {name: a, position: [0.6 mm, 0, 0]}]": "points.1.name",
        "output.probes.points=[{name: [a], position: [0.6 mm, 0, 0]}]": "points.0.name",
        "output.directory=[a, b]": "output.directory",
        "output.fields={every: 0}": "output.fields.every",
        "output.frames={}": "output.frames",
        "method={type: gnat, file: nowhere.h5}": "method.file",
        "method={type: gnat, file: /dev/zero}": "method.file",
        "method.type=fom.": "method.type",
        "plugins=[nowhere.so]": "nowhere.so",
        "plugins=[small.yaml]": "small.yaml",
        "plugins=[/dev/zero]": "/dev/zero",
        "plugins={a: b}": "plugins",
        "queries={points: {heat_source.power: []}}": "queries",
        "queries={points: {}}": "queries",
        "queries={points: {nothing: [1]}}": "queries",
        "queries={points: {heat_source.power: [1 kg]}}": "queries",
        "queries={points: {heat_source.power: [1 W, 2 W], heat_source.width: [1 mm]}}": "queries",
        "queries={file: nowhere.csv}": "queries.file",
        "queries={file: small.yaml, points: {heat_source.power: [1]}}": "queries",
    }  # fmt: skip
    for value, path in values.items():
        yield Case(f"--set {value}", nothing, [*check, "--set", value], re.escape(path))
    frames = ["--set", "time.end=1000000 s", "--set", "time.step=1 ms", "--set", "output.fields.every=1"]
    yield Case("--set very many frames", nothing, [*check, *frames], "output.fields.every")
    many = "queries={grid: true, points: {" + ", ".join(
        f"heat_source.{name}: [{', '.join(['1'] * 60)}]" for name in ("power", "width", "velocity.x", "velocity.y")
    ) + "}}"  # fmt: skip
    yield Case("--set very many combinations", nothing, [*check, "--set", many], "queries")
    for what, word in {
        "no value": "time.step", "no key": "=5", "dots": "...=5", "an empty key": "time..step=5", "brackets": "time.step=[",
        "a list's item": "output.probes.points.9.name=a", "a very deep path": "a." * 40000 + "a=1",
        "a deep value": "model=" + "[" * 50000, "an alias": "time=*a", "a tab": "time=\tx:\n\ty", "two documents": "time=a\n---\nb",
    }.items():  # fmt: skip
        yield Case(f"--set with {what}", nothing, [*check, "--set", word], "--set ")


def controls():
    """What must not be refused: a corpus that refuses everything would show nothing."""
    text = (FOLDERS["cases"] / "small.yaml").read_bytes()
    small = "cases/small.yaml"
    for what, data in {
        "as shipped": text,
        "a mark of byte order in front": b"\xef\xbb\xbf" + text,
        "Windows' ends of lines": text.replace(b"\n", b"\r\n"),
        "no last end of line": text.rstrip(b"\n"),
        "a title in Greek": text.replace(b"Small part", "Μικρό κομμάτι".encode(), 1),
    }.items():
        yield Case(
            f"control: {what}", lambda folder, data=data: (folder / small).write_bytes(data), ["check", small], "",
            statuses=(0,), counted=False,
        )  # fmt: skip


def found():
    """What a fuzzer found, kept in found/."""
    for path in sorted((HERE / "found" / "yaml").glob("*")):
        def write(folder, path=path):
            shutil.copy(path, folder / "cases" / "small.yaml")

        yield Case(f"found: {path.name}", write, ["check", "cases/small.yaml"], r"small\.yaml", statuses=(0, 2))


def cases(every=1, seed=SEED):
    """All cases, or each `every`-th of the many, with all that stand alone."""
    many = []
    for file, arguments in shipped().items():
        folder, _, name = file.rpartition("/")
        text = ((FOLDERS[folder] if folder else ROOT / "regression") / name).read_text()
        many += leaf_cases(file, arguments, text)
        if name in ("small.yaml", "experiment-1.yaml", "part.yaml", "study.yaml", "gnat.yaml", "formula.yaml"):
            many += text_cases(file, arguments, text, f"{seed} {file}")
    # One shuffle for all seeds of the files: a fixed part takes something of everything.
    random.Random(SEED).shuffle(many)
    return [*controls(), *others(), *found(), *many[::every]]
