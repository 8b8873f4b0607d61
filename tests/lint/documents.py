#!/usr/bin/env python3
"""Documents: links lead somewhere, files that are named exist, README and ARCHITECTURE stay short, folders say what they are."""

import pathlib
import re
import sys

from sources import report, source_files

FOLDERS = ["assets", "docs", "engine", "packaging", "passes", "shaders", "tests", "ui"]
README_WORDS, ARCHITECTURE_LINES = 500, 200
LINK = re.compile(r"\]\(([^)\s]+)\)")
# A path of this repository in running text or in a comment: folder/.../file.ending, without patterns.
NAMED = re.compile(r"(?<![\w/.<*-])((?:" + "|".join(FOLDERS) + r")/[\w./-]*\w\.(?:md|py|sh|gp|cpp|h|glsl|comp|svg|png|csv))\b")
DOCUMENT = re.compile(r"(?<![\w/.])([A-Z_]+\.md)\b")  # at the top, in docs, or beside the file that names it


def anchors(text):
    """As GitHub makes them of headings."""
    return {
        re.sub(r"[^\w\- ]", "", line.lstrip("#").strip().lower()).replace(" ", "-")
        for line in re.sub(r"```.*?```", "", text, flags=re.S).split("\n")
        if line.startswith("#")
    }


def complaints_of_links(root, path, text):
    for target in LINK.findall(text):
        if target.startswith(("http:", "https:")):
            continue
        file, _, anchor = target.partition("#")
        there = (root / path).parent / file if file else root / path
        if not there.exists():
            yield f"{path}: links to {target}, which does not exist"
        elif anchor and anchor not in anchors(there.read_text(encoding="utf-8")):
            yield f"{path}: there is no heading for {target}"


def complaints_of_names(root, path, text):
    for name in sorted(set(NAMED.findall(text))):
        if not (root / name).exists() and not name.rsplit("/", 1)[-1].startswith(("x.", "x_")):
            yield f"{path}: names {name}, which does not exist"
    for name in sorted(set(DOCUMENT.findall(text))):
        if not any((folder / name).exists() for folder in (root, root / "docs", (root / path).parent)):
            yield f"{path}: names {name}, which does not exist"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    documents = sorted(
        p.relative_to(root).as_posix() for folder in ["", *FOLDERS] for p in (root / folder).glob("*.md" if not folder else "**/*.md")
    )
    found = [f"{folder}/README.md is missing" for folder in FOLDERS if not (root / folder / "README.md").is_file()]
    texts = {p: (root / p).read_text(encoding="utf-8") for p in documents}
    for path, text in texts.items():
        found += [*complaints_of_links(root, path, text), *complaints_of_names(root, path, text)]
    for path in source_files(root, {".cpp", ".h", ".comp", ".glsl", ".py", ".sh"}):
        found += complaints_of_names(root, path, (root / path).read_text(encoding="utf-8"))
    words, lines = len(texts["README.md"].split()), texts["ARCHITECTURE.md"].count("\n")
    if words > README_WORDS:
        found.append(f"README.md: {words} words; {README_WORDS} is the most")
    if lines > ARCHITECTURE_LINES:
        found.append(f"ARCHITECTURE.md: {lines} lines; {ARCHITECTURE_LINES} is the most")
    sys.exit(report(found, f"{len(documents)} documents lead where they say"))


if __name__ == "__main__":
    main()
