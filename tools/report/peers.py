# SPDX-License-Identifier: Apache-2.0
"""Mitsuba, Radiance and our own path tracer on the faces of one scene under one sun, beside a bake and its relighting: all in
one run on one machine, so that their ratios mean something."""
import math
import re
import time

import numpy as np

import measure as measuring
from analysis import median, paid_after, sampling_time_at
from faces import read_rectangles
from mitsuba_peer import MitsubaPeer
from pack_file import Pack
from programs import Failed
from radiance_peer import RadiancePeer
from scenes import CASES, light_arguments
from tables import Light, judge, read_light

CASE = "A"
FINER = (0.01, 0.005)  # --error: further points of ours


def judged(scene, reference, sun, indirect):
    light = Light(reference.area)
    if sun is not None:
        light.value["E_sun"] = sun
    light.value["E_indirect"] = indirect
    return {q: judge(light, reference, q) for q in (["E_sun", "E_indirect"] if sun is not None else ["E_indirect"])}


def run_mitsuba(programs, scene, pack, rectangles, reference, to_sun, counts, say):
    folder = programs.work / "mitsuba"
    folder.mkdir(exist_ok=True)
    programs.run("heliopolis-bake", ["export", pack, *light_arguments(CASE), "--points", 1, "--mitsuba",
                                     folder / "scene.xml"])
    peer = MitsubaPeer(folder / "scene.xml", rectangles, to_sun, CASES[CASE][2])
    rows = []
    for count in counts:
        seconds, processor, (sun, indirect) = peer.timed(count, 3 if count <= 256 else 1)
        rows.append({"paths": count, "seconds": median(seconds), "all_seconds": seconds,
                     "processor_seconds": median(processor), "errors": judged(scene, reference, np.repeat(sun[:, None], 3, axis=1), indirect)})
        say(f"  Mitsuba, {count} paths a face: {rows[-1]['seconds']:.2f} s, "
            f"E_indirect rms {100 * rows[-1]['errors']['E_indirect']['rms']:.2f} %")
    return {"version": peer.version, "rows": rows}


def run_radiance(peer, scene, reference, settings, say):
    rows = []
    for side, samples in settings:
        indirect, entry = peer.indirect(side, samples)
        rows.append({"points": side * side, "ad": samples, "seconds": entry["seconds"],
                     "processor_seconds": entry["processor_seconds"], "command": entry["command"],
                     "errors": judged(scene, reference, None, indirect)})
        say(f"  Radiance rtrace, {side * side} points a face, -ad {samples}: {entry['seconds']:.1f} s, "
            f"E_indirect rms {100 * rows[-1]['errors']['E_indirect']['rms']:.2f} %")
    sun, entry = peer.direct(4)
    return {"version": peer.version, "rows": rows, "direct": {"points": 16, "seconds": entry["seconds"],
            "errors": {"E_sun": judge_sun(reference, sun)}}}


def judge_sun(reference, sun):
    light = Light(reference.area)
    light.value["E_sun"] = sun
    return judge(light, reference, "E_sun")


def run_coefficients(peer, scene, reference, sides, say):
    rows = []
    for side in sides:
        matrix, entry = peer.coefficients(side)
        start = time.monotonic()
        indirect, degrees = peer.from_coefficients(matrix)
        multiply = time.monotonic() - start
        rows.append({"rays": side * side, "seconds": entry["seconds"],
                     "processor_seconds": entry["processor_seconds"], "command": entry["command"],
                     "multiply_seconds": multiply, "matrix_mib": matrix.nbytes / 2 ** 20, "degrees_off": degrees,
                     "errors": judged(scene, reference, None, indirect)})
        say(f"  Radiance daylight coefficients, {side * side} rays a face: {entry['seconds']:.1f} s, "
            f"E_indirect rms {100 * rows[-1]['errors']['E_indirect']['rms']:.2f} %")
    return {"rows": rows}


def stated_noise(light, reference):
    """rms of the standard errors that a table states for E_indirect, as a fraction of the mean: what its distance from the
    reference should be."""
    value, area = reference.value["E_indirect"], reference.area
    mean = (area[:, None] * value).sum(axis=0) / area.sum()
    return float((np.sqrt((area[:, None] * light.error["E_indirect"] ** 2).sum(axis=0) / area.sum()) / mean).mean())


def run_own_tracer(programs, scene, pack, reference, counts, say):
    face = Pack(pack).patches()["face"]
    rows = []
    for count in counts:
        table = programs.work / "traced.csv"
        entry = programs.run("heliopolis-bake", ["reference", pack, *light_arguments(CASE), "--spp", count, "--seed", 77,
                                                 "-o", table])
        light = read_light(table).by_face(face, len(reference.area))
        found = re.search(r"rays in ([\d.]+) s", entry["text"])
        rows.append({"paths": count, "seconds": float(found[1]) if found else entry["seconds"],
                     "processor_seconds": entry["processor_seconds"],
                     "stated_noise": stated_noise(light, reference),
                     "errors": {q: judge(light, reference, q) for q in ("E_sun", "E_indirect")}})
        say(f"  heliopolis-bake reference, {count} paths a face: {rows[-1]['seconds']:.2f} s, "
            f"E_indirect rms {100 * rows[-1]['errors']['E_indirect']['rms']:.2f} %")
    return {"rows": rows}


def compare(ours, peers):
    """Ratios at equal error; what is extrapolated is said by `measured` (the smallest error that the peer reached)."""
    error, relight = ours["errors"][CASE]["E_indirect"]["rms"], ours["relight_seconds"]
    table = []
    for name in ("mitsuba", "rtrace", "own tracer"):
        rows = peers.get(name, {}).get("rows")
        if not rows:
            continue
        points = [(row["errors"]["E_indirect"]["rms"], row["seconds"]) for row in rows]
        seconds = sampling_time_at(error, points)
        if seconds:
            table.append({"peer": name, "error": error, "seconds": seconds, "measured": min(e for e, _ in points),
                          "ratio": seconds / relight,
                          "paid_after": paid_after(ours["bake_seconds"], relight, seconds)})
    rows = peers.get("daylight coefficients", {}).get("rows")
    if rows:
        points = [(row["errors"]["E_indirect"]["rms"], row["seconds"]) for row in rows]
        seconds = sampling_time_at(2 * error, points)
        each = median([row["multiply_seconds"] for row in rows]) + peers["rtrace"]["direct"]["seconds"]
        table.append({"peer": "daylight coefficients, precomputation at twice our error", "error": 2 * error,
                      "seconds": seconds, "measured": min(e for e, _ in points),
                      "ratio_of_bake": seconds / ours["bake_seconds"], "seconds_per_sun": each,
                      "paid_after": paid_after(ours["bake_seconds"], relight, each, seconds)})
    return table


def run_all(programs, scene, to_sun, say):
    """Every peer on the scene's faces. One patch a face and no links to speak of: the others get the scene as it is."""
    reference = scene.reference(programs, None, CASE)
    plain, rectangles = programs.work / "plain.pack", read_rectangles(scene.inputs[0])
    programs.bake(plain, scene.inputs, ["--method", "paper", "--epsilon", 1, "--cutoff", 1])
    peers = {}
    try:
        peers["mitsuba"] = run_mitsuba(programs, scene, plain, rectangles, reference, to_sun, (16, 64, 256, 1024), say)
    except (Failed, ImportError, RuntimeError) as failure:
        say(f"  Mitsuba is left out: {failure}")
        peers["mitsuba"] = {"rows": [], "failure": str(failure)}
    folder = programs.work / "radiance"
    programs.run("heliopolis-bake", ["export", plain, *light_arguments(CASE), "--points", 1, "--radiance", folder])
    peer = RadiancePeer(programs, folder, rectangles, to_sun, CASES[CASE][2])
    peers["rtrace"] = run_radiance(peer, scene, reference, ((1, 64), (1, 256), (2, 256)), say)
    peers["daylight coefficients"] = run_coefficients(peer, scene, reference, (4, 8), say)
    peers["own tracer"] = run_own_tracer(programs, scene, plain, reference, (16, 64, 256, 1024), say)
    return peers


def measure(programs, scenes, options, data, say):
    scene = next((s for s in scenes if s.name == ("S" if options.quick else "M")), None) or scenes[0]
    if not scene.given:
        raise ValueError("the peers need scene M, or S with --quick")
    say(f"{scene.title}: other programs on the same faces")
    def point_at(arguments):
        made = measuring.point(programs, scene, arguments, say, bench_repeats=7)
        made["relight_seconds"] = made["bench"]["ms"]["sun change, cold"]["real_time"]["median"] / 1e3
        return made

    # What the others need for an error grows with its square, what we need grows slower: one point does not tell it.
    finer = [] if options.quick else [{"error_asked": error, **point_at(["--error", error])} for error in FINER]
    ours = point_at([])
    azimuth, elevation = (math.radians(angle) for angle in CASES[CASE][:2])
    to_sun = (math.sin(azimuth) * math.cos(elevation), math.cos(azimuth) * math.cos(elevation), math.sin(elevation))
    peers = run_all(programs, scene, to_sun, say)
    # Ours once more: how much the machine changed in between.
    again = programs.bench(programs.work / f"{scene.name}.pack", 7)
    ours["relight_seconds_after"] = again["ms"]["sun change, cold"]["real_time"]["median"] / 1e3
    table = compare(ours, peers)
    for point in finer:
        point["at_equal_error"] = compare(point, peers)
    for row in table + [row for point in finer for row in point["at_equal_error"]]:
        ratio = f"{row['ratio']:.0f} x our relighting" if "ratio" in row else f"{row['ratio_of_bake']:.1f} x our bake"
        say(f"  {row['peer']}: {row['seconds']:.1f} s at {100 * row['error']:.2f} % rms = {ratio}; the bake has paid "
            f"after {row['paid_after']} suns")
    return {"scene": scene.name, "ours": ours, "finer": finer, "peers": peers, "at_equal_error": table}
