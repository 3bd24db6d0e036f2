"""POD of 70,000 x 1,000 snapshots on one core: Gram matrix, TSQR, randomised."""


def figures(bench):
    return bench.program("bench_pod", "pod")
