#!/usr/bin/env bash
# The figures of RESULTS.md, section "Autocovariance": tests/bench/results_correlate.sh [DIR] [more options of correlate]
# Five scenes, about 4e4 chains each, measured to M = 1024 and predicted to 32768. What DIR holds already is not measured
# again.
set -euo pipefail
cd "$(dirname "$0")/../.."
out=${1:-build/results/correlate}
[ $# = 0 ] || shift
sponza=${SPONZA:-../shared/scenes/sponza/sponza_curtain_spots.gltf}
for scene in cornell hall lamps dim "$sponza"; do
    name=$(basename "${scene%.*}")
    echo "== $name"
    build/release/trichrome correlate "$scene" -o "$out/$name" --size 48x27 --runs 32 --frames 1024 \
        --max-confidence 32768 --resume "$@"
done
