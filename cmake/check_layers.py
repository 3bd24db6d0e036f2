"""Checks who includes whom: framework/ knows neither physics/ nor rom/, these do not know each other nor the driver, and
folders of one of the three form no ring. Prints a line for each include that is wrong; status 1 then."""

import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FORBIDDEN = {"framework": r"physics/|rom/", "physics": r"rom/|framework/driver/", "rom": r"physics/|framework/driver/"}


def includes():
    """Each include: its place, its folder, the header, the header's folder."""
    for path in sorted(path for area in FORBIDDEN for path in (ROOT / area).rglob("*.[ch]pp")):
        name = path.relative_to(ROOT)
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if match := re.match(r'#include "((\w+/\w+)/.*)"', line):
                yield f"{name}:{number}", "/".join(name.parts[:2]), match[1], match[2]


def way(known, start, end):
    """The shortest way from a folder to another by includes; empty: there is none."""
    ways, seen = [[start]], {start}
    for path in ways:
        if path[-1] == end:
            return path
        new = sorted(known[path[-1]] - seen)
        seen.update(new)
        ways += [path + [folder] for folder in new]
    return []


edges, wrong = defaultdict(list), []
for place, here, header, there in includes():
    area = here.split("/")[0]
    if re.match(FORBIDDEN[area], header):
        wrong.append(f"{place}: {here} includes {header}, which {area}/ must not know")
    elif here != there and there.startswith(area + "/"):
        edges[here, there].append((place, header))
# What many files include is taken as meant: a ring is told by the includes that are fewest.
known = defaultdict(set)
for (here, there), found in sorted(edges.items(), key=lambda edge: -len(edge[1])):
    ring = way(known, there, here)
    if ring:
        wrong += [f"{place}: {here} includes {header}, which closes the ring {' -> '.join([here] + ring)}"
                  for place, header in found]
    else:
        known[here].add(there)
sys.exit("\n".join(wrong) if wrong else 0)
