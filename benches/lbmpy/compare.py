#!/usr/bin/env python3
"""finegrain's lattice Boltzmann in turns with lbmpy's, on the same cube: best and median of all rounds, and ratios.

Usage: benches/lbmpy/compare.py [SIDE] [ROUNDS]

lbmpy (PyPI) is installed into an environment of its own, target/lbmpy, the first time; where that does not work
it is named and left out. Its rows are bare kernels of TRT without boundaries; ours are whole steps.
"""

import re
import statistics
import subprocess
import sys
from pathlib import Path

SIDE, ROUNDS = sys.argv[1:3] + ["128", "3"][len(sys.argv[1:3]) :]
THREADS = subprocess.run(["nproc"], capture_output=True, text=True, check=True).stdout.strip()
ROOT = Path(__file__).resolve().parents[2]
PYTHON = ROOT / "target/lbmpy/bin/python"
OURS = ["cargo", "bench", "--bench", "lbm", "--", SIDE, "1", "short"]
THEIRS = [PYTHON, Path(__file__).with_name("peer.py"), SIDE, THREADS, "1"]


def install():
    """Whether lbmpy is there."""
    if PYTHON.exists():
        return True
    folder = PYTHON.parents[1]
    commands = [[sys.executable, "-m", "venv", folder], [PYTHON, "-m", "pip", "install", "-q", "lbmpy==2.0"]]
    try:
        for command in commands:
            subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"lbmpy could not be installed and is left out: {error}")
        return False
    return True


def measured(command):
    """Standard output of a command run in the root folder."""
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{command[0]} failed and is left out: {done.stderr.strip()[-300:]}")
    return done.stdout if done.returncode == 0 else ""


speeds = {}
has_peer = install()
for _ in range(int(ROUNDS)):
    row = r"\| (.+?) \| (\d+) \| ([a-z-]+) \| ([\d.]+) \|"
    for name, workers, schedule, best in re.findall(row, measured(OURS)):
        speeds.setdefault(f"{name}, {workers} workers, {schedule}", []).append(float(best))
    for line in measured(THEIRS).splitlines() if has_peer else []:
        scalar, pattern, speed = line.split()
        speeds.setdefault(f"lbmpy, {scalar}, {pattern}, {THREADS} threads", []).append(float(speed))

print(f"D3Q19, {SIDE}^3 sites, million updates a second, {ROUNDS} rounds")
print("| | best | median |\n|---|---|---|")
for name, values in speeds.items():
    print(f"| {name} | {max(values):.1f} | {statistics.median(values):.1f} |")
for scalar in ["f64", "f32"]:
    peers = [values for name, values in speeds.items() if f"lbmpy, {scalar}" in name]
    for name, values in speeds.items() if peers else []:
        if f"{scalar}, InPlace, {THREADS} workers" in name:
            ratios = [of(values) / max(map(of, peers)) for of in (max, statistics.median)]
            print(f"{name} over lbmpy's best: {ratios[0]:.2f} (best), {ratios[1]:.2f} (median)")
