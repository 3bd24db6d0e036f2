"""The four experiments, full order against GNAT in windows and with one global basis; training in full-order runs."""
import pathlib
import shutil
import statistics
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "framework/report"))
INPUTS = ROOT / "inputs/nrl-2022"
RUNS = 5
# An online run takes milliseconds: the middle of several stands for one.
ONLINE_RUNS = 5
# One basis for the whole run: the wake of a beam that crosses the whole part (3 and 4) takes more modes.
GLOBAL = {1: (60, 90, 150), 2: (60, 90, 150), 3: (90, 150, 250), 4: (90, 180, 300)}


def global_setting(experiment):
    rank, residual_rank, samples = GLOBAL[experiment]
    return ["reduction.windows.count=1", f"reduction.basis.rank={rank}",
            f"reduction.residual_basis.rank={residual_rank}", f"reduction.sampling.samples={samples}"]


class Experiment:
    """Runs one experiment below build/bench/online, on all cores up to two."""

    def __init__(self, bench, number):
        self.bench = bench
        self.number = number
        self.folder = bench.folder / f"online/experiment-{number}"
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)

    def kiln(self, command, name, *changes):
        """The run folder that `kiln COMMAND` leaves below `name`."""
        words = [word for change in changes for word in ("--set", change)]
        self.bench.run(["mpirun", "-n", "2", str(ROOT / "build/release/kiln"), command,
                        str(INPUTS / f"experiment-{self.number}.yaml"), "--quiet",
                        "--set", f"output.directory={self.folder / name}", *words])
        return self.folder / name

    def full_order(self):
        from run_folder import RunFolder

        return RunFolder(self.kiln("run", "full-order") / "fom")

    def online(self, reduction):
        """The last of several runs, and the middle one's wall and CPU time."""
        from run_folder import RunFolder

        times = []
        for _ in range(ONLINE_RUNS):
            run = RunFolder(self.kiln("run", "online", "method.type=gnat", f"method.file={reduction}") / "gnat")
            times.append((run.report["time"]["loop_wall_s"], run.report["time"]["loop_cpu_s"]))
        return run, statistics.median(wall for wall, _ in times), statistics.median(cpu for _, cpu in times)


def figure(name, values, unit=""):
    return {"name": name, "value": statistics.median(values), "unit": unit, "low": min(values), "high": max(values),
            "runs": len(values)}


def measure(experiment, settings):
    """Figures of the reductions `settings` (name → reduction file), each run after each full-order run."""
    from summary import compare_runs

    wall, cpu = {name: [] for name in settings}, {name: [] for name in settings}
    seconds, comparison = [], {}
    for _ in range(RUNS):
        full = experiment.full_order()
        seconds.append(full.report["time"]["loop_wall_s"])
        for name, reduction in settings.items():
            run, online_wall, online_cpu = experiment.online(reduction)
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
    import json

    result = []
    for number in (1, 2, 3, 4):
        print(f"bench: online: Experiment {number}", file=sys.stderr)
        experiment = Experiment(bench, number)
        windows = experiment.kiln("train", "windows")
        one_basis = experiment.kiln("train", "global", *global_setting(number))
        own, seconds = measure(experiment, {f"online.experiment_{number}": windows / "reduction.h5",
                                            f"online.global.experiment_{number}": one_basis / "reduction.h5"})
        result += own
        result.append(figure(f"online.experiment_{number}.full_order_s", seconds, "s"))
        if number == 1:
            training = json.loads((windows / "training/report.json").read_text())["time"]["total_wall_s"]
            result.append(figure("train.experiment_1.in_fom_runs", [training / value for value in seconds]))
    return result
