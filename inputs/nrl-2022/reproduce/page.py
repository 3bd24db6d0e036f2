"""The results page: Markdown and HTML, its figures, and summary.json."""

import datetime
import json

import markdown

import figures
import tables
from results import SETTINGS, SETTING_TITLES
from summary import full_order_figures

STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; display: block; overflow-x: auto; margin: 1em 0; }
th, td { border: 1px solid #ccc; padding: .2em .55em; text-align: right; white-space: nowrap; }
th { background: #f3f3f3; }
img { max-width: 100%; }
code { background: #f3f3f3; padding: 0 .2em; }
"""


def summary_of(results, published):
    """What summary.json holds: experiments.N.SETTING has the keys of the demo's summary of the best GNAT case, and all
    cases; experiments.N.report has the report's figures."""
    experiments = {}
    for experiment in results.experiments:
        entry = {}
        for setting in SETTINGS:
            best = results.best_gnat(experiment, setting)
            block = dict(results.summary(best), case=best.key) if best else {}
            cases = {}
            for case in results.find(experiment, setting):
                found = results.summary(case)
                cases[case.key] = {"status": case.status} | (
                    found | {"over_ranks": over_ranks(results, case)} if found else {"message": case.message}
                )
            entry[setting] = block | {"cases": cases}
            file = results.reduction_file(experiment, setting)
            if file:
                entry[setting]["reduction"] = tables.reduction_figures(file)
        full = results.full_order(experiment)
        if full:
            entry["full_order"] = full_order_figures(full.run) | {"over_ranks": over_ranks(results, full)}
        entry["report"] = published.of_experiment(experiment)
        experiments[str(experiment)] = entry
    return {"provenance": provenance_of(results), "experiments": experiments}


def provenance_of(results):
    """Of the first complete case: what ran on what; empty if none is complete."""
    complete = next((case for case in results.cases if case.complete), None)
    if complete is None:
        return {}
    facts = complete.run.report["provenance"]
    return {
        "commit": ", ".join(sorted({case.run.report["provenance"]["commit"]
                                    for case in results.cases + results.further if case.complete})),
        "date": facts["date"],
        "machine": f"{facts['processor']}, {facts['cores']} cores",
        "ranks": sorted({case.run.report["provenance"]["ranks"]
                         for case in results.cases + results.further if case.complete}),
        "blas": facts.get("openblas") or facts["blas"],
        "build": f"{facts['compiler']}, {facts['build_flags']}",
        **sizes_of(results),
        "libraries": f"Trilinos {facts['trilinos']}, {facts['mpi']}, HDF5 {facts['hdf5']}",
    }


def sizes_of(results):
    """Particles and steps of the full-order runs, or nothing without one."""
    full = next(filter(None, map(results.full_order, results.experiments)), None)
    if full is None:
        return {}
    return {"particles": full.run.report["method"]["particles"], "steps": full.run.report["run"]["steps"]}


def over_ranks(results, case):
    return {str(ranks): {key: times[key] for key in ("wall_s", "cpu_s", "setup_wall_s")}
            for ranks, times in sorted(results.over_ranks(case).items())}


def overview(results, published):
    """Two lines an experiment: what our setting gives beside what the report had."""
    rows = []
    for experiment in results.experiments:
        wall = published.saving("best_wall_time", experiment, "published_case_1")
        cpu = published.saving("best_cpu_hours", experiment, "published_case_1")
        row = {"Exp.": experiment, "wall saving, report": wall["wall"], "CPU saving, report": cpu["cpu"]}
        for method in ("ptrom", "gnat"):
            best = results.best(experiment, "kiln", method)
            ours = {"Kiln": tables.METHOD_TITLES[method]}
            if best:
                summary = results.summary(best)
                ours |= {
                    "wall saving": tables.number(summary["speedup"]["wall"]),
                    "CPU saving": tables.number(summary["speedup"]["cpu"]),
                    "worst probe error, % of K": tables.number(summary["worst_probe_error_percent"]),
                    "% of the largest rise": tables.number(summary["worst_probe_error_percent_of_rise"]),
                    "field L2, %": tables.number(summary["field_l2_error_percent"]),
                }
            else:
                cases = results.find(experiment, "kiln", method)
                ours |= {"wall saving": tables.state(cases[0] if cases else None)}
            rows.append(row | ours)
    return tables.pd.DataFrame(rows).fillna("")


def unfinished(results):
    lines = [f"- `{case.name}`: {tables.state(case)}" for case in results.cases + results.further if not case.complete]
    return "\n".join(lines) or "None: all cases are complete."


class Page:
    """Writes page.md, index.html, figures and summary.json into one folder."""

    def __init__(self, results, published, command, folder):
        self.results, self.published, self.command, self.folder = results, published, command, folder

    def write(self):
        self.folder.mkdir(parents=True, exist_ok=True)
        text = self.markdown()
        (self.folder / "README.md").write_text(text)
        body = markdown.markdown(text, extensions=["tables", "fenced_code"])
        (self.folder / "index.html").write_text(
            f"<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><title>The NRL report reproduced</title>"
            f"<style>{STYLE}</style></head>\n<body>\n{body}\n</body></html>\n"
        )
        summary = summary_of(self.results, self.published)
        (self.folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")

    def provenance(self):
        facts = provenance_of(self.results)
        if not facts:
            return "No case is complete."
        lines = {
            "command": f"`{self.command}`",
            "page written": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
            "first case run": facts["date"],
            "commit": f"`{facts['commit']}`",
            "machine": facts["machine"],
            "ranks": ", ".join(map(str, facts["ranks"])),
            "size": self.size(facts),
            "BLAS": facts["blas"],
            "build": f"`{facts['build']}`",
            "libraries": facts["libraries"],
            "the report's machine": self.published.facts["machine"],
        }
        frame = tables.pd.DataFrame(lines.items(), columns=["", "of these runs"])
        return tables.as_markdown(frame)

    def size(self, facts):
        """Particles and steps; where they are not the report's, that the figures cannot be read beside its own."""
        if "particles" not in facts:
            return "no full-order run is complete"
        size = (facts["particles"], facts["steps"])
        text = f"{size[0]:,} particles, {size[1]:,} steps"
        report = self.published.facts["size"]
        if size == (report["particles"], report["steps"]):
            return text
        return (f"**{text}; the report has {report['particles']:,} and {report['steps']:,}: a smaller study, whose figures "
                "say nothing about the report's**")

    def figure(self, name, title, number=None):
        """Markdown of one figure; `name` None: the runs that it shows are missing."""
        said = f" The report: {self.published.figure(number)}" if number else ""
        if name is None:
            return f"**{title}**: not drawn, its runs are missing.{said}"
        return f"![{title}]({name})\n\n*{title}.*{said}"

    def markdown(self):
        results, published, folder = self.results, self.published, self.folder
        why = published.reasons
        worst = published.facts["worst_probe_error"]
        table = tables.as_markdown
        parts = [
            "# The NRL report reproduced",
            f"The four experiments of {published.facts['title']}, in its own setting (Case 1: 99.9990 %, Case 2: "
            "99.9999 % of the snapshots' energy) and in the one that we advise (Kiln: twenty or more time windows with a "
            "small basis each, and PTROM's clustered sources). All figures are read from the files of the runs; those of the report stand beside them.",
            self.provenance(),
            "## In short",
            table(overview(results, published)),
            "Savings are against the full order on as many ranks. " + why["machines"],
            "## Cases without figures",
            unfinished(results),
            "## Table 2: ranks and sampled particles",
            table(tables.reductions(results, published)),
            "Of several windows the largest. Training is all of it: full order, POD, LSPG run, sampling, trial run. "
            f"{why['ranks']} {why['sources']}",
            "## Errors and times of every case",
            table(tables.accuracy(results)),
            "Probe error: the worst of four probes over all steps, in % of kelvin (Eq. 35) and of the largest rise of "
            "any probe; field L2: relative L2 error of T − T0 over all particles and frames. "
            f"The report: at most {worst['percent']} % of kelvin, in Experiment {worst['experiment']}, Probe "
            f"{worst['probe']}, Case {worst['case']}, tolerance 1e-2. {why['errors']} {why['full_order']}",
            "## Table 4: savings in wall time",
            table(tables.savings(results, published, "best_wall_time")),
            "SWT: saving in wall time (Eq. 33); SCPUH: in CPU hours (Eq. 34); each side on the cores where its wall time "
            f"is least; \"a against b\": ROM on a, full order on b. {why['savings']} {why['core_counts']}",
            "## Table 5: savings in CPU hours",
            table(tables.savings(results, published, "best_cpu_hours")),
            f"As Table 4, each side where its CPU time is least. {why['cpu_hours']}",
            "## Algorithm 1 as printed",
            table(tables.as_printed(results, published)),
            "Product and factorisation in every Gauss–Newton iteration (`method.factors: every iteration`) beside the "
            "factors that are kept until the Jacobian is refreshed.",
            "## Figures",
            self.figure(figures.material_curves(results, folder), "Fig. 2: material properties of 316L", 2),
            "Drawn from the table that the model reads, as it stands in the reduction file. " + why["curves"],
            self.figure(figures.full_order_surface(results, folder), "Fig. 3: full order, heated surface", 3),
            why["time"],
        ]
        for setting in SETTINGS:
            name = figures.reduced_surface(results, folder, setting)
            title = f"Fig. 4: GNAT, {SETTING_TITLES[setting]}; grey particles take no part"
            parts.append(self.figure(name, title, 4 if setting == "published_case_1" else None))
        for experiment in results.experiments:
            name = figures.probe_error_curves(results, folder, experiment)
            title = f"Fig. {4 + experiment}: errors of the probes, Experiment {experiment}"
            parts.append(self.figure(name, title, 4 + experiment))
        for measure, number, label in (("wall_s", 9, "wall time, s"), ("cpu_s", 10, "CPU time, s")):
            name = figures.times_over_cores(results, folder, measure, number, label)
            parts.append(self.figure(name, f"Fig. {number}: {label.split(',')[0]} over cores", number))
        parts.append(why["core_counts"])
        return "\n\n".join(parts) + "\n"
