"""One surface: remeshing, smoothing, maps into the plane."""

import numpy as np

from inputs import bumpy_surface, sphere


def remeshing(table):
    v, f = sphere(6)
    job, length = f"five rounds of remeshing, {len(f):,} triangles, edge length 0.02", 0.02
    path = table.file("a.ply", v, f)
    table.ours_alone(job, ["remesh", path, str(length), "5"])

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


def smoothing(table):
    """One implicit step of mean-curvature flow: (M + t L) x = M x."""
    for levels in (6, 7):
        v, f = sphere(levels)
        v, t = np.ascontiguousarray(bumpy_surface(v)), 1e-3
        job = f"one implicit step of curvature flow, {len(f):,} triangles"
        out = table.path("flowed")
        table.ours_alone(job, ["flow", table.file("a.ply", v, f), str(t), out])
        ours, wide = np.fromfile(out).reshape(-1, 3), f.astype(np.int64)
        off = lambda made: f"{abs(made - ours).max():.0e} from ours"

        def libigl():
            import igl

            def run():
                mass = igl.massmatrix(v, wide, igl.MASSMATRIX_TYPE_VORONOI)
                a = (mass - t * igl.cotmatrix(v, wide)).tocsc()
                none = np.zeros(0, np.int64)
                return igl.min_quad_with_fixed(a, -(mass @ v), none, np.zeros((0, 3)), empty(a), np.zeros((0, 3)), True)
            return run

        def scipy():
            import igl
            from scipy.sparse.linalg import spsolve

            def run():
                mass = igl.massmatrix(v, wide, igl.MASSMATRIX_TYPE_VORONOI)
                return spsolve((mass - t * igl.cotmatrix(v, wide)).tocsc(), mass @ v)
            return run

        table.peer(job, "libigl", libigl, off)
        table.peer(job, "scipy (spsolve, matrices of libigl)", scipy, off, rounds=1)


def empty(like):
    from scipy.sparse import csc_matrix
    return csc_matrix((0, like.shape[0]))


def harmonic(table):
    """A hilly square onto a disc, its boundary by length."""
    for n in (200, 450):
        i, j = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij")
        v = np.stack([i, j, 0.3 * np.sin(5 * i) * np.cos(4 * j)], -1).reshape(-1, 3)
        at = np.arange(n * n).reshape(n, n)
        a, b, c, d = (x.ravel() for x in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
        f = np.vstack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
        rim = np.concatenate([at[:-1, 0], at[-1, :-1], at[:0:-1, -1], at[0, :0:-1]])
        lengths = np.linalg.norm(v[np.roll(rim, -1)] - v[rim], axis=1)
        turn = 2 * np.pi * (np.cumsum(lengths) - lengths) / lengths.sum()
        held = np.stack([np.cos(turn), np.sin(turn)], -1)
        job, out = f"harmonic map onto a disc, {len(f):,} triangles", table.path("map")
        fixed = table.numbers("fixed", np.hstack([rim[:, None], held]))
        table.ours_alone(job, ["harmonic", table.file("a.ply", v, f), fixed, out])
        ours = np.fromfile(out).reshape(-1, 2)

        def libigl():
            import igl
            return lambda: igl.harmonic(v, f.astype(np.int64), rim.astype(np.int64), held, 1)

        def scipy():
            import igl
            from scipy.sparse.linalg import spsolve

            def run():
                pull = igl.cotmatrix(v, f.astype(np.int64)).tocsr()
                free = np.setdiff1d(np.arange(len(v)), rim)
                made = np.empty((len(v), 2))
                made[rim], made[free] = held, spsolve(pull[free][:, free].tocsc(), -(pull[free][:, rim] @ held))
                return made
            return run

        off = lambda made: f"{abs(made - ours).max():.0e} from ours"
        table.peer(job, "libigl", libigl, off)
        table.peer(job, "scipy (spsolve, matrix of libigl)", scipy, off, rounds=1)
