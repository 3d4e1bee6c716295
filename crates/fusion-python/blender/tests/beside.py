"""Ten pairs through this extension and through Blender's own Boolean + Bevel: `python beside.py [clamped] [NAME…]`.

Prints the table of docs/blender.md. Crossings are counted by the engine in both results, as Blender keeps them. The seam is
measured on the sharp boolean: a point of it counts as rounded where the surface of the result is between a half and twice
as far away as that of the arc.
"""

import math
import os
import sys
import time

import bpy
import harness
import numpy as np
from mathutils.bvhtree import BVHTree

SEGMENTS = 6
CLAMPED = "clamped" in sys.argv


def primitive(name, at=(0, 0, 0), turned=(0, 0, 0), **options):
    getattr(bpy.ops.mesh, f"primitive_{name}_add")(location=at, rotation=turned, **options)
    return bpy.context.object


def ball(at=(0, 0, 0), radius=1.0):
    return primitive("uv_sphere", at, segments=72, ring_count=36, radius=radius)


def post(at=(0, 0, 0), turned=(0, 0, 0.1), radius=0.4, depth=3.0):
    return primitive("cylinder", at, turned, vertices=48, radius=radius, depth=depth)


def ring(at=(0, 0, 0), turned=(0, 0, 0)):
    return primitive("torus", at, turned, major_segments=72, minor_segments=36, major_radius=1.0, minor_radius=0.3)


def cone(at=(0, 0, 0), turned=(0, 0, 0.1)):
    return primitive("cone", at, turned, vertices=48, radius1=0.8, radius2=0.2, depth=3.0)


# Name, operation, radius, and the two objects.
PAIRS = [
    ("cube − cylinder", "difference", 0.1, lambda: (harness.cube(cuts=4), post())),
    ("cube + cylinder", "union", 0.1, lambda: (harness.cube(cuts=4), post())),
    ("cube − sphere", "difference", 0.1, lambda: (harness.cube(cuts=4), ball((0.3, 0.2, 1.0), 0.6))),
    ("sphere + sphere", "union", 0.1, lambda: (ball(), ball((1.1, 0.2, 0.1), 0.8))),
    ("sphere − cylinder", "difference", 0.08, lambda: (ball(), post(radius=0.3))),
    ("torus + sphere", "union", 0.08, lambda: (ring(), ball((1.0, 0.1, 0.0), 0.45))),
    ("torus + cube", "union", 0.06, lambda: (ring(), harness.cube(size=0.8, at=(1.05, 0.03, 0.02), cuts=3))),
    ("cylinder + cylinder", "union", 0.08, lambda: (post(), post(turned=(math.pi / 2, 0.0, 0.05), radius=0.3))),
    ("cone + torus", "union", 0.05, lambda: (cone(), ring((0.0, 0.05, -0.6), (0.3, 0, 0)))),
    ("sphere ∩ cube", "intersection", 0.08, lambda: (ball(), harness.cube(size=1.5, at=(0.1, 0.05, 0.1), cuts=4))),
]


def main():
    harness.enable()
    print("| pair | faces in | crossings | time | seam rounded | Blender: crossings | time | seam rounded |")
    print("|---|---|---|---|---|---|---|---|")
    wanted = [word for word in sys.argv[1:] if word != "clamped"]
    for name, operation, radius, make in PAIRS:
        if wanted and name not in wanted:
            continue
        harness.empty()
        a, b = make()
        faces = len(a.data.polygons) + len(b.data.polygons)
        ours = row(*fusion(a, b, operation, radius), *seam(a, b, operation, radius))
        harness.empty()
        a, b = make()
        theirs = row(*blender(a, b, operation, radius), *seam(a, b, operation, radius))
        print(f"| {name} | {faces} | {ours} | {theirs} |", flush=True)
    os._exit(0)


def row(mesh, seconds, points, reach):
    import fusion_mesh as fm

    if mesh is None:
        return "no result | | "
    crossings = fm.info(mesh)["self_intersections"]
    # What is too broken to be told apart into triangles that cross is no count.
    crossings = "not a manifold" if crossings is None else crossings
    tree = BVHTree.FromPolygons(mesh[0].tolist(), mesh[1].tolist())
    away = np.array([tree.find_nearest(p)[3] for p in points.tolist()])
    share = np.mean((away > reach / 2) & (away < 2 * reach)) if len(points) else math.nan
    return f"{crossings} | {1000 * seconds:.0f} ms | {share:.0%}"


def fusion(a, b, operation, radius):
    start = time.perf_counter()
    try:
        result = harness.boolean(a, b, operation=operation, radius=radius, as_wire=False)
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return None, 0
    seconds = time.perf_counter() - start
    return arrays(result.data), seconds


def blender(a, b, operation, radius):
    modifier = a.modifiers.new("boolean", "BOOLEAN")
    modifier.operation, modifier.object, modifier.solver = operation_of(operation), b, "EXACT"
    bevel = a.modifiers.new("bevel", "BEVEL")
    bevel.limit_method, bevel.angle_limit = "ANGLE", math.radians(30)
    # Clamped, which is Blender's default, it is held back by the short edges along the seam until nothing is rounded.
    bevel.width, bevel.segments, bevel.use_clamp_overlap = radius, SEGMENTS, CLAMPED
    start = time.perf_counter()
    made = arrays(bpy.data.meshes.new_from_object(a.evaluated_get(bpy.context.evaluated_depsgraph_get())))
    seconds = time.perf_counter() - start
    a.modifiers.clear()
    return made, seconds


def operation_of(name):
    return {"intersection": "INTERSECT"}.get(name, name.upper())


def arrays(mesh):
    """Points and triangles."""
    mesh.calc_loop_triangles()
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    faces = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", faces)
    return points.reshape(-1, 3).astype(np.float64), faces.reshape(-1, 3)


def seam(a, b, operation, radius):
    """Points of the sharp seam in the first object's frame, and how far from each the arc is."""
    import fusion_mesh as fm

    into = a.matrix_world.inverted()
    parts = []
    for thing in (a, b):
        points, faces = arrays(thing.data)
        matrix = np.array(into @ thing.matrix_world)
        parts.append((points @ matrix[:3, :3].T + matrix[:3, 3], faces))
    result = getattr(fm, operation)(*parts)
    points, faces, part = result.vertices, result.faces.astype(np.int64), result.origins.faces["part"]
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort(edges.T)
    pairs = order.reshape(-1, 2)
    crossing = pairs[part[owner[pairs[:, 0]]] != part[owner[pairs[:, 1]]]]
    middle = points[edges[crossing[:, 0]]].mean(axis=1)
    normals = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cosine = np.einsum("nc,nc->n", normals[owner[crossing[:, 0]]], normals[owner[crossing[:, 1]]])
    # A ball that touches both sides is this far from the edge between them.
    reach = radius * (1 / np.cos(np.arccos(np.clip(cosine, -1, 1)) / 2) - 1)
    return middle, reach


main()
