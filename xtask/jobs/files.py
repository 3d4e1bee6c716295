"""Reading of files."""

import numpy as np

from inputs import sphere


def reading(table):
    import trimesh

    v, f = sphere(7)
    for kind in ("obj", "ply", "stl"):
        path, job = table.path(f"ball.{kind}"), f"read {len(f):,} triangles, {kind.upper()}"
        trimesh.Trimesh(v, f, process=False).export(path)
        table.ours_alone(job, ["read", path])

        def meshlib():
            import meshlib.mrmeshpy as mm
            return lambda: mm.loadMesh(path)

        def pymeshlab():
            import pymeshlab
            return lambda: pymeshlab.MeshSet().load_new_mesh(path)

        def trimesh_():
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
