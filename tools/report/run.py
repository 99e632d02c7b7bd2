# SPDX-License-Identifier: Apache-2.0
"""The whole run: parts in turn, report.json after each step, so that what was measured survives an interruption."""
import json
import shutil
import tempfile
import time
import pathlib

import environment
import figures
import measure
import page
import peers
import scaling
from programs import Failed, Programs
from scenes import all_scenes


class Report:
    """What goes into report.json."""

    def __init__(self, options):
        self.path = options.output / "report.json"
        self.data = {"scenes": {}}
        if self.path.exists():
            self.data = json.loads(self.path.read_text())
        self.data["facts"] = environment.facts()
        self.data["quick"] = options.quick
        self.data.setdefault("notes", {})
        self.start = time.monotonic()

    def save(self, programs):
        self.data["seconds"] = round(time.monotonic() - self.start, 1)
        self.data["commands"] = programs.log
        part = self.path.with_suffix(".part")
        part.write_text(json.dumps(self.data, indent=1) + "\n")
        part.rename(self.path)


def measure_scene(programs, scene, parts, options, report, notes, say):
    entry = report.data["scenes"].setdefault(scene.name, {})
    entry["title"], entry["reference"] = scene.title, scene.reference_name()
    if "curves" in parts:
        say(f"{scene.title}: default")
        entry["default"] = measure.point(programs, scene, [], say, bench_repeats=3 if options.quick else 5)
        kept = entry.get("curves", {}) if options.methods else {}
        entry["curves"] = {**kept, **measure.curves(programs, scene, say, options, notes, entry["default"])}
        report.save(programs)
    if "switches" in parts and (not options.quick or options.only or scene.name == "S"):
        threshold = (entry.get("default") or measure.point(programs, scene, [], say))["threshold"]
        entry["switches"] = measure.switches(programs, scene, threshold, say, notes)
        entry["reference_seconds"] = scene.cost
        report.save(programs)


def report(options):
    options.output.mkdir(parents=True, exist_ok=True)
    result = Report(options)
    if options.plots_only:
        page.write(options.output, result.data)
        return 0
    parts = options.parts.split(",")
    work = pathlib.Path(tempfile.mkdtemp(prefix="heliopolis-report-"))
    programs = Programs(options.bin, work)
    notes = []

    def say(text):
        print(f"[{time.monotonic() - result.start:6.0f} s] {text}", flush=True)

    try:
        scenes = all_scenes(options, work, notes)
        for scene in scenes:
            measure_scene(programs, scene, parts, options, result, notes, say)
        for part, module in (("peers", peers), ("scaling", scaling), ("figures", figures)):
            if part not in parts:
                continue
            try:
                result.data[part] = module.measure(programs, scenes, options, result.data, say)
            except (Failed, ValueError, OSError, ImportError) as failure:
                notes.append(f"Part \"{part}\" was not finished: {failure}")
                say(notes[-1])
            result.save(programs)
        result.data["notes"][",".join(parts)] = notes
        result.save(programs)
        page.write(options.output, result.data)
    finally:
        shutil.rmtree(work, ignore_errors=True)
    say(f"{options.output / 'report.html'}")
    return 0
