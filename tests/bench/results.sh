#!/usr/bin/env bash
# The measurements of RESULTS.md under motion and at rest: each scene with a resting and with a moving camera.
# tests/bench/results.sh PROGRAM DIR [SCENE...]   (SPONZA names that scene's file; SIZE, SECONDS_EACH, FRAMES, RUNS,
# REFERENCE_FRAMES and DEVICE shorten or lengthen it)
set -euo pipefail
program=$1 out=$2
shift 2
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || scenes=(cornell hall lamps dim ${SPONZA:+"$SPONZA"})
methods=pt,restir-pt:spatial=0,restir-pt:color=chosen,restir-pt,rgb-restir:spatial=0,rgb-restir
common=(--size "${SIZE:-128x72}" --methods "$methods" --runs "${RUNS:-8}" --resume
    --reference-frames "${REFERENCE_FRAMES:-1024}" ${DEVICE:+--device "$DEVICE"})
mkdir -p "$out"
for scene in "${scenes[@]}"; do
    name=$(basename "${scene%.*}")
    "$program" converge "$scene" -o "$out/$name-resting" "${common[@]}" --seconds "${SECONDS_EACH:-1.5}"
    "$program" converge "$scene" -o "$out/$name-moving" "${common[@]}" --orbit 0.3 --frames "${FRAMES:-16}"
done | tee "$out/verdicts.txt"
