"""Code that peers generate for the heat equation (7 points) and the wave equation (order 8, 25 points) on a cube.

Usage: peer.py PEER CASE SIDE THREADS, with PEER pystencils or devito, and CASE such as heat-f64. Says `ready`, then,
for each line it reads, runs STEPS steps in each way that is named in it, in all if none is, and prints `way speed` in
million points a second, then `done`.

Both have ghost points around SIDE^3 points, which nobody fills: all time is spent in their kernels. Coefficients are
numbers in the code.
"""

import os
import sys
import time

peer, case, side, threads = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:5])
equation, scalar = case.replace("f", "float").split("-")
# They wait asleep, for somebody else is measured meanwhile.
os.environ.update(OMP_NUM_THREADS=str(threads), OMP_PROC_BIND="true", OMP_WAIT_POLICY="passive")

import numpy as np

STEPS = 8
# Diffusivity dt / dx^2; square of wave speed dt / dx.
HEAT, WAVE = 0.15, 0.2
# Coefficients of the second derivative of order 8.
HERE, SHIFTED = -205 / 72, [8 / 5, -1 / 5, 8 / 315, -1 / 560]


def of_pystencils():
    """Functions that run STEPS steps, by name: whatever its options make, for which is fastest depends on the case."""
    import pystencils as ps

    ghosts = {"heat": 1, "wave": 4}[equation]
    handling = ps.create_data_handling((side,) * 3, default_ghost_layers=ghosts, default_layout="fzyx")
    now, new = (handling.add_array(name, dtype=np.dtype(scalar), alignment=64) for name in ["now", "new"])
    for name in ["now", "new"]:
        handling.fill(name, 0.5, ghost_layers=True)

    def around(by):
        return sum(now[tuple(by * sign * (a == b) for b in range(3))] for a in range(3) for sign in (1, -1))

    if equation == "heat":
        rule = ps.Assignment(new.center, now.center + HEAT * (around(1) - 6 * now.center))
    else:
        laplacian = 3 * HERE * now.center + sum(c * around(by + 1) for by, c in enumerate(SHIFTED))
        # The state before is read where the next one is written: two arrays, as ours.
        rule = ps.Assignment(new.center, 2 * now.center - new.center + WAVE * laplacian)

    def way(is_vector, is_past_caches, blocks):
        config = ps.CreateKernelConfig(target=ps.Target.CurrentCPU, default_dtype=scalar)
        config.cpu.openmp.enable = True
        config.cpu.openmp.num_threads = threads
        config.cpu.loop_blocking = blocks
        if is_vector:
            config.cpu.vectorize.enable = True
            config.cpu.vectorize.assume_inner_stride_one = True
            config.cpu.vectorize.use_nontemporal_stores = is_past_caches
        kernel = ps.create_kernel(rule, config).compile()

        def run():
            for _ in range(STEPS):
                handling.run_kernel(kernel)
                handling.swap("now", "new")

        return run

    ways = {}
    for kind, options in [("past-caches", (True, True)), ("vectors", (True, False)), ("compiler", (False, False))]:
        for name, blocks in [("rows", None), ("blocks", (side, 16, 16)), ("slabs", (side, 8, 64))]:
            ways[f"pystencils,{kind},{name}"] = way(*options, blocks)
    return ways


def of_devito():
    """The same. It tunes its blocks itself, before anything is measured."""
    from devito import Eq, Grid, Operator, TimeFunction, configuration

    configuration["log-level"] = "ERROR"
    configuration["language"] = "openmp"
    grid = Grid(shape=(side,) * 3, extent=(side - 1.0,) * 3, dtype=np.dtype(scalar).type)
    space, order = {"heat": (2, 1), "wave": (8, 2)}[equation]
    u = TimeFunction(name="u", grid=grid, space_order=space, time_order=order)
    u.data[:] = 0.5
    rule = {"heat": u + HEAT * u.laplace, "wave": 2 * u - u.backward + WAVE * u.laplace}[equation]

    def way(flag):
        configuration["compiler"].cflags.append(flag)
        operator = Operator(Eq(u.forward, rule), subs=grid.spacing_map, opt="advanced")
        operator.apply(time_m=1, time_M=2, autotune="basic")
        tuned = operator._state["autotuning"][-1]["tuned"]
        configuration["compiler"].cflags.remove(flag)
        return lambda: operator.apply(time_m=1, time_M=STEPS, **tuned)

    # Left to itself the compiler takes half of the length of vectors.
    return {"devito": way("-O3"), "devito,whole-vectors": way("-mprefer-vector-width=512")}


ways = {"pystencils": of_pystencils, "devito": of_devito}[peer]()
for run in ways.values():
    run()
print("ready", flush=True)
for line in sys.stdin:
    for name in line.split() or ways:
        run = ways[name]
        start = time.perf_counter()
        run()
        seconds = time.perf_counter() - start
        print(name, f"{1e-6 * STEPS * side**3 / seconds:.1f}")
    print("done", flush=True)
