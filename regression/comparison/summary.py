#!/usr/bin/python3
"""Compares the full-order and the hyper-reduced run below one output folder: prints the table, writes summary.json.

usage: summary.py FOLDER      FOLDER holds fom/, gnat/ and reduction.h5, as `kiln run` and `kiln train` leave them

Every figure is read from the files of the runs.
"""

import json
import pathlib
import sys

import numpy as np

from run_folder import RunFolder, probe_errors, reconstruct


def ratio(above, below):
    """None where one of them is not known."""
    return None if above is None or below is None else above / below


def run_figures(run):
    """Times are None of a run that was continued: its report knows those of its last part only."""
    report = run.report
    whole = report["run"].get("first_step", 0) == 0
    return {
        "wall_s": report["time"]["loop_wall_s"] if whole else None,
        "cpu_s": report["time"]["loop_cpu_s"] if whole else None,
        "setup_wall_s": report["time"]["setup_wall_s"],
        "ranks": report["provenance"]["ranks"],
        "steps": report["run"]["steps"],
        "residuals_per_step": report["solve"]["residuals_per_step"],
        "iterations_per_step": report["solve"]["iterations_per_step"],
        "peak_kelvin": report["observers"]["extremes"]["temperature"]["largest"],
    }


def field_error(full, reduced, reduction_file):
    """Relative L2 error of T − T0 over all particles and frames, in %."""
    times, _, _, states = full.frames()
    reduced_times, coordinates = reduced.coordinates()
    if not np.array_equal(times, reduced_times):
        raise SystemExit(f"{reduced.folder}: its frames are at other times than those of {full.folder}")
    approximate = reconstruct(reduction_file, coordinates)
    rise = states - states[0]
    return 100 * np.linalg.norm(approximate - states) / np.linalg.norm(rise)


def with_setup(figures):
    return None if figures["wall_s"] is None else figures["wall_s"] + figures["setup_wall_s"]


def full_order_figures(full):
    """What a full-order run says of itself, per pair of neighbours as well."""
    figures = run_figures(full)
    method = full.report["method"]
    pairs = method["model"]["pairs"]
    figures["particles"] = method["particles"]
    figures["neighbours_per_particle"] = pairs / figures["particles"]
    seconds_per_pair = ratio(figures["cpu_s"], full.report["solve"]["residuals"] * pairs)
    figures["ns_cpu_per_pair"] = seconds_per_pair and 1e9 * seconds_per_pair
    return figures


def reduced_figures(reduced, particles):
    """What a reduced run of any method says of itself; hyper-reduced ones tell their sample mesh as well."""
    figures = run_figures(reduced)
    method = reduced.report["method"]
    figures.update(time_windows=method["time_windows"], basis_rank=method["basis_rank"])
    if "sampled" in method:
        figures.update(
            residual_rank=method["residual_rank"],
            sampled=method["sampled"],
            sources=method["sources"],
            touched_percent=100 * method["sources"] / particles,
            held_percent=100 * method["held"] / particles,
            sigma_min=method["sigma_min"],
        )
    return figures


def compare_runs(full, reduced, reduction_file):
    """The figures of a full-order run, of a reduced run of the same case under the name of its method, and what lies
    between them."""
    fom = full_order_figures(full)
    name = reduced.report["run"]["method"]
    figures = reduced_figures(reduced, fom["particles"])
    errors = probe_errors(full, reduced)
    provenance = full.report["provenance"]
    return {
        "title": full.report["run"]["title"],
        "fom": fom,
        name: figures,
        "speedup": {
            "wall": ratio(fom["wall_s"], figures["wall_s"]),
            "cpu": ratio(fom["cpu_s"], figures["cpu_s"]),
            "wall_with_setup": ratio(with_setup(fom), with_setup(figures)),
        },
        "probes": {
            name: {
                "worst_error_percent": float(error["percent"].max()),
                "worst_error_percent_of_rise": float(error["percent_of_rise"].max()),
            }
            for name, error in errors.items()
        },
        "worst_probe_error_percent": float(max(e["percent"].max() for e in errors.values())),
        "worst_probe_error_percent_of_rise": float(max(e["percent_of_rise"].max() for e in errors.values())),
        "field_l2_error_percent": float(field_error(full, reduced, reduction_file)),
        "commit": provenance["commit"],
        "machine": f"{provenance['processor']}, {provenance['cores']} cores",
        "blas": provenance.get("openblas", provenance["blas"]),
        "build_flags": provenance["build_flags"],
    }


def summarise(folder):
    folder = pathlib.Path(folder)
    return compare_runs(RunFolder(folder / "fom"), RunFolder(folder / "gnat"), folder / "reduction.h5")


def table(summary):
    fom, gnat, speedup = summary["fom"], summary["gnat"], summary["speedup"]
    lines = [summary["title"], ""]

    def row(label, a="", b="", c=""):
        lines.append(f"  {label:<44}{a:>14}{b:>14}{c:>14}")

    row("", "full order", "GNAT", "ratio")
    row("wall time of the steps, s", f"{fom['wall_s']:.3f}", f"{gnat['wall_s']:.4f}", f"{speedup['wall']:.0f}x")
    row("CPU time of the steps, all ranks, s", f"{fom['cpu_s']:.3f}", f"{gnat['cpu_s']:.4f}", f"{speedup['cpu']:.0f}x")
    row("set-up before the first step, s", f"{fom['setup_wall_s']:.3f}", f"{gnat['setup_wall_s']:.4f}")
    row("wall time with set-up", c=f"{speedup['wall_with_setup']:.0f}x")
    row("ranks", fom["ranks"], gnat["ranks"])
    row("steps", fom["steps"], gnat["steps"])
    row("residual evaluations a step", f"{fom['residuals_per_step']:.2f}", f"{gnat['residuals_per_step']:.2f}")
    row("iterations a step", f"{fom['iterations_per_step']:.2f}", f"{gnat['iterations_per_step']:.2f}")
    row("CPU time a directed pair, ns", f"{fom['ns_cpu_per_pair']:.2f}")
    row("neighbours a particle", f"{fom['neighbours_per_particle']:.2f}")
    row("highest temperature, K", f"{fom['peak_kelvin']:.1f}", f"{gnat['peak_kelvin']:.1f}")
    row("time windows", "", gnat["time_windows"])
    row("modes M", "", gnat["basis_rank"])
    row("residual modes n_r", "", gnat["residual_rank"])
    row("sampled particles n_p", "", gnat["sampled"])
    row("their sources n_s", "", gnat["sources"])
    row("particles touched in a window, %", "", f"{gnat['touched_percent']:.2f}")
    row("particles held over all windows, %", "", f"{gnat['held_percent']:.2f}")
    row("smallest singular value of PΦ_r", "", f"{gnat['sigma_min']:.3g}")
    lines += ["", "  worst error over all steps                    % of kelvin   % of largest rise of any probe"]
    for name, error in summary["probes"].items():
        lines.append(
            f"  {name:<44}{error['worst_error_percent']:>12.4f}{error['worst_error_percent_of_rise']:>20.4f}"
        )
    lines += [
        f"  {'relative L2 error of T - T0, whole field, %':<44}{summary['field_l2_error_percent']:>12.4f}",
        "",
        f"  {summary['machine']} · {summary['blas']}",
        f"  commit {summary['commit']} · {summary['build_flags']}",
    ]
    return "\n".join(lines)


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    summary = summarise(folder)
    (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    print(table(summary))
    print(f"\n  the same as JSON: {folder / 'summary.json'}")


if __name__ == "__main__":
    main()
