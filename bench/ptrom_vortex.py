"""PTROM of two vortices against the direct sum and against Barnes and Hut's: growth with N, opening, unseen parameters."""

import statistics
import sys

import vortex_errors
from kiln_case import KilnCase

SIZES = (1000, 3000, 10000, 30000)
CORE_RADIUS = 0.15
# Clusters of a row, for the error and the time over how finely sources are resolved.
CLUSTERS = (32, 64, 128, 256)
BARNES_HUT_OPENINGS = (1.2, 0.9, 0.6, 0.45, 0.3)
# The corners that the training of a range learns from, and the points it has not met.
LEARNT = {"circulation_scale": (0.9, 1.1), "kernel.core_radius": (0.14, 0.16)}
UNSEEN = ((0.95, 0.15), (1.0, 0.145), (1.05, 0.155))


def two_vortices(bench, name, particles, *changes):
    return KilnCase(bench, bench.inputs / "vortex/projection-tree.yaml", bench.folder / "ptrom" / name,
                    [f"model.particles.count={particles}", *changes])


def measured(full, reduction, online):
    run, wall, cpu = online
    method = run.report["method"]
    return {
        "full_order_s": full.report["time"]["loop_wall_s"],
        "online_s": wall,
        "online_us_per_step": 1e6 * wall / run.report["run"]["steps"],
        "speedup_wall": full.report["time"]["loop_wall_s"] / wall,
        "speedup_cpu": full.report["time"]["loop_cpu_s"] / cpu,
        "sampled": method["sampled"],
        "sources": method["sources"],
        "pairs": method["pairs"],
        **{f"{name}_error_percent": value
           for name, value in vortex_errors.errors(full, run, reduction, CORE_RADIUS).items()},
    }


def scale(bench):
    """A list over N, and the largest case, for what else is measured on it."""
    cases, fulls, trainings = [], [], []
    for particles in SIZES:
        print(f"bench: ptrom: {particles} vortices", file=sys.stderr)
        case = two_vortices(bench, f"vortex-{particles}", particles)
        fulls.append(case.full_order())
        reduction, training = case.train("training")
        cases.append((case, reduction))
        trainings.append(training)
    # Runs of a few ms: it takes many of them to tell a tenth.
    onlines = KilnCase.online_in_turn(cases, "ptrom", rounds=25)
    rows = []
    for (_, reduction), full, training, online in zip(cases, fulls, trainings, onlines):
        row = {"particles": full.report["method"]["particles"], **measured(full, reduction, online)}
        row["training_in_full_order_runs"] = training / row["full_order_s"]
        row["median_spacings_moved"], row["most_spacings_moved"] = vortex_errors.spacings_moved(full)
        rows.append(row)
    return rows, case, full, reduction


def over_clusters(bench, particles=10000):
    case = two_vortices(bench, "vortex-clusters", particles)
    full = case.full_order()
    reductions = []
    for clusters in CLUSTERS:
        print(f"bench: ptrom: {clusters} clusters a row", file=sys.stderr)
        reductions.append(case.train(f"clusters-{clusters}", f"reduction.clustering.clusters={clusters}")[0])
    online = KilnCase.online_in_turn([(case, reduction) for reduction in reductions], "ptrom")
    rows = [{"clusters": clusters, **measured(full, reduction, each)}
            for clusters, reduction, each in zip(CLUSTERS, reductions, online)]
    reduction = reductions[-1]
    gnat, wall, _ = case.online(reduction, "gnat")
    found = vortex_errors.errors(full, gnat, reduction, CORE_RADIUS)
    return {"particles": particles, "clusters": rows,
            "gnat": {"online_s": wall, **{f"{name}_error_percent": value for name, value in found.items()}}}


def against_barnes_hut(case, full, row):
    """Barnes and Hut's sum in the full model, opened ever narrower until its positions err no more than PTROM's do; if none
    does, `same_error` is false and the ratio a bound from below."""
    tried = []
    for opening in BARNES_HUT_OPENINGS:
        print(f"bench: ptrom: Barnes-Hut, opening {opening}", file=sys.stderr)
        run = case.full_order(f"barnes-hut-{opening}", f"model.sum={{type: barnes-hut, opening: {opening}}}")
        tried.append({"opening": opening, "wall_s": run.report["time"]["loop_wall_s"],
                      "positions_error_percent": vortex_errors.position_error(full, run)})
        if tried[-1]["positions_error_percent"] <= row["positions_error_percent"]:
            break
    return {"tried": tried, "ratio": tried[-1]["wall_s"] / row["online_s"],
            "same_error": tried[-1]["positions_error_percent"] <= row["positions_error_percent"]}


def step_error(bench, particles=3000):
    """What the time step costs the full-order run itself: against half the step."""
    case = two_vortices(bench, "vortex-step", particles)
    full = case.full_order()
    half = case.full_order("half", "time.step=0.01 s", "output.fields.every=100")
    return vortex_errors.position_error(half, full)


def unseen(bench, particles=3000):
    points = ", ".join(f"{name}: [{low}, {high}]" for name, (low, high) in LEARNT.items())
    case = two_vortices(bench, "vortex-unseen", particles)
    print("bench: ptrom: a range of circulations and core radii", file=sys.stderr)
    reduction, _ = case.train("training", f"reduction.train_on={{points: {{{points}}}, grid: true}}",
                              "reduction.basis.rank=14", "reduction.residual_basis.rank=16",
                              "reduction.sampling.samples=28")
    rows = []
    for number, (circulation, radius) in enumerate(UNSEEN):
        point = (f"model.circulation_scale={circulation}", f"model.kernel.core_radius={radius}")
        full = case.full_order(f"full-order-{number}", *point)
        run, wall, _ = case.online(reduction, "ptrom", *point)
        rows.append({"circulation_scale": circulation, "core_radius": radius,
                     "speedup_wall": full.report["time"]["loop_wall_s"] / wall,
                     **{f"{name}_error_percent": value
                        for name, value in vortex_errors.errors(full, run, reduction, radius).items()}})
    return rows


def results(bench):
    rows, case, full, reduction = scale(bench)
    largest = rows[-1]
    found = {
        "speedup_wall": largest["speedup_wall"],
        "speedup_cpu": largest["speedup_cpu"],
        "quantities_error_percent": largest["quantities_error_percent"],
        "positions_error_percent": largest["positions_error_percent"],
        "scale": rows,
        "online_spread": max(row["online_us_per_step"] for row in rows) / min(row["online_us_per_step"] for row in rows),
        "barnes_hut": against_barnes_hut(case, full, largest),
        "over_clusters": over_clusters(bench),
        "full_order_step_error_percent": step_error(bench),
        "unseen": unseen(bench),
        "reduction_file": str(reduction),
        "reduction_file_of_pictures": str(bench.folder / "ptrom/vortex-3000/training/reduction.h5"),
    }
    found["against_barnes_hut"] = found["barnes_hut"]["ratio"]
    found["unseen_error_percent"] = max(row["positions_error_percent"] for row in found["unseen"])
    found["unseen_quantities_error_percent"] = max(row["quantities_error_percent"] for row in found["unseen"])
    found["unseen_median_speedup_wall"] = statistics.median(row["speedup_wall"] for row in found["unseen"])
    return found
