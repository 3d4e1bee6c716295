"""The same inputs through this program and through packaged peers, as a Markdown table.

usage: cargo xtask bench --peers, or: python3 xtask/peers.py PROGRAM FIT, the second rbf-solve's example of that name

Each job runs three times and the best counts. Wall-clock time means little on a busy machine, so processor seconds of all
threads are given as well: of a peer from arrays to arrays, of ours of the whole program with reading, checking and writing, so
that ours are an upper bound. The wall-clock time of ours is that of the report's stages named.
"""

import importlib.metadata
import json
import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

ROUNDS = 3


def sphere(levels, shift=(0.0, 0.0, 0.0)):
    """A subdivided icosahedron: points and triangles."""
    g = (1 + 5**0.5) / 2
    v = np.array([[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g], [0, -1, -g], [0, 1, -g],
                  [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]])
    f = np.array([[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2],
                  [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5],
                  [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1]])
    for _ in range(levels):
        edges = np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
        unique, index = np.unique(edges, axis=0, return_inverse=True)
        ab, bc, ca = (index.reshape(3, -1) + len(v))
        v = np.vstack([v, (v[unique[:, 0]] + v[unique[:, 1]]) / 2])
        a, b, c = f.T
        f = np.vstack([np.stack(t, axis=1) for t in [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]])
    v = v / np.linalg.norm(v, axis=1, keepdims=True)
    return np.ascontiguousarray(v + shift), np.ascontiguousarray(f.astype(np.int32))


def timed(job, who=resource.RUSAGE_SELF):
    best = (float("inf"), float("inf"))
    for _ in range(ROUNDS):
        before, start = resource.getrusage(who), time.perf_counter()
        job()
        wall, after = time.perf_counter() - start, resource.getrusage(who)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best = (min(best[0], wall), min(best[1], cpu))
    return best


class Table:
    def __init__(self, program, folder):
        self.program, self.folder, self.rows = program, folder, []

    def path(self, name):
        return os.path.join(self.folder, name)

    def ours(self, job, arguments, stages):
        report, walls = self.path("report.json"), []

        def run():
            subprocess.run([self.program, *arguments, "--report", report, "--quiet"], check=True, capture_output=True)
            made = json.load(open(report))["stages"]
            walls.append(sum(s["milliseconds"] for s in made if s["name"] in stages) / 1e3)

        wall, cpu = timed(run, resource.RUSAGE_CHILDREN)
        self.rows.append((job, "fusion", min(walls) if stages else wall, cpu, ", ".join(stages) or "whole program"))

    def peer(self, job, name, prepare):
        package = name.split()[0]
        try:
            version = importlib.metadata.version(package)
            wall, cpu = timed(prepare())
            self.rows.append((job, f"{name} {version}", wall, cpu, ""))
        except Exception as error:  # A peer that is not there or refuses is a row, not a failure.
            self.rows.append((job, name, None, None, f"{type(error).__name__}: {str(error)[:60]}"))

    def print(self):
        ours = {job: cpu for job, name, _, cpu, _ in self.rows if name == "fusion"}
        print("| job | program | clock | processor | processor, ours = 1 | |\n|---|---|---|---|---|---|")
        for job, name, wall, cpu, note in self.rows:
            figures = ["", "", ""]
            if wall is not None:
                figures[0] = f"{1e3 * wall:.0f} ms"
            if cpu is not None:
                figures[1:] = [f"{1e3 * cpu:.0f} ms", f"{cpu / ours[job]:.1f}"]
            print("| " + " | ".join([job, name, *figures, note]) + " |")


def write_files(table, v, f):
    import trimesh

    for kind in ("obj", "ply", "stl"):
        trimesh.Trimesh(v, f, process=False).export(table.path(f"ball.{kind}"))


def reading(table):
    v, f = sphere(7)
    write_files(table, v, f)
    for kind in ("obj", "ply", "stl"):
        path, job = table.path(f"ball.{kind}"), f"read {len(f):,} triangles, {kind.upper()}"
        table.ours(job, ["features", path, "--angle", "179", "--no-radii"], ["read"])

        def meshlib():
            import meshlib.mrmeshpy as mm
            return lambda: mm.loadMesh(path)

        def pymeshlab():
            import pymeshlab
            return lambda: pymeshlab.MeshSet().load_new_mesh(path)

        def trimesh_():
            import trimesh
            return lambda: trimesh.load(path, process=kind == "stl")

        def libigl():
            import igl
            return lambda: igl.read_triangle_mesh(path)

        def trueform():
            import trueform as tf
            read = {"obj": lambda: tf.read_obj(path, 3, dtype=np.float64), "stl": lambda: tf.read_stl(path)}[kind]
            return read

        for name, prepare in [("meshlib", meshlib), ("pymeshlab", pymeshlab), ("trimesh", trimesh_), ("libigl", libigl),
                              ("trueform", trueform)]:
            if (name, kind) != ("trueform", "ply"):
                table.peer(job, name, prepare)


def booleans(table):
    import trimesh

    for levels in (6, 7):
        (v, f), (w, g) = sphere(levels), sphere(levels, (0.7, 0.3, 0.2))
        job = f"union of two spheres, {len(f):,} triangles each"
        for name, points in (("a.ply", v), ("b.ply", w)):
            trimesh.Trimesh(points, f, process=False).export(table.path(name))
        table.ours(job, ["union", table.path("a.ply"), table.path("b.ply"), "-o", table.path("o.ply")],
                   ["connect", "boolean"])

        def manifold():
            import manifold3d as m
            solids = [m.Manifold(m.Mesh64(p, t.astype(np.uint64))) for p, t in ((v, f), (w, g))]
            return lambda: (solids[0] + solids[1]).num_tri()

        def manifold_arrays():
            import manifold3d as m
            solid = lambda p: m.Manifold(m.Mesh64(p, f.astype(np.uint64)))
            return lambda: (solid(v) + solid(w)).num_tri()

        def meshlib():
            import meshlib.mrmeshnumpy as mn
            import meshlib.mrmeshpy as mm
            a, b = mn.meshFromFacesVerts(f, v), mn.meshFromFacesVerts(g, w)
            return lambda: mm.boolean(a, b, mm.BooleanOperation.Union)

        def trueform():
            import trueform as tf
            return lambda: tf.boolean_union(tf.Mesh(f, v), tf.Mesh(g, w))

        table.peer(job, "manifold3d (solids ready)", manifold)
        table.peer(job, "manifold3d", manifold_arrays)
        table.peer(job, "meshlib (meshes ready, 32 bits)", meshlib)
        table.peer(job, "trueform", trueform)


def remeshing(table):
    import trimesh

    v, f = sphere(6)
    job, length = f"five rounds of remeshing, {len(f):,} triangles, edge length 0.02", 0.02
    trimesh.Trimesh(v, f, process=False).export(table.path("a.ply"))
    table.ours(job, ["remesh", table.path("a.ply"), "-o", table.path("o.ply"), "--edge-length", str(length)],
               ["connect", "remesh"])

    def gpytoolbox():
        import gpytoolbox as g
        return lambda: g.remesh_botsch(v, f, 5, length, True)

    def pymeshlab():
        import pymeshlab as p

        def run():
            meshes = p.MeshSet()
            meshes.add_mesh(p.Mesh(v, f))
            meshes.meshing_isotropic_explicit_remeshing(iterations=5, targetlen=p.PureValue(length))
        return run

    def trueform():
        import trueform as tf
        return lambda: tf.isotropic_remeshed((f, v), length, iterations=5)

    table.peer(job, "gpytoolbox", gpytoolbox)
    table.peer(job, "pymeshlab", pymeshlab)
    table.peer(job, "trueform", trueform)


def fields(table):
    """Constraints on a bumpy ball and off it, and points around it to evaluate at."""
    golden = np.pi * (3 - 5**0.5)
    for kernel, ours in (("linear", "biharmonic"), ("cubic", "triharmonic")):
        for count, evaluated in ((3_000, 100_000), (10_000, 20_000)):
            i = np.arange(count // 2)
            z = 1 - (4 * i + 2) / count
            s = np.sqrt(1 - z * z)
            d = np.stack([s * np.cos(golden * i), s * np.sin(golden * i), z], -1)
            on = d * (1 + 0.1 * np.sin(5 * d[:, :1]) * np.cos(4 * d[:, 1:2]))
            tau = 0.1 * (12 / count) ** 0.5
            places, values = np.vstack([on, on + tau * d]), np.repeat([0.0, tau], count // 2)
            points = np.random.default_rng(1).uniform(-1.2, 1.2, (evaluated, 3))
            np.hstack([places, values[:, None]]).tofile(table.path("constraints"))
            points.tofile(table.path("points"))
            call = [sys.argv[2], ours, table.path("constraints"), table.path("points")]
            fit, values_at = (f"{what} of {count:,} constraints, {ours}" for what in ("fit", f"{evaluated:,} values"))
            runs = [json.loads(subprocess.run(call, check=True, capture_output=True).stdout) for _ in range(ROUNDS)]
            for job, stage in ((fit, "fit"), (values_at, "evaluate")):
                note = f"residual {runs[0]['residual']:.0e} of the box" if stage == "fit" else ""
                table.rows.append((job, "fusion", min(r[stage] for r in runs), None, note))
            if count > 3_000 and kernel == "cubic":
                continue  # Minutes, and nothing new.
            from scipy.interpolate import RBFInterpolator

            since = time.perf_counter()
            made = RBFInterpolator(places, values, kernel=kernel, degree=1)
            table.rows.append((fit, "scipy " + importlib.metadata.version("scipy"), time.perf_counter() - since, None, "once"))
            since = time.perf_counter()
            made(points)
            table.rows.append((values_at, "scipy " + importlib.metadata.version("scipy"), time.perf_counter() - since, None, "once"))


def main():
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {time.strftime('%Y-%m-%d')}.\n")
    with tempfile.TemporaryDirectory() as folder:
        table = Table(sys.argv[1], folder)
        for jobs in (reading, booleans, remeshing, fields):
            jobs(table)
        table.print()


main()
