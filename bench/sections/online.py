"""The four experiments on two ranks and on one: full order against GNAT and PTROM, in windows and with one basis; training."""
import sys

from kiln_case import KilnCase, figure, global_setting
from summary import compare_runs

RUNS = 5


def measure(case, settings, ranks=2):
    """Figures of `settings` (name → method and reduction file), each run after each full-order run on as many ranks."""
    wall, cpu = {name: [] for name in settings}, {name: [] for name in settings}
    seconds, comparison = [], {}
    for _ in range(RUNS):
        full = case.full_order(ranks=ranks)
        seconds.append(full.report["time"]["loop_wall_s"])
        for name, (method, reduction) in settings.items():
            run, online_wall, online_cpu = case.online(reduction, method, ranks=ranks)
            wall[name].append(seconds[-1] / online_wall)
            cpu[name].append(full.report["time"]["loop_cpu_s"] / online_cpu)
            comparison[name] = compare_runs(full, run, reduction)
    result = []
    for name in settings:
        result += [figure(f"{name}.speedup_wall", wall[name]), figure(f"{name}.speedup_cpu", cpu[name]),
                   figure(f"{name}.worst_probe_error_percent", [comparison[name]["worst_probe_error_percent"]], "%"),
                   figure(f"{name}.field_l2_error_percent", [comparison[name]["field_l2_error_percent"]], "%")]
    return result, seconds


def figures(bench):
    result = []
    for number in (1, 2, 3, 4):
        print(f"bench: online: Experiment {number}", file=sys.stderr)
        case = KilnCase(bench, bench.inputs / f"nrl-2022/experiment-{number}.yaml",
                        bench.folder / f"online/experiment-{number}")
        windows, training = case.train("windows")
        one_basis, _ = case.train("global", *global_setting(number))
        own, seconds = measure(case, {f"online.experiment_{number}": ("ptrom", windows),
                                      f"online.gnat.experiment_{number}": ("gnat", windows),
                                      f"online.global.experiment_{number}": ("ptrom", one_basis),
                                      f"online.global.gnat.experiment_{number}": ("gnat", one_basis)})
        result += own
        result.append(figure(f"online.experiment_{number}.full_order_s", seconds, "s"))
        own, alone = measure(case, {f"online.one_rank.experiment_{number}": ("ptrom", windows),
                                    f"online.one_rank.gnat.experiment_{number}": ("gnat", windows)}, ranks=1)
        result += own
        result.append(figure(f"online.one_rank.experiment_{number}.full_order_s", alone, "s"))
        result.append(figure(f"train.experiment_{number}.in_fom_runs", [training / value for value in seconds]))
    return result
