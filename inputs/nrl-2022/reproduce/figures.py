"""The report's Figs. 2–10 from the files of the runs; each function writes one PNG and returns its name."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from pictures import PICTURE_TIME, top_layer
from results import METHOD_TITLES, SETTING_TITLES, SETTINGS, material_table
from run_folder import probe_errors, reconstruct, sample_mesh

COLOURS = {"published_case_1": "C0", "published_case_2": "C3", "kiln": "C2"}
DPI = 90


def save(figure, folder, name):
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / name, dpi=DPI, bbox_inches="tight")
    plt.close(figure)
    return name


def material_curves(results, folder):
    """Fig. 2, from the table that the model of the first training read; None if there is none."""
    files = (results.reduction_file(e, s) for e in results.experiments for s in SETTINGS)
    file = next((file for file in files if file), None)
    if file is None:
        return None
    temperature, values = material_table(file)
    shown = temperature <= 4000
    conductivity, heat, density = values[shown].T
    curves = (
        ("conductivity, W/(m K)", conductivity),
        ("specific heat, J/(kg K)", heat),
        ("density, kg/m³", density),
        ("diffusivity, mm²/s", 1e6 * conductivity / (density * heat)),
    )
    figure, axes = plt.subplots(2, 2, figsize=(9, 6), sharex=True, layout="constrained")
    for axis, (label, curve) in zip(axes.flat, curves):
        axis.plot(temperature[shown], curve, "k")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    for axis in axes[1]:
        axis.set_xlabel("temperature, K")
    return save(figure, folder, "figure-2-material.png")


def surface_panels(results, folder, name, title, panel):
    """A panel an experiment: panel(experiment) gives millimetres (n, 2), kelvin (n), grey (n) and a label, or None."""
    rows = (len(results.experiments) + 1) // 2
    figure, axes = plt.subplots(rows, 2, figsize=(11, 3.4 * rows), layout="constrained", squeeze=False)
    for axis, experiment in zip(axes.flat, results.experiments):
        found = panel(experiment)
        axis.set_aspect("equal")
        if found is None:
            axis.set_title(f"Experiment {experiment}: no complete run")
            continue
        millimetres, kelvin, inactive, label = found
        axis.scatter(*millimetres[inactive].T, c="0.82", s=6)
        shown = axis.scatter(*millimetres[~inactive].T, c=kelvin[~inactive], s=6, cmap="jet")
        figure.colorbar(shown, ax=axis, label="K", shrink=0.8)
        axis.set_title(f"Experiment {experiment}{label}")
        axis.set_xlabel("x, mm")
        axis.set_ylabel("y, mm")
    for axis in axes.flat[len(results.experiments) :]:
        axis.set_visible(False)
    figure.suptitle(title)
    return save(figure, folder, name)


def frame_at(times, time=PICTURE_TIME):
    return int(np.argmin(np.abs(times - time)))


def full_order_surface(results, folder):
    """Fig. 3."""

    def panel(experiment):
        full = results.full_order(experiment)
        if full is None:
            return None
        times, _, positions, states = full.run.frames()
        frame = frame_at(times)
        surface = top_layer(positions)
        return (1e3 * positions[surface, :2], states[frame][surface], np.zeros(surface.sum(), bool),
                f", t = {1e3 * times[frame]:.3g} ms")

    return surface_panels(results, folder, "figure-3-full-order.png", "full order, heated surface", panel)


def reduced_surface(results, folder, setting):
    """Fig. 4 of one setting: the particles that take no part are grey."""

    def panel(experiment):
        best, full = results.best_gnat(experiment, setting), results.full_order(experiment)
        if best is None:
            return None
        file = results.reduction_file(experiment, setting)
        times, coordinates = best.run.coordinates()
        frame = frame_at(times)
        _, _, positions, _ = full.run.frames()
        surface = top_layer(positions)
        state = reconstruct(file, coordinates[frame : frame + 1])[0]
        inactive = np.ones(len(positions), bool)
        rows, sources = sample_mesh(file, times[frame])
        inactive[np.union1d(rows, sources)] = False
        return (1e3 * positions[surface, :2], state[surface], inactive[surface],
                f", t = {1e3 * times[frame]:.3g} ms, {best.key}")

    name = f"figure-4-gnat-{setting.replace('_', '-')}.png"
    return surface_panels(results, folder, name, f"GNAT, {SETTING_TITLES[setting]}: heated surface", panel)


def probe_error_curves(results, folder, experiment):
    """Figs. 5–8: Eq. 35 of every probe, GNAT in every setting and tolerance; None without a complete case."""
    full = results.full_order(experiment)
    cases = [case for setting in SETTINGS for case in results.find(experiment, setting, "gnat")
             if case.complete and not case.printed]
    if full is None or not cases:
        return None
    errors = {case: probe_errors(full.run, case.run) for case in cases}
    probes = list(errors[cases[0]])
    figure, axes = plt.subplots(2, (len(probes) + 1) // 2, figsize=(11, 7), sharex=True, layout="constrained",
                                squeeze=False)
    for axis, probe in zip(axes.flat, probes):
        for case in cases:
            error = errors[case][probe]
            label = f"{SETTING_TITLES[case.setting]}, tol {results.tolerance(case)}"
            style = "--" if case.tolerance == "1e-2" else "-"
            axis.semilogy(1e3 * error["time"][1:], np.maximum(error["percent"][1:], 1e-8), style,
                          color=COLOURS[case.setting], linewidth=0.9, label=label)
        axis.set_title(probe.split(" temperature")[0])
        axis.grid(alpha=0.3)
    for axis in axes.flat[len(probes) :]:
        axis.set_visible(False)
    for axis in axes[-1]:
        axis.set_xlabel("time, ms")
    for axis in axes[:, 0]:
        axis.set_ylabel("error, % of kelvin (Eq. 35)")
    axes.flat[0].legend(fontsize="small")
    figure.suptitle(f"Experiment {experiment}: GNAT against full order")
    return save(figure, folder, f"figure-{4 + experiment}-errors-experiment-{experiment}.png")


def times_over_cores(results, folder, measure, number, label):
    """Figs. 9 and 10: full order and GNAT over the numbers of ranks that were measured."""
    rows = (len(results.experiments) + 1) // 2
    figure, axes = plt.subplots(rows, 2, figsize=(11, 3.6 * rows), layout="constrained", squeeze=False)
    everything, machine = set(), "?"
    for axis, experiment in zip(axes.flat, results.experiments):
        cases = results.find(experiment, None, "fom")
        for setting in SETTINGS:
            cases = cases + results.find(experiment, setting)
        for case in cases:
            points = sorted(results.over_ranks(case).items())
            if not points:
                continue
            ranks, values = zip(*((rank, figures[measure]) for rank, figures in points))
            everything.update(ranks)
            colour = "k" if case.setting is None else COLOURS[case.setting]
            machine = case.run.report["provenance"]["cores"]
            marker = "X" if case.printed else {"fom": "o", "ptrom": "D", "gnat": "s", "lspg": "^", "galerkin": "v"}[case.method]
            style = ":" if case.printed else "--" if case.tolerance == "1e-2" else "-"
            words = [METHOD_TITLES[case.method], SETTING_TITLES.get(case.setting, ""), case.tolerance or "",
                     "as printed" if case.printed else ""]
            axis.semilogy(ranks, values, style, marker=marker, color=colour, linewidth=0.9, markersize=5,
                          fillstyle="none" if case.tolerance == "1e-2" else "full", label=" ".join(filter(None, words)))
        axis.set_title(f"Experiment {experiment}")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3, which="both")
    for axis in axes.flat[: len(results.experiments)]:
        axis.set_xticks(sorted(everything) or [1])
        axis.set_xlabel(f"cores used, one rank each; this machine has {machine}")
    for axis in axes.flat[len(results.experiments) :]:
        axis.set_visible(False)
    handles, labels = axes.flat[0].get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=5, fontsize="small")
    return save(figure, folder, f"figure-{number}-{measure.split('_')[0]}-time.png")
