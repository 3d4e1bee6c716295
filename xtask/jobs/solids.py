"""Two surfaces that cross: booleans and the curves alone."""

import numpy as np

from inputs import sphere

SHIFT = (0.7, 0.3, 0.2)


def booleans(table):
    for levels in (6, 7):
        (v, f), (w, g) = sphere(levels), sphere(levels, SHIFT)
        job = f"union of two spheres, {len(f):,} triangles each"
        paths = [table.file("a.ply", v, f), table.file("b.ply", w, g)]
        table.ours_alone(job, ["union", *paths])

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


def curves(table):
    for levels in (6, 7):
        (v, f), (w, g) = sphere(levels), sphere(levels, SHIFT)
        job = f"intersection curves of two spheres, {len(f):,} triangles each"
        points = lambda n: f"{n:,} points"
        table.ours_alone(job, ["curves", table.file("a.ply", v, f), table.file("b.ply", w, g)], points)

        def trueform():
            import trueform as tf
            return lambda: tf.intersection_curves(tf.Mesh(f, v), tf.Mesh(g, w))

        def meshlib():
            import meshlib.mrmeshnumpy as mn
            import meshlib.mrmeshpy as mm

            def run():
                a, b = mn.meshFromFacesVerts(f, v), mn.meshFromFacesVerts(g, w)
                return mm.findIntersectionContours(a, b)
            return run

        def libigl():
            from igl.copyleft import cgal
            return lambda: cgal.intersect_other(v, f.astype(np.int64), w, g.astype(np.int64))

        table.peer(job, "trueform", trueform, lambda made: points(len(made[1])))
        # The first point of a closed curve stands at its end again.
        table.peer(job, "meshlib (32 bits)", meshlib, lambda made: points(sum(len(c) - 1 for c in made)))
        table.peer(job, "libigl (CGAL)", libigl, rounds=1)
