#!/usr/bin/env python3
"""How time and memory of a frame grow with what a scene and its settings hold: RESULTS.md,
"How do time and memory grow?"

  scaling.py TRICHROME DIR [SERIES...]     series: triangles, pixels, bounces, lights, neighbors, channels, confidence

Writes DIR/scaling.csv (a line a point, kept when measured again), DIR/plot_scaling.svg (by plots.gp), and the tables to stdout.
Time is the stages' time of a frame: that of a long render less that of a short one, so that first frames do not count; the
median of --rounds. Wants a quiet machine. Scenes of many triangles and lights are written as glTF: tiles, each a node.
"""

import argparse
import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

import gltf

COLUMNS = ["series", "method", "x", "ms", "rays", "device_bytes", "peak_bytes", "bvh_seconds"]
BASE = {"size": "160x90", "max-bounces": 3, "spatial": 3, "shift": "hybrid", "max-confidence": 20}
METHODS = ["pt", "restir-pt", "rgb-restir"]
CHANNELS = {"restir-pt": 1, "grouped-restir": 2, "rgb-restir": 3}
# Of what the time should be a power: the law that each series should follow, and over which part it is fitted.
LAWS = {
    "triangles": "logarithm (depth of the tree)",
    "pixels": "1",
    "bounces": "below 1: paths end",
    "lights": "0: one light of a table, whatever its size",
    "neighbors": "a + b K",
    "channels": "a + b N",
    "confidence": "0: a number in each reservoir",
}


def tiles(count, side, emissive):
    """glTF of `count` tiles on a square of 10 x 10: waves, or rows of small emitters, with a floor, under a sun or not."""
    points, normals, indices = [], [], []
    for j in range(side + 1):
        for i in range(side + 1):
            x, z = i / side, j / side
            points.append([x, 0.1 * math.sin(9 * x) * math.cos(7 * z), z])
            slope = -0.9 * math.cos(9 * x) * math.cos(7 * z), 0.7 * math.sin(9 * x) * math.sin(7 * z)
            length = math.hypot(*slope, 1)
            normals.append([slope[0] / length, 1 / length, slope[1] / length])
    for j in range(side):
        for i in range(side):
            a = j * (side + 1) + i
            indices += [a, a + side + 1, a + 1, a + 1, a + side + 1, a + side + 2]
    floor = [[-20, -0.5, -20], [20, -0.5, -20], [-20, -0.5, 20], [20, -0.5, 20]]
    across = math.ceil(math.sqrt(count))
    scale = 10 / across
    nodes = [{"mesh": 0, "translation": [-5 + scale * (k % across), 2.0 if emissive else 0, -5 + scale * (k // across)],
              "scale": [0.7 * scale] * 3 if emissive else [scale] * 3} for k in range(count)]
    nodes += [{"mesh": 1}, {"camera": 0, "translation": [0, 5, 12], "rotation": [-0.195, 0, 0, 0.981]}]
    materials = [{"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.8, 0.7, 0.5, 1]}, "doubleSided": True}]
    if emissive:
        materials.append({"emissiveFactor": [1, 0.8, 0.5], "doubleSided": True})
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01, "aspectRatio": 16 / 9}}],
        "materials": materials, "nodes": nodes,
        **gltf.packed([points, normals, indices, floor, [0, 2, 1, 1, 2, 3]]),
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": int(emissive)}]},
                   {"primitives": [{"attributes": {"POSITION": 3}, "indices": 4, "material": 0}]}]}
    if not emissive:
        nodes.append({"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-0.5, 0.2, 0, 0.84]})
        scene["scenes"][0]["nodes"].append(len(nodes) - 1)
        scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}}
        scene["extensionsUsed"] = ["KHR_lights_punctual"]
    return scene


def pointsOf(series, folder):
    """Of a series: (x, scene, methods, settings)."""
    def written(name, scene):
        file = folder / f"{name}.gltf"
        file.write_text(json.dumps(scene))
        return str(file)

    if series == "triangles":
        for across in (1, 3, 10, 32, 101):
            yield 968 * across**2 + 2, written(f"triangles-{across}", tiles(across**2, 22, False)), METHODS, {}
    elif series == "lights":
        for count, side in ((1, 1), (5, 1), (50, 1), (61, 2), (101, 7), (1023, 7), (1033, 22)):
            yield 2 * side**2 * count, written(f"lights-{count}-{side}", tiles(count, side, True)), METHODS, {}
    elif series == "pixels":
        for width, height in ((32, 18), (64, 36), (128, 72), (256, 144), (512, 288), (1024, 576)):
            yield width * height, "cornell", METHODS, {"size": f"{width}x{height}"}
    elif series == "bounces":
        for bounces in (1, 2, 4, 8, 16, 32):
            yield bounces, "cornell", METHODS, {"max-bounces": bounces}
    elif series == "neighbors":
        for neighbors in range(0, 9, 2):
            yield neighbors, "cornell", METHODS[1:], {"spatial": neighbors}
    elif series == "channels":
        for method, channels in CHANNELS.items():
            yield channels, "cornell", [method], {}
    elif series == "confidence":
        for power in range(0, 21, 5):
            yield 2**power, "cornell", METHODS[1:], {"max-confidence": 2**power}


def render(program, scene, method, settings, frames, folder):
    """Milliseconds of all frames' stages, the program's peak memory, and its --stats."""
    stats = folder / "stats.json"
    command = [program, "render", scene, "--quiet", "-o", str(folder / "picture.exr"), "--stats", str(stats), "--method", method,
               "--frames", str(frames), "--orbit", "0.3"]
    for name, value in settings.items():
        command += [f"--{name}", str(value)]
    child = subprocess.Popen(command)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"scaling.py: {' '.join(command)} ended with {child.returncode}.")
    found = json.loads(stats.read_text())
    return frames * sum(found["stage_ms"].values()), 1024 * usage.ru_maxrss, found


def measure(program, scene, method, settings, rounds, folder):
    few = 3
    milliseconds, _, _ = render(program, scene, method, settings, few, folder)  # also fills the cache of pipelines
    frames = few + max(5, min(400, int(4000 * few / max(milliseconds, 0.1))))
    times = []
    for _ in range(rounds):
        short, _, _ = render(program, scene, method, settings, few, folder)
        long, peak, stats = render(program, scene, method, settings, frames, folder)
        times.append((long - short) / (frames - few))
    return {"ms": round(statistics.median(times), 4), "rays": round(sum(stats["rays"].values()) / frames),
            "device_bytes": stats["memory_bytes"], "peak_bytes": peak, "bvh_seconds": round(stats["bvh_seconds"], 3)}


def exponent(points):
    """Slope of log time against log x over the upper half of the points, by least squares."""
    upper = [(math.log(x), math.log(y)) for x, y in points if x > 0][-max(3, len(points) // 2):]
    mx, my = statistics.fmean(x for x, _ in upper), statistics.fmean(y for _, y in upper)
    return sum((x - mx) * (y - my) for x, y in upper) / sum((x - mx) ** 2 for x, _ in upper)


def report(rows, folder):
    by = {}
    for row in rows:
        by.setdefault(row["series"], {}).setdefault(row["method"], []).append(row)
    for series, methods in by.items():
        if series == "channels":  # one curve
            methods = {"all": [row for rows in methods.values() for row in rows]}
        print(f"\n{series}: the law is {LAWS[series]}\n")
        print("| method | x: ms | exponent of the upper half | device memory |\n|---|---|---|---|")
        for method, found in methods.items():
            found.sort(key=lambda row: float(row["x"]))
            pairs = [(float(row["x"]), float(row["ms"])) for row in found]
            cells = ", ".join(f"{x:g}: {ms:.3g}" for x, ms in pairs)
            memory = f"{float(found[0]['device_bytes']) / 1e6:.3g} to {float(found[-1]['device_bytes']) / 1e6:.3g} MB"
            print(f"| {method} | {cells} | {exponent(pairs):.2f} | {memory} |")
    plots = pathlib.Path(__file__).with_name("plots.gp")
    subprocess.run(["gnuplot", "-e", f"data='{folder}'; out='{folder}'; only='scaling'", plots], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("series", nargs="*", metavar="SERIES", help="; ".join(f"{k}: {v}" for k, v in LAWS.items()))
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    unknown = [series for series in arguments.series if series not in LAWS]
    if unknown:
        parser.error(f"no series {unknown[0]}; there are {', '.join(LAWS)}")
    folder = arguments.folder
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "scaling.csv"
    rows = list(csv.DictReader(file.open())) if file.exists() else []
    for series in arguments.series or LAWS:
        rows = [row for row in rows if row["series"] != series]
        for x, scene, methods, settings in pointsOf(series, folder):
            for method in methods:
                figures = measure(arguments.program, scene, method, {**BASE, **settings}, arguments.rounds, folder)
                rows.append({"series": series, "method": method, "x": x, **figures})
                print(f"{series} {x} {method}: {figures}", file=sys.stderr, flush=True)
        with file.open("w", newline="") as out:
            writer = csv.DictWriter(out, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
    report(rows, folder)


if __name__ == "__main__":
    main()
