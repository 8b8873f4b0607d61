#!/usr/bin/env bash
# The figures of RESULTS.md, section "Autocovariance": tests/bench/results_correlate.sh PROGRAM DIR
# Five scenes, measured to M = FRAMES and predicted to 32768 (SIZE, RUNS and FRAMES shorten or lengthen it; SPONZA names
# that scene's file). What DIR holds already is not measured again.
set -euo pipefail
program=$1 out=$2
mkdir -p "$out"
for scene in cornell hall lamps dim ${SPONZA:+"$SPONZA"}; do
    name=$(basename "${scene%.*}")
    echo "== $name"
    "$program" correlate "$scene" -o "$out/$name" --size "${SIZE:-32x18}" --runs "${RUNS:-32}" \
        --frames "${FRAMES:-1024}" --max-confidence 32768 --resume
done | tee "$out/verdicts.txt"
