"""The source files of the repository, as paths relative to its root."""

FOLDERS = ["engine", "passes", "shaders", "ui", "tests"]
SUFFIXES = {".cpp", ".h", ".comp", ".glsl"}


def source_files(root, suffixes=SUFFIXES):
    return sorted(
        path.relative_to(root).as_posix()
        for folder in FOLDERS
        for path in (root / folder).rglob("*")
        if path.is_file() and path.suffix in suffixes
    )


def report(found, praise):
    """Prints what is wrong and returns the exit code."""
    print("\n".join(found) if found else praise)
    return 1 if found else 0
