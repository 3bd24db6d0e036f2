"""Source clustering, on vortices and on SPH heat: build/ptrom/summary.json and pictures; asked for by --ptrom."""
import json
import pathlib

import ptrom_heat
import ptrom_pictures
import ptrom_vortex
from kiln_case import figure
from run_folder import RunFolder

only_on_request = True
FOLDER = pathlib.Path("build/ptrom")


def figures(bench):
    FOLDER.mkdir(parents=True, exist_ok=True)
    summary = {"heat": ptrom_heat.results(bench), "vortex": ptrom_vortex.results(bench)}
    summary["machine"] = bench.machine = RunFolder(bench.folder / "ptrom/heat-1/full-order/fom").report["provenance"]
    (FOLDER / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    ptrom_pictures.draw(summary, FOLDER)
    vortex = summary["vortex"]
    result = [figure(f"vortex.{name}", [vortex[name]], "%" if name.endswith("percent") else "")
              for name in ("speedup_wall", "quantities_error_percent", "positions_error_percent", "against_barnes_hut",
                           "unseen_error_percent", "online_spread")]
    for name, found in summary["heat"].items():
        result += [figure(f"heat.{name}.{ratio}", [found[ratio]])
                   for ratio in ("sources_ratio", "time_ratio", "error_ratio")]
    return result
