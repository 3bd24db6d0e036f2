"""The figures that a nightly run watches, flat, from the summary of the results page."""

KINDS = ("ranks", "errors", "residuals", "temperatures", "ratios")

# Key of a case's summary → kind.
OF_CASE = {
    "worst_probe_error_percent": "errors",
    "worst_probe_error_percent_of_rise": "errors",
    "field_l2_error_percent": "errors",
}
OF_RUN = {"residuals_per_step": "residuals", "peak_kelvin": "temperatures"}
OF_REDUCTION = ("time_windows", "basis_rank", "residual_rank", "sampled", "sources")


def kind_of(name):
    """One of KINDS, from the name of a figure."""
    last = name.rsplit("/", 1)[1]
    if "/speedup/" in name:
        return "ratios"
    if "/reduction/" in name:
        return "ranks"
    return OF_CASE.get(last) or OF_RUN[last]


def figures_of(summary):
    """Name → value, e.g. experiment-1/kiln/gnat/field_l2_error_percent. Seconds are not among them; a case that failed has
    no figures."""
    figures = {}
    for experiment, entry in summary["experiments"].items():
        place = f"experiment-{experiment}"
        if "full_order" in entry:
            for key in OF_RUN:
                figures[f"{place}/full-order/{key}"] = entry["full_order"][key]
        for setting, block in entry.items():
            if setting in ("full_order", "report"):
                continue
            for key in OF_REDUCTION:
                if "reduction" in block:
                    figures[f"{place}/{setting}/reduction/{key}"] = block["reduction"][key]
            for case, found in block["cases"].items():
                if found["status"] != "complete":
                    continue
                name = f"{place}/{setting}/{case}"
                method = case.split("-")[0]
                figures.update({f"{name}/{key}": found[key] for key in OF_CASE})
                figures.update({f"{name}/{key}": found[method][key] for key in OF_RUN})
                figures.update({
                    f"{name}/speedup/{key}": found["speedup"][key] for key in ("wall", "cpu")
                    if found["speedup"][key] is not None
                })
    return figures


def failures_of(summary):
    """Name of a case that is not complete → why."""
    return {
        f"experiment-{experiment}/{setting}/{case}": f"{found['status']}: {found['message']}".strip(": ")
        for experiment, entry in summary["experiments"].items()
        for setting, block in entry.items()
        if setting not in ("full_order", "report")
        for case, found in block["cases"].items()
        if found["status"] != "complete"
    }
