#!/usr/bin/env python3
"""finegrain's flow past a cylinder in turns with PySPH's, the same particles and neighbours: best and median of all rounds.

Usage: benches/pysph/compare.py [WIDTH] [ROUNDS]

PySPH (PyPI) is installed into an environment of its own, target/pysph, the first time, which compiles it; where that
does not work it is named and left out. Both evaluate once a step, with laminar viscosity, on all cores and on one.
"""

import csv
import os
import statistics
import subprocess
import sys
from pathlib import Path

WIDTH, ROUNDS = sys.argv[1:3] + ["0.001", "3"][len(sys.argv[1:3]) :]
STEPS = "12"
ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "target/bench-pysph"
PYTHON = ROOT / "target/pysph/bin/python"
CORES = len(os.sched_getaffinity(0))
OURS = ["cargo", "run", "--release", "--quiet", "--", "bench", "cylinder", "--sizes", WIDTH, "--steps", STEPS]
OURS += ["--repeats", "1", "--viscous-form", "morris", "--out", OUT]
THEIRS = [PYTHON, Path(__file__).with_name("peer.py"), WIDTH, STEPS]


def install():
    """Whether PySPH is there."""
    if PYTHON.exists():
        return True
    pip = [PYTHON, "-m", "pip", "install", "-q"]
    commands = [[sys.executable, "-m", "venv", PYTHON.parents[1]], [*pip, "pysph==1.0b2", "setuptools<81"]]
    try:
        for command in commands:
            subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"PySPH could not be installed and is left out: {error}")
        return False
    return True


def run(command, folder=ROOT, **environment):
    """Standard output of a command run in a folder; empty if it fails."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env={**os.environ, **environment})
    if done.returncode != 0:
        print(f"{command[0]} failed and is left out: {done.stderr.strip()[-300:]}")
    return done.stdout if done.returncode == 0 else ""


def note(name, workers, particles, seconds):
    speeds.setdefault((name, workers), []).append(1e-3 * particles / seconds)


speeds = {}
has_peer = install()
for _ in range(int(ROUNDS)):
    for precision in ["f64", "mixed"]:
        if run([*OURS, "--precision", precision]):
            for row in csv.DictReader((OUT / "cylinder.csv").open()):
                seconds = float(row["seconds_per_step_median"])
                note(f"finegrain, {precision}", int(row["workers"]), int(row["particles"]), seconds)
    for workers in [1, CORES] if has_peer else []:
        # It writes logs where it runs.
        words = run(THEIRS, PYTHON.parents[1], OMP_NUM_THREADS=str(workers)).split("\n")
        words = words[-2].split() if len(words) > 1 else []
        if words:
            note("PySPH, f64", workers, int(words[0]), statistics.median(map(float, words[1:])))

print(f"cylinder, width {WIDTH} m, {STEPS} steps, thousand particle-steps a second, {ROUNDS} rounds")
print("| | workers | best | median | over PySPH |\n|---|---|---|---|---|")
for (name, workers), values in sorted(speeds.items()):
    theirs = speeds.get(("PySPH, f64", workers))
    ratio = f"{statistics.median(values) / statistics.median(theirs):.2f}" if theirs else "-"
    print(f"| {name} | {workers} | {max(values):.0f} | {statistics.median(values):.0f} | {ratio} |")
