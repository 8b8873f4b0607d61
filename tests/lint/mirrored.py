#!/usr/bin/env python3
"""Every product source has a test. engine/scene/x.cpp is tested by tests/engine/scene/x_test.cpp, by another test there that
includes x.h, or by a test that says in its head: Covers engine/scene/x.cpp. Prints what has none; exit code 1 if any."""

import pathlib
import re
import sys

from sources import report, source_files

COVERS = re.compile(r"^// Covers ((?:.|\n// )*?)\.$", re.M)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    files = source_files(root, {".cpp", ".h"})
    products = {f for f in files if f.endswith(".cpp") and not f.startswith("tests/")}
    tests = {f: (root / f).read_text(encoding="utf-8") for f in files if f.endswith("_test.cpp")}
    covered, found = set(), []
    for test, text in tests.items():
        for claim in COVERS.findall(text):
            for source in re.split(r",\s*|\s+and\s+", claim.replace("\n// ", " ")):
                covered.add(source)
                if source not in products:
                    found.append(f"{test}: covers {source}, which does not exist")
    for source in sorted(products - covered):
        folder = f"tests/{source.rpartition('/')[0]}/"
        header = f'#include "{source[:-4]}.h"'
        if f"tests/{source[:-4]}_test.cpp" in tests:
            continue
        if not any(test.startswith(folder) and header in text for test, text in tests.items()):
            found.append(f"{source} has no test: tests/{source[:-4]}_test.cpp, or one that says that it covers it")
    sys.exit(report(found, f"{len(products)} sources have tests"))


if __name__ == "__main__":
    main()
