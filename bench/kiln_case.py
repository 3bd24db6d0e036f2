"""An input that sections of ./dev bench train, run in full order and run reduced, on two ranks if they don't say else."""
import json
import shutil
import statistics

from run_folder import RunFolder

# An online run takes milliseconds: the middle of several stands for one.
ONLINE_RUNS = 5
# One basis for the whole run: the wake of a beam that crosses the whole part (Experiments 3 and 4) takes more modes.
GLOBAL = {
    1: (60, 80, 104, 16),
    2: (60, 90, 120, 24),
    3: (70, 90, 120, 16),
    4: (90, 120, 160, 24),
}


def global_setting(experiment):
    rank, residual_rank, samples, sources = GLOBAL[experiment]
    return ["reduction.windows.count=1", f"reduction.basis.rank={rank}",
            f"reduction.residual_basis.rank={residual_rank}", f"reduction.sampling.samples={samples}",
            f"reduction.clustering={{type: among samples, sources: {sources}}}"]


class KilnCase:
    """Runs of one input with some of its values changed, below a folder of their own."""

    def __init__(self, bench, file, folder, changes=()):
        self.bench = bench
        self.file = file
        self.folder = folder
        self.changes = list(changes)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)

    def kiln(self, command, name, *changes, ranks=2):
        """The run folder that `kiln COMMAND` leaves below `name`."""
        words = [word for change in [*self.changes, *changes] for word in ("--set", change)]
        self.bench.run(["mpirun", "-n", str(ranks), str(self.bench.kiln), command, str(self.file), "--quiet",
                        "--set", f"output.directory={self.folder / name}", *words])
        if not self.bench.machine:
            report = next((self.folder / name).glob("*/report.json"))
            self.bench.machine = json.loads(report.read_text())["provenance"]
        return self.folder / name

    def train(self, name, *changes):
        """The reduction file and the training's wall time in s."""
        folder = self.kiln("train", name, *changes)
        report = json.loads((folder / "training/report.json").read_text())
        return folder / "reduction.h5", report["time"]["total_wall_s"]

    def full_order(self, name="full-order", *changes, ranks=2):
        return RunFolder(self.kiln("run", name, "method.type=fom", *changes, ranks=ranks) / "fom")

    def online(self, reduction, method="gnat", *changes, ranks=2):
        """The last of several runs, and the middle one's wall and CPU time in s."""
        return self.online_in_turn([(self, reduction)], method, *changes, ranks=ranks)[0]

    @staticmethod
    def online_in_turn(cases, method, *changes, ranks=2, rounds=ONLINE_RUNS):
        """Of each pair of case and reduction file what online() tells. They run in turn, so that a machine that is slower
        for a while is so for all."""
        times = [[] for _ in cases]
        runs = [None for _ in cases]
        for _ in range(rounds):
            for number, (case, reduction) in enumerate(cases):
                words = (f"method.type={method}", f"method.file={reduction}", *changes)
                runs[number] = run = RunFolder(case.kiln("run", f"online-{number}", *words, ranks=ranks) / method)
                times[number].append((run.report["time"]["loop_wall_s"], run.report["time"]["loop_cpu_s"]))
        return [(run, statistics.median(wall for wall, _ in each), statistics.median(cpu for _, cpu in each))
                for run, each in zip(runs, times)]


def figure(name, values, unit=""):
    return {"name": name, "value": statistics.median(values), "unit": unit, "low": min(values), "high": max(values),
            "runs": len(values)}
