"""Gold values of the nightly run: reading, comparing, and the explicit update that records its reason."""

import dataclasses
import datetime
import fnmatch
import json
import math
import pathlib

import yaml

TOLERANCES = pathlib.Path(__file__).resolve().parent / "tolerances.yaml"


@dataclasses.dataclass(frozen=True)
class Drift:
    """A figure that is not as its gold value says; `found` is None for a missing one."""

    name: str
    gold: float | None
    found: float | None
    allowed: str

    def __str__(self):
        return f"{self.name}: gold {shown(self.gold)}, found {shown(self.found)}, allowed {self.allowed}"


def shown(value):
    return "missing" if value is None else f"{value:.6g}"


class Tolerances:
    """The rules of tolerances.yaml. `at_least`, if given, takes the place of every rule's own."""

    def __init__(self, file=TOLERANCES, at_least=None):
        self.rules = yaml.safe_load(pathlib.Path(file).read_text())
        if at_least is not None:
            self.rules = [rule | {"at_least": at_least} if "at_least" in rule else rule for rule in self.rules]
        for rule in self.rules:
            if not rule.get("reason"):
                raise SystemExit(f"{file}: the tolerance of '{rule['figures']}' gives no reason")

    def rule(self, name):
        for rule in self.rules:
            if fnmatch.fnmatchcase(name, rule["figures"]):
                return rule
        raise SystemExit(f"tolerances.yaml: no entry fits the figure '{name}'")

    def check(self, name, gold, found):
        """A Drift, or None where the figure is as it should be."""
        rule = self.rule(name)
        if "at_least" in rule:
            bound = rule["at_least"] * gold
            allowed, kept = f"at least {bound:.6g}", found is not None and found >= bound
        else:
            width = max(rule["relative"] * abs(gold), rule["floor"])
            allowed = f"{gold - width:.6g} to {gold + width:.6g}"
            # The last digit of a sum is not what a floor of 0 is about.
            kept = found is not None and abs(found - gold) <= width * (1 + 1e-12)
        # NaN compares as false everywhere; infinity is no figure either.
        kept = kept and math.isfinite(found)
        return None if kept else Drift(name, gold, found, f"{allowed} ({rule['reason'].rstrip('.')})")


def read_gold(file):
    """Name → gold value. Throws SystemExit for a missing file, one without figures, and values that are no numbers."""
    file = pathlib.Path(file)
    if not file.exists():
        raise SystemExit(f"{file}: there are no gold values; `./dev nightly --update-gold --reason \"…\"` writes them")
    figures = json.loads(file.read_text()).get("figures")
    if not figures:
        raise SystemExit(f"{file}: holds no figures, so that nothing would be compared")
    for name, value in figures.items():
        if not isinstance(value, (int, float)) or not math.isfinite(value):
            raise SystemExit(f"{file}: {name} is {value}, expected a finite number")
    return figures


def compare(gold, found, tolerances):
    """Every Drift between gold values and found figures; figures without a gold value are among them."""
    drifts = [tolerances.check(name, value, found.get(name)) for name, value in gold.items()]
    strange = [Drift(name, None, found[name], "none: it has no gold value") for name in found if name not in gold]
    return [drift for drift in drifts if drift] + strange


def update_gold(file, figures, reason, facts):
    """Writes all figures as gold values and adds to the list of updates why, when, of which commit and machine. Throws
    SystemExit without a reason, without figures and for values that are not finite."""
    if not reason or not reason.strip():
        raise SystemExit("--update-gold needs --reason \"why the figures are expected to differ\"")
    bad = [name for name, value in figures.items() if not math.isfinite(value)]
    if bad or not figures:
        raise SystemExit(f"no gold values are written: {'not finite: ' + ', '.join(bad) if bad else 'there are no figures'}")
    file = pathlib.Path(file)
    before = json.loads(file.read_text()) if file.exists() else {"updates": [], "figures": {}}
    old = before["figures"]
    changed = sorted(name for name in old.keys() | figures.keys() if old.get(name) != figures.get(name))
    update = {"reason": reason.strip(), "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
              **facts, "changed": len(changed), "of": len(figures)}
    text = json.dumps({"updates": before["updates"] + [update], "figures": dict(sorted(figures.items()))}, indent=1)
    file.write_text(text + "\n")
    return update
