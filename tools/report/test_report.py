# SPDX-License-Identifier: Apache-2.0
"""Tests of the parts that need no package: python3 tools/report/test_report.py"""
import math
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import analysis  # noqa: E402
import dense_city  # noqa: E402
import links_md  # noqa: E402


def vector_area(face):
    a, b, d = face[0], face[1], face[3]
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, d)]
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


class Analysis(unittest.TestCase):
    def test_power_law_is_found(self):
        factor, exponent = analysis.power_fit([1, 10, 100], [3, 3 * 10 ** 1.2, 3 * 100 ** 1.2])
        self.assertAlmostEqual(factor, 3)
        self.assertAlmostEqual(exponent, 1.2)
        with self.assertRaises(ValueError):
            analysis.power_fit([5, 5], [1, 2])

    def test_half_the_error_takes_four_times_as_long(self):
        self.assertAlmostEqual(analysis.sampling_time_at(0.01, [(0.04, 1.0), (0.02, 4.0)]), 16.0)
        # An overhead of the coarse run (error 100 x as large) must not count.
        self.assertAlmostEqual(analysis.sampling_time_at(0.01, [(1.0, 5.0), (0.02, 4.0)]), 16.0)
        self.assertIsNone(analysis.sampling_time_at(0.01, []))

    def test_a_curve_is_read_between_its_points_only(self):
        self.assertAlmostEqual(analysis.curve_at(20, [(10, 4), (40, 1)]), 2)
        self.assertIsNone(analysis.curve_at(41, [(10, 4), (40, 1)]))

    def test_suns_until_the_bake_has_paid(self):
        self.assertEqual(analysis.paid_after(10, 0.1, 1.1), 10)
        self.assertIsNone(analysis.paid_after(10, 1, 0.5))
        self.assertEqual(analysis.paid_after(10, 1, 2, peer_once=20), 0)
        self.assertEqual(analysis.paid_after(10, 1, 0.5, peer_once=20), 0)

    def test_median(self):
        self.assertEqual(analysis.median([3, 1, 2]), 2)
        self.assertEqual(analysis.median([4, 1, 2, 3]), 2.5)

    def test_the_prototypes_best_curve_falls(self):
        for scene in links_md.PROTOTYPE:
            for case in links_md.CASE_COLUMN:
                points = links_md.best_of_prototype(scene, case)
                self.assertGreater(len(points), 3)
                self.assertTrue(all(a[0] < b[0] and a[1] > b[1] for a, b in zip(points, points[1:])))


class DenseCity(unittest.TestCase):
    def test_areas_and_sides(self):
        blocks, street, block = 3, 6.0, 20.0
        scene = dense_city.make_city(blocks=blocks, street=street, block=block, seed=4)
        size = blocks * (block + street) + street
        up = sides = 0.0
        closed = [0.0, 0.0]
        for face, row in zip(scene.corners, scene.rows):
            n = vector_area(face)
            if row[0] in ("ground", "roof"):
                self.assertGreater(n[2], 0)
                up += n[2]
            else:
                self.assertEqual(n[2], 0)
                sides += math.hypot(n[0], n[1])
                closed = [closed[0] + n[0], closed[1] + n[1]]
        # Roofs and ground tile the square; walls look outward and close around each tower.
        self.assertAlmostEqual(up, size ** 2, places=6)
        self.assertAlmostEqual(math.hypot(*closed), 0, places=6)
        heights = {row[1]: face[0][2] for face, row in zip(scene.corners, scene.rows) if row[0] == "roof"}
        self.assertEqual(len(heights), blocks ** 2)
        self.assertTrue(all(25 <= h <= 60 for h in heights.values()))
        self.assertAlmostEqual(sides, sum(4 * block * h for h in heights.values()), places=6)

    def test_walls_look_outward(self):
        scene = dense_city.make_city(blocks=1, seed=1)
        for face, row in zip(scene.corners, scene.rows):
            if row[0] in ("wall", "window"):
                n, centre = vector_area(face), [0.25 * sum(p[a] for p in face) for a in range(2)]
                self.assertTrue(all(6 - 1e-9 <= p[a] <= 26 + 1e-9 for p in face for a in range(2)))
                self.assertGreater(n[0] * (centre[0] - 16.0) + n[1] * (centre[1] - 16.0), 0)

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "city")
            scene = dense_city.make_city(blocks=1)
            scene.write(name)
            with open(name + ".obj", encoding="ascii") as file:
                lines = file.read().splitlines()
            self.assertEqual(sum(line.startswith("v ") for line in lines), 4 * len(scene.rows))
            self.assertEqual(sum(line == "f -4 -3 -2 -1" for line in lines), len(scene.rows))
            with open(name + ".csv", encoding="ascii") as file:
                rows = file.read().splitlines()
            self.assertEqual(len(rows), len(scene.rows) + 1)
            self.assertEqual(len(set(len(row.split(",")) for row in rows)), 1)


if __name__ == "__main__":
    unittest.main()
