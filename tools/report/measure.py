# SPDX-License-Identifier: Apache-2.0
"""Measures packs: what they cost, and how far their light is from the reference."""
import math
import re

from methods import BEST, METHODS, SWITCHES
from pack_file import NONE, Pack
from programs import Failed
from scenes import light_arguments
from tables import read_light, judge

LEAST_LINKS, MOST_LINKS = 5.0, 200.0    # per patch: where a curve ends
MOST_STEPS = 12                         # from the default, each way


def predicted_error(text, stats):
    """The error that the bake itself predicts, if it does: a fraction."""
    for key in ("predicted_error", "predicted_rms"):
        if isinstance(stats.get(key), (int, float)):
            return float(stats[key])
    found = re.search(r"predicted error\D*([\d.]+) ?%", text)
    return float(found[1]) / 100 if found else None


def cost_of(pack, stats):
    """Size of a pack and cost of its bake, for the report's JSON."""
    tile = Pack(pack)
    patches, links = stats["patches"], stats["links"]
    faces = tile.source_faces()
    return {"command": stats["command"], "patches": patches, "nodes": stats["nodes"], "links": links,
            "patches_per_face": patches / faces if faces else None,
            "links_per_patch": links / patches, "bake_seconds": stats["process_seconds"],
            "bake_processor_seconds": stats["processor_seconds"], "steps": stats["seconds"],
            "steps_light": stats.get("seconds_light"), "peak_mib": stats["peak_memory_mib"],
            "threshold": stats.get("error_a_link_may_leave"), "closure_defect": stats.get("closure_defect"),
            "predicted_error": predicted_error(stats["text"], stats), "pack_bytes": tile.bytes,
            "bytes_per_patch": tile.bytes / patches, "bytes_per_link": tile.link_bytes() / max(links, 1),
            "linear_senders": tile.linear()}


def own_direct_light(programs, scene, pack, case):
    """A table of the pack's own E_sun and E_sky by rays, for --first-light."""
    key = (Pack(pack).geometry_key(), case)
    if key not in scene.direct:
        table = programs.work / f"{scene.name}.direct-{len(scene.direct)}.csv"
        programs.run("heliopolis-bake", ["reference", pack, *light_arguments(case), "--spp", 4096 if scene.faces else 1024,
                                         "--first-hand", "-o", table])
        scene.direct[key] = table
    return scene.direct[key]


def errors_of(programs, scene, pack, arguments=()):
    """{case: {quantity: figures}} and the solver's sweeps; "A+sky" has the total under sun and sky together."""
    errors, light, solves = {}, {}, {}
    table = programs.work / "table.csv"
    if not scene.faces and "--first-light" not in arguments:
        # The sun raster sees dormers and cornices that the traced patches lack: rays of the same patches for both.
        arguments = [*arguments, "--first-light", "@"]
    for case in scene.cases():
        words = [own_direct_light(programs, scene, pack, case) if word == "@" else word for word in arguments]
        solves[case] = programs.render(pack, [*light_arguments(case), "--table", table, "--per",
                                              "face" if scene.faces else "patch", *words])
        light[case] = read_light(table)
        reference = scene.reference(programs, pack, case)
        figures = {q: judge(light[case], reference, q) for q in ("E_sun", "E_sky", "E_indirect", "E_total")}
        errors[case] = {quantity: f for quantity, f in figures.items() if f}
    if "A" in light and "sky" in light:
        both = scene.reference(programs, pack, "A").plus(scene.reference(programs, pack, "sky"))
        if not scene.faces:
            errors["worst"] = worst_patches(pack, light["A"], scene.reference(programs, pack, "A"))
        errors["A+sky"] = {q: judge(light["A"].plus(light["sky"]), both, q) for q in ("E_indirect", "E_total")}
    return errors, solves


def worst_patches(pack, result, reference, count=12):
    """The patches of a city that hold most of the squared error of E_indirect: where to look."""
    tile = Pack(pack)
    patches, (_, infos, _), rows = tile.patches(), tile.nodes(), tile.links()[0]
    value, (truth, error) = result.value["E_indirect"], reference.get("E_indirect")
    excess = reference.area * ((value - truth).mean(axis=1) ** 2 - error.mean(axis=1) ** 2)
    order = (-excess).argsort()
    return {"share_of_100": float(excess[order[:100]].sum() / excess.sum()),
            "patches": [{"patch": int(i), "share": float(excess[i] / excess.sum()), "area": float(reference.area[i]),
                         "building": -1 if patches["building"][i] == NONE else int(patches["building"][i]),
                         "normal": [round(float(x), 3) for x in patches["normal"][i]],
                         "centroid": [round(float(x), 2) for x in infos["centroid"][i]], "links": int(rows[i + 1] - rows[i]),
                         "here": float(value[i].mean()), "reference": float(truth[i].mean()),
                         "reference_se": float(error[i].mean())} for i in order[:count]]}


def point(programs, scene, arguments, say, bench_repeats=0, render=()):
    """Bakes with these arguments and measures cost and errors."""
    pack = programs.work / f"{scene.name}.pack"
    stats = programs.bake(pack, scene.inputs, arguments)
    result = cost_of(pack, stats)
    result["errors"], result["solves"] = errors_of(programs, scene, pack, render)
    if "worst" in result["errors"]:
        result["worst"] = result["errors"].pop("worst")
    if bench_repeats:
        result["bench"] = programs.bench(pack, bench_repeats)
    shown = ", ".join(f"{case} {100 * e['E_indirect']['rms']:.2f}" for case, e in result["errors"].items()
                      if "E_indirect" in e and case != "A+sky")
    say(f"  {scene.name} {' '.join(str(a) for a in arguments) or '(default)'}: {result['patches']} patches, "
        f"{result['links_per_patch']:.1f} links a patch, {result['bake_seconds']:.1f} s; E_indirect rms % {shown}")
    return result


def walk(measure_at, start, growth):
    """Points from a method's own default outward, in steps that change the links by about `growth`, to LEAST_LINKS and to
    MOST_LINKS or until a bake takes too long. measure_at(threshold): a point, or None at the end."""
    points = [start]
    for direction in (1.0, -1.0):
        last, factor = start, 2.0
        for _ in range(MOST_STEPS):
            links = last["links_per_patch"]
            if not LEAST_LINKS < links < MOST_LINKS and (links > MOST_LINKS) != (direction > 0):
                break
            point_ = measure_at(last["threshold"] * factor ** direction)
            if point_ is None:
                break
            points.append(point_)
            change = abs(math.log(point_["links_per_patch"] / links)) if point_["links_per_patch"] > 0 < links else 0.0
            factor = min(64.0, max(1.2, factor ** (math.log(growth) / max(change, 0.05))))
            last = point_
    return sorted(points, key=lambda p: p["links_per_patch"])


def curve(programs, scene, method, say, options, default):
    """Points of one method on one scene, from few links to many. default: the point of the default bake."""
    def measure_at(threshold):
        arguments = [*method.arguments, *([] if threshold is None else [method.option, f"{threshold:.4g}"])]
        try:
            made = point(programs, scene, arguments, say, bench_repeats=1 if method.name == BEST and scene.faces else 0)
        except Failed as failure:
            say(f"  left out: {failure}")
            return None
        # Too long: the point counts, but is the last one.
        return made if made["bake_seconds"] <= options.longest or threshold is None else None

    if method.values:
        values = method.values[1::2] if options.quick else method.values
        return [made for made in map(measure_at, values) if made]
    start = default if not method.arguments else measure_at(None)
    if start is None:
        return []
    growth = 2.5 if options.quick or not scene.faces else 1.5 if method.name == BEST else 2.0
    return walk(measure_at, start, growth) if start["threshold"] else [start]


def curves(programs, scene, say, options, notes, default):
    """{method: points}, without the methods that this build lacks."""
    result = {}
    for method in METHODS:
        if options.methods and method.name not in options.methods:
            continue
        if (method.scenes and scene.name not in method.scenes) or (not scene.faces and options.quick):
            continue
        lacking = programs.missing("heliopolis-bake", [*method.arguments, method.option])
        if lacking:
            note = f"Method \"{method.name}\" is left out: this build has no {' '.join(lacking)}."
            if note not in notes:
                notes.append(note)
            continue
        say(f"{scene.title}: {method.name}")
        result[method.name] = curve(programs, scene, method, say, options, default)
    return result


def switches(programs, scene, threshold, say, notes):
    """[{name, ...point}]: each source of error set to its reference in turn."""
    rows = []
    say(f"{scene.title}: sources of error")
    for switch in SWITCHES:
        bake = [*switch.bake, *(["--epsilon", (threshold or 0) * switch.finer] if switch.finer else [])]
        if switch.finer and not threshold:
            notes.append(f"Switch \"{switch.name}\" is left out: the bake does not state its threshold.")
            continue
        lacking = programs.missing("heliopolis-bake", bake) + programs.missing("heliopolis-render", switch.render)
        if lacking:
            note = f"Switch \"{switch.name}\" is left out: this build has no {' '.join(lacking)}."
            if note not in notes:
                notes.append(note)
            continue
        try:
            rows.append({"name": switch.name, **point(programs, scene, bake, say, render=switch.render)})
        except Failed as failure:
            notes.append(f"Switch \"{switch.name}\" on {scene.name} failed: {failure}")
    return rows
