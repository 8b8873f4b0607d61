#!/usr/bin/env python3
"""The dependency rule of ARCHITECTURE.md, checked on #include lines. Prints every violation; exit code 1 if any."""

import pathlib
import re
import sys

from sources import report, source_files

CONTRACT = ["shaders/path/domain.glsl", "shaders/path/shift.glsl", "shaders/path/candidates.glsl"]
RESAMPLING = ["canonical", "temporal", "spatial_trace", "spatial_gather"]

# Folder -> what it may include from the repository, besides itself. The longest matching folder counts.
ALLOWED = {
    "engine/base": [],
    "engine/image": ["engine/base"],
    "engine/gpu": ["engine/base", "shaders/shared"],
    "engine/scene": ["engine/base", "engine/image", "engine/gpu", "shaders/shared"],
    "passes": ["engine", "shaders/shared"],
    "passes/experiments": ["engine", "passes", "shaders/shared"],
    "ui/cli": ["engine", "passes", "shaders/shared"],
    "ui/report": ["engine", "passes", "ui/cli"],
    "ui/window": ["engine", "passes", "shaders/shared", "ui/cli"],
    "ui/commands": ["engine", "passes", "shaders/shared", "ui/cli", "ui/report", "ui/window"],
    "ui": ["engine", "passes", "shaders/shared", "ui"],
    "shaders/shared": [],
    "shaders/lib": ["shaders/shared"],
    "shaders/scene": ["shaders/shared", "shaders/lib"],
    "shaders/path": ["shaders/shared", "shaders/lib", "shaders/scene", "shaders/restir"],
    "shaders/restir": ["shaders/shared", "shaders/lib"],
    # The stages that resample know no scene: their tests put toys in the place of these three.
    **{f"shaders/{stage}.comp": ["shaders/shared", "shaders/lib", "shaders/restir", *CONTRACT] for stage in RESAMPLING},
    "shaders": [""],
    "tests": [""],
}

# Header of a library -> the only places that may include it.
CONFINED = {
    r"vulkan/": ["engine/gpu", "ui/window", "tests/engine/gpu", "tests/faults"],
    r"(imgui|imgui_\w+)\.h|GLFW/": ["ui/window"],
    r"embree3/": ["engine/scene/bvh", "tests"],
    r"mpi\.h": ["ui/ranks_mpi.cpp"],
    r"CLI/": ["ui", "tests"],
    r"gtest/": ["tests"],
    r"boost/": ["engine/base/statistics.cpp", "tests/support/chi_squared.cpp"],
    r"kainjow/": ["ui/report/page.cpp"],
    r"tiny_gltf\.h": ["engine/scene"],
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
SHADER_ROOTS = ["shaders", "shaders/path"]  # as shaders/CMakeLists.txt gives them to glslang


def owner(path, folders):
    fits = [f for f in folders if path == f or path.startswith(f + "/")]
    return max(fits, key=len) if fits else None


def resolve(root, path, included):
    """The repository's path of a file that `path` includes, or None when it is a library's."""
    for base in ["", *SHADER_ROOTS, str(pathlib.PurePosixPath(path).parent)]:
        candidate = pathlib.PurePosixPath(base) / included
        if (root / candidate).is_file():
            return str(candidate)
    return None


def violations(root, path, lines):
    folder = owner(path, ALLOWED)
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        included = match[2]
        where = f"{path}:{number}: "
        if ".." in included.split("/"):
            yield where + f'includes "{included}": name files from the repository\'s root'
            continue
        if included.endswith((".comp", ".cpp")):
            yield where + f'includes "{included}": stages and sources are never included'
        for pattern, places in CONFINED.items():
            if re.match(pattern, included) and not any(path.startswith(place) for place in places):
                yield where + f"includes <{included}>, which belongs to {', '.join(places)} only"
        target = resolve(root, path, included)
        if target is None:
            if match[1] == '"':
                yield where + f'includes "{included}", which is not in the repository; libraries go in <>'
            continue
        if folder is None:
            yield where + "lies in a folder that the dependency rule does not know (tests/lint/layers.py)"
        elif owner(target, ALLOWED) != folder and not any(
            allowed in ("", target) or target.startswith(allowed + "/") for allowed in ALLOWED[folder]
        ):
            yield where + f"{folder} may not include {target}"
        elif target.startswith("tests/") and not path.startswith("tests/"):
            yield where + f"nothing outside tests/ may include {target}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    sources = source_files(root)
    found = [v for p in sources for v in violations(root, p, (root / p).read_text(encoding="utf-8").split("\n"))]
    sys.exit(report(found, f"{len(sources)} files keep the dependency rule"))


if __name__ == "__main__":
    main()
