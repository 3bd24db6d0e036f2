"""Pictures of source clustering: sampled rows and the clusters of one of them, boxes of clusters, growth, resolution."""

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import patches, pyplot  # noqa: E402


class Clusters:
    """The sampled rows of a reduction of vortices in its first time window, their clusters, and where particles begin."""

    def __init__(self, reduction):
        with h5py.File(reduction) as file:
            group = file["windows/0/clusters"]
            self.rows = group["rows"][:]
            self.row_offsets = group["row_offsets"][:]
            self.row_clusters = group["row_clusters"][:]
            self.member_offsets = group["member_offsets"][:]
            self.members = group["members"][:]
            self.beginning = file["reference"][:]

    def of(self, row):
        """Members of each cluster of a row."""
        numbers = self.row_clusters[self.row_offsets[row] : self.row_offsets[row + 1]]
        return [self.members[self.member_offsets[c] : self.member_offsets[c + 1]] for c in numbers]


def targets(clusters, row, axes):
    places = clusters.beginning
    axes.scatter(*places.T, s=3, c="0.8", label="particles")
    axes.scatter(*places[clusters.rows].T, s=22, c="tab:blue", label="sampled rows")
    target = places[clusters.rows[row]]
    for members in clusters.of(row):
        middle = places[members].mean(axis=0)
        axes.plot(*np.stack([target, middle]).T, c="tab:orange", lw=0.4, zorder=0)
        axes.scatter(*middle, s=4 + 2 * np.sqrt(len(members)), c="tab:orange")
    axes.scatter(*target, s=60, c="tab:red", marker="*", label="one of them, with its clusters", zorder=3)
    axes.set(aspect="equal", xlabel="x in m", ylabel="y in m", title="sampled rows; the clusters of one")
    axes.legend(loc="upper right", fontsize=7)


def boxes(clusters, row, axes):
    places = clusters.beginning
    axes.scatter(*places.T, s=2, c="0.7")
    for members in clusters.of(row):
        low, high = places[members].min(axis=0), places[members].max(axis=0)
        axes.add_patch(patches.Rectangle(low, *(high - low), fill=False, ec="tab:orange", lw=0.8))
    axes.scatter(*places[clusters.rows[row]], s=60, c="tab:red", marker="*", zorder=3)
    axes.set(aspect="equal", xlabel="x in m", ylabel="y in m", title="boxes around the members of its clusters")


def draw_clusters(reduction, path):
    clusters = Clusters(reduction)
    row = len(clusters.rows) // 2
    picture, both = pyplot.subplots(1, 2, figsize=(13, 4.6), layout="constrained")
    targets(clusters, row, both[0])
    boxes(clusters, row, both[1])
    picture.savefig(path, dpi=130)


def draw_growth(rows, path):
    sizes = [row["particles"] for row in rows]
    picture, (speed, time, error) = pyplot.subplots(1, 3, figsize=(13, 3.6), layout="constrained")
    speed.plot(sizes, [row["speedup_wall"] for row in rows], "o-")
    speed.set(xscale="log", yscale="log", xlabel="vortices", title="wall time, direct sum ÷ PTROM")
    time.plot(sizes, [row["online_us_per_step"] for row in rows], "o-", label="PTROM")
    time.set(xscale="log", xlabel="vortices", ylabel="µs a step", title="online time")
    time.set_ylim(bottom=0)
    draw_errors(error, sizes, rows, "vortices")
    picture.savefig(path, dpi=130)


def draw_resolution(found, path):
    rows = found["clusters"]
    numbers = [row["clusters"] for row in rows]
    picture, (speed, error) = pyplot.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    speed.plot(numbers, [row["speedup_wall"] for row in rows], "o-")
    speed.set(xscale="log", yscale="log", xlabel="clusters of a row", title=f"direct sum ÷ PTROM, {found['particles']} vortices")
    draw_errors(error, numbers, rows, "clusters of a row")
    error.axhline(found["gnat"]["positions_error_percent"], c="0.6", ls=":", label="positions, no clusters")
    error.legend(fontsize=7)
    picture.savefig(path, dpi=130)


def draw_errors(axes, along, rows, label):
    for name in ("positions", "centroids", "induced_velocity"):
        axes.plot(along, [row[f"{name}_error_percent"] for row in rows], "o-", label=name.replace("_", " "))
    axes.axhline(0.1, c="k", lw=0.5)
    axes.set(xscale="log", yscale="log", xlabel=label, ylabel="%", title="relative L2 error")
    axes.legend(fontsize=7)


def draw(summary, folder):
    vortex = summary["vortex"]
    draw_clusters(vortex["reduction_file_of_pictures"], folder / "clusters.png")
    draw_growth(vortex["scale"], folder / "growth.png")
    draw_resolution(vortex["over_clusters"], folder / "resolution.png")
