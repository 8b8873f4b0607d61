#!/usr/bin/env python3
"""Do two programs render the same pixels? Small pictures by both, EXR files compared bit by bit.

  same_pixels.py OLD NEW [--only TEXT] [--store DIR] [--shaders DIR] [--new-options "..."]

Each case is a command line of `render`; the list goes over scenes, methods, shift maps, numbers of neighbors, resting and moving
cameras, pixel filters, ways of reading color, means and last frames, and renders that are broken off and resumed. `--shaders`
gives NEW a tree of shaders, `--new-options` any other options, such as a device tuning that must not change pixels; `--store`
keeps OLD's pictures for the next time. What differs is printed with the number of bytes; the exit code says whether anything did.
"""

import argparse
import concurrent.futures
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

RESAMPLING = ["restir-pt", "rgb-restir", "grouped-restir"]
SHIFTS = ["replay", "reconnection", "hybrid"]
MOVING = "--orbit 2"


def cases():
    """Options of `render`. "resume" at the end: rendered in two parts, by way of a checkpoint."""
    for scene in ["cornell", "hall", "dim", "furnace"]:
        yield f"{scene} --method pt"
        yield f"{scene} --method restir-pt"
        yield f"{scene} --method rgb-restir {MOVING}"
    for method in RESAMPLING:
        for shift in SHIFTS:
            yield f"lamps --method {method} --shift {shift}"
            yield f"lamps --method {method} --shift {shift} {MOVING}"
        for neighbors in [0, 1, 2, 8]:
            yield f"lamps --method {method} --spatial {neighbors}"
        yield f"lamps --method {method} --spatial 0 {MOVING}"
        yield f"lamps --method {method} --temporal off"
        yield f"lamps --method {method} --max-confidence 3 --seed 7 --size 37x53"
        yield f"lamps --method {method} resume"
        yield f"lamps --method {method} {MOVING} resume"
        for average in ["on", "off"]:
            yield f"lamps --method {method} --average {average} --pixel-filter box"
    for method in ["restir-pt", "grouped-restir"]: # of rgb-restir both readings are one picture
        for more in ["", "--spatial 0", MOVING]:
            yield f"lamps --method {method} --color chosen {more}"
    yield "hall --method pt --pixel-filter box --average off"
    yield f"lamps --method pt {MOVING} resume"


def render(program, options, more):
    """The pixels of the picture: the file without its header, which says where settings and versions differ."""
    words = [program, "render", *shlex.split(options), "--quiet", *more]
    if "--size" not in words:
        words += ["--size", "64x36"]
    with tempfile.TemporaryDirectory() as folder:
        file, checkpoint = f"{folder}/picture.exr", f"{folder}/checkpoint"
        parts = [["--frames", "4"]]
        if "resume" in words:
            words.remove("resume")
            parts = [["--frames", "2", "--checkpoint", checkpoint], ["--frames", "4", "--resume", checkpoint]]
        for part in parts:
            done = subprocess.run([*words, *part, "-o", file], capture_output=True, text=True, check=False)
            if done.returncode != 0:
                raise RuntimeError(f"{' '.join(words)}: {done.stderr.strip()}")
        return pixels(pathlib.Path(file).read_bytes())


def pixels(exr):
    """What follows the header (a list of name, type, size, value) and the table of offsets, which depend on its length."""
    at = 8
    while exr[at] != 0:
        at = exr.index(b"\0", exr.index(b"\0", at) + 1) + 1
        at += 4 + int.from_bytes(exr[at:at + 4], "little")
    return exr[int.from_bytes(exr[at + 1:at + 9], "little"):]


def stored(store, program, options):
    if not store:
        return render(program, options, [])
    file = pathlib.Path(store) / re.sub(r"[^a-z0-9]+", "_", options)
    if not file.exists():
        picture = render(program, options, [])
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(picture)
    return file.read_bytes()


def compare(options, args, more):
    try:
        a, b = stored(args.store, args.old, options), render(args.new, options, more)
    except RuntimeError as error:
        return str(error)
    differing = sum(x != y for x, y in zip(a, b)) + abs(len(a) - len(b))
    return f"{options}: {differing} of {len(a)} bytes differ" if differing else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--only", default="", help="cases whose options hold this text")
    parser.add_argument("--store", help="keeps what OLD renders")
    parser.add_argument("--shaders", help="a tree of shaders for NEW")
    parser.add_argument("--new-options", default="", help="more options for NEW")
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    more = shlex.split(args.new_options) + (["--shaders", args.shaders] if args.shaders else [])
    wanted = [c for c in cases() if args.only in c]
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        found = list(pool.map(lambda c: compare(c, args, more), wanted))
    different = [text for text in found if text]
    print("\n".join(different + [f"{len(wanted) - len(different)} of {len(wanted)} pictures are the same."]))
    sys.exit(bool(different))


if __name__ == "__main__":
    main()
