"""What Blender's module does, for jobs that others do too: in a process of its own, since it bears no other library before it."""

import importlib.metadata
import multiprocessing

import numpy as np

from table import ROUNDS, timed


def row(table, job, make, *arguments, how="", rounds=ROUNDS):
    """`make(*arguments)` gives the job."""
    try:
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            wall, cpu = pool.apply(measure, (make, arguments, rounds))
        table.add(job, f"bpy {how}{importlib.metadata.version('bpy')}", wall, cpu, "once" if rounds == 1 else "")
    except Exception as error:  # As of any peer.
        table.add(job, f"bpy {how}".strip(), None, None, f"{type(error).__name__}: {str(error)[:60]}")


def measure(make, arguments, rounds):
    wall, cpu, _ = timed(make(*arguments), rounds=rounds)
    return wall, cpu


def bpy():
    import bpy as blender

    if blender.data.objects:
        blender.ops.wm.read_factory_settings(use_empty=True)
    return blender


def add(blender, points, faces):
    """A surface as an object of the scene."""
    mesh = blender.data.meshes.new("surface")
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.astype(np.int32).ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 3, dtype=np.int32))
    mesh.update(calc_edges=True)
    thing = blender.data.objects.new("surface", mesh)
    blender.context.collection.objects.link(thing)
    return thing


def reader(path, kind):
    blender = bpy()
    read = getattr(blender.ops.wm, f"{kind}_import")
    return lambda: read(filepath=path)


def union(solver, surfaces):
    blender = bpy()
    a, b = (add(blender, *surface) for surface in surfaces)
    both = a.modifiers.new("both", "BOOLEAN")
    both.operation, both.object, both.solver = "UNION", b, solver

    def run():
        a.update_tag()
        made = a.evaluated_get(blender.context.evaluated_depsgraph_get())
        return len(made.to_mesh().polygons)
    return run
