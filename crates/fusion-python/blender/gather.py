"""What operators take from the scene: points, strokes, regions, in the frame of a result."""

import bmesh
import bpy
import numpy as np

from .problems import Problem


def into(frame, points):
    """Points of the scene in a frame."""
    points = np.atleast_2d(np.asarray(points, dtype=float))
    back = np.linalg.inv(frame)
    return points @ back[:3, :3].T + back[:3, 3]


def turned(frame, direction):
    """A direction of the scene in a frame."""
    return (np.linalg.inv(frame)[:3, :3] @ np.asarray(direction, dtype=float)).tolist()


def picked(thing, frame):
    """The selected vertices of a mesh, in the order of picking where Blender remembers it."""
    if thing.type != "MESH":
        return []
    matrix = np.array(thing.matrix_world)
    if thing.mode == "EDIT":
        edited = bmesh.from_edit_mesh(thing.data)
        chosen = [one for one in edited.select_history if isinstance(one, bmesh.types.BMVert)]
        found = [v.co for v in chosen] or [v.co for v in edited.verts if v.select]
    else:
        found = [v.co for v in thing.data.vertices if v.select]
    if not found:
        return []
    world = np.array(found) @ matrix[:3, :3].T + matrix[:3, 3]
    return into(frame, world).tolist()


def cursor(context, frame):
    """The 3D cursor: its place, and its Z axis."""
    matrix = np.array(context.scene.cursor.matrix)
    return into(frame, matrix[:3, 3])[0].tolist(), turned(frame, matrix[:3, 2])


def group_faces(surface, name):
    """The triangles all of whose vertices weigh at least a half in a vertex group."""
    weights = surface.groups.get(name)
    if weights is None:
        raise Problem(f'there is no vertex group "{name}"', remedy="Choose one that the object has")
    inside = (weights >= 0.5)[surface.corner_points[surface.triangles]].all(axis=1)
    if not inside.any():
        raise Problem(f'the vertex group "{name}" holds no whole face', remedy="Assign more vertices to it")
    return np.flatnonzero(inside).tolist()


def strokes(things, frame):
    """The points of curves and grease pencil strokes."""
    made = []
    for thing in things:
        matrix = np.array(thing.matrix_world)
        for points in _lines(thing):
            if len(points) > 1:
                world = np.array(points) @ matrix[:3, :3].T + matrix[:3, 3]
                made.append(into(frame, world).tolist())
    return made


STROKES = {"CURVE", "GREASEPENCIL", "GPENCIL"}


def _lines(thing):
    if thing.type == "CURVE":
        depsgraph = bpy.context.evaluated_depsgraph_get()
        mesh = thing.evaluated_get(depsgraph).to_mesh()
        points = [tuple(v.co) for v in mesh.vertices]
        thing.evaluated_get(depsgraph).to_mesh_clear()
        return [points]
    if thing.type == "GREASEPENCIL":
        frames = [layer.current_frame() for layer in thing.data.layers]
        drawn = [stroke for frame in frames if frame for stroke in frame.drawing.strokes]
        return [[tuple(p.position) for p in stroke.points] for stroke in drawn]
    return []


def view_direction(context):
    """Where the 3D view looks; None without one."""
    space = context.space_data
    if space is None or space.type != "VIEW_3D" or space.region_3d is None:
        return None
    return -np.array(space.region_3d.view_matrix.inverted())[:3, 2]
