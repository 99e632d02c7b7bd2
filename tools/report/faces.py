# SPDX-License-Identifier: Apache-2.0
"""The rectangles of an OBJ scene, and points on them: where other programs are asked for irradiance."""
import numpy as np


def read_rectangles(path):
    """corner (n,3), u (n,3), v (n,3) of every face; negative indices as the scenes' files have them, and positive ones."""
    points, faces = [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if words and words[0] == "v":
                points.append([float(word) for word in words[1:4]])
            elif words and words[0] == "f":
                if len(words) != 5:
                    raise ValueError(f"{path}: a face of {len(words) - 1} corners; rectangles are needed")
                index = [int(word.split("/")[0]) for word in words[1:]]
                faces.append([len(points) + i if i < 0 else i - 1 for i in index])
    corners = np.array(points)[np.array(faces)]
    corner, u, v = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    if np.abs(corners[:, 2] - corner - u - v).max() > 1e-4:
        raise ValueError(f"{path}: a face is no parallelogram")
    return corner, u, v


def normals(u, v):
    n = np.cross(u, v)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def grid_points(corner, u, v, side, lift):
    """The centres of side x side cells of each rectangle, `lift` m in front: (n, side^2, 3)."""
    s, t = ((cell + 0.5) / side for cell in (np.arange(side * side) % side, np.arange(side * side) // side))
    return (corner + lift * normals(u, v))[:, None] + s[:, None] * u[:, None] + t[:, None] * v[:, None]


def jittered_points(corner, u, v, side, rng, lift):
    """side x side points on each rectangle, one at random in each cell, `lift` m in front: (n, side^2, 3)."""
    cells = (np.arange(side * side) % side, np.arange(side * side) // side)
    s, t = ((cell + rng.random((len(corner), side * side))) / side for cell in cells)
    return (corner + lift * normals(u, v))[:, None] + s[..., None] * u[:, None] + t[..., None] * v[:, None]


def cosine_directions(u, v, side, rng):
    """side x side directions over each rectangle's front, stratified and in random order: (n, side^2, 3)."""
    n, count = normals(u, v), side * side
    order = np.argsort(rng.random((len(n), count)), axis=1)
    a = (order % side + rng.random(order.shape)) / side
    b = (order // side + rng.random(order.shape)) / side
    radius, angle = np.sqrt(a), 2 * np.pi * b
    x = u / np.linalg.norm(u, axis=1, keepdims=True)
    y = np.cross(n, x)
    local = (radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1 - a))
    return sum(part[..., None] * axis[:, None] for part, axis in zip(local, (x, y, n)))
