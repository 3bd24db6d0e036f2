"""PTROM of SPH heat against GNAT, both from one reduction file: the four experiments, in time windows.

The section `online` has both with one basis for the whole run."""

import sys

from kiln_case import KilnCase
from summary import compare_runs


def compared(case, full, reduction):
    found = {}
    for method in ("gnat", "ptrom"):
        run, wall, cpu = case.online(reduction, method)
        comparison = compare_runs(full, run, reduction)
        found[method] = {
            "online_s": wall,
            "online_cpu_s": cpu,
            "speedup_wall": full.report["time"]["loop_wall_s"] / wall,
            "speedup_cpu": full.report["time"]["loop_cpu_s"] / cpu,
            "worst_probe_error_percent": comparison["worst_probe_error_percent"],
            "field_l2_error_percent": comparison["field_l2_error_percent"],
        }
    gnat, ptrom, method = found["gnat"], found["ptrom"], run.report["method"]
    return {
        **found,
        "sources_ratio": method["sources_ratio"],
        "pairs_ratio": method["pairs_ratio"],
        "time_ratio": gnat["online_s"] / ptrom["online_s"],
        "cpu_time_ratio": gnat["online_cpu_s"] / ptrom["online_cpu_s"],
        "error_ratio": ptrom["worst_probe_error_percent"] / gnat["worst_probe_error_percent"],
        "field_error_ratio": ptrom["field_l2_error_percent"] / gnat["field_l2_error_percent"],
    }


def results(bench):
    found = {}
    for number in (1, 2, 3, 4):
        case = KilnCase(bench, bench.inputs / f"nrl-2022/experiment-{number}.yaml",
                        bench.folder / f"ptrom/heat-{number}")
        full = case.full_order()
        print(f"bench: ptrom: heat, Experiment {number}", file=sys.stderr)
        reduction, _ = case.train("training")
        found[f"experiment_{number}"] = compared(case, full, reduction)
    return found
