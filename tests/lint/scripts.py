#!/usr/bin/env python3
"""The scripts of pages are JavaScript, as node sees it. Exit code 1 if one is not, 77 when node is not installed."""

import pathlib
import shutil
import subprocess
import sys


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    if not shutil.which("node"):
        print("SKIPPED, NOT CHECKED: node is not installed (Debian package nodejs)")
        sys.exit(77)
    scripts = sorted(root.glob("assets/**/*.js"))
    if not scripts:
        sys.exit("there is no script in assets")
    sys.exit(max(subprocess.run(["node", "--check", script]).returncode for script in scripts))


if __name__ == "__main__":
    main()
