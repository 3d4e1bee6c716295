"""Fields by radial basis functions: fits, values, zero sets."""

import importlib.metadata
import json
import subprocess
import time

import numpy as np

from inputs import bumpy, bumpy_surface, grid, off_and_on
from table import ROUNDS

# The name of ours, of scipy's, of ferreus_rbf's. All have a linear polynomial beside them.
KERNELS = [("biharmonic", "linear", "Linear"), ("triharmonic", "cubic", "Cubic")]
# Constraints, points to evaluate at, and whether a dense solver is worth the wait.
SIZES = [(3_000, 100_000, True), (10_000, 20_000, True), (100_000, 20_000, False)]


def ferreus(constraints, kernel):
    """A fit to a relative 1e-6, its default."""
    import ferreus_rbf as r
    from ferreus_rbf import interpolant_config as c

    settings = c.InterpolantSettings(getattr(c.RBFKernelType, kernel), drift=c.Drift.Linear)
    return r.RBFInterpolator(np.ascontiguousarray(constraints[:, :3]), np.ascontiguousarray(constraints[:, 3]), settings)


def fits(table):
    for ours, scipys, ferreuss in KERNELS:
        for count, evaluated, dense in SIZES:
            constraints = bumpy(count)
            points = np.random.default_rng(1).uniform(-1.2, 1.2, (evaluated, 3))
            call = [table.fit, ours, table.numbers("constraints", constraints), table.numbers("points", points)]
            fit, values = (f"{what} of {count:,} constraints, {ours}" for what in ("fit", f"{evaluated:,} values"))
            rounds = ROUNDS if count < 50_000 else 1
            runs = [json.loads(subprocess.run(call, check=True, capture_output=True).stdout) for _ in range(rounds)]
            note = f"residual {runs[0]['residual']:.0e} of the box" + ("; once" if rounds == 1 else "")
            table.add(fit, "fusion", min(r["fit"] for r in runs), None, note)
            box = np.linalg.norm(np.ptp(constraints[:, :3], axis=0))
            table.add(values, "fusion", min(r["evaluate"] for r in runs), None,
                      f"off by {runs[0]['off'] / box:.0e} of the box" if runs[0]["off"] > 0 else "exact sums")

            def scipy():
                from scipy.interpolate import RBFInterpolator
                return RBFInterpolator(constraints[:, :3], constraints[:, 3], kernel=scipys, degree=1)

            # Minutes for many cubes, and nothing new.
            if dense and (count == 3_000 or scipys == "linear"):
                once(table, "scipy", fit, values, scipy, lambda made, at: made(at), points, constraints)
            fitted = lambda: ferreus(constraints, ferreuss)
            once(table, "ferreus_rbf", fit, values, fitted, lambda made, at: made.evaluate(at), points, constraints)


def once(table, name, fit, values, make, evaluate, points, constraints):
    """A fit and its values, timed once; the note is the largest miss at the constraints."""
    try:
        version, since = f"{name} {importlib.metadata.version(name)}", time.perf_counter()
        made = make()
        table.add(fit, version, time.perf_counter() - since)
        since = time.perf_counter()
        evaluate(made, points)
        table.add(values, version, time.perf_counter() - since, None, "once")
        some = constraints[:: max(1, len(constraints) // 2000)]
        box = np.linalg.norm(np.ptp(constraints[:, :3], axis=0))
        miss = abs(np.ravel(evaluate(made, np.ascontiguousarray(some[:, :3]))) - some[:, 3]).max() / box
        table.rows[-2] = (*table.rows[-2][:4], f"residual {miss:.0e} of the box; once")
    except Exception as error:
        table.add(fit, name, None, None, f"{type(error).__name__}: {str(error)[:60]}")


def caps(around):
    """The bumpy ball above and below two circles of latitude 30°, the parts that a zero set is followed between."""
    rows, steps = around // 8, np.arange(around) / around
    v, f = [], []
    for sign in (1.0, -1.0):
        latitude = sign * np.linspace(np.pi / 6, np.pi / 2, rows + 1)[:-1, None]
        turn = 2 * np.pi * sign * steps[None, :]
        ring = np.stack([np.cos(latitude) * np.cos(turn), np.cos(latitude) * np.sin(turn),
                         np.sin(latitude) + 0 * turn], -1).reshape(-1, 3)
        start, pole = sum(map(len, v)), len(ring)
        last = pole - around + np.arange(around)
        fan = np.stack([last, np.roll(last, -1), np.full(around, pole)], -1)
        f.append(start + np.vstack([grid(rows, around, False)[:, [0, 1, 2]], fan]))
        v.append(np.vstack([ring, [[0, 0, sign]]]))
    return bumpy_surface(np.vstack(v)), np.vstack(f), np.vstack([v[0][:around], v[1][:around]])


def zero_sets(table):
    """The band between two caps: ours follows it from rim to rim, the others sample a grid of the same cells around it. Fits are not timed."""
    for count, around in ((3_000, 120), (10_000, 200)):
        v, f, rims = caps(around)
        inner = bumpy(count)[: count // 2, :3]
        inner = inner / np.linalg.norm(inner, axis=1, keepdims=True)
        spacing = (4 * np.pi / len(inner)) ** 0.5
        directions = np.vstack([inner[abs(abs(inner[:, 2]) - 0.5) > spacing], rims])
        constraints = off_and_on(directions, spacing)
        cell = 2 * np.pi * np.cos(np.pi / 6) / around
        low, high = np.array([-1.15, -1.15, -0.52]), np.array([1.15, 1.15, 0.52])
        job = f"zero set of {len(constraints):,} constraints, biharmonic, cell {cell:.3f}"
        triangles = lambda n: f"{n:,} triangles"
        table.ours_alone(job, ["field", "biharmonic", table.numbers("constraints", constraints),
                               table.file("caps.ply", v, f), str(cell), table.path("zero")], triangles)

        def cubes(evaluate):
            from skimage.measure import marching_cubes

            axes = [np.arange(a, b + cell, cell) for a, b in zip(low, high)]

            def run():
                values = evaluate(axes)
                return marching_cubes(values.reshape([len(a) for a in axes]), 0.0, spacing=[cell] * 3)
            return run

        def scipy():
            from scipy.interpolate import RBFInterpolator
            made = RBFInterpolator(constraints[:, :3], constraints[:, 3], kernel="linear", degree=1)
            points = lambda axes: np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
            return cubes(lambda axes: made(points(axes)))

        def ferreus_rbf():
            made = ferreus(constraints, "Linear")
            return lambda: made.build_isosurface(np.concatenate([low, high]), cell, 0.0)

        table.peer(job, "scipy + skimage", scipy, lambda made: triangles(len(made[1])), rounds=1)
        table.peer(job, "ferreus_rbf", ferreus_rbf, lambda made: triangles(len(made.facets)))
