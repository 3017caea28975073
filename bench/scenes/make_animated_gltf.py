#!/usr/bin/env python3
"""Writes scenes/clockwork/clockwork.gltf: a small scene of two seconds in which everything moves that can.

usage: bench/scenes/make_animated_gltf.py [FILE]

On a floor under a lamp a box turns about an upright axis (LINEAR rotations), a second box slides to and fro on a cubic
spline (CUBICSPLINE), a reed bends (a skin of two joints), a tile bulges (a morph target), and the camera moves to the
right. Everything is in one buffer, inside of the file.
"""
import base64
import json
import math
import struct
import sys
from pathlib import Path

FLOAT, SHORT, BYTE = 5126, 5123, 5121
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
CODES = {FLOAT: "f", SHORT: "H", BYTE: "B"}


class Buffer:
    """Numbers in one buffer, and the accessors that name them."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, kind, numbers, code=FLOAT, bounds=False):
        numbers = [x for item in numbers for x in (item if isinstance(item, (list, tuple)) else [item])]
        packed = struct.pack(f"<{len(numbers)}{CODES[code]}", *numbers)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed + b"\0" * (-len(packed) % 4)
        width = WIDTHS[kind]
        accessor = {"bufferView": len(self.views) - 1, "componentType": code, "count": len(numbers) // width, "type": kind}
        if bounds:
            columns = [numbers[i::width] for i in range(width)]
            accessor["min"], accessor["max"] = [min(c) for c in columns], [max(c) for c in columns]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def box(buffer, x, y, z):
    """A box around the origin, with flat faces: its half sizes."""
    positions, normals, indices = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            normal = [0, 0, 0]
            normal[axis] = sign
            first = len(positions)
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                p = [0, 0, 0]
                p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = sign, a, b
                positions.append([p[0] * x, p[1] * y, p[2] * z])
                normals.append(normal)
            order = (0, 1, 2, 0, 2, 3) if sign > 0 else (0, 2, 1, 0, 3, 2)
            indices += [first + i for i in order]
    return {"attributes": {"POSITION": buffer.add("VEC3", positions, bounds=True), "NORMAL": buffer.add("VEC3", normals)},
            "indices": buffer.add("SCALAR", indices, SHORT)}


def grid(width, height, at):
    """Positions at(i, j) of a grid, and its triangles."""
    positions = [at(i / width, j / height) for j in range(height + 1) for i in range(width + 1)]
    indices = []
    for j in range(height):
        for i in range(width):
            a = j * (width + 1) + i
            indices += [a, a + 1, a + width + 2, a, a + width + 2, a + width + 1]
    return positions, indices


def reed(buffer):
    """An upright strip that a joint at its foot and one at its middle carry."""
    positions, indices = grid(1, 8, lambda u, v: [0.3 * (u - 0.5), 1.6 * v, 0])
    joints, weights = [], []
    for p in positions:
        share = min(max(p[1] / 1.6, 0), 1)
        joints.append([0, 1, 0, 0])
        weights.append([1 - share, share, 0, 0])
    return {"attributes": {"POSITION": buffer.add("VEC3", positions, bounds=True),
                           "JOINTS_0": buffer.add("VEC4", joints, BYTE), "WEIGHTS_0": buffer.add("VEC4", weights)},
            "indices": buffer.add("SCALAR", indices, SHORT)}


def tile(buffer):
    """A flat tile, and what makes a hill of it."""
    positions, indices = grid(6, 6, lambda u, v: [1.2 * (u - 0.5), 0.02, 1.2 * (0.5 - v)])
    hill = [[0, 0.5 * math.cos(math.pi * p[0] / 1.2) * math.cos(math.pi * p[2] / 1.2), 0] for p in positions]
    return {"attributes": {"POSITION": buffer.add("VEC3", positions, bounds=True)},
            "indices": buffer.add("SCALAR", indices, SHORT),
            "targets": [{"POSITION": buffer.add("VEC3", hill, bounds=True)}]}


def quad(buffer, corners):
    return {"attributes": {"POSITION": buffer.add("VEC3", corners, bounds=True)},
            "indices": buffer.add("SCALAR", [0, 1, 2, 0, 2, 3], SHORT)}


def turn(degrees, axis):
    half = math.radians(degrees) / 2
    q = [0, 0, 0, math.cos(half)]
    q[axis] = math.sin(half)
    return q


def channels(buffer):
    """The animation: two seconds."""
    samplers, targets = [], []

    def add(node, path, kind, times, values, interpolation="LINEAR"):
        samplers.append({"input": buffer.add("SCALAR", times, bounds=True), "output": buffer.add(kind, values),
                         "interpolation": interpolation})
        targets.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})

    add(1, "rotation", "VEC4", [0, 1, 2], [turn(a, 1) for a in (0, 90, 180)])
    still = [0, 0, 0]
    add(2, "translation", "VEC3", [0, 1, 2],
        [still, [-1, 0.3, 1], [0, 0, 0.5], still, [0.5, 0.3, 1.4], still, [0, 0, -0.5], [-1, 0.3, 1], still], "CUBICSPLINE")
    add(5, "rotation", "VEC4", [0, 1, 2], [turn(a, 2) for a in (-35, 35, -35)])
    add(6, "weights", "SCALAR", [0, 1, 2], [0, 1, 0])
    add(8, "translation", "VEC3", [0, 2], [[-0.4, 1.6, 5.5], [0.4, 1.6, 5.5]])
    return {"name": "tick", "samplers": samplers, "channels": targets}


def document():
    buffer = Buffer()
    color = lambda name, rgb, metallic, roughness: {  # noqa: E731
        "name": name, "pbrMetallicRoughness": {"baseColorFactor": [*rgb, 1], "metallicFactor": metallic,
                                               "roughnessFactor": roughness}}
    materials = [color("floor", (0.6, 0.6, 0.6), 0, 0.9), color("copper", (0.95, 0.64, 0.54), 1, 0.35),
                 color("blue", (0.1, 0.2, 0.7), 0, 0.3), {**color("reed", (0.2, 0.6, 0.1), 0, 0.7), "doubleSided": True},
                 color("tile", (0.8, 0.7, 0.2), 0, 0.5),
                 {**color("lamp", (0, 0, 0), 0, 1), "emissiveFactor": [1, 0.9, 0.8],
                  "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 12}}}]
    primitives = [quad(buffer, [[-6, 0, 6], [6, 0, 6], [6, 0, -6], [-6, 0, -6]]), box(buffer, 0.5, 0.5, 0.5),
                  box(buffer, 0.3, 0.3, 0.3), reed(buffer), tile(buffer),
                  quad(buffer, [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])]
    meshes = [{"name": m["name"], "primitives": [{**p, "material": i}]}
              for i, (m, p) in enumerate(zip(materials, primitives))]
    meshes[4]["weights"] = [0]
    down = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.8, 0, 1]
    skins = [{"joints": [4, 5], "inverseBindMatrices":
              buffer.add("MAT4", [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], down])}]
    nodes = [{"name": "floor", "mesh": 0}, {"name": "box", "mesh": 1, "translation": [-0.6, 0.5, -0.6]},
             {"name": "slider", "mesh": 2, "translation": [-1, 0.3, 1]}, {"name": "reed", "mesh": 3, "skin": 0},
             {"name": "foot", "translation": [1.1, 0, -0.4], "children": [5]},
             {"name": "middle", "translation": [0, 0.8, 0]},
             {"name": "tile", "mesh": 4, "translation": [1.3, 0, 1.2]},
             {"name": "lamp", "mesh": 5, "translation": [0, 3.5, 0.5]},
             {"name": "camera", "camera": 0, "translation": [-0.4, 1.6, 5.5], "rotation": turn(-10, 0)}]
    return {
        "asset": {"version": "2.0", "generator": "bench/scenes/make_animated_gltf.py"},
        "extensionsUsed": ["KHR_materials_emissive_strength"], "scene": 0,
        "scenes": [{"nodes": [0, 1, 2, 3, 4, 6, 7, 8]}], "nodes": nodes, "meshes": meshes, "materials": materials,
        "skins": skins, "animations": [channels(buffer)],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 16 / 9, "znear": 0.01}}],
        "accessors": buffer.accessors, "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data), "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(buffer.data).decode()}]}


def main():
    here = Path(__file__).resolve().parents[2] / "scenes" / "clockwork" / "clockwork.gltf"
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else here
    path.write_text(json.dumps(document(), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
