"""The tables of the results page, as data frames of text: the report's figures beside ours."""

import pandas as pd

from results import METHODS, METHOD_TITLES, SETTING_TITLES, SETTINGS, reduction_figures
from summary import ratio

MISSING = "not run"
NOT_IN_REPORT = "–"


def number(value, digits=3):
    """A figure with that many significant digits, without an exponent; a dash for None."""
    if value is None:
        return NOT_IN_REPORT
    if value == 0:
        return "0"
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:,.0f}"
    if abs(value) < 1e-4:
        return f"{value:.{digits - 1}e}"
    return f"{value:#.{digits}g}"


def state(case):
    """Why a case has no figures, in one line."""
    if case is None:
        return MISSING
    first_line = case.message.split("\n")[0]
    return f"{case.status}: {first_line}" if first_line else case.status


def reductions(results, published):
    """Table 2."""
    rows = []
    for experiment in results.experiments:
        for setting in SETTINGS:
            report = published.reduction(experiment, setting) or {}
            file = results.reduction_file(experiment, setting)
            ours = reduction_figures(file) if file else {}
            trained = next(iter(results.find(experiment, setting, "training")), None)
            row = {"Exp.": experiment, "setting": SETTING_TITLES[setting]}
            for key, title in (
                ("basis_rank", "rank Φ"), ("residual_rank", "rank Φ_r"), ("sampled", "n_p"), ("sources", "n_s"),
                ("potp", "POTP, %"),
            ):
                for suffix, figures, otherwise in ((", report", report, NOT_IN_REPORT), ("", ours, MISSING)):
                    value = figures.get(key, otherwise)
                    row[title + suffix] = number(value, 4) if isinstance(value, float) else value
            row["windows"] = ours.get("time_windows", MISSING)
            row["training"] = f"{trained.seconds:.1f} s" if file else state(trained)
            rows.append(row)
    return pd.DataFrame(rows)


def accuracy(results):
    """Every case: its errors and its times on the main study's ranks."""
    rows = []
    for experiment in results.experiments:
        full = results.full_order(experiment)
        row = {"Exp.": experiment, "setting": "", "method": "full order", "tolerance": ""}
        if full:
            row |= {
                "residuals a step": number(full.times["residuals_per_step"]),
                "peak, K": number(full.times["peak_kelvin"], 4),
                "wall, s": number(full.times["wall_s"]),
                "CPU, s": number(full.times["cpu_s"]),
                "state": "complete",
            }
        else:
            row["state"] = state(next(iter(results.find(experiment, None, "fom")), None))
        rows.append(row)
        for setting in SETTINGS:
            for case in results.find(experiment, setting):
                row = {
                    "Exp.": experiment,
                    "setting": SETTING_TITLES[setting],
                    "method": case.title,
                    "tolerance": results.tolerance(case),
                }
                summary = results.summary(case)
                if summary:
                    row |= {
                        "probe error, % of K": number(summary["worst_probe_error_percent"]),
                        "probe error, % of rise": number(summary["worst_probe_error_percent_of_rise"]),
                        "field L2, %": number(summary["field_l2_error_percent"]),
                        "residuals a step": number(case.times["residuals_per_step"]),
                        "peak, K": number(case.times["peak_kelvin"], 4),
                        "wall, s": number(case.times["wall_s"]),
                        "CPU, s": number(case.times["cpu_s"]),
                        "wall saving": number(summary["speedup"]["wall"]),
                        "CPU saving": number(summary["speedup"]["cpu"]),
                        "state": "complete" if case.times["wall_s"] is not None else "complete, continued: no times",
                    }
                else:
                    row["state"] = "complete, but not what it needs" if case.complete else state(case)
                rows.append(row)
    columns = ["Exp.", "setting", "method", "tolerance", "probe error, % of K", "probe error, % of rise", "field L2, %",
               "residuals a step", "peak, K", "wall, s", "CPU, s", "wall saving", "CPU saving", "state"]
    return pd.DataFrame(rows, columns=columns).fillna("")


def best_over_ranks(results, cases, measure):
    """(case, ranks, figures) with the least wall_s or cpu_s among the complete runs of these cases, or None."""
    found = [(figures[measure], case, ranks, figures)
             for case in cases for ranks, figures in results.over_ranks(case).items()]
    return min(found, key=lambda item: item[0])[1:] if found else None


def savings(results, published, table):
    """Table 4 (`best_wall_time`) or 5 (`best_cpu_hours`): each side at the ranks and tolerance where it is best."""
    measure = {"best_wall_time": "wall_s", "best_cpu_hours": "cpu_s"}[table]
    rows = []
    for experiment in results.experiments:
        full = best_over_ranks(results, results.find(experiment, None, "fom"), measure)
        for setting in SETTINGS:
            for method in METHODS:
                cases = [case for case in results.find(experiment, setting, method) if not case.printed]
                if method == "ptrom" and not cases:
                    continue  # the report's settings have no clustered sources
                best = best_over_ranks(results, cases, measure)
                report = published.saving(table, experiment, setting) if method == "gnat" else None
                row = {"Exp.": experiment, "setting": SETTING_TITLES[setting], "method": METHOD_TITLES[method]}
                if report:
                    row |= {
                        "SWT, report": number(report["wall"], 5),
                        "SCPUH, report": number(report["cpu"], 5),
                        "tolerance, report": f"{report['tolerance']:.0e}".replace("e-0", "e-"),
                        "cores, report": f"{report['cores']} against {published.facts[table]['full_order_cores']}",
                    }
                if best and full:
                    case, ranks, figures = best
                    _, full_ranks, full_figures = full
                    hours = [number(of["cpu_s"] / 3600) for of in (figures, full_figures)]
                    row |= {
                        "SWT": number(full_figures["wall_s"] / figures["wall_s"]),
                        "SCPUH": number(full_figures["cpu_s"] / figures["cpu_s"]),
                        "tolerance": results.tolerance(case),
                        "cores": f"{ranks} against {full_ranks}",
                        "CPU hours": " against ".join(hours),
                    }
                else:
                    # The best of nothing: every case that should be here says why it is not.
                    row["SWT"] = "; ".join(dict.fromkeys(state(case) for case in cases)) or MISSING
                rows.append(row)
    columns = ["Exp.", "setting", "method", "SWT, report", "SWT", "SCPUH, report", "SCPUH", "tolerance, report",
               "tolerance", "cores, report", "cores", "CPU hours"]
    return pd.DataFrame(rows, columns=columns).fillna("")


def as_printed(results, published, experiments=(1, 3), setting="published_case_1", tolerance="1e-3"):
    """Algorithm 1 with product and factorisation in every iteration, beside the kept factors."""
    rows = []
    for experiment in (e for e in experiments if e in results.experiments):
        cases = [case for case in results.find(experiment, setting, "gnat") if case.tolerance == tolerance]
        kept = next((case for case in cases if not case.printed), None)
        printed = next((case for case in cases if case.printed), None)
        row = {"Exp.": experiment, "setting": SETTING_TITLES[setting], "tolerance": tolerance}
        report = published.saving("best_wall_time", experiment, setting)
        row["SWT, report"] = number(report["wall"], 5) if report else NOT_IN_REPORT
        for title, case in (("factors kept", kept), ("as printed", printed)):
            summary = case and results.summary(case)
            row[f"wall, s, {title}"] = number(case.times["wall_s"]) if summary else state(case)
            row[f"CPU, s, {title}"] = number(case.times["cpu_s"]) if summary else ""
            row[f"SWT, {title}"] = number(summary["speedup"]["wall"]) if summary else ""
        if kept and printed and results.summary(kept) and results.summary(printed):
            row["as printed / kept, wall"] = number(ratio(printed.times["wall_s"], kept.times["wall_s"]))
        rows.append(row)
    return pd.DataFrame(rows).fillna("")


def as_markdown(frame):
    """A Markdown table; a bar in a cell would end it."""
    def cell(value):
        return str(value).replace("|", "\\|").replace("\n", " ")

    lines = ["| " + " | ".join(map(cell, frame.columns)) + " |", "|" + " --- |" * len(frame.columns)]
    lines += ["| " + " | ".join(map(cell, row)) + " |" for row in frame.itertuples(index=False)]
    return "\n".join(lines)
