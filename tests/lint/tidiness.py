#!/usr/bin/env python3
"""Small rules for every source file: length, unfinished marks, and no laundering of values in shaders."""

import pathlib
import re
import sys

from sources import report, source_files

MAX_LINES = 500
MARKS = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b|\bDISABLED_")
# A value that is not finite is counted where it appears, never replaced by a pleasant one.
LAUNDERING = re.compile(r"max\(.*1e-|min\(.*1e[0-9]")
FINITE = re.compile(r"\bisFinite\b")
# Compilers that are told of no such values take these away; bits stay.
FRAIL = re.compile(r"\b(isnan|isinf)\s*\(")


def complaints(path, text):
    lines = text.split("\n")
    if len(lines) - 1 > MAX_LINES:
        yield f"{path}: {len(lines) - 1} lines; {MAX_LINES} is the most"
    for number, line in enumerate(lines, 1):
        if MARKS.search(line):
            yield f"{path}:{number}: an unfinished mark: {line.strip()}"
        if path.startswith("shaders/") and LAUNDERING.search(line):
            yield f"{path}:{number}: may hide a value that is not finite: {line.strip()}"
        if path.startswith("shaders/") and FRAIL.search(line):
            yield f"{path}:{number}: ask isFinite (lib/frame.glsl), which looks at bits: {line.strip()}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    texts = {p: (root / p).read_text(encoding="utf-8") for p in source_files(root)}
    found = [c for p, text in texts.items() for c in complaints(p, text)]
    askers = [p for p, text in texts.items() if p.startswith("shaders/") and FINITE.search(text)]
    if len(askers) > 1:
        found.append(f"isFinite belongs in one shader file, which counts; it is in {', '.join(askers)}")
    sys.exit(report(found, f"{len(texts)} files are tidy"))


if __name__ == "__main__":
    main()
