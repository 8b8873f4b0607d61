#!/usr/bin/env python3
"""Other path tracers beside Trichrome: RESULTS.md, "How fast is it beside others?"

  rivals.py TRICHROME DIR [--rounds N] [--blender PROGRAM] [--samples N]

Cycles (Debian's blender, CPU), interleaved in one run on the same cores: both trace two Lambertian scenes of 5 scattering events at
512x512; microseconds per sample and pixel are the time of many samples less that of few, so that start-up does not count. The means of
both pictures are printed beside. Then frames (the time of their stages) of ReSTIR at 128x128 with a resting camera, as Tauray was once
measured on the same kind of machine (it needs ray-query hardware or a driver that imitates it; its figures are constants here). Wants
a quiet machine, Debian's blender and python3-numpy.
"""

import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

import gltf

BOUNCES = 5
# Milliseconds of a frame of Tauray on two such cores, lavapipe 25.0.7, 128x128, scenes of like size: settings of render, and its time.
TAURAY = [
    ("path tracer", "pt", [], {"box": 51, "hall": 390}),
    ("replay, temporal", "restir", ["--shift", "replay", "--spatial", "0"], {"box": 81, "hall": 643}),
    ("replay, temporal, 2 neighbors", "restir", ["--shift", "replay", "--spatial", "2"], {"box": 152, "hall": 1092}),
    ("hybrid, temporal, 2 neighbors", "restir", ["--shift", "hybrid", "--spatial", "2"], {"box": 115, "hall": 787}),
]


class Mesh:
    """Vertices and triangles of one material."""

    def __init__(self, name, color=None, radiance=None):
        self.points, self.indices = [], []
        if radiance:
            strength = max(radiance)
            self.material = {
                "name": name, "emissiveFactor": [x / strength for x in radiance], "doubleSided": True,
                "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0},
                               "KHR_materials_emissive_strength": {"emissiveStrength": strength}}}
        else:
            self.material = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0},
                             "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}

    def quad(self, corner, u, v):
        first = len(self.points)
        for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
            self.points.append([c + a * x + b * y for c, x, y in zip(corner, u, v)])
        self.indices += [first, first + 1, first + 2, first, first + 2, first + 3]

    def box(self, low, high):
        size = [h - l for l, h in zip(low, high)]
        x, y, z = [size[0], 0, 0], [0, size[1], 0], [0, 0, size[2]]
        for corner, u, v in ((low, y, x), (low, z, y), (low, x, z)):
            self.quad(corner, u, v)
        for corner, u, v in ((high, [-t for t in x], [-t for t in y]), (high, [-t for t in y], [-t for t in z]),
                             (high, [-t for t in z], [-t for t in x])):
            self.quad(corner, u, v)

    def torus(self, center, radius, thickness, around, across):
        first = len(self.points)
        for i in range(around):
            for j in range(across):
                a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
                r = radius + thickness * math.cos(b)
                self.points.append([center[0] + r * math.cos(a), center[1] + thickness * math.sin(b), center[2] + r * math.sin(a)])
        for i in range(around):
            for j in range(across):
                p, q = first + i * across, first + (i + 1) % around * across
                k = (j + 1) % across
                self.indices += [p + j, p + k, q + k, p + j, q + k, q + j]


def box():
    """A Cornell box: 38 triangles, one area light."""
    white, red, green = Mesh("white", [0.73] * 3), Mesh("red", [0.63, 0.065, 0.05]), Mesh("green", [0.14, 0.45, 0.091])
    lamp = Mesh("lamp", radiance=[18, 14, 9])
    white.quad([0, 0, 0], [0, 0, 1], [1, 0, 0])
    white.quad([0, 1, 0], [1, 0, 0], [0, 0, 1])
    white.quad([0, 0, 0], [1, 0, 0], [0, 1, 0])
    red.quad([0, 0, 0], [0, 1, 0], [0, 0, 1])
    green.quad([1, 0, 0], [0, 0, 1], [0, 1, 0])
    lamp.quad([0.38, 0.999, 0.4], [0.24, 0, 0], [0, 0, 0.2])
    white.box([0.55, 0, 0.5], [0.85, 0.3, 0.8])
    white.box([0.15, 0, 0.15], [0.45, 0.6, 0.45])
    return [white, red, green, lamp], {"translation": [0.5, 0.5, 2.4]}


def hall():
    """A hall of 24 tori: 245 804 triangles, 16 colored area lights."""
    walls, tori = Mesh("walls", [0.7, 0.68, 0.6]), Mesh("tori", [0.6, 0.6, 0.65])
    walls.quad([0, 0, 0], [0, 0, 10], [20, 0, 0])
    walls.quad([0, 5, 0], [20, 0, 0], [0, 0, 10])
    walls.quad([0, 0, 0], [20, 0, 0], [0, 5, 0])
    walls.quad([0, 0, 10], [0, 5, 0], [20, 0, 0])
    walls.quad([0, 0, 0], [0, 5, 0], [0, 0, 10])
    walls.quad([20, 0, 0], [0, 0, 10], [0, 5, 0])
    for k in range(24):
        tori.torus([2 + 3.2 * (k % 6), 0.4 + 0.2 * (k % 3), 1.5 + 2.3 * (k // 6)], 0.8, 0.3, 64, 80)
    lamps = []
    for k in range(16):
        hue = [0.15 + (k * n % 7) / 6 for n in (1, 2, 4)]
        lamps.append(Mesh(f"lamp {k}", radiance=[12 * x for x in hue]))
        lamps[-1].quad([1.5 + 2.4 * (k % 8), 4.9, 3 + 4 * (k // 8)], [0.5, 0, 0], [0, 0, 0.5])
    return [walls, tori, *lamps], {"translation": [19, 2.5, 5], "rotation": [0, math.sqrt(0.5), 0, math.sqrt(0.5)]}


def write(name, meshes, camera, folder):
    """Its file and number of triangles."""
    primitives = [{"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1, "material": i} for i in range(len(meshes))]
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01, "aspectRatio": 1}}],
        "nodes": [{"mesh": 0}, {"camera": 0, **camera}], "materials": [mesh.material for mesh in meshes],
        "meshes": [{"primitives": primitives}],
        **gltf.packed([array for mesh in meshes for array in (mesh.points, mesh.indices)])}
    file = folder / f"{name}.gltf"
    file.write_text(json.dumps(scene))
    return file, sum(len(mesh.indices) // 3 for mesh in meshes)


def trichrome(program, file, method, size, frames, folder, more=()):
    """--stats of a render."""
    stats = folder / "stats.json"
    subprocess.run([program, "render", file, "--quiet", "-o", folder / "trichrome.exr", "--stats", stats, "--method", method, "--frames",
                    str(frames), "--size", f"{size}x{size}", "--max-bounces", str(BOUNCES), *more], check=True)
    return json.loads(stats.read_text())


def cycles(blender, file, size, samples, folder):
    """The same of Cycles, a pair for each number of samples."""
    script = pathlib.Path(__file__).with_name("cycles.py")
    run = subprocess.run([blender, "-b", "--factory-startup", "-noaudio", "-P", script, "--", file, folder / "cycles.exr", str(size),
                          str(BOUNCES), *map(str, samples)], capture_output=True, text=True,
                         env={**os.environ, "PATH": f"/usr/bin:{os.environ['PATH']}"})  # the Python that Debian's numpy is for
    lines = [json.loads(line[5:]) for line in run.stdout.splitlines() if line.startswith("JSON ")]
    if len(lines) != len(samples) + 1:
        sys.exit(f"rivals.py: {blender} failed:\n{run.stdout}{run.stderr}")
    return [(line["seconds"], line["mean"]) for line in lines[1:]]


def besideCycles(arguments, scenes):
    few, size = 2, 512
    many = few + arguments.samples
    for file, _ in scenes.values():  # fills the cache of pipelines
        trichrome(arguments.program, file, "pt", size, few, arguments.folder, ["--pixel-filter", "box"])
    print("| scene | triangles | Trichrome, us per sample and pixel | Cycles | Cycles : Trichrome | means, Trichrome : Cycles |\n"
          "|---|---|---|---|---|---|")
    for name, (file, triangles) in scenes.items():
        ours, theirs = [], []
        for _ in range(arguments.rounds):
            first, last = (trichrome(arguments.program, file, "pt", size, n, arguments.folder, ["--pixel-filter", "box"])
                           for n in (few, many))
            ours.append(1e6 * (last["wall_seconds"] - first["wall_seconds"]) / (many - few) / size**2)
            (short, _), (long, mean) = cycles(arguments.blender, file, size, [few, many], arguments.folder)
            theirs.append(1e6 * (long - short) / (many - few) / size**2)
        ratio = statistics.median(t / o for t, o in zip(theirs, ours))
        means = ", ".join(f"{a / b:.4f}" for a, b in zip(last["mean_rgb"], mean))
        print(f"| {name} | {triangles} | {statistics.median(ours):.2f} | {statistics.median(theirs):.2f} | {ratio:.2f} | {means} |",
              flush=True)


def besideTauray(arguments, scenes):
    few, many, size = 4, 24, 128
    print("\n| frames of 128x128, ms: Tauray, restir-pt, rgb-restir | box | hall |\n|---|---|---|")
    for name, kind, more, tauray in TAURAY:
        cells = []
        for scene, (file, _) in scenes.items():
            cell = [f"{tauray[scene]}"]
            for method in [kind] if kind == "pt" else ["restir-pt", "rgb-restir"]:
                frames = []
                for n in [few] + [few, many] * arguments.rounds:  # the first also fills the cache of pipelines
                    found = trichrome(arguments.program, file, method, size, n, arguments.folder, more)
                    frames.append(n * sum(found["stage_ms"].values()))
                ms = statistics.median((long - short) / (many - few) for short, long in zip(frames[1::2], frames[2::2]))
                cell.append(f"{ms:.3g} ({tauray[scene] / ms:.1f} times as fast)")
            cells.append(", ".join(cell))
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--samples", type=int, default=32, help="that are timed, of each scene")
    parser.add_argument("--blender", default="blender")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    scenes = {"box": write("box", *box(), arguments.folder), "hall": write("hall", *hall(), arguments.folder)}
    besideCycles(arguments, scenes)
    besideTauray(arguments, scenes)


if __name__ == "__main__":
    main()
