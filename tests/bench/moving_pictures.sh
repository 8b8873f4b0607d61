#!/usr/bin/env bash
# The pictures of RESULTS.md of scenes that move, assets/moving.png and assets/carousel.gif, into DIR:
# tests/bench/moving_pictures.sh PROGRAM DIR   (after results_moving.sh, which leaves walker.gltf in DIR; needs ImageMagick)
set -euo pipefail
program=$1 out=$2
size=(--size 160x90 --quiet)
label=(-background black -fill white -font DejaVu-Sans)
mkdir -p "$out/film" "$out/still"

# The 16th frame, and at the same time pt with as many samples as fit into a frame of rgb-restir, and a reference.
rows=()
for each in carousel:4 flags:8 "$out/walker.gltf:6"; do
    scene=${each%:*} row=()
    stem=$out/still/$(basename "${scene%.*}")
    "$program" render "$scene" --fps 12 --frames 16 --method pt -o "$stem-0.png" "${size[@]}"
    "$program" render "$scene" --time 1.25 --frames "${each##*:}" --method pt -o "$stem-1.png" "${size[@]}"
    "$program" render "$scene" --fps 12 --frames 16 --method restir-pt -o "$stem-2.png" "${size[@]}"
    "$program" render "$scene" --fps 12 --frames 16 --method rgb-restir -o "$stem-3.png" "${size[@]}"
    "$program" render "$scene" --time 1.25 --frames 1000 --method pt --seed 7 -o "$stem-4.png" "${size[@]}"
    names=("path tracing" "as long as RGB ReSTIR" "ReSTIR PT" "RGB ReSTIR" reference)
    for i in 0 1 2 3 4; do
        [ ${#rows[@]} -lt 2 ] || row+=(-label "${names[i]}")
        row+=("$stem-$i.png")
    done
    montage "${label[@]}" -pointsize 10 "${row[@]}" -tile 5x1 -geometry +2+2 "$stem-row.png"
    rows+=("$stem-row.png")
done
convert "${rows[@]}" -append +dither -colors 256 -define png:compression-level=9 "PNG8:$out/moving.png"

for method in pt restir-pt rgb-restir; do
    mkdir -p "$out/film/$method"
    "$program" render carousel --sequence 0:12 --warm-up 8 --fps 12 --method "$method" -o "$out/film/$method/%04d.png" "${size[@]}"
done
for frame in $(seq -f %04g 0 11); do
    montage "${label[@]}" -pointsize 11 -label "path tracing" "$out/film/pt/$frame.png" -label "ReSTIR PT" "$out/film/restir-pt/$frame.png" \
        -label "RGB ReSTIR" "$out/film/rgb-restir/$frame.png" -tile 3x1 -geometry +2+1 "$out/film/$frame.png"
done
convert -delay 8 -loop 0 "$out"/film/????.png +dither -colors 32 +map "$out/carousel.gif"
