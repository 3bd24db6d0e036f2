"""Growth over 9k, 70k and 560k particles: full order (also 1,890k), training, online, with a picture; asked for by --scale."""
import sys

from kiln_case import KilnCase, figure

only_on_request = True
LATTICES = {"9k": (50, 25, 7), "70k": (100, 50, 14), "560k": (200, 100, 28)}
# Only evaluations of the rate are measured there.
LARGER = {"1890k": (300, 150, 42)}
# The first fifth of Experiment 1, in windows as long as the whole one's.
SPAN = ["time.end=0.8 ms", "reduction.windows.count=4", "output.fields.every=200"]


def figures(bench):
    result = bench.program("bench_fom", "scale")
    cases = []
    for name, count in LATTICES.items():
        print(f"bench: scale: training, {name} particles", file=sys.stderr)
        case = KilnCase(bench, bench.inputs / "nrl-2022/experiment-1.yaml", bench.folder / f"scale/{name}",
                        [*SPAN, f"model.particles.count=[{', '.join(map(str, count))}]"])
        reduction, training = case.train("training")
        full = case.full_order()
        steps = full.report["run"]["steps"]
        cases.append((case, reduction))
        result += [figure(f"scale.train_in_fom_runs_{name}", [training / full.report["time"]["loop_wall_s"]]),
                   figure(f"scale.full_order_us_per_step_{name}", [1e6 * full.report["time"]["loop_wall_s"] / steps],
                          "us")]
    rounds = [KilnCase.online_in_turn(cases, "ptrom") for _ in range(5)]
    for number, name in enumerate(LATTICES):
        walls = [each[number][1] for each in rounds]
        result.append(figure(f"scale.online_us_per_step_{name}", [1e6 * wall / steps for wall in walls], "us"))
    draw({each["name"]: each for each in result}, bench.folder / "scale.png")
    return result


def draw(figures, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    def sizes(lattices):
        return [x * y * z for x, y, z in lattices.values()]

    def values(what, lattices=LATTICES):
        return [figures[f"scale.{what}_{name}"]["value"] for name in lattices]

    kernels = LATTICES | LARGER
    pairs = [figures[f"scale.fom_ns_per_pair_{name}"] for name in kernels]
    spread = [[each["value"] - each["low"] for each in pairs], [each["high"] - each["value"] for each in pairs]]
    picture, (rate, memory, step) = pyplot.subplots(1, 3, figsize=(12, 3.4), layout="constrained")
    rate.errorbar(sizes(kernels), values("fom_ns_per_pair", kernels), yerr=spread, marker="o", capsize=4)
    rate.set(xscale="log", xlabel="particles", ylabel="ns a directed pair", title="one evaluation of the rate")
    rate.set_ylim(bottom=0)
    for label, key in (("pair list", "pair_list"), ("lattice", "layout")):
        memory.plot(sizes(kernels), values(f"{key}_bytes_per_particle", kernels), "o-", label=label)
    memory.set(xscale="log", yscale="log", xlabel="particles", ylabel="bytes a particle", title="memory of the pairs")
    memory.legend()
    for label, key in (("full order", "full_order_us_per_step"), ("online", "online_us_per_step")):
        step.plot(sizes(LATTICES), values(key), "o-", label=label)
    step.set(xscale="log", yscale="log", xlabel="particles", ylabel="µs a step", title="a step, two ranks")
    step.legend()
    picture.savefig(path, dpi=130)
