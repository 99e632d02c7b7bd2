# SPDX-License-Identifier: Apache-2.0
"""Irradiance of rectangles by Mitsuba 3 (llvm): N paths from each, spread over its area and the cosine-weighted half space.

The paths are a loop of our own on Mitsuba's rays and materials: it knows that all surfaces are diffuse and that there is one
sun, and takes half the time at equal error of Mitsuba's `path` integrator, with which it agrees. So the peer is as fast as we
can make it."""
import time

import numpy as np

from faces import normals

MOST_RAYS = 5e6         # first rays of one launch: few launches, and memory of about 1 GiB


class MitsubaPeer:
    """A scene of `heliopolis-bake export --mitsuba`, asked for the irradiance of rectangles under one sun."""

    def __init__(self, scene_file, rectangles, to_sun, dni):
        import drjit as dr
        import mitsuba as mi
        mi.set_variant("llvm_ad_rgb")
        mi.set_log_level(mi.LogLevel.Error)
        self.mi, self.dr, self.dni = mi, dr, dni
        self.version = mi.__version__
        self.scene = mi.load_file(str(scene_file))
        self.sampler = mi.load_dict({"type": "independent"})
        corner, u, v = rectangles
        self.faces = len(corner)
        self.corner, self.u, self.v, self.n = (mi.Vector3f(np.ascontiguousarray(a.T.astype(np.float32)))
                                               for a in (corner, u, v, normals(u, v)))
        self.sun = mi.Vector3f(*to_sun)
        dr.eval(self.corner, self.u, self.v, self.n)

    def _trace(self, ray):
        """Radiance that comes down each ray: sun light after one or more reflections. Roulette from the second surface on."""
        mi, dr, scene, sun = self.mi, self.dr, self.scene, self.sun

        def follow(ray, throughput, radiance, depth, active, sampler):
            hit = scene.ray_intersect(ray, mi.RayFlags.Minimal, False, active)
            active &= hit.is_valid() & (dr.dot(hit.n, ray.d) < 0)
            throughput = dr.select(active, throughput * hit.bsdf(ray).eval_diffuse_reflectance(hit, active), throughput)
            start, cosine = hit.p + 1e-4 * hit.n, dr.dot(hit.n, sun)
            lit = active & (cosine > 0)
            lit &= ~scene.ray_test(mi.Ray3f(start, sun), lit)
            radiance += dr.select(lit, throughput * (cosine * self.dni / dr.pi), 0)
            survival = dr.select(depth >= 1, dr.minimum(dr.max(throughput), 0.95), 1)
            active &= sampler.next_1d(active) < survival
            toward = mi.Frame3f(hit.n).to_world(mi.warp.square_to_cosine_hemisphere(sampler.next_2d(active)))
            return mi.Ray3f(start, toward), throughput / survival, radiance, depth + 1, active, sampler

        state = (ray, mi.Color3f(1), mi.Color3f(0), mi.UInt32(0), mi.Bool(True), self.sampler)
        return dr.while_loop(state, lambda *now: now[4], follow, label="paths")[2]

    def _launch(self, paths, seed):
        mi, dr = self.mi, self.dr
        side = int(round(paths ** 0.5))
        count = self.faces * paths
        # A seed that is opaque to the compiler: every launch is the same kernel.
        seed = dr.opaque(mi.UInt32, seed)
        self.sampler.seed(seed, count)
        index = dr.arange(mi.UInt32, count)
        face = index // paths
        k = index - face * paths
        # Where on the rectangle and in which direction: two stratified squares, in orders that know nothing of each other.
        j = mi.permute_kensler(k, paths, face + seed * 7919)
        where, toward = self.sampler.next_2d(), self.sampler.next_2d()
        where.x, where.y = (mi.Float(k % side) + where.x) / side, (mi.Float(k // side) + where.y) / side
        toward.x, toward.y = (mi.Float(j % side) + toward.x) / side, (mi.Float(j // side) + toward.y) / side
        n = dr.gather(mi.Vector3f, self.n, face)
        point = (dr.gather(mi.Vector3f, self.corner, face) + where.x * dr.gather(mi.Vector3f, self.u, face)
                 + where.y * dr.gather(mi.Vector3f, self.v, face) + 1e-4 * n)
        direction = mi.Frame3f(n).to_world(mi.warp.square_to_cosine_hemisphere(toward))
        radiance = self._trace(mi.Ray3f(point, direction))
        cosine = dr.dot(n, self.sun)
        lit = (cosine > 0) & ~self.scene.ray_test(mi.Ray3f(point, self.sun), cosine > 0)
        sums = [dr.block_reduce(dr.ReduceOp.Add, value, paths) for value in
                (radiance.x, radiance.y, radiance.z, dr.select(lit, cosine, 0))]
        dr.eval(sums)
        dr.sync_thread()
        return [np.array(value) for value in sums]

    def _launch_paths(self, paths):
        """Paths a rectangle of one launch: `paths`, or a quarter of it as often as it takes."""
        while paths > 4 and paths % 4 == 0 and self.faces * paths > MOST_RAYS:
            paths //= 4
        return paths

    def irradiance(self, paths, seed):
        """E_sun (n) and E_indirect (n,3), W/m2."""
        launch = self._launch_paths(paths)
        total = [0.0] * 4
        for number in range(paths // launch):
            total = [a + b for a, b in zip(total, self._launch(launch, seed * 65536 + number))]
        return self.dni * total[3] / paths, np.pi * np.stack(total[:3], axis=1) / paths

    def timed(self, paths, repeats):
        """Seconds and processor seconds of each repetition, and the last one's irradiance; compiling is not counted."""
        for seed in (1, 2):     # the second launch may compile anew: its seed is no longer the first
            self._launch(self._launch_paths(paths), seed)
        seconds, processor = [], []
        for number in range(repeats):
            start, start_processor = time.monotonic(), time.process_time()
            result = self.irradiance(paths, number + 2)
            seconds.append(time.monotonic() - start)
            processor.append(time.process_time() - start_processor)
        return seconds, processor, result
