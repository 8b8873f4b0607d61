#!/usr/bin/env python3
"""clang-tidy (.clang-tidy) on the sources of a configured build: tidy.py BUILD [FILE...]. Exit code 77: not installed."""

import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys


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
    build = sys.argv[1]
    commands = json.loads(pathlib.Path(build, "compile_commands.json").read_text(encoding="utf-8"))
    files = sys.argv[2:] or sorted({c["file"] for c in commands if c["file"].endswith(".cpp")})
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for file, (well, output) in zip(files, pool.map(lambda file: check(build, file), files)):
            failed += not well
            print(output.strip() or f"{file}: {'clean' if well else 'FAILED'}", flush=True)
    print(f"{len(files)} files, {failed} with findings")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
