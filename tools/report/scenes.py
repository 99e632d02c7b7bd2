# SPDX-License-Identifier: Apache-2.0
"""The scenes of the report and their references."""
import json
import math
import pathlib

import numpy as np

import dense_city
from environment import ROOT
from pack_file import Pack
from tables import Light, read_csv, read_light

DNI, DHI = 800, 120
# Light cases: the name in tables, azimuth, elevation, DNI, DHI.
CASES = {"A": (150, 40, DNI, 0), "B": (235, 18, DNI, 0), "C": (100, 62, DNI, 0), "sky": (150, 40, 0, DHI)}


def light_arguments(case):
    azimuth, elevation, dni, dhi = CASES[case]
    return ["--sun", f"{azimuth},{elevation}", "--dni", dni, "--dhi", dhi]


class Scene:
    """Something to bake, and what its patches or faces should receive.

    faces: an OBJ scene, judged on the faces of its file whatever patches the bake makes of them. Otherwise a city, judged on
    the patches of each pack, so that packs whose patches differ have references of their own."""

    def __init__(self, name, title, inputs, faces=False, samples=0):
        self.name, self.title, self.inputs, self.faces, self.samples = name, title, inputs, faces, samples
        self.given = {}     # references by case that came with the scene
        self.made = {}      # (geometry, case): reference of our own path tracer
        self.cost = []      # seconds of those
        self.direct = {}    # (geometry, case): table of a pack's own first-hand light by rays

    def reference_name(self):
        return "Mitsuba 3" if self.given else f"heliopolis-bake reference, {self.samples} paths a patch"

    def cases(self):
        return list(self.given) or list(CASES)

    def reference(self, programs, pack, case):
        """The reference of a case for the rows of this pack's tables."""
        if self.given:
            return self.given[case]
        key = ("faces" if self.faces else Pack(pack).geometry_key(), case)
        if key not in self.made:
            table = programs.work / f"{self.name}.reference-{len(self.made)}.csv"
            entry = programs.run("heliopolis-bake", ["reference", pack, *light_arguments(case), "--spp", self.samples,
                                                     "-o", table])
            self.cost.append(entry["seconds"])
            light = read_light(table)
            if self.faces:
                face = Pack(pack).patches()["face"]
                light = light.by_face(face, int(face.max()) + 1)
            self.made[key] = light
        return self.made[key]


def green(columns, name):
    """The standard error of the green channel serves all three."""
    return np.repeat(columns[name][:, None], 3, axis=1)


def colours(columns, name):
    return np.stack([columns[f"{name}_{c}"] for c in "rgb"], axis=1)


def load_given(folder, name):
    """The Mitsuba references of a scene, by case; those of the further suns if their file is there."""
    reference = read_csv(folder / f"{name}.reference.csv")
    area = reference["area"]
    sky_radiance = json.loads((folder / f"{name}.json").read_text())["sky_L"][0]
    sun, sky = Light(area), Light(area)
    sun.value["E_sun"], sun.error["E_sun"] = colours(reference, "sun_dir"), green(reference, "sun_dir_se_g")
    sun.value["E_indirect"], sun.error["E_indirect"] = colours(reference, "sun_ind"), green(reference, "sun_ind_se_g")
    sky.value["E_sky"] = math.pi * sky_radiance * green(reference, "svf")
    sky.error["E_sky"] = math.pi * sky_radiance * green(reference, "svf_se")
    sky.value["E_indirect"], sky.error["E_indirect"] = colours(reference, "sky_ind"), green(reference, "sky_ind_se_g")
    given = {"A": sun}
    suns = folder / f"{name}.suns.csv"
    if suns.exists():
        columns = read_csv(suns)
        for case, prefix in (("B", "el18"), ("C", "el62")):
            light = Light(area)
            light.value["E_sun"] = green(columns, f"{prefix}_sun_dir_g")
            light.value["E_indirect"] = colours(columns, f"{prefix}_sun_ind")
            light.error["E_indirect"] = green(columns, f"{prefix}_sun_ind_se_g")
            given[case] = light
    return {**given, "sky": sky}


def given_scene(folder, name, title):
    folder = pathlib.Path(folder)
    scene = Scene(name, title, [folder / f"{name}.obj", "--surfaces", folder / f"{name}.csv"], faces=True)
    scene.given = load_given(folder, name)
    return scene


def made_scene(work, name, title, samples, **city):
    """A city of dense_city.py."""
    dense_city.make_city(**city).write(str(work / name))
    return Scene(name, title, [work / f"{name}.obj", "--surfaces", work / f"{name}.csv"], faces=True, samples=samples)


def all_scenes(options, work, notes):
    """What the options ask for and the folders have; what is left out is said in notes."""
    own = ROOT / "tests" / "data" / "scenes"
    folder = options.scenes if options.scenes and (options.scenes / "S.suns.csv").exists() else own
    scenes = [given_scene(folder, "S", "S: four buildings, streets of 20 m")]
    if folder == own:
        notes.append("Suns B and C of S are left out: no --scenes FOLDER with S.suns.csv.")
    if options.quick:
        scenes.append(made_scene(work, "dense", "Dense: 2 x 2 towers of 25 to 60 m, streets of 6 m", 4096, blocks=2))
    else:
        if options.scenes and (options.scenes / "M.reference.csv").exists():
            scenes.append(given_scene(options.scenes, "M", "M: grid city of 64 buildings, streets of 20 m"))
        else:
            notes.append("M is left out: no --scenes FOLDER with M.obj, M.csv, M.json, M.reference.csv.")
        scenes.append(made_scene(work, "dense", "Dense: 4 x 4 towers of 25 to 60 m, streets of 6 m", 8192, blocks=4))
    samples = 512 if options.quick else 1024
    prague = options.data and options.data / "prague_bubenec"
    if prague and (prague / "footprints.geojson").exists():
        scenes.append(Scene("prague", "Prague, Bubeneč" + (", a part of it" if options.quick else ""),
                            [prague / "footprints.geojson", "--streets", prague / "streets.geojson", "--height", 18,
                             "--lat", 50.1031, "--lon", 14.4038, "--north", -7.85,
                             *(["--bbox=-110,-38,-10,62"] if options.quick else [])], samples=samples))
    else:
        notes.append("Prague is left out: no --data FOLDER with prague_bubenec/footprints.geojson.")
    rotterdam = options.data and options.data / "rotterdam_delfshaven"
    if rotterdam and (rotterdam / "footprints.geojson").exists():
        scenes.append(Scene("rotterdam", "Rotterdam, Delfshaven, a quarter of " + ("20" if options.quick else "100") + " buildings",
                            [rotterdam / "footprints.geojson", "--lat", 51.9071, "--lon", 4.4560, "--north", -0.7,
                             "--bbox=-155,-22,-75,58" if options.quick else "--bbox=-192,-59,-38,95"], samples=samples))
    else:
        notes.append("Rotterdam is left out: no --data FOLDER with rotterdam_delfshaven/footprints.geojson.")
    wanted = options.only.split(",") if options.only else [scene.name for scene in scenes]
    return [scene for scene in scenes if scene.name in wanted]
