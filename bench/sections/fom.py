"""Full-order residual: its kernels against a plain loop, the machine's limits, two ranks; --instructions."""


def figures(bench):
    result = bench.program("bench_fom", "one")
    result += bench.program("bench_fom", "ranks", ranks=2)
    if bench.options.instructions:
        result += instructions(bench)
    return result


def instructions(bench):
    """Executed instructions a directed pair, by callgrind, which knows AVX2 and no AVX-512: from a build for that."""
    result = []
    for kernel in ("plain", "lattice", "half", "rows"):
        count, pairs = bench.count_instructions("bench_fom", f"count-{kernel}")
        result.append({"name": f"fom.{kernel}.instructions_per_pair", "value": count / pairs, "unit": "",
                       "low": count / pairs, "high": count / pairs, "runs": 1})
    return result
