#!/usr/bin/env python3
"""Are all C++ files as clang-format wants them? Exit code 77: clang-format is missing, nothing was checked."""

import pathlib
import shutil
import subprocess
import sys

from sources import report, source_files


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    if not shutil.which("clang-format"):
        print("SKIPPED, FORMAT NOT CHECKED: clang-format is not installed (Debian package clang-format)")
        sys.exit(77)
    sources = source_files(root, {".cpp", ".h"})
    run = subprocess.run(
        ["clang-format", "--dry-run", "-ferror-limit=1", *sources], cwd=root, capture_output=True, text=True, check=True
    )
    wrong = sorted({line.split(":")[0] for line in run.stderr.split("\n") if "-Wclang-format-violations" in line})
    sys.exit(report([f"{p} is not formatted: clang-format -i {p}" for p in wrong], f"{len(sources)} files are formatted"))


if __name__ == "__main__":
    main()
