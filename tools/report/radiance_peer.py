# SPDX-License-Identifier: Apache-2.0
"""Irradiance of rectangles by Radiance: rtrace for one sun, rcontrib's daylight coefficients for all of them."""
import math
import os
import pathlib
import re

import numpy as np

from faces import cosine_directions, grid_points, jittered_points, normals

SOURCE_DEGREES = 0.5
LIFT = 1e-3             # m, of rays from the surface that they start on
# Tregenza's sky: rows of patches from the horizon up.
ROWS = ((6, 30), (18, 30), (30, 24), (42, 24), (54, 18), (66, 12), (78, 6), (90, 1))
RTRACE = ("-ab", 5, "-ad", 256, "-aa", 0, "-as", 0, "-lr", -12, "-lw", 1e-5, "-dt", 0, "-dc", 1, "-dj", 0, "-dv-", "-u+")
RCONTRIB = ("-ab", 6, "-ad", 1, "-lw", 1e-3, "-lr", -12, "-u+", "-aa", 0, "-dt", 0, "-dc", 1, "-dj", 0, "-ds", 0, "-dv-")


def sky_directions():
    """Unit vectors to the centres of the 145 patches."""
    return np.array([(math.sin(a) * math.cos(e), math.cos(a) * math.cos(e), math.sin(e))
                     for elevation, count in ROWS for k in range(count)
                     for e, a in [(math.radians(elevation), 2 * math.pi * k / count)]])


class RadiancePeer:
    """A scene of `heliopolis-bake export --radiance`, asked for the irradiance of rectangles under one sun."""

    def __init__(self, programs, folder, rectangles, to_sun, dni):
        import pyradiance
        root = pathlib.Path(pyradiance.__file__).parent
        self.bin = root / "bin"
        os.environ["RAYPATH"] = str(root / "lib")
        self.programs, self.folder = programs, pathlib.Path(folder)
        self.rectangles, self.to_sun, self.dni = rectangles, np.array(to_sun), dni
        self.cores = os.cpu_count() or 1
        self.rng = np.random.default_rng(1)
        self._take_front_sides()
        self.octree = self.folder / "sun.oct"
        self._run("oconv", [self.folder / "light.rad", self.folder / "scene.rad"], stdout=self.octree)
        self.version = self._run("rtrace", ["-version"])["text"].strip()

    def _run(self, name, arguments, stdin=None, stdout=None):
        return self.programs.run(self.bin / name, arguments, stdin=stdin, stdout=stdout)

    def _take_front_sides(self):
        """Takes out the test which side of a polygon a ray meets: in scenes of closed buildings no ray meets a back, and
        the test costs Radiance more than twice the time."""
        path = self.folder / "scene.rad"
        text = re.sub(r"void mixfunc (m\d+)\n4 \1_front black if\(Rdot,1,0\) \.\n0\n0\n", "", path.read_text())
        path.write_text(re.sub(r"\b(m\d+)_front\b", r"\1", text))

    def _write_rays(self, points, directions):
        path = self.folder / "rays.bin"
        np.concatenate([points, np.broadcast_to(directions, points.shape)], axis=-1).astype("<f4").tofile(path)
        return path

    def _trace(self, side, arguments):
        corner, u, v = self.rectangles
        points = grid_points(corner, u, v, side, LIFT)
        rays = self._write_rays(points, normals(u, v)[:, None])
        result = self.folder / "irradiance.bin"
        entry = self._run("rtrace", ["-I+", "-h", "-fff", "-n", self.cores, *arguments, self.octree], rays, result)
        values = np.fromfile(result, "<f4").reshape(len(corner), side * side, 3).mean(axis=1)
        return values.astype(float), entry

    def direct(self, side):
        """E_sun (n,3) by side x side points, and the log entry."""
        return self._trace(side, ["-ab", 0, *RTRACE[2:]])

    def indirect(self, side, samples):
        """E_indirect (n,3) of side x side points with `samples` rays each; the time is that of sun and bounces together."""
        settings = list(RTRACE)
        settings[3] = samples
        both, entry = self._trace(side, settings)
        return both - self.direct(side)[0], entry

    def coefficients(self, side):
        """Matrix (n, 145, 3) of E_indirect for a source of radiance 1 in each sky patch; side^2 gather rays a rectangle."""
        directions = sky_directions()
        lights, names = self.folder / "patches.rad", self.folder / "patches.txt"
        lights.write_text("".join(
            f"void light d{k}\n0\n0\n3 1 1 1\nd{k} source s{k}\n0\n0\n4 {x:.9f} {y:.9f} {z:.9f} {SOURCE_DEGREES}\n"
            for k, (x, y, z) in enumerate(directions)))
        names.write_text("".join(f"d{k}\n" for k in range(len(directions))))
        octree, result = self.folder / "patches.oct", self.folder / "matrix.bin"
        self._run("oconv", [lights, self.folder / "scene.rad"], stdout=octree)
        corner, u, v = self.rectangles
        points = jittered_points(corner, u, v, side, self.rng, LIFT)
        rays = self._write_rays(points, cosine_directions(u, v, side, self.rng))
        entry = self._run("rcontrib", ["-h", "-fff", "-n", self.cores, "-c", side * side, *RCONTRIB, "-M", names, octree],
                          rays, result)
        matrix = np.fromfile(result, "<f4").reshape(len(corner), len(directions), 3)
        result.unlink()
        return math.pi * matrix, entry

    def from_coefficients(self, matrix):
        """E_indirect under the sun put into the sky patch nearest to it, and how far that is, degrees."""
        cosines = sky_directions() @ self.to_sun
        nearest = int(cosines.argmax())
        radiance = self.dni / (math.pi * math.sin(math.radians(SOURCE_DEGREES / 2)) ** 2)
        return matrix[:, nearest].astype(float) * radiance, math.degrees(math.acos(min(1.0, cosines[nearest])))
