#!/usr/bin/env python3
"""A skinned figure in a room of small colored lamps, for the moving pictures of RESULTS.md: walker.py FIGURE.gltf OUT.gltf

FIGURE is a glTF file with a skin, some 1.5 m tall, that faces +z. Its lights, cameras and textures are left out: it becomes white,
so that it has the color of the light. OUT holds all it needs.
"""

import base64
import json
import pathlib
import sys

import gltf

ROOM = (1.8, 2.5, 1.3)  # m: half its width, its height, half its depth; it is open towards the camera and above
LAMP = 0.04  # m, half an edge
PAINT = [("wall", 0.3), ("floor", 0.45)]
LAMPS = [("red", (1, 0.05, 0.03)), ("blue", (0.04, 0.12, 1)), ("green", (0.05, 0.6, 0.05)), ("yellow", (0.5, 0.35, 0.05))]
RADIANCE = 40
CORNERS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]  # outwards


def quads(corners):
    return [i for a in range(0, corners, 4) for i in (a, a + 1, a + 2, a, a + 2, a + 3)]


def cube(center):
    return [tuple(c + LAMP * d for c, d in zip(center, CORNERS[i])) for face in FACES for i in face]


def lamps_of(color):
    """To the left, to the right, on the floor in front of the figure, and on the wall behind."""
    w, h, d = ROOM
    if color < 2:
        return [((2 * color - 1) * (w - 0.08), y, z * d / 3) for y in (0.5, 1.2, 1.9) for z in (-1, 1, 3)]
    return [(x * w / 5, 0.06, d) for x in range(-4, 5, 2)] if color == 2 else [(x * w / 4, h - 0.35, 0.08 - d) for x in range(-3, 4)]


def meshes():
    w, h, d = ROOM
    yield [(-w, 0, -d), (w, 0, -d), (w, h, -d), (-w, h, -d), (-w, 0, d), (-w, 0, -d), (-w, h, -d), (-w, h, d),
           (w, 0, -d), (w, 0, d), (w, h, d), (w, h, -d)]
    yield [(-w, 0, d), (w, 0, d), (w, 0, -d), (-w, 0, -d)]
    for color in range(len(LAMPS)):
        yield [corner for place in lamps_of(color) for corner in cube(place)]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    figure, out = map(pathlib.Path, sys.argv[1:])
    scene = json.loads(figure.read_text(encoding="utf-8"))
    for buffer in scene["buffers"]:
        if not buffer["uri"].startswith("data:"):
            data = (figure.parent / buffer["uri"]).read_bytes()
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    for key in ("extensions", "extensionsUsed", "cameras", "textures", "images", "samplers"):
        scene.pop(key, None)
    for node in scene["nodes"]:
        node.pop("camera", None)
        node.pop("extensions", None)
    for material in scene["materials"]:
        material.clear()
        material["pbrMetallicRoughness"] = {"baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0}
    points = list(meshes())
    room = gltf.packed([array for mesh in points for array in (mesh, quads(len(mesh)))])
    first = {key: len(scene[key]) for key in ("buffers", "bufferViews", "accessors", "materials", "meshes", "nodes")}
    for view in room["bufferViews"]:
        view["buffer"] += first["buffers"]
    for accessor in room["accessors"]:
        accessor["bufferView"] += first["bufferViews"]
    for key, items in room.items():
        scene[key] += items
    scene["materials"] += [{"name": name, "pbrMetallicRoughness": {"baseColorFactor": [paint, paint, paint, 1], "metallicFactor": 0}}
                           for name, paint in PAINT]
    scene["materials"] += [{"name": name, "emissiveFactor": color, "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": RADIANCE}}}
                           for name, color in LAMPS]
    scene["extensionsUsed"] = ["KHR_materials_emissive_strength"]
    for i in range(len(points)):
        accessor = first["accessors"] + 2 * i
        scene["meshes"].append({"primitives": [{"attributes": {"POSITION": accessor}, "indices": accessor + 1, "material": first["materials"] + i}]})
        scene["nodes"].append({"mesh": first["meshes"] + i})
    scene["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]
    scene["nodes"].append({"camera": 0, "translation": [0, 0.88, 3.5]})
    scene["scenes"][scene.get("scene", 0)]["nodes"] += range(first["nodes"], len(scene["nodes"]))
    out.write_text(json.dumps(scene), encoding="utf-8")


main()
