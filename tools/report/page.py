# SPDX-License-Identifier: Apache-2.0
"""The report's one HTML page, from its JSON."""
from html import escape

import plots
from analysis import curve_at
from links_md import best_of_prototype
from methods import BEST

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:1180px;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;font-size:13px;margin:1em 0}td,th{padding:2px 9px;text-align:right;border-bottom:1px solid #ddd}
td:first-child,th:first-child{text-align:left}img{max-width:100%}h2{border-top:2px solid #1f4e9c;padding-top:.6em;margin-top:2em}
.note{color:#666;font-size:13px}"""
CASES = {**plots.CASE_TITLES, "A+sky": "sun 150/40 and sky"}


def percent(value, digits=2, sign=False):
    return "" if value is None else f"{100 * value:{'+' if sign else ''}.{digits}f}"


def table(head, rows):
    cells = "".join(f"<th>{escape(str(h))}</th>" for h in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(str(c))}</td>" for c in row) + "</tr>" for row in rows)
    return f"<table><tr>{cells}</tr>{body}</table>"


def picture(made, key, caption):
    if key not in made:
        return ""
    name = made[key]
    return (f'<figure><a href="plots/{name}.svg"><img src="plots/{name}.svg" alt="{escape(caption)}"></a>'
            f'<figcaption class="note">{escape(caption)} <a href="plots/{name}.png">PNG</a></figcaption></figure>')


def cost_cells(point):
    ms = point.get("bench", {}).get("ms", {})
    relight, sweep = ms.get("sun change, cold", {}).get("real_time"), ms.get("sweep, mean of 16", {}).get("real_time")
    return [f"{point['bake_seconds']:.2f}", f"{point['bake_processor_seconds']:.2f}", point["patches"],
            f"{point['links_per_patch']:.1f}", f"{point['bytes_per_link']:.1f}", f"{point['bytes_per_patch']:.0f}",
            f"{point['peak_mib']:.0f}", f"{sweep['median']:.2f}" if sweep else "",
            f"{relight['median']:.1f} ({relight['min']:.1f}-{relight['max']:.1f})" if relight else "",
            percent(point.get("predicted_error"))]


COST_HEAD = ["bake, s", "processor, s", "patches", "links/patch", "bytes/link", "pack bytes/patch", "peak, MiB", "sweep, ms",
             "relight, ms (min-max)", "predicted error, %"]


def error_rows(point):
    rows = []
    for case, title in CASES.items():
        for quantity, f in point["errors"].get(case, {}).items():
            if f and not (quantity == "E_total" and case != "A+sky"):
                rows.append([title, quantity, f"{f['mean']:.4g}", percent(f["rms"]),
                             f"{percent(f['rms_low'])}-{percent(f['rms_high'])}", percent(f["bias"], 2, True),
                             percent(f["bias_se"], 3), percent(f["p95"]), percent(f["max"], 1), percent(f["noise"])])
    return rows


ERROR_HEAD = ["light", "quantity", "mean, W/m2", "rms, %", "rms, 1 s.e. of the noise", "bias, %", "+-", "P95, %", "max, %",
              "reference noise, %"]


def beside_prototype(name, scene):
    """Our curve at the prototype's links per patch: where it is worse, and by how much."""
    rows = []
    for case in plots.CASE_TITLES:
        ours = [(p["links_per_patch"], p["errors"][case]["E_indirect"]["rms"])
                for p in scene.get("curves", {}).get(BEST, []) if case in p["errors"]]
        for links, rms in best_of_prototype(name, case):
            here = curve_at(links, ours)
            if here is not None:
                rows.append([plots.CASE_TITLES[case], f"{links:g}", percent(rms), percent(here), f"{here / rms:.2f}"])
    return rows


def summary(scenes):
    """One row a scene: the default bake."""
    rows = []
    for name, scene in scenes.items():
        point = scene.get("default")
        if not point:
            continue
        errors = [point["errors"].get(case, {}).get("E_indirect") for case in plots.CASE_TITLES]
        known = [f for f in errors if f]
        sun = [e["E_sun"]["rms"] for e in point["errors"].values() if e.get("E_sun")]
        total = point["errors"].get("A+sky", {}).get("E_total")
        ms = point.get("bench", {}).get("ms", {}).get("sun change, cold", {}).get("real_time")
        rows.append([name, point["patches"], f"{point['patches_per_face']:.2f}" if point.get("patches_per_face") else "",
                     f"{point['links_per_patch']:.1f}", *(percent(f["rms"]) if f else "" for f in errors),
                     percent(max(known, key=lambda f: abs(f["bias"]))["bias"], 2, True),
                     percent(max(f["p95"] for f in known)), percent(max(sun)) if sun else "",
                     percent(total["rms"]) if total else "", percent(point.get("predicted_error")),
                     f"{point['bake_seconds']:.1f}", f"{ms['median']:.0f}" if ms else ""])
    return table(["default bake of", "patches", "per face", "links/patch", *(f"E_ind rms {c}, %" for c in plots.CASE_TITLES),
                  "worst bias, %", "worst P95, %", "worst E_sun rms, %", "total rms, %", "predicted, %", "bake, s",
                  "relight, ms"], rows)


def scene_section(name, scene, made):
    text = [f"<h2>{escape(scene['title'])}</h2>"]
    if scene.get("default"):
        point = scene["default"]
        text.append(table(COST_HEAD, [cost_cells(point)]))
        text.append(table(ERROR_HEAD, error_rows(point)))
        text.append(f'<p class="note">Reference: {escape(scene["reference"])}. rms has the reference\'s noise subtracted; '
                    "P95 and maximum have not."
                    + ("" if point.get("patches_per_face") else " The sun raster sees the assets (cornices, dormers, balconies), "
                       "the path tracer the patches alone: part of the error of E_sun, and what follows from it in "
                       "E_indirect, is that difference; the last table tells them apart.") + "</p>")
    if scene.get("default", {}).get("worst"):
        worst = scene["default"]["worst"]
        text.append(f"<details><summary>Where it is worst under sun 150/40: 100 patches hold {100 * worst['share_of_100']:.0f} % "
                    "of the squared error</summary>" +
                    table(["patch", "share, %", "area, m2", "building", "normal", "centroid", "links", "here, W/m2",
                           "reference, W/m2", "+-"],
                          [[w["patch"], percent(w["share"], 1), f"{w['area']:.2f}", w["building"],
                            " ".join(f"{x:g}" for x in w["normal"]), " ".join(f"{x:g}" for x in w["centroid"]), w["links"],
                            f"{w['here']:.1f}", f"{w['reference']:.1f}", f"{w['reference_se']:.1f}"]
                           for w in worst["patches"]]) + "</details>")
    text.append(picture(made, f"links:{name}", "Error of E_indirect against links per patch; bars: one standard error of "
                        "what the reference's noise does to the rms."))
    text.append(picture(made, f"bake:{name}", "The same against the seconds of the bake."))
    if scene.get("curves"):
        rows = []
        for method, points in scene["curves"].items():
            for p in points:
                rows.append([method, f"{p['threshold']:.3g}", *cost_cells(p)[:-1],
                             *(percent(p["errors"].get(c, {}).get("E_indirect", {}).get("rms")) for c in plots.CASE_TITLES),
                             percent(p["errors"].get("A", {}).get("E_indirect", {}).get("bias"), 2, True)])
        text.append("<details><summary>All points</summary>" +
                    table(["method", "threshold", *COST_HEAD[:-1], *(f"rms {c}" for c in plots.CASE_TITLES), "bias A"], rows)
                    + "</details>")
    rows = beside_prototype(name, scene)
    if rows:
        text.append("<details><summary>Beside the prototype's curves, at its links per patch</summary>" +
                    table(["light", "links/patch", "prototype, %", "here, %", "here / prototype"], rows) + "</details>")
    if scene.get("switches"):
        text.append("<h3>Each source of error set to its reference</h3>")
        text.append(picture(made, f"switches:{name}", "What the error falls to when one source of it is taken away."))
        rows = [[row["name"], f"{row['links_per_patch']:.1f}", row["patches"],
                 *(f"{percent(row['errors'].get(c, {}).get('E_indirect', {}).get('rms'))} / "
                   f"{percent((row['errors'].get(c, {}).get('E_sun') or row['errors'].get(c, {}).get('E_sky') or {}).get('rms'))}"
                   for c in plots.CASE_TITLES)] for row in scene["switches"]]
        text.append(table(["switch", "links/patch", "patches", *(f"{t}: indirect / direct, %"
                                                                 for t in plots.CASE_TITLES.values())], rows))
    return "".join(text)


def peers_section(data, made):
    ours = data["ours"]
    text = ["<h2>Beside other programs</h2>",
            f"<p>Scene {escape(data['scene'])}, one sun (150/40), the same faces, one after the other in one run. "
            f"Relighting: {1e3 * ours['relight_seconds']:.0f} ms from scratch to residual 1e-3 "
            f"({1e3 * ours.get('relight_seconds_after', 0):.0f} ms when measured again at the end of the run); bake "
            f"{ours['bake_seconds']:.2f} s; E_indirect rms {percent(ours['errors']['A']['E_indirect']['rms'])} %.</p>",
            picture(made, "peers", "Seconds for one sun position against the error of E_indirect.")]
    rows = []
    for name, (title, _, _) in plots.PEERS.items():
        for row in data["peers"].get(name, {}).get("rows", []):
            f = row["errors"]["E_indirect"]
            what = ", ".join(f"{row[key]} {word}" for key, word in (("paths", "paths"), ("points", "points"), ("ad", "-ad"),
                                                                   ("rays", "rays")) if key in row)
            rows.append([title, what, f"{row['seconds']:.2f}", f"{row.get('processor_seconds', 0):.2f}", percent(f["rms"]),
                         percent(f["bias"], 2, True), percent(f["p95"]), percent(f["max"], 0), percent(row.get("stated_noise"))])
    text.append(table(["program", "a face", "seconds", "processor, s", "rms, %", "bias, %", "P95, %", "max, %",
                       "standard error that it states, %"], rows))
    points = [data, *data.get("finer", [])]
    rows = [[row["peer"], percent(row["error"]), f"{row['seconds']:.2f}", percent(row["measured"]),
             f"{row['ratio']:.0f} x relighting" if "ratio" in row else f"{row['ratio_of_bake']:.2f} x bake",
             "never" if row["paid_after"] is None else row["paid_after"]]
            for point in points for row in point["at_equal_error"]]
    text.append(table(["at equal error", "error, %", "seconds", "least error run, %", "ratio",
                       "suns after which the bake has paid"], rows))
    text.append('<p class="note">Seconds at equal error: time x error^2 is one number for plain sampling; it is taken from the '
                "runs within a factor of 4 of the least error, and carried to ours. Where \"least error run\" is above the "
                "error, that is an extrapolation. Compiling and loading are not counted for Mitsuba, oconv not for "
                "Radiance, opening the pack not for us.</p>")
    return "".join(text)


def scaling_section(data, made):
    rows = [[row["patches"], row["buildings"], f"{row['bake_seconds']:.2f}", f"{row['bake_processor_seconds']:.2f}",
             f"{row['patches'] / row['bake_seconds']:.0f}", f"{row['links_per_patch']:.1f}", f"{row['peak_mib']:.0f}",
             f"{row['peak_mib'] * 2 ** 20 / row['patches']:.0f}", f"{row['bytes_per_patch']:.0f}",
             f"{row['bytes_per_link']:.1f}"] for row in data["rows"]]
    fits = ", ".join(f"{name.replace('_', ' ')} ~ patches^{fit['exponent']:.2f}" for name, fit in data["fits"].items())
    return ("<h2>Scaling of the bake</h2>" + f"<p>{escape(data['city'])}. {escape(fits)}.</p>"
            + picture(made, "scaling", "Bake time, peak memory and size against the number of patches.")
            + table(["patches", "buildings", "bake, s", "processor, s", "patches/s", "links/patch", "peak, MiB",
                     "peak bytes/patch", "pack bytes/patch", "bytes/link"], rows))


def figures_section(data, made):
    text = ["<h2>The paper's figures</h2>"]
    for name, entry in data.items():
        made = {**made, f"tree:{name}": entry["tree"], f"drawn:{name}": entry["links"], f"sweeps:{name}": entry["sweeps"]}
        text += [f"<h3>{escape(entry['title'])}</h3>",
                 picture(made, f"tree:{name}", "The light hierarchy of one building: patches of one colour are one node."),
                 picture(made, f"drawn:{name}", "Links of two buildings and the ground around them, between the centroids of "
                         "their nodes: the 400 of each kind that carry most."),
                 picture(made, f"sweeps:{name}", "The picture and E_indirect after 0, 1, 2 and 3 sweeps, at one exposure."),
                 picture(made, f"convergence:{name}", "The paper's measure E_i, the residual, and the distance from the "
                         "solution, by sweep."),
                 table(["sweep", "E_i, W/m2", "residual", "distance from the solution, %"],
                       [[r["sweep"], f"{r['E_i']:.4g}", f"{r['residual']:.3g}", percent(r["error"], 3)]
                        for r in entry["convergence"]])]
    return "".join(text)


def write(output, data):
    made = plots.draw_all(data, output)
    facts = data["facts"]
    first = next((s["default"]["bench"] for s in data["scenes"].values() if s.get("default", {}).get("bench")), {})
    text = ["<!DOCTYPE html><html lang='en'><meta charset='utf-8'><title>Heliopolis: speed against error</title>",
            f"<style>{STYLE}</style><h1>Speed against error</h1>",
            f"<p>Commit {escape(facts['commit'])}{' with uncommitted changes' if facts['uncommitted_changes'] else ''}, "
            f"{escape(facts['processor'])}, {facts['cores']} cores, load average at the start "
            f"{facts['load_average_at_start'][0]:.1f}; {escape(str(first.get('device', '')))}, "
            f"{escape(str(first.get('driver', '')))}{'; quick run' if data.get('quick') else ''}. Errors are deterministic; "
            "times are those of this machine and its load (medians where there are repeats): compare them within one "
            "table only.</p>", summary(data["scenes"])]
    for name, scene in data["scenes"].items():
        text.append(scene_section(name, scene, made))
    if "prediction" in made:
        text.append("<h2>Predicted and measured error</h2>" +
                    picture(made, "prediction", "Within the dotted lines: a factor of two."))
    for part, section in (("peers", peers_section), ("scaling", scaling_section), ("figures", figures_section)):
        if data.get(part):
            text.append(section(data[part], made))
    notes = sorted({note for group in data.get("notes", {}).values() for note in group})
    if notes:
        text.append("<h2>Left out</h2><ul>" + "".join(f"<li>{escape(note)}</li>" for note in notes) + "</ul>")
    (output / "report.html").write_text("".join(text), encoding="utf-8")
