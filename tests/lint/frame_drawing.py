#!/usr/bin/env python3
"""assets/frame.svg is what the stages declare: frame_drawing.py ROOT [--write]. Exit code 1 if it is not."""

import pathlib
import re
import sys

STAGES = ["primary", "canonical", "mutate", "temporal", "spatial_trace", "spatial_gather", "accumulate"]
MUTATES = "mutate"  # its column is dashed: not in every frame
BUFFERS = {  # what is drawn of a frame's buffers (passes/frame_buffers.cpp); paths and confidences go with their set
    "Surfaces": ("what each pixel sees", True),
    "Reservoirs": ("this frame's set", False),
    "Shifted": ("samples in other domains", False),
    "MergedColor": ("of the last merge", False),
    "History": ("the frame before's set", True),
    "HistoryColor": ("variate: of the last frame", True),
    "Color": ("this frame's picture", True),
    "Film": ("the sum of frames", True),
}
LEFT, STEP, TOP, ROW, RIGHT = 260, 108, 85, 44, 952
READS = {"TABLE", "TABLE_INOUT"}
WRITES = {"TABLE_OUT", "TABLE_INOUT"}


def declared(root, stage):
    """Buffer -> (read, written), of a stage and of the headers that declare tables for it."""
    text = (root / "shaders" / f"{stage}.comp").read_text(encoding="utf-8")
    if re.search(r'#include "(shift|candidates|path/primary_hit)\.glsl"', text):
        text += (root / "shaders" / "path" / "primary_hit.glsl").read_text(encoding="utf-8")
    tables = re.findall(r"^(TABLE\w*)\(SET_PASS, \d+, (\w+)\)", text, re.M)
    return {name: (kind in READS, kind in WRITES) for kind, name in tables}


def circle(x, y, reads, writes):
    outer = ('fill="#fff" stroke="#1565c0"' if reads else 'fill="#e8710a" stroke="#e8710a"') + ' stroke-width="3"'
    text = f'<circle cx="{x}" cy="{y}" r="9" {outer}/>'
    return text + (f'<circle cx="{x}" cy="{y}" r="5" fill="#e8710a"/>' if reads and writes else "")


def drawing(root):
    height = TOP + ROW * len(BUFFERS)
    columns = [LEFT + STEP * i for i in range(len(STAGES))]
    uses = [declared(root, stage) for stage in STAGES]
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 960 {height + 60}" '
        'font-family="Helvetica, Arial, sans-serif" font-size="14">',
        "  <title>A frame of ReSTIR: stages from left to right, and the buffers that they write and read</title>",
        f'  <rect width="960" height="{height + 60}" fill="#fff"/>',
    ]
    for i, (stage, x) in enumerate(zip(STAGES, columns)):
        dashes = ' stroke-dasharray="5 3"' if stage == MUTATES else ""
        lines.append(
            f'  <rect x="{x - 50}" y="12" width="100" height="34" rx="6" fill="#e8eefc" stroke="#4a6fc4"{dashes}/>'
            f'<text x="{x}" y="34" text-anchor="middle">{stage}</text>'
        )
        if i:
            lines.append(f'  <path d="M{columns[i - 1] + 50} 29h{STEP - 100}" stroke="#4a6fc4" stroke-width="2"/>')
        lines.append(f'  <path d="M{x} 46V{height}" stroke="#e3e6ec"/>')
    for row, (name, (what, lasts)) in enumerate(BUFFERS.items()):
        y = TOP + ROW * row
        users = [(x, *use[name]) for x, use in zip(columns, uses) if name in use]
        first, last = users[0][0], users[-1][0]
        held = f"M{first} {y}H{last}"
        if lasts:  # from the writer to the right edge, and from the left edge to whoever reads before; two frames' surfaces
            writer = next(x for x, reads, writes in users if writes and not (name == "History" and reads))
            before = [x for x, reads, _ in users if reads and x < writer]
            whole = name == "Surfaces" or users[0][1] and first == writer
            held = (f"M200 {y}H{before[-1]}" if before else "") + f"M{200 if whole else writer} {y}H{RIGHT}"
        lines.append(
            f'  <text x="12" y="{y - 3}" font-weight="bold">{name}</text>'
            f'<text x="12" y="{y + 14}" fill="#666" font-size="13">{what}</text>'
        )
        lines.append(f'  <path d="{held}" stroke="#c9ced8" stroke-width="10"/>')
        lines += [f"  {circle(x, y, reads, writes)}" for x, reads, writes in users]
    y = height + 31
    key = [(112, False, True, "writes"), (202, True, False, "reads"), (288, True, True, "both")]
    lines.append(
        "  "
        + "".join(f'{circle(x, y, reads, writes)}<text x="{x + 16}" y="{y + 5}">{word}</text>' for x, reads, writes, word in key)
        + f'<path d="M360 {y}h34" stroke="#c9ced8" stroke-width="10"/>'
        f'<text x="404" y="{y + 5}">holds something; at an edge: across frames. Dashed: by --mutate</text>'
    )
    return "\n".join([*lines, "</svg>"]) + "\n"


def main():
    root = pathlib.Path(sys.argv[1])
    page, wanted = root / "assets" / "frame.svg", drawing(root)
    if "--write" in sys.argv:
        page.write_text(wanted, encoding="utf-8")
    elif not page.exists() or page.read_text(encoding="utf-8") != wanted:
        sys.exit(f"{page} is not what the shaders declare; draw it anew: {sys.argv[0]} {sys.argv[1]} --write")
    print(f"{page} is what the shaders declare")


if __name__ == "__main__":
    main()
