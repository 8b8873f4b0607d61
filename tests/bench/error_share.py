#!/usr/bin/env python3
"""How much of a picture's relative MSE lies in its worst values: error_share.py REFERENCE.exr PICTURE.exr...

Prints for each picture its relative MSE, the part of it in the worst 1% of all values (channels of pixels), and what the others have.
"""

import pathlib
import struct
import sys
import zlib


def header(data):
    """Attributes by name, and where the table of blocks begins."""
    at, found = 8, {}
    while data[at]:
        name, kind = data.index(0, at), data.index(0, data.index(0, at) + 1)
        (length,) = struct.unpack_from("<i", data, kind + 1)
        found[data[at:name].decode()] = data[kind + 5 : kind + 5 + length]
        at = kind + 5 + length
    return found, at + 1


def inflated(packed):
    """OpenEXR's ZIP: differences of bytes, first the even ones and then the odd ones."""
    data = bytearray(zlib.decompress(packed))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    whole, half = bytearray(len(data)), (len(data) + 1) // 2
    whole[0::2], whole[1::2] = data[:half], data[half:]
    return bytes(whole)


def values(path):
    """All values of all channels, as Trichrome writes them: float32, ZIP or not compressed, without layers."""
    data = pathlib.Path(path).read_bytes()
    found, at = header(data)
    left, top, right, bottom = struct.unpack("<4i", found["dataWindow"])
    lines = {0: 1, 2: 1, 3: 16}[found["compression"][0]]
    result = []
    for place in struct.unpack_from(f"<{-(-(bottom - top + 1) // lines)}Q", data, at):
        y, length = struct.unpack_from("<ii", data, place)
        size = 12 * (right - left + 1) * min(lines, bottom + 1 - y)
        block = data[place + 8 : place + 8 + length]
        result += struct.unpack(f"<{size // 4}f", inflated(block) if length < size else block)
    return result


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    reference = values(sys.argv[1])
    for path in sys.argv[2:]:
        errors = sorted(((x - r) ** 2 / (r * r + 0.01) for x, r in zip(values(path), reference, strict=True)), reverse=True)
        worst = len(errors) // 100
        print(f"{path}: {sum(errors) / len(errors):.3g}, {sum(errors[:worst]) / sum(errors):.2f}, {sum(errors[worst:]) / (len(errors) - worst):.3g}")


main()
