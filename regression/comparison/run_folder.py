"""Reads the files of one finished run: report.json, probes.csv and run.h5."""

import json
import pathlib

import h5py
import numpy as np
import pandas as pd


class RunFolder:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.report = json.loads((self.folder / "report.json").read_text())

    def probes(self):
        """One row a sampled step; columns 'step', 'time [s]' and one for each probe and field."""
        return pd.read_csv(self.folder / "probes.csv")

    def frames(self, field="temperature"):
        """Times in s, particle ids, positions in m and the field's values, frame by frame, as written."""
        with h5py.File(self.folder / "run.h5") as run:
            times = run["time"][:]
            written = np.isfinite(times)
            return times[written], run["particle"][:], run["position"][:], run[field][:][written]

    def coordinates(self):
        """Times in s and the reduced coordinates at each frame of run.h5."""
        with h5py.File(self.folder / "run.h5") as run:
            times = run["time"][:]
            written = np.isfinite(times)
            return times[written], run["coordinates"][:][written]


def reconstruct(reduction_file, coordinates):
    """State of every particle from reduced coordinates, u_ref + Σ_w Φ_w û_w over the time windows, frame by frame: a row a
    frame, particle by particle and in each component by component."""
    with h5py.File(reduction_file) as reduction:
        components = int(reduction.attrs["components"])
        state = np.repeat(reduction["reference"][:].reshape(1, -1), len(coordinates), axis=0)
        windows = reduction["windows"]
        first = 0
        for window in sorted(windows, key=int):
            # A particle's row holds mode after mode, in each its components.
            folded = windows[window]["basis/modes"][:]
            modes = folded.reshape(len(folded), -1, components).transpose(0, 2, 1).reshape(components * len(folded), -1)
            state += coordinates[:, first : first + modes.shape[1]] @ modes.T
            first += modes.shape[1]
        return state


def sample_mesh(reduction_file, time):
    """Sampled particles and their sources in the time window that a step ending at `time` (s) lies in."""
    with h5py.File(reduction_file) as reduction:
        windows = reduction["windows"]
        names = sorted(windows, key=int)
        serving = next((w for w in names if time <= windows[w].attrs["end"] * (1 + 1e-9)), names[-1])
        mesh = windows[serving]["sample_mesh"]
        return mesh["rows"][:], mesh["sources"][:]


def probe_errors(full, reduced):
    """For each probe column: errors of `reduced` in % of the full-order kelvin (Eq. 35) and of max(T − T0)
    over all probes and steps."""
    full_probes, reduced_probes = full.probes(), reduced.probes()
    merged = full_probes.merge(reduced_probes, on="step", suffixes=("", " reduced"))
    if len(merged) != len(full_probes) or len(merged) != len(reduced_probes):
        raise SystemExit(f"{reduced.folder}: the probes' steps differ from those of {full.folder}")
    columns = [c for c in full_probes.columns if c not in ("step", "time [s]")]
    start = full_probes.iloc[0]
    rise = max(float((full_probes[c] - start[c]).abs().max()) for c in columns)
    errors = {}
    for column in columns:
        difference = (merged[f"{column} reduced"] - merged[column]).abs()
        errors[column] = {
            "time": merged["time [s]"].to_numpy(),
            "percent": (100 * difference / merged[column].abs()).to_numpy(),
            "percent_of_rise": (100 * difference / rise).to_numpy(),
        }
    return errors
