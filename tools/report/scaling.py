# SPDX-License-Identifier: Apache-2.0
"""Time and memory of the bake from 2,000 to 200,000 patches, on grid cities of one kind."""
from analysis import power_fit
from measure import cost_of
from programs import Failed
from scenes import made_scene

CITY = {"street": 20.0, "heights": (8.0, 24.0)}


def measure(programs, scenes, options, data, say):
    say("Scaling")
    rows = []
    for blocks in (2, 3, 4, 6) if options.quick else (2, 3, 4, 6, 10, 14, 20, 23):
        scene = made_scene(programs.work, "grid", "", 0, blocks=blocks, **CITY)
        pack = programs.work / "grid.pack"
        try:
            rows.append({"buildings": blocks ** 2, **cost_of(pack, programs.bake(pack, scene.inputs, []))})
        except Failed as failure:
            say(f"  {blocks} x {blocks} buildings failed: {failure}")
            break
        row = rows[-1]
        say(f"  {row['patches']} patches: {row['bake_seconds']:.1f} s ({row['bake_processor_seconds']:.1f} s of processor "
            f"time), {row['links_per_patch']:.1f} links a patch, {row['peak_mib']:.0f} MiB")
        if row["bake_seconds"] > 5 * options.longest:
            break
    fits = {}
    for name in ("bake_seconds", "bake_processor_seconds", "peak_mib", "links"):
        if len(rows) >= 2:
            factor, exponent = power_fit([row["patches"] for row in rows], [row[name] for row in rows])
            fits[name] = {"factor": factor, "exponent": exponent}
    if fits:
        say(f"  bake time grows as patches^{fits['bake_seconds']['exponent']:.2f}")
    return {"city": f"grid of towers of 20 m, streets of {CITY['street']} m, heights {CITY['heights']} m",
            "rows": rows, "fits": fits}
