# SPDX-License-Identifier: Apache-2.0
"""Makes a city of towers as an OBJ of one-sided rectangles and a CSV of their surfaces, in the form of tests/data/scenes.

    python3 tools/report/dense_city.py NAME [--blocks 5] [--street 6] [--heights 25,60] [--seed 1]

writes NAME.obj and NAME.csv. The defaults are the dense city of the report: streets of 6 m between towers of 25 to 60 m, whose
walls see little but each other. Plain Python.
"""
import argparse
import random

WALLS = [(0.45, 0.42, 0.38), (0.62, 0.58, 0.50), (0.35, 0.20, 0.16), (0.55, 0.55, 0.55)]
GLASS, ROOF, ASPHALT, PAVING = (0.12, 0.13, 0.15), (0.30, 0.29, 0.28), (0.12, 0.12, 0.12), (0.35, 0.34, 0.32)


class Scene:
    """Rectangles in file order, each with its surface and its place in the hierarchy."""

    def __init__(self):
        self.corners, self.rows = [], []

    def add(self, corner, u, v, kind, place, rho):
        """The rectangle corner, corner + u, corner + u + v, corner + v: counter-clockwise seen from its lit side."""
        moves = ((0, 0), (1, 0), (1, 1), (0, 1))
        self.corners.append([[corner[a] + s * u[a] + t * v[a] for a in range(3)] for s, t in moves])
        self.rows.append((kind, *place, *rho, 0, 0, 0))

    def write(self, name):
        with open(f"{name}.obj", "w", encoding="ascii") as file:
            for face in self.corners:
                for corner in face:
                    file.write("v %.6f %.6f %.6f\n" % tuple(corner))
                file.write("f -4 -3 -2 -1\n")
        with open(f"{name}.csv", "w", encoding="ascii") as file:
            file.write("quad_id,kind,building,facade,floor,bay,rho_r,rho_g,rho_b,emit_r,emit_g,emit_b\n")
            for number, row in enumerate(self.rows):
                file.write(",".join(str(value) for value in (number, *row)) + "\n")


def add_cells(scene, x, y, z, width, depth, cell, kind, place, rho):
    """A horizontal rectangle, lit from above, in cells of about `cell` metres; place = (building, facade)."""
    columns, rows = max(1, round(width / cell)), max(1, round(depth / cell))
    for r in range(rows):
        for c in range(columns):
            scene.add((x + c * width / columns, y + r * depth / rows, z), (width / columns, 0, 0),
                      (0, depth / rows, 0), kind, (*place, r, c), rho)


def add_tower(scene, number, x, y, width, depth, height, rng):
    """Four walls of bays, each a pier, a sill and a window as tall as it, and a roof of cells."""
    wall = rng.choice(WALLS)
    floors = max(1, round(height / 3.5))
    storey = height / floors
    walls = [((x, y), (1, 0), width), ((x + width, y), (0, 1), depth),
             ((x + width, y + depth), (-1, 0), width), ((x, y + depth), (0, -1), depth)]
    for facade, ((x0, y0), (dx, dy), length) in enumerate(walls):
        bays = max(1, round(length / 4.0))
        bay, pier, sill = length / bays, 0.3 * length / bays, 0.3 * storey
        for floor in range(floors):
            z = floor * storey
            for b in range(bays):
                place = (number, facade, floor, b)
                left = (x0 + dx * b * bay, y0 + dy * b * bay, z)
                right = (left[0] + dx * pier, left[1] + dy * pier, z)
                across = (dx * (bay - pier), dy * (bay - pier), 0)
                scene.add(left, (dx * pier, dy * pier, 0), (0, 0, storey), "wall", place, wall)
                scene.add(right, across, (0, 0, sill), "wall", place, wall)
                scene.add((right[0], right[1], z + sill), across, (0, 0, storey - sill), "window", place, GLASS)
    add_cells(scene, x, y, height, width, depth, 4.0, "roof", (number, 4), ROOF)


def make_city(blocks=5, street=6.0, heights=(25.0, 60.0), block=20.0, seed=1):
    """A grid of blocks x blocks towers of block x block m, a street around each and around them all."""
    rng = random.Random(seed)
    scene = Scene()
    pitch, size = block + street, blocks * (block + street) + street
    for j in range(blocks):
        for i in range(blocks):
            add_tower(scene, j * blocks + i, street + i * pitch, street + j * pitch, block, block,
                      rng.uniform(*heights), rng)
    cell = 4.0
    for k in range(blocks + 1):
        # Streets run through in x; those in y are cut where they cross them.
        add_cells(scene, 0, k * pitch, 0, size, street, cell, "ground", (-1, 2 * k), ASPHALT)
        for j in range(blocks):
            add_cells(scene, k * pitch, street + j * pitch, 0, street, block, cell, "ground",
                      (-1, 2 * (blocks + 1) + k * blocks + j), PAVING)
    return scene


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", help="of the files to write, without .obj and .csv")
    parser.add_argument("--blocks", type=int, default=5, help="towers along each side (5)")
    parser.add_argument("--street", type=float, default=6.0, help="width of the streets, m (6)")
    parser.add_argument("--block", type=float, default=20.0, help="side of a tower, m (20)")
    parser.add_argument("--heights", default="25,60", help="least and largest height, m (25,60)")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    low, high = (float(word) for word in options.heights.split(","))
    scene = make_city(options.blocks, options.street, (low, high), options.block, options.seed)
    scene.write(options.name)
    print(f"{options.name}.obj, {options.name}.csv: {len(scene.rows)} rectangles")


if __name__ == "__main__":
    main()
