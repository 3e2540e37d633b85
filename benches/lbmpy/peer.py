"""lbmpy's generated kernels: million site updates a second on D3Q19, a periodic cube without its boundary sweep.

Usage: peer.py SIDE THREADS REPEATS; prints `scalar pattern speed` of each repeat, patterns in turns.
"""

import os
import sys
import time

side, threads, repeats = map(int, sys.argv[1:4])
os.environ["OMP_NUM_THREADS"] = str(threads)

import numpy as np
from lbmpy import LBMConfig, LBMOptimisation, LBStencil, Method, Stencil, create_lb_ast
from lbmpy.advanced_streaming import Timestep
from pystencils import CreateKernelConfig, Target, create_data_handling

STEPS = 10


def case(scalar, pattern):
    """A function that runs STEPS steps."""
    handling = create_data_handling((side,) * 3, default_ghost_layers=1, default_layout="fzyx")
    kind = {"f64": np.float64, "f32": np.float32}[scalar]
    names = ["src", "dst"] if pattern == "pull" else ["src"]
    fields = [handling.add_array(name, values_per_cell=19, dtype=kind, alignment=64) for name in names]
    for name in names:
        handling.fill(name, 0.0, ghost_layers=True)

    def kernel(timestep):
        config = LBMConfig(
            stencil=LBStencil(Stencil.D3Q19),
            method=Method.TRT,
            relaxation_rates=[1.6, 1.1],
            zero_centered=True,
            streaming_pattern=pattern,
            timestep=timestep,
        )
        optimisation = LBMOptimisation(
            symbolic_field=fields[0],
            symbolic_temporary_field=fields[-1] if pattern == "pull" else None,
            field_layout="fzyx",
            cse_global=True,
        )
        target = CreateKernelConfig(
            target=Target.CPU,
            data_type=scalar.replace("f", "float"),
            cpu_openmp=threads,
            cpu_vectorize_info={
                "instruction_set": "avx512",
                "assume_inner_stride_one": True,
                "nontemporal": pattern == "pull",
                "assume_aligned": False,
            },
        )
        return create_lb_ast(lbm_config=config, lbm_optimisation=optimisation, config=target).compile()

    if pattern == "pull":
        pull = kernel(Timestep.BOTH)

        def run():
            for _ in range(STEPS):
                handling.run_kernel(pull)
                handling.swap("src", "dst")
    else:
        even, odd = kernel(Timestep.EVEN), kernel(Timestep.ODD)

        def run():
            for _ in range(STEPS // 2):
                handling.run_kernel(even)
                handling.run_kernel(odd)

    return run


cases = {(s, p): case(s, p) for s in ["f64", "f32"] for p in ["pull", "aa", "esopull"]}
for repeat in range(repeats + 1):
    for (scalar, pattern), run in cases.items():
        start = time.perf_counter()
        run()
        seconds = time.perf_counter() - start
        if repeat > 0:
            print(scalar, pattern, f"{1e-6 * STEPS * side**3 / seconds:.1f}", flush=True)
