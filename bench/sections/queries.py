"""1,000 parameter points of Experiment 1 by PTROM: advanced together against one by one, on one core."""
import time

from kiln_case import figure


def figures(bench):
    folder = bench.folder / "queries"
    file = folder / "reduction.h5"
    experiment = "inputs/nrl-2022/experiment-1.yaml"
    bench.run(["mpirun", "-n", "2", str(bench.kiln), "train", experiment, "--quiet", "--set", f"output.directory={folder}"])
    result = bench.program("bench_queries", "queries", experiment, "ptrom", str(file), "1000")
    return result + runs_of_their_own(bench, experiment, file, result)


def runs_of_their_own(bench, experiment, file, figures):
    """The same by a `kiln run` for each point, which also starts the program and reads the reduction."""
    seconds = []
    for number in range(10):
        start = time.perf_counter()
        bench.run([str(bench.kiln), "run", experiment, "--quiet", "--set", f"output.directory={bench.folder / 'queries'}",
                   "--set", "method.type=ptrom", "--set", f"method.file={file}",
                   "--set", f"model.heat_source.power={38 + 0.4 * number}"])
        seconds.append(time.perf_counter() - start)
    together = next(each["value"] for each in figures if each["name"] == "queries.together_16_us_per_step")
    return [figure("queries.together_vs_runs", [1e6 * each / 1000 / together for each in seconds]),
            figure("queries.run_of_its_own_s", seconds, "s")]
