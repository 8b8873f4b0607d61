#!/usr/bin/env python3
"""Is one build of the program slower than another? Both in turns, on one machine.

  two_programs.py OLD NEW [--rounds N] [--only TEXT] [--options "..."]

Each case is rendered by both programs, one after the other, N times over, so that what else the machine does meets both. A frame's
time is the difference of a long and a short render, divided by the frames that the long one has more: what compiles when stages
first run is in both. Printed are medians of OLD's and of NEW's milliseconds a frame and of the quotient NEW : OLD, with its
quartiles; then the same of what a start takes, from the command to the first pixel.
"""

import argparse
import json
import pathlib
import shlex
import statistics
import subprocess
import tempfile

MOVING = "--orbit 0.3"


FEW = 3  # frames of the short render: all stages have run by then


def cases():
    """Name, options of `render`, and how many frames more the long render has."""
    for scene in ["cornell", "hall", "lamps"]:
        yield f"{scene} pt", f"{scene} --method pt --size 160x90", 100
        for method in ["restir-pt", "rgb-restir"]:
            yield f"{scene} {method} moving", f"{scene} --method {method} {MOVING} --size 160x90", 30
    for method, frames in [("pt", 2000), ("restir-pt", 400), ("rgb-restir", 400)]:
        yield f"cornell {method} small", f"cornell --method {method} {MOVING} --size 32x18", frames


def render(program, options, more, frames):
    """Seconds of rendering, and from the start to the first pixel."""
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder, "stats.json")
        words = [program, "render", *shlex.split(options), *more, "--frames", str(frames), "--quiet"]
        subprocess.run([*words, "-o", f"{folder}/picture.exr", "--stats", stats], check=True, capture_output=True)
        found = json.loads(stats.read_text())
    return found["wall_seconds"], found["first_pixel_seconds"]


def measure(program, options, frames, more):
    """Milliseconds a frame; seconds from the start to the first pixel."""
    short, start = render(program, options, more, FEW)
    return 1e3 * (render(program, options, more, FEW + frames)[0] - short) / frames, start


def row(name, unit, old, new):
    ratios = [b / a for a, b in zip(old, new)]
    low, middle, high = statistics.quantiles(ratios, n=4, method="inclusive") if len(ratios) > 1 else ratios * 3
    print(f"{name:<28}{statistics.median(old):>10.2f}{statistics.median(new):>10.2f} {unit:<3}"
          f"{middle:>8.3f} ({low:.3f} to {high:.3f})", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--only", default="", help="cases whose names contain this")
    parser.add_argument("--options", default="", help="more options of `render`, for both")
    arguments = parser.parse_args()
    more = shlex.split(arguments.options)
    print(f"{'':<28}{'old':>10}{'new':>10}{'new : old':>13}")
    for name, options, frames in cases():
        if arguments.only not in name:
            continue
        rounds = []
        for _ in range(arguments.rounds + 1):  # the first one fills caches
            rounds.append([measure(program, options, frames, more) for program in (arguments.old, arguments.new)])
        (old, old_start), (new, new_start) = [list(zip(*side)) for side in zip(*rounds[1:])]
        row(name, "ms", old, new)
        row("    start", "s", old_start, new_start)


if __name__ == "__main__":
    main()
