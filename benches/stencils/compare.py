#!/usr/bin/env python3
"""finegrain's finite differences in turns with code that pystencils and Devito generate: best and median of all rounds.

Usage: benches/stencils/compare.py [SIDE] [ROUNDS] [CASE...], of SIDE (448) points along a side of a cube, the cases
being heat-f64, heat-f32, wave-f64, wave-f32 and plane-f64, which has no peers.

The peers (PyPI) are installed into an environment of their own, target/stencils, the first time; one where that
does not work is named and left out. Theirs are bare kernels within ghost points that nobody fills; ours are whole
steps of periodic cubes: their ends, the check every ten steps that fields are finite, and all that stepping takes.
A copy moves as many points as a step, by as many threads.
"""

import statistics
import subprocess
import sys
from pathlib import Path

CASES = ["heat-f64", "heat-f32", "wave-f64", "wave-f32", "plane-f64"]
SIDE, ROUNDS = sys.argv[1:3] + ["448", "5"][len(sys.argv[1:3]) :]
THREADS = subprocess.run(["nproc"], capture_output=True, text=True, check=True).stdout.strip()
ROOT = Path(__file__).resolve().parents[2]
PYTHON = ROOT / "target/stencils/bin/python"
# Without the second, pystencils does not know what the processor can and generates no vectors.
PEERS = {"pystencils": ["pystencils==2.0", "py-cpuinfo==9.0.0"], "devito": ["devito==4.8.23"]}
# Ways of a peer that go on after a round with all of them.
KEPT = 3


def install():
    """The peers that are there."""
    if not PYTHON.exists():
        subprocess.run([sys.executable, "-m", "venv", PYTHON.parents[1]], check=True)
    there = []
    for peer, packages in PEERS.items():
        has_it = [PYTHON, "-c", f"import {peer}"]
        if subprocess.run(has_it, capture_output=True).returncode != 0:
            subprocess.run([PYTHON, "-m", "pip", "install", "-q", *packages])
        if subprocess.run(has_it, capture_output=True).returncode == 0:
            there.append(peer)
        else:
            print(f"{peer} could not be installed and is left out")
    return there


class Contestant:
    """A process that takes a sample of each of its ways whenever it is asked to."""

    def __init__(self, name, command):
        self.name = name
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(list(map(str, command)), cwd=ROOT, stdin=pipe, stdout=pipe, text=True)
        self.says("ready")

    def says(self, last):
        """The lines until it says that; none if it has ended."""
        lines = []
        for line in self.process.stdout:
            if line.strip() == last:
                return lines
            lines.append(line)
        return []

    def sample(self, ways=()):
        """Speeds by way."""
        if self.process.poll() is not None:
            return {}
        self.process.stdin.write(" ".join(ways) + "\n")
        self.process.stdin.flush()
        return {way: float(speed) for way, speed in (line.split() for line in self.says("done"))}

    def end(self):
        """Lets it check what it has done."""
        self.process.stdin.close()
        if self.process.wait() != 0:
            print(f"{self.name} failed")


def contest(case, peers):
    """Speeds of every round, by way; those of peers under their names."""
    ours = Contestant("finegrain", ["cargo", "bench", "-q", "--bench", "fd", "--", SIDE, case])
    script = Path(__file__).with_name("peer.py")
    theirs = [Contestant(peer, [PYTHON, script, peer, case, SIDE, THREADS]) for peer in peers]
    kept = []
    for peer in theirs:
        first = peer.sample()
        kept.append(sorted(first, key=first.get, reverse=True)[:KEPT])
    speeds = {}
    for _ in range(int(ROUNDS)):
        for contestant, ways in zip([ours, *theirs], [(), *kept]):
            for way, speed in contestant.sample(ways).items():
                speeds.setdefault(way, []).append(speed)
    for contestant in [ours, *theirs]:
        contestant.end()
    return speeds


peers = install()
print(f"{SIDE}^3 points, {THREADS} threads, million points a second, best and median of {ROUNDS} rounds")
print("| case | | best | median | of the best peer: best | median | of a copy: median |\n|---|---|---|---|---|---|---|")
for case in sys.argv[3:] or CASES:
    speeds = contest(case, [] if case.startswith("plane") else peers)
    rivals = [values for way, values in speeds.items() if way.startswith(tuple(PEERS))]
    for way, values in speeds.items():
        cells = [f"{of(values):.0f}" for of in (max, statistics.median)]
        for of in (max, statistics.median):
            cells.append(f"{of(values) / max(map(of, rivals)):.2f}" if rivals else "")
        cells.append(f"{statistics.median(values) / statistics.median(speeds['copy']):.2f}")
        print(f"| {case} | {way} | {' | '.join(cells)} |", flush=True)
