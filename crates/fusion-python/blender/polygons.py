"""The polygons of a result: those of the inputs whose triangles all came back whole, and triangles for the rest."""

from dataclasses import dataclass

import numpy as np

WHOLE, NEW = 0, 3


@dataclass
class Polygons:
    """Polygons and where each came from."""

    corner_points: np.ndarray
    sizes: np.ndarray
    sources: np.ndarray
    """The input polygon of each polygon; -1 for a new one."""
    corners: np.ndarray
    """Three input corners for each corner, between which it lies."""
    weights: np.ndarray
    """How much each of the three weighs; NaN for corners of new polygons."""
    whole: int
    """How many polygons of inputs came back; they are the first."""


def assemble(stack, made):
    """Joins the triangles of a result to polygons where they were one before. Everything is done on whole arrays."""
    faces = made.faces.astype(np.int64)
    triangle = made.face_sources
    is_whole = (made.face_kinds == WHOLE) & (triangle >= 0)
    corner_points, is_kept, is_turned = _kept(stack, made, faces, triangle, is_whole)

    kept = np.flatnonzero(is_kept)
    sizes = stack.sizes[kept]
    source_corners = _ragged(stack.starts[kept], sizes, is_turned[kept])
    joined = is_whole.copy()
    joined[is_whole] = is_kept[stack.triangle_polygons[triangle[is_whole]]]
    rest = np.flatnonzero(~joined)
    known = triangle[rest] >= 0
    rest_corners = np.zeros((len(rest), 3), np.int64)
    rest_corners[known] = stack.triangles[triangle[rest[known]]]
    sources = np.full(len(rest), -1, np.int64)
    sources[known] = stack.triangle_polygons[triangle[rest[known]]]
    rest_weights = made.corner_weights[rest].reshape(-1, 3).copy()
    rest_weights[np.repeat(~known, 3)] = np.nan

    one = np.zeros((len(source_corners), 3))
    one[:, 0] = 1.0
    return Polygons(
        corner_points=np.concatenate([corner_points[source_corners], faces[rest].ravel()]),
        sizes=np.concatenate([sizes, np.full(len(rest), 3, sizes.dtype)]),
        sources=np.concatenate([kept, sources]),
        corners=np.concatenate([np.repeat(source_corners[:, None], 3, axis=1), np.repeat(rest_corners, 3, axis=0)]),
        weights=np.concatenate([one, rest_weights]),
        whole=len(kept),
    )


def _kept(stack, made, faces, triangle, is_whole):
    """The result's point at each input corner, which polygons came back, and which of them run the other way round."""
    rows = np.flatnonzero(is_whole)
    of = triangle[rows]
    polygon = stack.triangle_polygons[of]
    source = np.where(made.point_kinds == WHOLE, made.point_sources[:, 0], -1)
    is_corner = stack.corner_points[stack.triangles[of]][:, None, :] == source[faces[rows]][:, :, None]
    place = is_corner.argmax(axis=2)
    fits = is_corner.any(axis=2).all(axis=1)
    turns = (place[:, 1] - place[:, 0]) % 3 == 2
    turned_by_matrix = stack.mirrored[stack.polygon_parts[polygon]]

    corner_points = np.full(len(stack.corner_points), -1, np.int64)
    corners = np.take_along_axis(stack.triangles[of], place, axis=1)
    corner_points[corners.ravel()] = faces[rows].ravel()
    # Sheets that touch get points of their own: two triangles of one polygon may then disagree.
    fits &= (corner_points[corners] == faces[rows]).all(axis=1)

    count = len(stack.sizes)
    wanted = np.bincount(stack.triangle_polygons, minlength=count)
    there = np.bincount(polygon[fits], minlength=count)
    is_kept = (there == wanted) & (wanted > 0)
    is_turned = np.zeros(count, bool)
    is_turned[polygon] = turns ^ turned_by_matrix
    return corner_points, is_kept, is_turned


def _ragged(starts, sizes, is_turned):
    """The corners of polygons one after the other, backwards for those that are turned."""
    first = np.cumsum(sizes) - sizes
    step = np.arange(int(sizes.sum())) - np.repeat(first, sizes)
    backwards = np.repeat(sizes, sizes) - 1 - step
    return np.repeat(starts, sizes) + np.where(np.repeat(is_turned, sizes), backwards, step)
