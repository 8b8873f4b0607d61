#!/usr/bin/env python3
"""The window under load, in a virtual display: how soon it answers, how soon a toggle shows, and whether it lasts.

  window_bench.py TRICHROME latency [SCENE]     from mouse motion to changed pixels on the screen, while frames take long
  window_bench.py TRICHROME toggle [SCENE]      from a click on a method to its first frame: cold, and again warm
  window_bench.py TRICHROME soak [SCENE]        random changes of settings for --minutes (20), under Vulkan validation; in
                                                between it comes to rest in one state, where memory must not grow

Needs Xvfb and xdotool. Prints one JSON object. Exit code 1: the soak found growth of memory, messages, values that are not
finite, or an end; 77: a tool is missing.
"""

import argparse
import ctypes
import json
import math
import mmap
import os
import pathlib
import random
import shutil
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import time

LAYER = "VK_LAYER_KHRONOS_validation"
GROWTH = 0.01  # of memory in use at rest, at most
TURN_SECONDS = 60  # of random clicks, before the window comes to rest
WARM_TURNS = 3  # until caches are full


class Display:
    """Xvfb, its screen as memory, and a mouse."""

    def __init__(self, folder):
        self.name = f":{500 + os.getpid() % 20000}"
        command = ["Xvfb", self.name, "-screen", "0", "1280x720x24", "-nolisten", "tcp", "-fbdir", str(folder)]
        self.server = subprocess.Popen(command, stderr=subprocess.DEVNULL)
        for _ in range(100):
            if pathlib.Path(f"/tmp/.X11-unix/X{self.name[1:]}").exists():
                break
            time.sleep(0.05)
        os.environ["DISPLAY"] = self.name
        self.x11 = ctypes.CDLL("libX11.so.6")
        self.xtst = ctypes.CDLL("libXtst.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.connection = ctypes.c_void_p(self.x11.XOpenDisplay(None))
        with open(folder / "Xvfb_screen0", "rb") as file:
            self.memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        header = struct.unpack(">25I", self.memory[:100])
        self.start, self.line = header[0] + 12 * header[19], header[12]

    def move(self, x, y):
        self.xtst.XTestFakeMotionEvent(self.connection, -1, int(x), int(y), 0)
        self.x11.XFlush(self.connection)

    def click(self, x, y):
        self.move(x, y)
        for down in (1, 0):
            time.sleep(0.15)
            self.xtst.XTestFakeButtonEvent(self.connection, 1, down, 0)
            self.x11.XFlush(self.connection)

    def pixel(self, x, y):
        at = self.start + int(y) * self.line + 4 * int(x)
        return self.memory[at : at + 3]


class Window:
    def __init__(self, program, scene, folder, options=(), environment=()):
        self.report_file, self.log_file = folder / "report.json", folder / "log"
        self.report_file.unlink(missing_ok=True)
        command = [program, "view", scene, "--report", str(self.report_file), *options]
        with open(self.log_file, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(
                command, cwd=folder, stdout=log, stderr=log, env={**os.environ, "XDG_CONFIG_HOME": str(folder), **dict(environment)}
            )

    def report(self):
        try:
            return json.loads(self.report_file.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return {}

    def wait(self, condition, seconds=600):
        """Seconds until the report fits."""
        start = time.monotonic()
        while time.monotonic() - start < seconds:
            report = self.report()
            if report.get("frames", 0) > 0 and condition(report):
                return time.monotonic() - start
            if self.process.poll() is not None:
                break
            time.sleep(0.005)
        sys.exit(f"window_bench: it never came; the last report: {json.dumps(self.report())[:2000]}\n{self.log_file.read_text()}")

    def resident(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="utf-8")
        return int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1]) * 1024

    def close(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=120)


def percentile(values, p):
    return sorted(values)[min(int(p * len(values)), len(values) - 1)]


def latency(arguments, display, folder):
    window = Window(arguments.program, arguments.scene, folder, ["--size", arguments.size, "--method", "rgb-restir"])
    window.wait(lambda report: report["frames"] > 1)
    x, y = window.report()["places"]["screenshot"]
    corner = (x - 15, y - 8)  # of the button, beside its word
    times = []
    meanwhile = set()
    for i in range(arguments.samples):
        meanwhile.add(window.report()["ahead"] != "")
        display.move(900, 600)
        time.sleep(0.25 + 0.1 * random.random())
        before = display.pixel(*corner)
        start = time.monotonic()
        display.move(x, y)
        while display.pixel(*corner) == before and time.monotonic() - start < 5:
            time.sleep(0.0005)
        times.append(1000 * (time.monotonic() - start))
    report = window.report()
    result = {
        "scene": arguments.scene, "size": arguments.size, "samples": len(times),
        "frame_ms": 1000 * report["seconds"] / report["frames"],
        "p50_ms": percentile(times, 0.5), "p99_ms": percentile(times, 0.99), "max_ms": max(times),
        "compiling_ahead_meanwhile": sorted(meanwhile), "load": os.getloadavg(),
    }  # fmt: skip
    window.close()
    return result


def toggle(arguments, display, folder):
    result = {"scene": arguments.scene, "size": arguments.size, "load": os.getloadavg()}
    cache = {"MESA_SHADER_CACHE_DIR": str(folder / "mesa"), "XDG_CACHE_HOME": str(folder / "cache")}
    window = Window(arguments.program, arguments.scene, folder, ["--size", arguments.size], cache)
    window.wait(lambda report: report["frames"] > 0)
    for name in ("cold", "ahead", "again"):
        if name == "ahead":  # a new start: what the last one compiled is in the driver's cache, and compiled ahead anyway
            window.close()
            window = Window(arguments.program, arguments.scene, folder, ["--size", arguments.size], cache)
            window.wait(lambda report: not report["ahead"] and not report["activity"] and report["frames"] > 2)
            time.sleep(1)
            window.wait(lambda report: not report["ahead"])
        for method, index in (("rgb-restir", 2), ("pt", 0)):
            before = window.report()["frames"]
            display.click(*window.report()["places"][f"method.{index}"])
            start = time.monotonic()
            went_on = [False]

            def shown(report, method=method):
                went_on[0] |= report["settings"]["method"] != method and report["frames"] > before
                return report["settings"]["method"] == method

            window.wait(shown)
            result[f"{name}_{method}_s"] = time.monotonic() - start
            if name == "cold":
                result[f"{name}_{method}_picture_went_on"] = went_on[0]
    window.close()
    return result


def come_to_rest(window, display):
    """All tools off, and every method and shift map shown once: what is in memory then should be the same every time.
    Returns that: resident, and in use on the heap."""

    def click_until(widget, condition):
        for _ in range(20):
            if condition(window.report()):
                return
            display.click(*window.report()["places"][widget])
            time.sleep(0.2)  # Dear ImGui reads the mouse once a frame: one that has left by then has not clicked
            display.move(900, 700)
            deadline = time.monotonic() + 5
            while time.monotonic() < deadline and not condition(window.report()):
                time.sleep(0.05)
        sys.exit(f"window_bench: clicking {widget} does not help; {json.dumps({key: window.report()[key] for key in ('places', 'asked', 'reference')})}")

    for key, widget in (("comparing", "compare"), ("paused", "pause"), ("converging", "drop-reference"),
                        ("correlation", "correlation"), ("pixel", "pixel")):  # fmt: skip
        click_until(widget, lambda report, key=key: not report["asked"][key])
    click_until("drop-reference", lambda report: not report["reference"])
    click_until("temporal", lambda report: report["asked"]["settings"]["temporal"])
    click_until("pixel-filter.0", lambda report: report["asked"]["settings"]["pixel-filter"] == "center")
    for method, index in (("pt", 0), ("restir-pt", 1), ("grouped-restir", 3), ("rgb-restir", 2)):
        click_until(f"method.{index}", lambda report, method=method: report["asked"]["settings"]["method"] == method)
        for shift in ("replay", "reconnection", "hybrid"):
            index = ["replay", "reconnection", "hybrid"].index(shift)
            click_until(f"shift.{index}", lambda report, shift=shift: report["asked"]["settings"]["shift"] == shift)
            asked = {"method": method, "shift": shift}
            window.wait(lambda report, asked=asked: asked.items() <= report["settings"].items() and not report["activity"])
    quiet = 0
    memory = []
    while quiet < 150:  # for fifteen seconds on end: what compilers freed is given back after two, and again after ten
        report = window.report()
        quiet = quiet + 1 if report and not report["activity"] and not report["ahead"] and report["frames"] > 10 else 0
        memory.append((window.resident(), report.get("heap_bytes", math.inf)))
        time.sleep(0.1)
    return [min(values) for values in zip(*memory[-quiet:])]


def soak(arguments, display, folder):
    # Memory in use, not what glibc keeps of freed memory by thread.
    environment = {"GLIBC_TUNABLES": "glibc.malloc.tcache_count=0:glibc.malloc.arena_max=1"}
    layers = arguments.validate and pathlib.Path("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json").exists()
    if layers:
        environment |= {"VK_INSTANCE_LAYERS": LAYER, "VK_LAYER_ENABLES": "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT"}
    window = Window(
        arguments.program, arguments.scene, folder, ["--size", arguments.size, "--max-bounces", "2"], environment
    )
    window.wait(lambda report: report["frames"] > 0)
    widgets = ["method.0", "method.1", "method.2", "method.3", "shift.0", "shift.1", "shift.2", "temporal", "compare", "freeze",
               "pixel-filter.0", "pixel-filter.1", "pause", "restart", "step", "undo", "redo", "reset-view", "layout.0",
               "layout.1", "layout.2", "pixel", "first.0", "second.1", "converge", "drop-reference", "correlation"]  # fmt: skip
    chance = random.Random(arguments.seed)
    start, samples, turns, nonfinite, clicks = time.monotonic(), [], [], 0, 0
    while len(turns) < WARM_TURNS + 2 or time.monotonic() - start < 60 * arguments.minutes:
        turn_start = time.monotonic()
        while time.monotonic() - turn_start < TURN_SECONDS and window.process.poll() is None:
            report = window.report()
            place = report.get("places", {}).get(chance.choice(widgets))
            if place and place[1] < 720:
                display.click(*place)
                clicks += 1
            if chance.random() < 0.1:
                display.move(chance.uniform(420, 1260), chance.uniform(120, 600))
            time.sleep(0.3)
            nonfinite += sum(report.get("nonfinite", {}).values())
            samples.append((window.resident(), report.get("memory_bytes", 0)))
        if window.process.poll() is not None:
            break
        turns.append(come_to_rest(window, display))
        minutes = (time.monotonic() - start) / 60
        print(f"{minutes:6.1f} min, {clicks} clicks: resident, heap at rest (MB):", *(round(b / 1e6, 1) for b in turns[-1]),
              file=sys.stderr, flush=True)  # fmt: skip
    ended = window.process.poll() is not None
    code = window.process.poll() if ended else window.close()
    log = window.log_file.read_text(encoding="utf-8")
    quarter = max(len(samples) // 4, 1)
    growth = [last / warm - 1 for warm, last in zip(turns[WARM_TURNS - 1], turns[-1])] if len(turns) > WARM_TURNS else [1, 1]
    result = {
        "scene": arguments.scene, "minutes": (time.monotonic() - start) / 60, "clicks": clicks, "validation": layers,
        "messages": log.count("\n"), "nonfinite": nonfinite, "ended_early": ended, "exit_code": code,
        "resident_mb_at_rest": [round(turn[0] / 1e6, 1) for turn in turns],
        "heap_mb_at_rest": [round(turn[1] / 1e6, 1) for turn in turns],
        "resident_growth": growth[0], "heap_growth": growth[1],
        "resident_peak_mb_by_quarter": [
            round(max(s[0] for s in samples[i * quarter : (i + 1) * quarter] or samples[-1:]) / 1e6, 1) for i in range(4)
        ],
        "device_mb_max": max(s[1] for s in samples) / 1e6,
    }  # fmt: skip
    failed = ended or code != 0 or nonfinite or log or max(growth) > GROWTH
    if log:
        result["log"] = log[:2000]
    return result, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("what", choices=["latency", "toggle", "soak"])
    parser.add_argument("scene", nargs="?", default="cornell")
    parser.add_argument("--size", default="128x72")
    parser.add_argument("--samples", type=int, default=200)
    parser.add_argument("--minutes", type=float, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--no-validate", dest="validate", action="store_false", help="soak without the validation layer")
    arguments = parser.parse_args()
    arguments.program = os.path.abspath(arguments.program)
    if os.path.exists(arguments.scene):
        arguments.scene = os.path.abspath(arguments.scene)
    if not shutil.which("Xvfb") or not shutil.which("xdotool"):
        print("SKIPPED, NOT MEASURED: Xvfb or xdotool is not installed")
        sys.exit(77)
    failed = False
    with tempfile.TemporaryDirectory(prefix="trichrome-bench-") as name:
        display = Display(pathlib.Path(name))
        try:
            result = {"latency": latency, "toggle": toggle, "soak": soak}[arguments.what](arguments, display, pathlib.Path(name))
            if arguments.what == "soak":
                result, failed = result
        finally:
            display.server.terminate()
            display.server.wait()
    print(json.dumps(result, indent=2))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
