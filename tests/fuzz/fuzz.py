#!/usr/bin/env python3
"""Fuzzes every target for SECONDS: tests/fuzz/fuzz.py FUZZER SECONDS [TARGET...]. Exit code 1 when one fails.
0 seconds: a thousand inputs, the same every time from the same start.

Inputs are kept beside the fuzzer and used again next time; a failing one is printed with the command that replays it.
Copied to tests/fuzz/corpus/TARGET/, it is tried by every test run from then on."""

import os
import pathlib
import re
import subprocess
import sys

TARGETS = """gltf png jpeg exr hdr preset camera-path pipeline-cache checkpoint race-store correlation-batch
    window-memory""".split()
KEPT = pathlib.Path(__file__).parent / "corpus"
SHARED = pathlib.Path(__file__).parents[3] / "shared" / "malformed"
MODELS = {"gltf": ["*.gltf", "*.glb"], "hdr": ["*.hdr"], "png": ["*.png"], "jpeg": ["*.jpg"]}
MAX_BYTES = 16384


def fuzz(fuzzer, target, seconds):
    """Runs one target. Returns whether it stood, and how often it was run."""
    grown, seeds, found = (fuzzer.parent / "fuzz" / target / part for part in ("grown", "seeds", "found"))
    for folder in (grown, seeds, found):
        folder.mkdir(parents=True, exist_ok=True)
    if SHARED.is_dir():
        for pattern in MODELS.get(target, []):
            for file in SHARED.glob(pattern):
                if file.stat().st_size <= MAX_BYTES:
                    (seeds / file.name).write_bytes(file.read_bytes())
    folders = [grown, seeds] + [kept for kept in [KEPT / target] if kept.is_dir()]
    limits = ["-rss_limit_mb=2048", "-malloc_limit_mb=600", "-timeout=20", f"-max_len={MAX_BYTES}"]
    limits += [f"-max_total_time={seconds}"] if seconds else ["-runs=1000", "-seed=1"]
    command = [fuzzer, *limits, "-print_final_stats=1", f"-artifact_prefix={found}/", *folders]
    environment = os.environ | {
        "TRICHROME_FUZZ": target,
        "TRICHROME_FUZZ_SEEDS": str(seeds),
        "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=0",
    }
    done = subprocess.run(command, env=environment, capture_output=True, text=True, errors="replace")
    runs = re.search(r"number_of_executed_units: (\d+)", done.stderr)
    if done.returncode != 0:
        print(done.stderr[-6000:])
        print(f"Again: TRICHROME_FUZZ={target} TRICHROME_FUZZ_SEEDS={seeds} {fuzzer} FILE, with a FILE of {found}/")
    return done.returncode == 0, int(runs[1]) if runs else 0


def main():
    fuzzer, seconds = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2])
    if not fuzzer.exists():
        print(f"SKIPPED, NOT FUZZED: there is no {fuzzer}; ./run fuzz builds it (Debian packages clang, libclang-rt-14-dev)")
        sys.exit(77)
    well = True
    for target in sys.argv[3:] or TARGETS:
        stood, runs = fuzz(fuzzer, target, seconds)
        print(f"{target:16} {runs:10} runs  {'stood' if stood else 'FAILED'}", flush=True)
        well = well and stood
    sys.exit(0 if well else 1)


if __name__ == "__main__":
    main()
