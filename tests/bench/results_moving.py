#!/usr/bin/env python3
"""moving_scenes.csv and moving_ratios.csv of docs/data, from what `converge` measured in scenes that move:

results_moving.py OUT DIR...

Errors and times are medians over repeats; ratios are taken within repeats, and their geometric mean stands with an interval at 95%.
At equal time an error counts times the seconds of a frame.
"""

import csv
import math
import pathlib
import statistics
import sys

T95 = [12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262]  # Student's, by degrees of freedom from 1
FIGURES = [("relative MSE", "relmse"), ("chroma MSE", "chroma_mse")]
CHOSEN, WEIGHTED, RGB = "restir-pt:color=chosen", "restir-pt", "rgb-restir"
PAIRS = [("pt", CHOSEN), ("pt", WEIGHTED), ("pt", RGB), (CHOSEN, RGB), (WEIGHTED, RGB)]


def factor(values):
    """Geometric mean and interval, as texts."""
    logs = [math.log(value) for value in values]
    mean = statistics.fmean(logs)
    half = T95[min(len(logs) - 2, len(T95) - 1)] * statistics.stdev(logs) / math.sqrt(len(logs))
    return [f"{math.exp(x):.3g}" for x in (mean, mean - half, mean + half)]


def frames_of(folder):
    """By frame and method, the rows of its repeats."""
    with open(folder / "converge.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    frames = {int(row["frames"]): {} for row in rows}
    for row in rows:
        numbers = {key: float(row[key]) for key in ("seconds", "relmse", "chroma_mse")}
        frames[int(row["frames"])].setdefault(row["name"], []).append(numbers)
    return frames


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1])
    with open(out / "moving_scenes.csv", "w") as errors_file, open(out / "moving_ratios.csv", "w") as ratios_file:
        errors, ratios = (csv.writer(file, lineterminator="\n") for file in (errors_file, ratios_file))
        errors.writerow(["scene", "frame", "method", "repeats", "ms a frame", "time of a frame : pt's", *(name for name, _ in FIGURES)])
        ratios.writerow(["scene", "frame", "figure", "worse", "better", "worse : better, equal frames", "95% low", "95% high",
                         "equal time", "95% low", "95% high"])
        for folder in map(pathlib.Path, sys.argv[2:]):
            for frame, by in sorted(frames_of(folder).items()):
                middle = lambda name, key: statistics.median(row[key] for row in by[name])
                for name, rows in by.items():
                    times = [a["seconds"] / b["seconds"] for a, b in zip(rows, by["pt"])]
                    cells = [1000 * middle(name, "seconds") / frame, statistics.median(times), *(middle(name, key) for _, key in FIGURES)]
                    errors.writerow([folder.name, frame, name, len(rows), *(f"{cell:.3g}" for cell in cells)])
                for figure, key in FIGURES:
                    for worse, better in PAIRS:
                        pairs = list(zip(by[worse], by[better]))
                        line = factor([a[key] / b[key] for a, b in pairs])
                        line += factor([a[key] * a["seconds"] / (b[key] * b["seconds"]) for a, b in pairs])
                        ratios.writerow([folder.name, frame, figure, worse, better, *line])


main()
