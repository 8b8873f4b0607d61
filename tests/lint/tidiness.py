#!/usr/bin/env python3
"""Small rules for every source file: length (stages fit a screen), unfinished marks, no laundering of values in shaders."""

import pathlib
import re
import sys

from sources import report, source_files

MAX_LINES = 500
MAX_STAGE_LINES, MAX_MAIN_LINES = 120, 60  # of a .comp, and of what it does
MAIN = re.compile(r"^void main\(\)\n\{\n(.*?)^\}", re.S | re.M)
MARKS = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b|\bDISABLED_")
# A value that is not finite is counted where it appears, never replaced by a pleasant one.
LAUNDERING = re.compile(r"max\(.*1e-|min\(.*1e[0-9]")
FINITE = re.compile(r"\bisFinite\b")
MAY_ASK = {"shaders/lib/lanes.glsl", "shaders/lib/frame.glsl"}  # where it is defined, and where such values are counted
# Compilers that are told of no such values take these away; bits stay.
FRAIL = re.compile(r"\b(isnan|isinf)\s*\(")


def complaints(path, text):
    lines = text.split("\n")
    isStage = path.startswith("shaders/") and path.endswith(".comp")
    most = MAX_STAGE_LINES if isStage else MAX_LINES
    if len(lines) - 1 > most:
        yield f"{path}: {len(lines) - 1} lines; {most} is the most"
    if isStage and MAIN.search(text)[1].count("\n") > MAX_MAIN_LINES:
        yield f"{path}: main has {MAIN.search(text)[1].count(chr(10))} lines; {MAX_MAIN_LINES} is the most"
    for number, line in enumerate(lines, 1):
        if MARKS.search(line):
            yield f"{path}:{number}: an unfinished mark: {line.strip()}"
        if path.startswith("shaders/") and LAUNDERING.search(line):
            yield f"{path}:{number}: may hide a value that is not finite: {line.strip()}"
        if path.startswith("shaders/") and FRAIL.search(line):
            yield f"{path}:{number}: ask isFinite (lib/lanes.glsl), which looks at bits: {line.strip()}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    texts = {p: (root / p).read_text(encoding="utf-8") for p in source_files(root)}
    found = [c for p, text in texts.items() for c in complaints(p, text)]
    askers = {p for p, text in texts.items() if p.startswith("shaders/") and FINITE.search(text)} - MAY_ASK
    found += [f"{p}: asks isFinite; only finiteOrCounted (lib/frame.glsl) may, which counts" for p in sorted(askers)]
    sys.exit(report(found, f"{len(texts)} files are tidy"))


if __name__ == "__main__":
    main()
