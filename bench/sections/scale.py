"""Growth of the full order over 9k, 70k and 560k particles, with a picture; asked for by --scale."""
only_on_request = True


def figures(bench):
    result = bench.program("bench_fom", "scale")
    draw({figure["name"]: figure for figure in result}, bench.folder / "scale.png")
    return result


def draw(figures, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    sizes = {"9k": 50 * 25 * 7, "70k": 100 * 50 * 14, "560k": 200 * 100 * 28}
    pairs = [figures[f"scale.fom_ns_per_pair_{name}"] for name in sizes]
    values = [figure["value"] for figure in pairs]
    below = [figure["value"] - figure["low"] for figure in pairs]
    above = [figure["high"] - figure["value"] for figure in pairs]
    figure, (time, memory) = pyplot.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    time.errorbar(list(sizes.values()), values, yerr=[below, above], marker="o", capsize=4)
    time.set(xscale="log", xlabel="particles", ylabel="ns a directed pair", title="one evaluation of the rate")
    time.set_ylim(bottom=0)
    for label, key in (("pair list", "pair_list"), ("lattice", "layout")):
        memory.plot(list(sizes.values()),
                    [figures[f"scale.{key}_bytes_per_particle_{name}"]["value"] for name in sizes], "o-", label=label)
    memory.set(xscale="log", yscale="log", xlabel="particles", ylabel="bytes a particle", title="memory of the pairs")
    memory.legend()
    figure.savefig(path, dpi=130)
