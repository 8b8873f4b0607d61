#!/usr/bin/env python3
"""PSNR, SSIM and FLIP of the picture pairs in metrics_test.cpp, by other means: writes metrics_reference.json.

PSNR and SSIM are scikit-image's. FLIP is written here from the paper (Andersson et al. 2020) by its definition: whole
two-dimensional kernels, no separation. Needs python3-numpy, python3-scipy, python3-skimage (Debian 12); run by hand.
"""

import json
import math
import pathlib

import numpy as np
from scipy.ndimage import correlate
from skimage.metrics import peak_signal_noise_ratio, structural_similarity

WIDTH, HEIGHT = 61, 47
PIXELS_PER_DEGREE = 67


def noise(x, y, c, seed):
    """The same integers as in metrics_test.cpp: 0 to 255, without visible order."""
    h = (x * 73856093) ^ (y * 19349663) ^ (c * 83492791) ^ (seed * 2654435761)
    h = (h ^ (h >> 13)) * 1274126177 & 0xFFFFFFFF
    return h >> 24


def picture(color):
    return np.array([[[color(x, y, c) for c in range(3)] for x in range(WIDTH)] for y in range(HEIGHT)], np.float64)


def waves(x, y, c):
    return 1 + math.sin(0.3 * x + c) * math.cos(0.2 * y)


def bars(x, y, c):
    return 4 if (x // 7 + y // 5 + c) % 3 == 0 else 0.0625


def lights(x, y, c):
    return 0.25 + (64 if noise(x, y, 0, 3) > 250 else 0) + (0.5 if c == x * 3 // WIDTH else 0)


PAIRS = {
    "noise on waves": (waves, lambda x, y, c: waves(x, y, c) + noise(x, y, c, 1) / 512),
    "bars moved by a pixel, reddened": (bars, lambda x, y, c: bars(x + 1, y, c) * (1.25 if c == 0 else 1)),
    "lights gone, channels swapped": (lights, lambda x, y, c: min(lights(x, y, 2 - c), 4)),
}

# CIE 1931 from linear Rec. 709, in the rational form of the authors.
TO_XYZ = np.array([
    [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
    [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
    [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382],
])
WHITE = TO_XYZ @ np.ones(3)
CSF = [[(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)]]


def opponent(xyz):
    x, y, z = np.moveaxis(xyz / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def hunt_lab(rgb):
    t = rgb @ TO_XYZ.T / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t * (29 / 6) ** 2 / 3 + 4 / 29)
    lab = opponent(f * WHITE)
    return np.concatenate([lab[..., :1], 0.01 * lab[..., :1] * lab[..., 1:]], -1)


def grid(radius):
    return np.meshgrid(np.arange(-radius, radius + 1), np.arange(-radius, radius + 1))


def perceived(color):
    radius = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi**2)) * PIXELS_PER_DEGREE)
    x, y = grid(radius)
    square = (x**2 + y**2) / PIXELS_PER_DEGREE**2
    blurred = []
    for c in range(3):
        kernel = sum(a * math.sqrt(math.pi / b) * np.exp(-(math.pi**2) * square / b) for a, b in CSF[c])
        blurred.append(correlate(color[..., c], kernel / kernel.sum(), mode="nearest"))
    y = (blurred[0] + 16) / 116
    xyz = np.stack([y + blurred[1] / 500, y, y - blurred[2] / 200], -1) * WHITE
    return hunt_lab(np.clip(xyz @ np.linalg.inv(TO_XYZ).T, 0, 1))


def features(color):
    sigma = 0.5 * 0.082 * PIXELS_PER_DEGREE
    x, y = grid(math.ceil(3 * sigma))
    g = np.exp(-(x**2 + y**2) / (2 * sigma**2))
    strengths = []
    for kernel in (-x * g, (x**2 / sigma**2 - 1) * g):
        kernel = np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())
        lightness = (color[..., 0] + 16) / 116
        parts = [correlate(lightness, k, mode="nearest") for k in (kernel, kernel.T)]
        strengths.append(np.hypot(*parts))
    return strengths


def hyab(a, b):
    d = a - b
    return np.abs(d[..., 0]) + np.hypot(d[..., 1], d[..., 2])


def flip(reference, test):
    """The error map of two pictures in linear Rec. 709, 0 to 1."""
    a, b = (opponent(p @ TO_XYZ.T) for p in (reference, test))
    largest = hyab(hunt_lab(np.array([0.0, 1, 0])), hunt_lab(np.array([0.0, 0, 1]))) ** 0.7
    e = hyab(perceived(a), perceived(b)) ** 0.7
    knee = 0.4 * largest
    color = np.where(e < knee, 0.95 / knee * e, 0.95 + (e - knee) / (largest - knee) * 0.05)
    feature = np.maximum(*(np.abs(p - q) for p, q in zip(features(a), features(b))))
    return color ** (1 - np.sqrt(feature / math.sqrt(2)))


def main():
    values = {}
    for name, (first, second) in PAIRS.items():
        a, b = (p / (1 + p) for p in (picture(first), picture(second)))
        ssim = [
            structural_similarity(
                a[..., c], b[..., c], data_range=1, gaussian_weights=True, sigma=1.5, use_sample_covariance=False
            )
            for c in range(3)
        ]
        values[name] = {
            "psnr": peak_signal_noise_ratio(a, b, data_range=1),
            "ssim": float(np.mean(ssim)),
            "flip": float(np.mean(flip(a, b))),
        }
    path = pathlib.Path(__file__).with_suffix(".json")
    path.write_text(json.dumps(values, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
