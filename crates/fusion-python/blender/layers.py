"""The attributes of a result, from where its points and corners came from."""

import numpy as np

from .polygons import NEW
from .spread import spread

_SMOOTH = {"FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR"}


def of_points(stack, made, polygons, values):
    """An attribute of points. New points take what spreads from around them; flags and whole numbers are 0 there."""
    table = values.reshape(len(values), -1)
    if table.dtype.kind != "f":
        main = np.take_along_axis(made.point_sources, made.point_weights.argmax(axis=1)[:, None], axis=1)[:, 0]
        picked = table[main].copy()
        picked[made.point_kinds == NEW] = 0
        return picked.reshape(-1, *values.shape[1:])
    blended = np.einsum("nk,nkc->nc", made.point_weights, table[made.point_sources].astype(np.float64))
    is_known = made.point_kinds != NEW
    if not is_known.all():
        blended = spread(blended, is_known, made.edges)
    return blended.astype(values.dtype).reshape(-1, *values.shape[1:])


def of_corners(layer, made, polygons):
    """An attribute of corners. On new polygons it goes on from the polygons around them."""
    values = layer.values
    table = values.reshape(len(values), -1)
    is_new = np.isnan(polygons.weights[:, 0])
    if layer.type not in _SMOOTH:
        heaviest = np.nan_to_num(polygons.weights).argmax(axis=1)[:, None]
        picked = table[np.take_along_axis(polygons.corners, heaviest, axis=1)[:, 0]].copy()
        picked[is_new] = 0
        return picked.reshape(-1, *values.shape[1:])
    out = np.empty((len(is_new), table.shape[1]))
    whole = polygons.weights[:, 0] == 1.0
    out[whole] = table[polygons.corners[whole, 0]]
    rest = ~whole & ~is_new
    out[rest] = np.einsum("nk,nkc->nc", polygons.weights[rest], table[polygons.corners[rest]].astype(np.float64))
    if is_new.any():
        out[is_new] = _continued(out, is_new, made, polygons)
    return out.astype(values.dtype).reshape(-1, *values.shape[1:])


def _continued(out, is_new, made, polygons):
    count = len(made.points)
    owner = polygons.corner_points[~is_new]
    near = np.bincount(owner, minlength=count)
    sums = np.stack([np.bincount(owner, weights=c, minlength=count) for c in out[~is_new].T], axis=1)
    mean = sums / np.maximum(near, 1)[:, None]
    return spread(mean, near > 0, made.new_edges)[polygons.corner_points[is_new]]


def of_faces(values, polygons):
    """An attribute of faces: 0 on new ones."""
    picked = values[np.maximum(polygons.sources, 0)].copy()
    picked[polygons.sources < 0] = 0
    return picked


def normals(stack, polygons):
    """Custom normals of all corners; 0, which stands for Blender's own, where they are not known."""
    out = np.zeros((len(polygons.weights), 3))
    known = ~np.isnan(polygons.weights[:, 0])
    out[known] = np.einsum("nk,nkc->nc", polygons.weights[known], stack.normals[polygons.corners[known]])
    return out
