# SPDX-License-Identifier: Apache-2.0
"""Draws the patches of a pack in parallel projection: the tree's levels, the links between nodes."""
import math

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402

from pack_file import NONE  # noqa: E402


class View:
    """Parallel projection towards the south-west corner from above."""

    def __init__(self, azimuth=215.0, elevation=35.0):
        a, e = math.radians(azimuth), math.radians(elevation)
        self.toward = np.array([math.sin(a) * math.cos(e), math.cos(a) * math.cos(e), math.sin(e)])
        self.right = np.array([-math.cos(a), math.sin(a), 0.0])
        self.up = np.cross(self.toward, self.right)

    def flat(self, points):
        return np.stack([points @ self.right, points @ self.up], axis=-1)


class Leaves:
    """Outlines of a pack's patches, and the tree above them."""

    def __init__(self, pack):
        self.patches = pack.patches()
        self.nodes, self.infos, self.children = pack.nodes()
        self.rows, self.rings, self.points = pack.outline()

    def outline(self, patch):
        """The rings of a patch that are no holes."""
        result = []
        for ring in range(self.rows[patch], self.rows[patch + 1]):
            if self.rings[ring] % 2 == 0:
                result.append(self.points[self.rings[ring] // 2:self.rings[ring + 1] // 2])
        return result

    def depth_chain(self, node, stop):
        """The node and its ancestors up to, without, those of other buildings."""
        chain = [node]
        while self.nodes["parent"][chain[-1]] != NONE and self.infos["building"][self.nodes["parent"][chain[-1]]] == stop:
            chain.append(int(self.nodes["parent"][chain[-1]]))
        return chain[::-1]


def draw_patches(axes, leaves, view, chosen, colours, edge="#00000040"):
    """The chosen patches that face the viewer, far ones first."""
    normal = leaves.patches["normal"][chosen]
    front = normal @ view.toward > 1e-6
    shown = np.asarray(chosen)[front]
    depth = leaves.infos["centroid"][shown] @ view.toward
    order = np.argsort(depth)
    polygons, faces = [], []
    for k in order:
        for ring in leaves.outline(shown[k]):
            polygons.append(view.flat(ring))
            faces.append(np.asarray(colours)[front][k])
    axes.add_collection(PolyCollection(polygons, facecolors=faces, edgecolors=edge, linewidths=0.2))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")


def shuffled_colours(keys):
    """A colour for each key, far apart for keys that are neighbours."""
    _, index = np.unique(keys, return_inverse=True)
    hue = (index * 0.61803398875) % 1.0
    light = 0.75 + 0.2 * ((index * 0.38196601125) % 1.0)
    return matplotlib.colors.hsv_to_rgb(np.stack([hue, np.full_like(hue, 0.45), light], axis=1))


def typical_building(leaves):
    """The building with the median number of patches."""
    numbers, counts = np.unique(leaves.patches["building"][leaves.patches["building"] != NONE], return_counts=True)
    return int(numbers[np.argsort(counts)[len(counts) // 2]])


def tree_figure(leaves, building):
    """The levels of a building's tree: patches of one colour belong to one node."""
    chosen = np.flatnonzero(leaves.patches["building"] == building)
    chains = [leaves.depth_chain(int(patch), building) for patch in chosen]
    deepest = max(len(chain) for chain in chains)
    levels = sorted({0, 1, 2, 3, 4, 5, deepest - 1} & set(range(deepest)))
    columns = min(4, len(levels))
    rows = -(-len(levels) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(3.2 * columns, 3.4 * rows), squeeze=False)
    counts = []
    for axis in axes.flat:
        axis.axis("off")
    for axis, level in zip(axes.flat, levels):
        keys = np.array([chain[min(level, len(chain) - 1)] for chain in chains])
        draw_patches(axis, leaves, View(), chosen, shuffled_colours(keys))
        counts.append({"level": level, "nodes": len(np.unique(keys))})
        axis.set_title(f"level {level}, nodes: {counts[-1]['nodes']}", fontsize=9)
    figure.tight_layout()
    return figure, counts


def neighbours_of(leaves, building):
    """The building whose centre is nearest to that of `building`."""
    centroids, owners = leaves.infos["centroid"][:len(leaves.patches)], leaves.patches["building"]
    centre = centroids[owners == building].mean(axis=0)
    others = [b for b in np.unique(owners) if b not in (NONE, building)]
    return int(min(others, key=lambda b: np.linalg.norm(centroids[owners == b].mean(axis=0) - centre)))


def links_figure(leaves, links, first, second, most=400):
    """Links among two buildings and the ground around them: lines between the centroids of sender and receiver, the `most`
    of each kind that carry most."""
    rows, columns, factors = links
    centroid, owner = leaves.infos["centroid"], leaves.infos["building"]
    count = len(leaves.patches)
    pair = np.flatnonzero(np.isin(leaves.patches["building"], (first, second)))
    low, high = centroid[pair].min(axis=0) - 2.0, centroid[pair].max(axis=0) + 2.0
    near = ((centroid[:, :2] >= low[:2]) & (centroid[:, :2] <= high[:2])).all(axis=1)
    inside = np.isin(owner, (first, second)) | ((owner == NONE) & near)
    receiver = np.repeat(np.arange(len(rows) - 1), np.diff(rows.astype(np.int64)))
    kept = inside[receiver] & inside[columns] & (owner[receiver] != owner[columns])
    r, s = receiver[kept], columns[kept].astype(np.int64)
    exchange = leaves.nodes["area"][r] * factors[kept]
    order = np.argsort(exchange)
    view = View(elevation=28.0)
    shown = np.flatnonzero(inside[:count])
    figure, axes = plt.subplots(figsize=(9, 6.5))
    draw_patches(axes, leaves, view, shown, np.full((len(shown), 3), 0.93), edge="#00000020")
    ground = (owner[r] == NONE) | (owner[s] == NONE)
    ends = np.stack([view.flat(centroid[r]), view.flat(centroid[s])], axis=1)
    drawn = 0
    for mask, colour, name in ((ground, "#1b7837", "building and street"), (~ground, "#b2182b", "building and building")):
        chosen = order[mask[order]][-most:]
        drawn += len(chosen)
        axes.add_collection(LineCollection(ends[chosen], colors=colour, linewidths=0.5, alpha=0.4, label=f"{name}: {int(mask.sum())} links"))
    axes.legend(loc="upper right", fontsize=9)
    figure.tight_layout()
    return figure, {"links": int(kept.sum()), "drawn": drawn, "with_ground": int(ground.sum())}
