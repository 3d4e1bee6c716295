"""An object's evaluated mesh as arrays, in the object's own coordinates."""

from dataclasses import dataclass, field

import numpy as np

# Names of the values of each type of attribute, how many, and their type. Text and matrices are not carried.
TYPES = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, np.bool_),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "QUATERNION": ("value", 4, np.float32),
    "INT32_2D": ("value", 2, np.int32),
}
# What the mesh itself is made of, and what belongs to the editor.
_OWN = {"position", "material_index", "custom_normal", "fusion_origin"}
SEAM = "uv_seam"
KINDS = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


@dataclass
class Layer:
    """Values of one attribute: a row each for points, edges, faces or corners."""

    name: str
    domain: str
    type: str
    values: np.ndarray


@dataclass
class Surface:
    """What is read from one object."""

    points: np.ndarray
    corner_points: np.ndarray
    starts: np.ndarray
    sizes: np.ndarray
    edges: np.ndarray
    triangles: np.ndarray
    """Corner ids of each triangle."""
    triangle_polygons: np.ndarray
    material_ids: np.ndarray
    layers: list = field(default_factory=list)
    groups: dict = field(default_factory=dict)
    """The weights of every point by the name of the vertex group."""
    materials: list = field(default_factory=list)
    """Names, with None for an empty slot."""
    normals: np.ndarray = None
    """Of every corner, where they are custom."""
    selected_edges: np.ndarray = None
    active_uv: str = ""
    active_color: str = ""


def read(thing, depsgraph):
    """The surface of an object, with its modifiers and shape keys."""
    if thing.fusion.kind != "NONE" and not thing.modifiers:
        # A result is there before Blender evaluates it.
        return _read(thing.data, thing)
    evaluated = thing.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
    if mesh is None:
        return None
    try:
        return _read(mesh, thing)
    finally:
        evaluated.to_mesh_clear()


def _read(mesh, thing):
    mesh.calc_loop_triangles()
    points = _get(mesh.vertices, "co", 3, np.float32).astype(np.float64)
    surface = Surface(
        points=points,
        corner_points=_get(mesh.loops, "vertex_index", 1, np.int32),
        starts=_get(mesh.polygons, "loop_start", 1, np.int32),
        sizes=_get(mesh.polygons, "loop_total", 1, np.int32),
        edges=_get(mesh.edges, "vertices", 2, np.int32).reshape(-1, 2),
        triangles=_get(mesh.loop_triangles, "loops", 3, np.int32).reshape(-1, 3),
        triangle_polygons=_get(mesh.loop_triangles, "polygon_index", 1, np.int32),
        material_ids=_get(mesh.polygons, "material_index", 1, np.int32),
    )
    surface.layers = [layer for layer in map(_layer, mesh.attributes) if layer is not None]
    surface.groups = _groups(mesh, thing)
    surface.selected_edges = _get(mesh.edges, "select", 1, np.bool_)
    surface.materials = [slot.material.name if slot.material else None for slot in thing.material_slots]
    if mesh.has_custom_normals:
        surface.normals = _get(mesh.corner_normals, "vector", 3, np.float32)
    surface.active_uv = mesh.uv_layers.active.name if mesh.uv_layers.active else ""
    surface.active_color = mesh.color_attributes.active_color_name or ""
    return surface


def _get(items, name, width, dtype):
    values = np.empty(len(items) * width, dtype=dtype)
    items.foreach_get(name, values)
    return values if width == 1 else values.reshape(-1, width)


def _layer(attribute):
    known = TYPES.get(attribute.data_type)
    # Hidden in older versions of Blender.
    title = SEAM if attribute.name == f".{SEAM}" else attribute.name
    if known is None or title.startswith(".") or title in _OWN:
        return None
    name, width, dtype = known
    values = _get(attribute.data, name, width, dtype)
    return Layer(title, attribute.domain, attribute.data_type, values)


def _groups(mesh, thing):
    """Weights have no array of their own in Blender: this walks over the points."""
    if not thing.vertex_groups or not mesh.vertices:
        return {}
    weights = {group.index: np.zeros(len(mesh.vertices), dtype=np.float32) for group in thing.vertex_groups}
    for point in mesh.vertices:
        for element in point.groups:
            if element.group in weights:
                weights[element.group][point.index] = element.weight
    return {group.name: weights[group.index] for group in thing.vertex_groups}
