#!/usr/bin/env python3
"""Means over repeats of what `converge` measured, for docs/data/motion.csv: results_table.py DIR...

A line for each method and kind of picture, at the last number of frames that every repeat reached.
"""

import collections
import csv
import pathlib
import statistics
import sys

FIGURES = {"relMSE": "relmse", "PSNR dB": "psnr", "SSIM": "ssim", "FLIP": "flip", "seconds": "seconds"}


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("| measured | method | picture | frames |", " | ".join(FIGURES), "|")
    print("|---" * (4 + len(FIGURES)) + "|")
    for folder in map(pathlib.Path, sys.argv[1:]):
        with open(folder / "converge.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        repeats = len({row["repeat"] for row in rows})
        points = collections.defaultdict(list)
        for row in rows:
            points[row["name"], row["average"], int(row["frames"])].append(row)
        last = {}
        for (name, average, frames), found in points.items():
            if len(found) == repeats and frames >= last.get((name, average), 0):
                last[name, average] = frames
        for (name, average), frames in last.items():
            found = points[name, average, frames]
            means = [statistics.fmean(float(row[column]) for row in found) for column in FIGURES.values()]
            picture = "mean" if average == "on" else "single"
            print(f"| {folder.name} | {name} | {picture} | {frames} |", " | ".join(f"{x:.4g}" for x in means), "|")


main()
