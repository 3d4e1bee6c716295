"""What a live object is made of now: surfaces, frame, options."""

import hashlib
import json
from dataclasses import dataclass

import bpy
import numpy as np

from . import edges, options, settings
from .problems import Problem
from .stack import stack
from .surface import KINDS, read

_surfaces = {}
# Matrices have 32 bits: two objects that move together move apart by a rounding error.
_DIGITS = 6


@dataclass
class Snapshot:
    """Everything a job needs; it has nothing of Blender's in it."""

    stack: object
    function: str
    options: dict
    frame: np.ndarray
    key: str


def forget(uids=None):
    """Forgets the surfaces of these objects, or of all."""
    if uids is None:
        _surfaces.clear()
    else:
        for uid in uids:
            _surfaces.pop(uid, None)


def sources(thing):
    """The objects that a live object is made of.

    Raises `Problem` if one of them is gone.
    """
    found = []
    for number, entry in enumerate(thing.fusion.sources, 1):
        source = entry.object
        if source is None or not source.users_scene:
            name = f' "{source.name}"' if source else ""
            raise Problem(f"source {number}{name} is not in any scene", remedy="Choose another source, or bake")
        if source == thing:
            raise Problem(f"source {number} is the result itself", remedy="Choose another source")
        found.append(source)
    least = 2 if thing.fusion.kind == "BOOLEAN" else 1
    if len(found) < least:
        raise Problem(f"{least} sources are needed, there are {len(found)}", remedy="Add a source")
    return found


def take(thing):
    """The state of a live object's sources and options."""
    group = thing.fusion
    found = sources(thing)
    surfaces = surfaces_of(found)
    frame, matrices = frame_of(found)
    joined = stack([s for s, _ in surfaces], matrices)
    if group.kind == "BOOLEAN":
        function = group.operation
        given = options.values("boolean", group.boolean, settings.BOOLEAN_WITHOUT)
    else:
        function = "blend"
        given = options.values("blend", group.blend, settings.BLEND_WITHOUT)
        given.update(_chosen(group, surfaces[0][0], joined))
    return Snapshot(joined, function, given, frame, _key(function, given, surfaces, matrices))


def surfaces_of(things):
    """The surface of every object with its digest, read again only where it has changed.

    Raises `Problem` for what is no surface.
    """
    depsgraph = graph_of(things)
    return [_surface(thing, depsgraph) for thing in things]


def _surface(thing, depsgraph):
    if thing.session_uid in _surfaces:
        return _surfaces[thing.session_uid]
    if thing.type not in KINDS:
        raise Problem(f'"{thing.name}" is no mesh', remedy="Choose objects with a surface")
    surface = read(thing, depsgraph)
    if surface is None or len(surface.triangles) == 0:
        raise Problem(f'"{thing.name}" has no faces', remedy="Give it faces, or choose another object")
    bad = np.flatnonzero(~np.isfinite(surface.points).all(axis=1))
    if len(bad):
        message = f'"{thing.name}": vertex {bad[0]} is at a place that is no number'
        raise Problem(message, remedy=f"Delete vertex {bad[0]}, or give it a place")
    _surfaces[thing.session_uid] = surface, _digest(surface)
    return _surfaces[thing.session_uid]


def graph_of(things):
    """A dependency graph that holds all of these objects."""
    context = bpy.context
    layers = [context.view_layer] + [layer for scene in bpy.data.scenes for layer in scene.view_layers]
    for layer in layers:
        if all(layer.objects.get(thing.name) == thing for thing in things):
            if layer.depsgraph is None:
                layer.update()
            return layer.depsgraph
    raise Problem("the objects are not all in one scene", remedy="Link them to the scene of the first")


def frame_of(things):
    """Place and rotation of the first object, and the matrix of each in that frame.

    Points of the first keep their bits unless it is scaled; a scale is applied, so that lengths are those of the scene.
    """
    first = things[0].matrix_world
    place, rotation, scale = first.decompose()
    frame = np.array(rotation.to_matrix().to_4x4())
    frame[:3, 3] = place
    into = np.linalg.inv(frame)
    matrices = [into @ np.array(thing.matrix_world) for thing in things]
    if not all(np.isfinite(m).all() and abs(np.linalg.det(m[:3, :3])) > 0 for m in matrices):
        raise Problem("an object is scaled to nothing", remedy="Give it a scale other than 0")
    plain = np.diag([*scale, 1.0])
    if np.allclose(plain, matrices[0], atol=1e-5 * max(map(abs, scale))):
        matrices[0] = plain
    return frame, matrices


def _chosen(group, surface, joined):
    """Which edges of a blend."""
    if group.edges == "ANGLE":
        return {}
    name = group.attribute if group.edges == "CUSTOM" else group.edges
    is_marked = edges.marked(surface, name)
    if is_marked is None or not is_marked.any():
        label = next(label for word, label, _ in settings.EDGES if word == group.edges)
        raise Problem(f"no edge is chosen ({label.lower()})", remedy="Choose edges, or blend them by angle")
    return {"curves": edges.curves(joined, is_marked)}


def _digest(surface):
    state = hashlib.blake2b(digest_size=16)
    for value in vars(surface).values():
        items = value.values() if isinstance(value, dict) else value if isinstance(value, list) else [value]
        for item in items:
            values = getattr(item, "values", item)
            state.update(values.tobytes() if isinstance(values, np.ndarray) else repr(item).encode())
    return state.hexdigest()


def _key(function, given, surfaces, matrices):
    state = hashlib.blake2b(digest_size=16)
    state.update(json.dumps([function, given], sort_keys=True).encode())
    for (_, digest), matrix in zip(surfaces, matrices):
        state.update(digest.encode())
        state.update((np.round(matrix, _DIGITS) + 0.0).tobytes())
    return state.hexdigest()
