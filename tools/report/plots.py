# SPDX-License-Identifier: Apache-2.0
"""The plots of the report, from its JSON alone. Each is written as SVG and PNG."""
import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from links_md import CASE_COLUMN, PROTOTYPE  # noqa: E402
from methods import BEST, METHODS  # noqa: E402

CASE_TITLES = {"A": "sun 150/40", "B": "sun 235/18", "C": "sun 100/62", "sky": "uniform sky"}
COLOURS = dict(zip((method.name for method in METHODS),
                   ("#1f4e9c", "#17a2b8", "#6a51a3", "#9ecae1", "#4fa3d1", "#3a9a5b", "#c17d11", "#b2182b", "#d6604d",
                    "#7f7f7f")))
PEERS = {"mitsuba": ("Mitsuba 3, llvm", "#c17d11", "s"), "rtrace": ("Radiance rtrace", "#b2182b", "^"),
         "own tracer": ("heliopolis-bake reference", "#3a9a5b", "D"),
         "daylight coefficients": ("Radiance daylight coefficients, precomputation", "#7b3294", "v")}
plt.rcParams.update({"font.size": 9, "errorbar.capsize": 2, "axes.grid": True, "grid.alpha": 0.3, "svg.hashsalt": "heliopolis",
                     "axes.spines.top": False, "axes.spines.right": False})


def save(figure, output, name):
    """Writes plots/NAME.svg and plots/NAME.png; returns the name."""
    folder = output / "plots"
    folder.mkdir(exist_ok=True)
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    figure.savefig(folder / f"{name}.png", dpi=130)
    plt.close(figure)
    return name


def plain_numbers(*parts):
    """1, 2, 5, 10 ... on logarithmic axes of a plot."""
    for part in parts:
        part.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
        part.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        part.set_minor_formatter(matplotlib.ticker.NullFormatter())


def save_log_log(figure, axis, x, y, output, name):
    """Finishes a plot with two logarithmic axes of these titles."""
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    plain_numbers(axis.xaxis, axis.yaxis)
    axis.legend(fontsize=8)
    figure.tight_layout()
    return save(figure, output, name)


def rms_points(points, case, x):
    """x, rms, and how far one standard error of the reference's noise reaches below and above, in %."""
    rows = [(x(p), p["errors"][case]["E_indirect"]) for p in points if p["errors"].get(case, {}).get("E_indirect")]
    rows = [(a, f) for a, f in rows if a > 0 and f["rms"] > 0]
    return ([a for a, _ in rows], [100 * f["rms"] for _, f in rows],
            [[100 * (f["rms"] - f["rms_low"]) for _, f in rows], [100 * (f["rms_high"] - f["rms"]) for _, f in rows]])


def error_curves(scene, name, output, x, label, prototype, least=None):
    cases = [case for case in CASE_TITLES if case in scene["default"]["errors"]]
    figure, axes = plt.subplots(1, len(cases), figsize=(3.6 * len(cases), 4.4), sharey=True, squeeze=False)
    for axis, case in zip(axes[0], cases):
        for method, points in scene.get("curves", {}).items():
            xs, ys, bars = rms_points(points, case, x)
            axis.errorbar(xs, ys, yerr=bars, marker="o", markersize=3, linewidth=1.6 if method == BEST else 1.0,
                          capsize=2, color=COLOURS.get(method, "#000000"), label=method)
        xs, ys, bars = rms_points([scene["default"]], case, x)
        axis.errorbar(xs, ys, yerr=bars, marker="*", markersize=12, color=COLOURS[BEST], linestyle="", label="default")
        for style, (title, rows) in zip(("--", ":"), prototype.items()):
            axis.plot([row[0] for row in rows], [row[CASE_COLUMN[case]] for row in rows], style, color="#555555",
                      linewidth=1.2, label=title)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlim(left=least)
        axis.set_xlabel(label)
        axis.set_title(CASE_TITLES[case])
        plain_numbers(axis.xaxis, axis.yaxis)
    axes[0][0].set_ylabel("E_indirect, rms error, % of its mean")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=4, fontsize=8, frameon=False)
    figure.tight_layout(rect=(0, 0.12, 1, 1))
    return save(figure, output, name)


def peer_plot(data, output):
    """Seconds for one sun position against the error of E_indirect, all in one run."""
    figure, axis = plt.subplots(figsize=(7.5, 5))
    for name, (title, colour, marker) in PEERS.items():
        rows = data["peers"].get(name, {}).get("rows", [])
        if rows:
            f = [row["errors"]["E_indirect"] for row in rows]
            axis.errorbar([row["seconds"] for row in rows], [100 * e["rms"] for e in f],
                          yerr=[[100 * (e["rms"] - e["rms_low"]) for e in f], [100 * (e["rms_high"] - e["rms"]) for e in f]],
                          marker=marker, color=colour, linewidth=1, label=title)
    ours = [data["ours"], *data.get("finer", [])]
    rms = [100 * point["errors"]["A"]["E_indirect"]["rms"] for point in ours]
    axis.plot([point["relight_seconds"] for point in ours], rms, "*-", color=COLOURS[BEST], markersize=14, linewidth=1,
              label="Heliopolis: relight")
    axis.plot([point["bake_seconds"] for point in ours], rms, "*-", color=COLOURS[BEST], markersize=14, linewidth=1,
              fillstyle="none", label="Heliopolis: bake, once")
    axis.axhline(rms[0], color=COLOURS[BEST], linewidth=0.6, linestyle=":")
    return save_log_log(figure, axis, "seconds", "E_indirect, rms error, % of its mean", output, "peers")


def switch_plot(scene, name, output):
    rows = scene["switches"]
    cases = [case for case in CASE_TITLES if case in rows[0]["errors"]]
    figure, axis = plt.subplots(figsize=(9.5, 0.45 * len(rows) + 1.6))
    for case, marker in zip(cases, "osD^"):
        f = [row["errors"][case]["E_indirect"] for row in rows]
        axis.errorbar([100 * e["rms"] for e in f], range(len(rows)),
                      xerr=[[100 * (e["rms"] - e["rms_low"]) for e in f], [100 * (e["rms_high"] - e["rms"]) for e in f]],
                      marker=marker, linestyle="", capsize=2, label=CASE_TITLES[case])
    axis.set_yticks(range(len(rows)), [row["name"] for row in rows])
    axis.invert_yaxis()
    axis.set_xscale("log")
    plain_numbers(axis.xaxis)
    axis.set_xlabel("E_indirect, rms error, % of its mean")
    axis.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))
    figure.tight_layout()
    return save(figure, output, name)


def scaling_plot(data, output):
    rows = data["rows"]
    x = [row["patches"] for row in rows]
    figure, axes = plt.subplots(1, 3, figsize=(13, 4))
    for axis, names, unit in ((axes[0], ("bake_seconds", "bake_processor_seconds"), "seconds"),
                              (axes[1], ("peak_mib",), "peak memory of the bake, MiB")):
        for name, marker in zip(names, "os"):
            fit = data["fits"].get(name)
            label = name.replace("_", " ") + (f": patches^{fit['exponent']:.2f}" if fit else "")
            line = axis.plot(x, [row[name] for row in rows], marker, label=label)[0]
            if fit:
                axis.plot(x, [fit["factor"] * value ** fit["exponent"] for value in x], color=line.get_color(),
                          linewidth=0.8)
        axis.set_ylabel(unit)
        axis.legend(fontsize=8)
    axes[2].plot(x, [row["bytes_per_patch"] for row in rows], "o-", label="bytes of the pack per patch")
    axes[2].plot(x, [row["bytes_per_link"] for row in rows], "s-", label="bytes per link")
    axes[2].plot(x, [row["links_per_patch"] for row in rows], "^-", label="links per patch")
    axes[2].legend(fontsize=8)
    for axis in axes:
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("patches")
        plain_numbers(axis.xaxis, axis.yaxis)
    figure.tight_layout()
    return save(figure, output, "scaling")


def prediction_plot(scenes, output):
    """The error that each bake predicted against the one measured; None where no bake predicts."""
    figure, axis = plt.subplots(figsize=(5.5, 5))
    shown = False
    for name, scene in scenes.items():
        points = [scene.get("default"), *scene.get("curves", {}).get(BEST, [])]
        rows = [(p["predicted_error"], max(e["E_indirect"]["rms"] for c, e in p["errors"].items()
                                           if c in CASE_TITLES and "E_indirect" in e))
                for p in points if p and p.get("predicted_error")]
        if rows:
            shown = True
            axis.plot([100 * a for a, _ in rows], [100 * b for _, b in rows], "o", markersize=5, label=name)
    if not shown:
        plt.close(figure)
        return None
    low, high = axis.get_xlim()[0] * 0.5, axis.get_xlim()[1] * 2
    for factor in (0.5, 1, 2):
        axis.plot([low, high], [factor * low, factor * high], color="#888888", linewidth=0.8,
                  linestyle="-" if factor == 1 else ":")
    return save_log_log(figure, axis, "predicted error, %", "measured rms of E_indirect, the worst light, %", output, "prediction")


def convergence_plot(rows, name, output):
    figure, axis = plt.subplots(figsize=(6.5, 4.2))
    x = [row["sweep"] for row in rows]
    axis.plot(x, [row["E_i"] / rows[0]["E_i"] for row in rows], "o-", label="E_i of the paper / E_1")
    axis.plot(x, [row["residual"] for row in rows], "s-", label="residual")
    axis.plot(x, [row["error"] for row in rows], "^-", label="distance of E_indirect from the solution")
    axis.set_yscale("log")
    axis.set_xlabel("sweeps")
    axis.legend(fontsize=8)
    figure.tight_layout()
    return save(figure, output, name)


def draw_all(data, output):
    """Every plot that the data allow: {key: name}, keys as page.py asks for them."""
    made = {}
    for name, scene in data["scenes"].items():
        prototype = PROTOTYPE.get(name, {})
        if scene.get("default") and scene.get("curves"):
            made[f"links:{name}"] = error_curves(scene, f"error_links_{name}", output, lambda p: p["links_per_patch"],
                                                 "links per patch", prototype, least=2.0)
            made[f"bake:{name}"] = error_curves(scene, f"error_bake_{name}", output, lambda p: p["bake_seconds"],
                                                "bake, seconds", {})
        if scene.get("switches"):
            made[f"switches:{name}"] = switch_plot(scene, f"switches_{name}", output)
    if data.get("peers"):
        made["peers"] = peer_plot(data["peers"], output)
    if data.get("scaling", {}).get("rows"):
        made["scaling"] = scaling_plot(data["scaling"], output)
    made["prediction"] = prediction_plot(data["scenes"], output)
    for name, entry in data.get("figures", {}).items():
        made[f"convergence:{name}"] = convergence_plot(entry["convergence"], f"convergence_{name}", output)
    return {key: name for key, name in made.items() if name}
