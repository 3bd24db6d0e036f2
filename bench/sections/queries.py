"""1,000 parameter points of Experiment 1's GNAT: advanced together against one by one, on one core; trains it at first."""


def figures(bench):
    folder = bench.folder / "queries"
    file = folder / "reduction.h5"
    experiment = "inputs/nrl-2022/experiment-1.yaml"
    if not file.exists():
        bench.run(["mpirun", "-n", "2", "build/release/kiln", "train", experiment, "--quiet", "--set",
                   f"output.directory={folder}"])
    return bench.program("bench_queries", "queries", experiment, str(file), "1000")
