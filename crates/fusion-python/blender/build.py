"""A result as a Blender mesh. Arrays are copied; nothing here walks over points or faces, but for vertex groups."""

import bpy
import numpy as np

from . import layers, marks
from .polygons import assemble
from .surface import SEAM, TYPES

ORIGIN = "fusion_origin"
NEW_SLOT = "fusion_new_slot"


def fill(thing, stack, made, material=None):
    """Puts a result into the mesh of an object, whose materials and vertex groups become those of all inputs."""
    mesh = thing.data
    polygons = assemble(stack, made)
    slot = _materials(mesh, stack, material)
    mesh.clear_geometry()
    mesh.vertices.add(len(made.points))
    mesh.loops.add(len(polygons.corner_points))
    mesh.polygons.add(len(polygons.sizes))
    mesh.vertices.foreach_set("co", made.points.astype(np.float32).ravel())
    mesh.loops.foreach_set("vertex_index", polygons.corner_points.astype(np.int32))
    mesh.polygons.foreach_set("loop_start", (np.cumsum(polygons.sizes) - polygons.sizes).astype(np.int32))
    ids = layers.of_faces(stack.material_ids, polygons)
    ids[polygons.sources < 0] = slot
    mesh.polygons.foreach_set("material_index", ids.astype(np.int32))
    mesh.update(calc_edges=True)
    _attributes(mesh, stack, made, polygons)
    _groups(thing, stack, made, polygons)
    if stack.normals is not None:
        mesh.normals_split_custom_set(layers.normals(stack, polygons))
    mesh.update()
    return polygons


def _materials(mesh, stack, material):
    """The slots of all inputs, and one more for new faces, whose material may be chosen by hand; gives that slot."""
    wanted = [bpy.data.materials.get(name) if name else None for name in stack.materials]
    slot = len(wanted)
    had = mesh.get(NEW_SLOT, -1)
    if material is None and 0 <= had < len(mesh.materials):
        material = mesh.materials[had]
    wanted.append(material or next((m for m in wanted if m), None))
    if list(mesh.materials) != wanted:
        mesh.materials.clear()
        for entry in wanted:
            mesh.materials.append(entry)
    mesh[NEW_SLOT] = slot
    return slot


def set_new_material(mesh, material):
    """Gives the slot of new faces another material."""
    slot = mesh.get(NEW_SLOT, -1)
    if material is not None and 0 <= slot < len(mesh.materials) and mesh.materials[slot] != material:
        mesh.materials[slot] = material


def _attributes(mesh, stack, made, polygons):
    edges = np.empty(len(mesh.edges) * 2, np.int32)
    mesh.edges.foreach_get("vertices", edges)
    edges = edges.reshape(-1, 2).astype(np.int64)
    edge_sources = marks.sources(stack, made, edges)
    for layer in stack.layers:
        if layer.domain == "POINT":
            values = layers.of_points(stack, made, polygons, layer.values)
        elif layer.domain == "CORNER":
            values = layers.of_corners(layer, made, polygons)
        elif layer.domain == "FACE":
            values = layers.of_faces(layer.values, polygons)
        else:
            values = marks.carried(layer.values, edge_sources)
        _put(mesh, layer.name, layer.type, layer.domain, values)
    parts = np.where(polygons.sources < 0, -1, stack.polygon_parts[np.maximum(polygons.sources, 0)])
    _put(mesh, ORIGIN, "INT", "FACE", parts.astype(np.int32))
    if stack.active_uv in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[stack.active_uv]
    if stack.active_color in mesh.color_attributes:
        mesh.color_attributes.active_color_name = stack.active_color


def _put(mesh, name, kind, domain, values):
    if name == SEAM:
        mesh.edges.foreach_set("use_seam", np.ascontiguousarray(values, dtype=np.bool_))
        return
    attribute = mesh.attributes.get(name)
    if attribute is None:
        attribute = mesh.attributes.new(name, kind, domain)
    key, _, dtype = TYPES[kind]
    # Some names are Blender's own, of a type and domain that it decides.
    if (attribute.data_type, attribute.domain) == (kind, domain) and len(attribute.data) == len(values):
        attribute.data.foreach_set(key, np.ascontiguousarray(values, dtype=dtype).ravel())


def _groups(thing, stack, made, polygons):
    for group in list(thing.vertex_groups):
        if group.name not in stack.groups:
            thing.vertex_groups.remove(group)
    for name, weights in stack.groups.items():
        group = thing.vertex_groups.get(name) or thing.vertex_groups.new(name=name)
        values = layers.of_points(stack, made, polygons, weights)
        group.remove(range(len(values)))
        order = np.argsort(values, kind="stable")
        order = order[values[order] > 0]
        for same in np.split(order, np.flatnonzero(np.diff(values[order])) + 1):
            if len(same):
                group.add(same.tolist(), float(values[same[0]]), "REPLACE")
