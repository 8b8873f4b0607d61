#!/usr/bin/env python3
"""clang-tidy (.clang-tidy) on the sources of a configured build: tidy.py BUILD [--minutes N] [FILE...]. After N minutes no
further file is begun, and those that are left are named. Exit code 77: not installed."""

import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import time


def check(build, file):
    # Options of g++ that clang does not know are no findings.
    extra = ["--extra-arg=-Wno-unknown-warning-option"]
    done = subprocess.run(
        ["clang-tidy", "--quiet", "-p", build, *extra, file], capture_output=True, text=True, errors="replace"
    )
    return done.returncode == 0, done.stdout


def main():
    if not shutil.which("clang-tidy"):
        print("SKIPPED: there is no clang-tidy (Debian package clang-tidy)")
        sys.exit(77)
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--minutes", type=float, default=math.inf)
    parser.add_argument("files", nargs="*")
    options = parser.parse_intermixed_args()
    commands = json.loads(pathlib.Path(options.build, "compile_commands.json").read_text(encoding="utf-8"))
    files = options.files or sorted({c["file"] for c in commands if c["file"].endswith(".cpp")})
    end = time.monotonic() + 60 * options.minutes
    failed, left = 0, []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        in_time = lambda file: check(options.build, file) if time.monotonic() < end else None
        for file, result in zip(files, pool.map(in_time, files)):
            if result is None:
                left.append(file)
                continue
            well, output = result
            failed += not well
            print(output.strip() or f"{file}: {'clean' if well else 'FAILED'}", flush=True)
    if left:
        print(f"NOT CHECKED, for lack of time: {' '.join(left)}")
    print(f"{len(files) - len(left)} files, {failed} with findings")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
