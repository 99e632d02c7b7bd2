# SPDX-License-Identifier: Apache-2.0
"""Draws what a sun change and a sweep cost against the number of patches, from files of `heliopolis-bench PACK --json`.

    python3 tools/report/cost_against_size.py OUT_FOLDER A.json B.json ...
"""
import json
import pathlib
import sys

from matplotlib import pyplot as plt

import plots

COLD = "sun change, cold"
SERIES = [(COLD, None, "sun change, from scratch", "#555555", "D"), (COLD, "1 sun raster", "sun raster", "#c17d11", "s"),
          (COLD, "2 histogram", "histogram", "#3a9a5b", "^"), (COLD, "3 gather", "gather, to residual 1e-3", "#1f4e9c", "o"),
          ("sweep, mean of 16", None, "one sweep", "#17a2b8", "v")]


def medians(path):
    """Patches, links, and the median of each case: its time and its counters, ms."""
    report = json.loads(pathlib.Path(path).read_text())
    cases = {}
    for row in report["benchmarks"]:
        if row.get("aggregate_name") == "median":
            cases[row["name"].split("/")[0]] = {None: row["real_time"], **row}
    return int(report["context"]["patches"]), int(report["context"]["links"]), cases


def main(arguments):
    if len(arguments) < 3:
        sys.exit("usage: cost_against_size.py OUT_FOLDER A.json B.json ...: two files or more")
    rows = sorted((medians(path) for path in arguments[1:]), key=lambda row: row[0])
    patches = [row[0] for row in rows]
    figure, axis = plt.subplots(figsize=(6.4, 4.2))
    for case, part, label, colour, marker in SERIES:
        axis.plot(patches, [row[2][case][part] for row in rows], color=colour, marker=marker, label=label)
    sweep = [row[2]["sweep, mean of 16"][None] for row in rows]
    axis.plot(patches, [sweep[0] * n / patches[0] for n in patches], color="#bbbbbb", linestyle="--", label="linear")
    for count, links, cases in rows:
        nanoseconds = 1e6 * cases["sweep, mean of 16"][None] / links
        print(f"{count} patches, {links} links: " + ", ".join(
            f"{label} {cases[case][part]:.1f} ms" for case, part, label, _, _ in SERIES) + f", {nanoseconds:.1f} ns a link")
    folder = pathlib.Path(arguments[0])
    folder.mkdir(parents=True, exist_ok=True)
    plots.save_log_log(figure, axis, "patches", "ms", folder, "cost_against_size")


if __name__ == "__main__":
    main(sys.argv[1:])
