#!/usr/bin/env bash
# The autocovariance of RESULTS.md: tests/bench/results_correlate.sh PROGRAM DIR [SCENE...]
# Five scenes or those named, measured to M = FRAMES and predicted to 32768 (SIZE, RUNS, BATCH and FRAMES shorten or lengthen it;
# SPONZA names that scene's file). Many runs of few pixels: tails are heavy, and the runs must tell how much. What DIR holds already is not measured again.
set -euo pipefail
program=$1 out=$2
shift 2
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || scenes=(cornell hall lamps dim ${SPONZA:+"$SPONZA"})
mkdir -p "$out"
for scene in "${scenes[@]}"; do
    name=$(basename "${scene%.*}")
    echo "== $name"
    "$program" correlate "$scene" -o "$out/$name" --size "${SIZE:-16x9}" --runs "${RUNS:-256}" --batch "${BATCH:-64}" \
        --frames "${FRAMES:-1024}" --max-confidence 32768 --resume
done | tee "$out/verdicts.txt"
