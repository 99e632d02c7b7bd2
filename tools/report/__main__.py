# SPDX-License-Identifier: Apache-2.0
"""Speed against error: bakes, lights and judges scenes, runs other programs on the same patches, and writes one folder with
report.html, report.json and plots. See README.md beside this file."""
import argparse
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import environment  # noqa: E402
from methods import METHODS  # noqa: E402


def parse():
    parser = argparse.ArgumentParser(prog="python3 tools/report", description=__doc__)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=environment.ROOT / "out" / "report",
                        help="folder to write (out/report)")
    parser.add_argument("--quick", action="store_true", help="small scenes and few points: minutes instead of an hour")
    parser.add_argument("--scenes", type=pathlib.Path,
                        help="folder with M.obj, M.csv, M.json, M.reference.csv and S.suns.csv, M.suns.csv")
    parser.add_argument("--data", type=pathlib.Path,
                        help="folder with prague_bubenec/ and rotterdam_delfshaven/, each with footprints.geojson")
    parser.add_argument("--only", metavar="NAME,...", help="only these scenes: S, M, dense, prague, rotterdam")
    parser.add_argument("--parts", metavar="NAME,...", default="curves,switches,peers,scaling,figures",
                        help="only these parts: curves, switches, peers, scaling, figures; what an earlier run left in the "
                        "output folder's report.json stays for the others")
    parser.add_argument("--methods", metavar="NAME;...", help="only these lines of the curves, as methods.py names them; the "
                        "others stay as an earlier run left them")
    parser.add_argument("--bin", type=pathlib.Path, default=environment.ROOT / "build" / "release" / "bin",
                        help="folder of the programs (build/release/bin)")
    parser.add_argument("--longest", type=float, default=120.0, metavar="SECONDS",
                        help="a curve ends after a bake of this length (120)")
    parser.add_argument("--plots-only", action="store_true", help="draw report.json of the output folder again")
    options = parser.parse_args()
    for name in ("scenes", "data"):
        folder = getattr(options, name)
        if folder and not folder.is_dir():
            parser.error(f"--{name} {folder}: no such folder")
    options.methods = set((options.methods or "").split(";")) - {""}
    unknown = options.methods - {method.name for method in METHODS}
    if unknown:
        parser.error(f"--methods: no {'; '.join(sorted(unknown))}; there are: {'; '.join(m.name for m in METHODS)}")
    lacking = [name for name in ("heliopolis-bake", "heliopolis-render", "heliopolis-bench")
               if not (options.bin / name).exists()]
    if lacking and not options.plots_only:
        parser.error(f"{options.bin} has no {', '.join(lacking)}: build first (tools/build), or name the folder with --bin")
    return options


if __name__ == "__main__":
    chosen = parse()
    environment.enter()
    environment.use_software_driver()
    environment.find_llvm()
    import run  # noqa: E402 needs the packages of the environment
    sys.exit(run.report(chosen))
