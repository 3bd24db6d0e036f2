"""Draws how each figure went over the nightly runs: a PNG an experiment and measure, a line a case, and a page of them."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import markdown

from measured import KINDS

TITLES = {
    "ranks": "Ranks and sampled particles",
    "errors": "Errors, %",
    "residuals": "Residual evaluations a step",
    "temperatures": "Highest temperature, K",
    "ratios": "Savings against the full order",
}


def series_of(history, kind):
    """(experiment, measure) → {case: ([runs], [values])}."""
    found = {}
    for number, line in enumerate(history):
        for name, value in line.get(kind, {}).items():
            experiment, *case, measure = name.split("/")
            if kind == "ratios":
                case, measure = case[:-1], f"speedup/{measure}"
            runs, values = found.setdefault((experiment, measure), {}).setdefault("/".join(case), ([], []))
            runs.append(number)
            values.append(value)
    return found


def draw(history, gold, kind, experiment, measure, lines, folder):
    figure, axis = plt.subplots(figsize=(9, 4.2), layout="constrained")
    axis.set_prop_cycle(color=plt.get_cmap("tab20").colors)
    for case, (runs, values) in lines.items():
        drawn, = axis.plot(runs, values, marker=".", label=case)
        name = f"{experiment}/{case}/{measure}"
        if name in gold:
            axis.axhline(gold[name], color=drawn.get_color(), linestyle=":", linewidth=0.8)
        drifted = [k for k, run in enumerate(runs) if name in history[run]["drifted"]]
        axis.plot([runs[k] for k in drifted], [values[k] for k in drifted], "x", color="red", markersize=9)
    everything = [value for _, values in lines.values() for value in values]
    if kind in ("errors", "ratios") and all(value > 0 for value in everything):
        axis.set_yscale("log")
    first = max(0, len(history) - 12)
    axis.set_xticks(range(first, len(history)))
    axis.set_xticklabels([f"{line['date'][:10]}\n{line['commit'][:7]}" for line in history[first:]], fontsize="x-small")
    axis.set_title(f"{experiment}: {measure} (dotted: gold; red: drifted)")
    axis.legend(fontsize="x-small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    axis.grid(alpha=0.3)
    name = f"{experiment}-{measure.replace('/', '-').replace('_', '-')}.png"
    figure.savefig(folder / name, dpi=80)
    plt.close(figure)
    return name


def write_trends(history, gold, drifts, folder):
    """All pictures, README.md and index.html. `history`: as history.read() gives it."""
    folder.mkdir(parents=True, exist_ok=True)
    last = history[-1]
    parts = [
        "# Kiln, nightly",
        f"{len(history)} runs; the last on {last['date']}, commit `{last['commit']}`, {last['machine']}, {last['blas']}.",
        "## Drifted",
        "\n".join(f"- {drift}" for drift in drifts) or "Nothing.",
    ]
    for kind in KINDS:
        parts.append(f"## {TITLES[kind]}")
        for (experiment, measure), lines in sorted(series_of(history, kind).items()):
            name = draw(history, gold, kind, experiment, measure, lines, folder)
            parts.append(f"![{experiment}: {measure}]({name})")
    text = "\n\n".join(parts) + "\n"
    (folder / "README.md").write_text(text)
    body = markdown.markdown(text, extensions=["tables"])
    (folder / "index.html").write_text(
        f"<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><title>Kiln, nightly</title></head>\n"
        f"<body style='font-family: sans-serif; max-width: 70em; margin: auto'>\n{body}\n</body></html>\n"
    )
