#!/usr/bin/env bash
# PSNR and SSIM beside the paper, docs/data/history_alone.csv: tests/bench/results_paper.sh PROGRAM DIR [SCENE...]
# Temporal reuse alone, random replay, resting camera, after FRAMES frames of history (SIZE, FRAMES, RUNS, REFERENCE_FRAMES
# shorten or lengthen it; SPONZA names that scene's file).
set -euo pipefail
program=$1 out=$2
shift 2
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || scenes=(hall lamps dim ${SPONZA:+"$SPONZA"})
mkdir -p "$out"
for scene in "${scenes[@]}"; do
    "$program" converge "$scene" -o "$out/$(basename "${scene%.*}")" --preset paper --methods pt,restir-pt,rgb-restir --resume \
        --size "${SIZE:-64x36}" --frames "${FRAMES:-1024}" --runs "${RUNS:-3}" --reference-frames "${REFERENCE_FRAMES:-16384}"
done | tee "$out/verdicts.txt"
