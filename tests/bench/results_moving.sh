#!/usr/bin/env bash
# Single frames while objects move, for results_moving.py: tests/bench/results_moving.sh PROGRAM DIR FIGURE.gltf [FILE...]
# FIGURE has a skin (walker.py puts it into a room of colored lamps); FILEs are measured as they are. SIZE, FRAMES, RUNS,
# REFERENCE_FRAMES and DEVICE shorten or lengthen it.
set -euo pipefail
program=$1 out=$2 figure=$3
shift 3
mkdir -p "$out"
"$(dirname "$0")/walker.py" "$figure" "$out/walker.gltf"
for scene in carousel flags "$out/walker.gltf" "$@"; do
    name=$(basename "${scene%.*}")
    "$program" converge "$scene" -o "$out/$name" --fps 12 --frames "${FRAMES:-16}" --size "${SIZE:-128x72}" --runs "${RUNS:-8}" --resume \
        --methods pt,restir-pt:color=chosen,restir-pt,rgb-restir --reference-frames "${REFERENCE_FRAMES:-512}" ${DEVICE:+--device "$DEVICE"}
done | tee "$out/verdicts.txt"
