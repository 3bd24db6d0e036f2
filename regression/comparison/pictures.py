#!/usr/bin/python3
"""Draws the pictures of a full-order and a hyper-reduced run below one output folder.

usage: pictures.py FOLDER      FOLDER holds fom/, gnat/ and reduction.h5, as `kiln run` and `kiln train` leave them

surface.png   temperature of the heated surface, full order and reduced, with the sample mesh (the report's Figs. 3, 4)
probes.png    temperature of the probes, full order and reduced, and their error over time (Figs. 5–8)
"""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from run_folder import RunFolder, probe_errors, reconstruct, sample_mesh

PICTURE_TIME = 3.2e-3  # s, the time of the report's Figs. 3 and 4


def top_layer(positions):
    z = positions[:, 2]
    return np.isclose(z, z.max(), atol=1e-9)


def draw_surface(folder, full, reduced):
    times, _, positions, states = full.frames()
    _, coordinates = reduced.coordinates()
    frame = int(np.argmin(np.abs(times - PICTURE_TIME)))
    approximate = reconstruct(folder / "reduction.h5", coordinates[frame : frame + 1])[0]
    rows, sources = sample_mesh(folder / "reduction.h5", times[frame])

    surface = np.flatnonzero(top_layer(positions))
    millimetres = 1e3 * positions
    low, high = states[frame, surface].min(), states[frame, surface].max()
    figure, axes = plt.subplots(3, 1, figsize=(9, 12), sharex=True, layout="constrained")
    for axis, values, title in (
        (axes[0], states[frame], "full order"),
        (axes[1], approximate, "GNAT, whole surface reconstructed"),
    ):
        shown = axis.scatter(
            millimetres[surface, 0], millimetres[surface, 1], c=values[surface], s=9, cmap="jet", vmin=low, vmax=high
        )
        axis.set_title(title)
    active = np.intersect1d(sources, surface)
    axes[2].scatter(millimetres[surface, 0], millimetres[surface, 1], c="0.85", s=9)
    axes[2].scatter(
        millimetres[active, 0], millimetres[active, 1], c=approximate[active], s=9, cmap="jet", vmin=low, vmax=high
    )
    sampled = np.intersect1d(rows, surface)
    axes[2].scatter(
        millimetres[sampled, 0], millimetres[sampled, 1], facecolors="none", edgecolors="black", s=22, linewidths=0.8,
        label=f"sampled on this surface: {len(sampled)} of {len(rows)}",
    )
    axes[2].legend(loc="upper right")
    axes[2].set_title("GNAT's sample mesh; grey particles take no part in the run")
    for axis in axes:
        axis.set_aspect("equal")
        axis.set_ylabel("y, mm")
    axes[-1].set_xlabel("x, mm")
    figure.colorbar(shown, ax=axes, label="temperature, K", shrink=0.6)
    figure.suptitle(f"{full.report['run']['title']}: surface at t = {1e3 * times[frame]:.3g} ms")
    figure.savefig(folder / "surface.png", dpi=110)


def draw_probes(folder, full, reduced):
    full_probes, reduced_probes = full.probes(), reduced.probes()
    errors = probe_errors(full, reduced)
    figure, (temperature, error_axis) = plt.subplots(2, 1, figsize=(9, 9), sharex=True, layout="constrained")
    for index, (column, error) in enumerate(errors.items()):
        colour = f"C{index}"
        name = column.split(" temperature")[0]
        temperature.plot(1e3 * full_probes["time [s]"], full_probes[column], colour, label=f"{name}, full order")
        temperature.plot(
            1e3 * reduced_probes["time [s]"], reduced_probes[column], "k--", linewidth=0.9,
            label="GNAT" if index == 0 else None,
        )
        error_axis.semilogy(1e3 * error["time"][1:], np.maximum(error["percent"][1:], 1e-8), colour, label=name)
    temperature.set_ylabel("temperature, K")
    temperature.legend()
    error_axis.set_ylabel("error, % of kelvin (Eq. 35)")
    error_axis.set_xlabel("time, ms")
    error_axis.grid(alpha=0.3)
    error_axis.legend()
    figure.suptitle(f"{full.report['run']['title']}: probes")
    figure.savefig(folder / "probes.png", dpi=110)


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    full, reduced = RunFolder(folder / "fom"), RunFolder(folder / "gnat")
    draw_surface(folder, full, reduced)
    draw_probes(folder, full, reduced)
    print(f"  pictures: {folder / 'surface.png'}, {folder / 'probes.png'}")


if __name__ == "__main__":
    main()
