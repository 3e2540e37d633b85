"""Flow past a cylinder in a periodic box by PySPH, the scene of `finegrain bench cylinder`: close packing, Gaussian kernel
cut at three smoothing lengths, weakly compressible, laminar viscosity, one evaluation a step.

Usage: peer.py WIDTH STEPS. Prints, last, the number of particles and the seconds of every step but the first two.
"""

import sys
import time

import numpy as np
from pysph.base.kernels import Gaussian
from pysph.base.nnps import DomainManager
from pysph.base.utils import get_particle_array_wcsph
from pysph.solver.application import Application
from pysph.solver.solver import Solver
from pysph.sph.basic_equations import ContinuityEquation
from pysph.sph.equation import Group
from pysph.sph.integrator import PECIntegrator
from pysph.sph.integrator_step import WCSPHStep
from pysph.sph.wc.basic import MomentumEquation, TaitEOS
from pysph.sph.wc.viscosity import LaminarViscosity

WIDTH, STEPS = float(sys.argv[1]), int(sys.argv[2])
SPACING, SIDE, RADIUS = 2e-4, 0.025, 5e-3
DENSITY, SOUND_SPEED, VISCOSITY, DRIVING = 1000.0, 6e-3, 1e-6, 1e-5
# Layers of the packing, an even number where the box is periodic.
LAYERS = SPACING * np.array([1.0, np.sqrt(3) / 2, np.sqrt(6) / 3])
COUNTS = [max(2, 2 * round(length / (2 * layer))) for length, layer in zip((SIDE, SIDE, WIDTH), LAYERS)]
LENGTHS = LAYERS * COUNTS


class Cylinder(Application):
    def create_domain(self):
        periodic = {f"periodic_in_{axis}": True for axis in "xyz"}
        ends = {f"{axis}max": length for axis, length in zip("xyz", LENGTHS)}
        return DomainManager(xmin=0.0, ymin=0.0, zmin=0.0, **ends, **periodic)

    def create_particles(self):
        i, j, k = (index.ravel() for index in np.meshgrid(*map(np.arange, COUNTS), indexing="ij"))
        x = LAYERS[0] * (i + 0.5 * ((j + k) % 2) + 0.25)
        y = LAYERS[1] * (j + (k % 2) / 3 + 0.25)
        z = LAYERS[2] * (k + 0.5)
        in_body = (x - 0.5 * LENGTHS[0]) ** 2 + (y - 0.5 * LENGTHS[1]) ** 2 < RADIUS**2
        mass = DENSITY * LAYERS.prod()

        def particles(name, where):
            places = {axis: values[where] for axis, values in zip("xyz", (x, y, z))}
            return get_particle_array_wcsph(name=name, m=mass, rho=DENSITY, h=SPACING, **places)

        arrays = [particles("fluid", ~in_body), particles("body", in_body)]
        self.count = len(x)
        self.moments = []
        return arrays

    def create_equations(self):
        names = ["fluid", "body"]
        states = [TaitEOS(name, None, DENSITY, SOUND_SPEED, 1.0) for name in names]
        sums = [
            ContinuityEquation("fluid", names),
            ContinuityEquation("body", ["fluid"]),
            MomentumEquation("fluid", names, SOUND_SPEED, alpha=0.0, beta=0.0, gx=DRIVING),
            LaminarViscosity("fluid", names, VISCOSITY),
        ]
        return [Group(states, real=False), Group(sums)]

    def create_solver(self):
        integrator = PECIntegrator(fluid=WCSPHStep(), body=WCSPHStep())
        step = 0.125 * SPACING**2 / VISCOSITY
        return Solver(kernel=Gaussian(dim=3), dim=3, integrator=integrator, dt=step, tf=1e9, pfreq=10**9)

    def post_step(self, solver):
        self.moments.append(time.perf_counter())


cylinder = Cylinder()
cylinder.run(["--openmp", "--disable-output", "--max-steps", str(STEPS), "--logfile", ""])
print(cylinder.count, *np.diff(cylinder.moments[1:]))
