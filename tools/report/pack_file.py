# SPDX-License-Identifier: Apache-2.0
"""Reads a pack's tile as numpy arrays (city/format/README.md says what every byte means)."""
import json
import pathlib
import struct

import numpy as np

NONE = 0xFFFFFFFF
PATCHES, NODES, INFOS, CHILDREN, OUTLINE_ROWS, OUTLINE_RINGS, OUTLINE_POINTS = 1, 2, 3, 4, 5, 6, 7
LINK_ROWS, LINK_COLUMNS, LINK_FACTORS, LINK_MOMENTS, NODE_NAMES = 9, 10, 11, 12, 21
GEOMETRY = (PATCHES, OUTLINE_ROWS, OUTLINE_RINGS, OUTLINE_POINTS)

PATCH = np.dtype([("normal", "<f4", 3), ("area", "<f4"), ("rho", "<f4", 4), ("emission", "<f4", 4),
                  ("building", "<u4"), ("face", "<u4"), ("surface", "<u4"), ("flags", "<u4")])
NODE = np.dtype([("parent", "<u4"), ("child_begin", "<u4"), ("child_count", "<u4"), ("area", "<f4")])
INFO = np.dtype([("centroid", "<f4", 3), ("height", "<u4"), ("normal", "<f4", 3), ("kind", "<u4"), ("coverage", "<f4"),
                 ("building", "<u4"), ("name", "<u4"), ("pad", "<u4")])


class Pack:
    """The sections of a pack, read on demand. Only raw sections can be read: bake without --zstd."""

    def __init__(self, folder):
        self.path = pathlib.Path(folder) / "tile-0000"
        with open(self.path, "rb") as file:
            head = file.read(64)
            if head[:8] != b"HELIOTIL":
                raise ValueError(f"{self.path}: not a tile")
            count = struct.unpack_from("<I", head, 12)[0]
            table = file.read(48 * count)
        self.sections = {}  # id: codec, offset, bytes in the file, bytes unpacked, checksum
        for k in range(count):
            number, codec, offset, stored, size, checksum, _ = struct.unpack_from("<IIQQQQQ", table, 48 * k)
            self.sections[number] = (codec, offset, stored, size, checksum)
        self.bytes = self.path.stat().st_size

    def read(self, section, kind):
        codec, offset, stored, _, _ = self.sections[section]
        if codec != 0:
            raise ValueError(f"{self.path}: section {section} is packed")
        if stored == 0:
            return np.zeros(0, kind)
        return np.fromfile(self.path, kind, stored // np.dtype(kind).itemsize, offset=offset)

    def geometry_key(self):
        """The same for packs with the same patches, whatever their links."""
        return "-".join(f"{self.sections[number][4]:016x}" for number in GEOMETRY)

    def source_faces(self):
        """Faces of the OBJ file that the pack was made from; 0 for cities."""
        text = (self.path.parent / "index").read_text(encoding="utf-8")
        return int(json.JSONDecoder().raw_decode(text, text.index("{"))[0]["source_faces"])

    def link_bytes(self):
        """Bytes in the file of columns, factors and moments; rows and what the tree adds are not in it."""
        return sum(self.sections[number][2] for number in (LINK_COLUMNS, LINK_FACTORS, LINK_MOMENTS)
                   if number in self.sections)

    def linear(self):
        return LINK_MOMENTS in self.sections and self.sections[LINK_MOMENTS][3] > 0

    def patches(self):
        return self.read(PATCHES, PATCH)

    def nodes(self):
        return self.read(NODES, NODE), self.read(INFOS, INFO), self.read(CHILDREN, "<u4")

    def outline(self):
        """rows, ring offsets (x 2 + 1 for holes) and points of all nodes."""
        return (self.read(OUTLINE_ROWS, "<u4"), self.read(OUTLINE_RINGS, "<u4"),
                self.read(OUTLINE_POINTS, "<f4").reshape(-1, 3))

    def links(self):
        return self.read(LINK_ROWS, "<u4"), self.read(LINK_COLUMNS, "<u4"), self.read(LINK_FACTORS, "<f4")
