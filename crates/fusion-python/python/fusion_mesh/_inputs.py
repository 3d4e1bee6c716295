"""Meshes from whatever holds one."""

from __future__ import annotations

import os
from typing import Any, List, Sequence, Tuple

import numpy as np

from . import _native
from ._errors import InputError
from ._mesh import Mesh, faces_from, vertices_from
from ._types import MeshLike

Part = Tuple[str, Mesh]


def as_mesh(mesh: MeshLike, name: str = "mesh") -> Mesh:
    """A `Mesh` from whatever holds one.

    Parameters
    ----------
    mesh : mesh-like
        A `Mesh` or `Result`; anything with ``.vertices`` and ``.faces`` (trimesh) or ``.triangles`` (Open3D); ``(V, F)`` with
        F an array or a list of polygons; a PyVista ``PolyData``; a path.
    name : str
        What an exception calls it.

    Returns
    -------
    Mesh
        Float64 and integer arrays that are C-contiguous are taken over without a copy.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> fm.as_mesh((square, [[0, 1, 2, 3]]))
    <fusion_mesh.Mesh: 4 vertices, 2 faces>
    """
    return _checked(_mesh(mesh, name), name)


def parts(meshes: Sequence[MeshLike], names: Sequence[str]) -> List[Part]:
    """Meshes with the names of their arguments."""
    return [(name, as_mesh(mesh, name)) for mesh, name in zip(meshes, names)]


def _mesh(mesh: Any, name: str) -> Mesh:
    if isinstance(mesh, Mesh):
        # Arrays may have been assigned since.
        mesh.vertices = vertices_from(mesh.vertices, f"{name}.vertices")
        mesh.faces = faces_from(mesh.faces, f"{name}.faces")
        return mesh
    if isinstance(mesh, (str, os.PathLike)):
        return Mesh(**_native.read(os.fspath(mesh)))
    inner = getattr(mesh, "mesh", None)
    if isinstance(inner, Mesh):
        return _mesh(inner, name)
    if _has(mesh, "points", "faces", "n_points"):
        return _from_pyvista(mesh, name)
    if _has(mesh, "vertices", "faces"):
        return _from_pair(mesh.vertices, mesh.faces, name)
    if _has(mesh, "vertices", "triangles"):
        return _from_pair(np.asarray(mesh.vertices), np.asarray(mesh.triangles), name)
    if _has(mesh, "vertex", "triangle"):
        return _from_pair(mesh.vertex.positions.numpy(), mesh.triangle.indices.numpy(), name)
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return _from_pair(mesh[0], mesh[1], name)
    raise TypeError(
        f"{name}: a {type(mesh).__name__} is not a mesh; give an object with .vertices and .faces, a pair (V, F), "
        "a PyVista PolyData or a path"
    )


def _checked(mesh: Mesh, name: str) -> Mesh:
    for what, array in (("vertices", mesh.vertices), ("faces", mesh.faces)):
        if len(array) == 0:
            raise InputError(f"{name}: the mesh has no {what}")
    return mesh


def _has(mesh: Any, *names: str) -> bool:
    return all(hasattr(mesh, name) for name in names)


def _from_pair(vertices: Any, faces: Any, name: str) -> Mesh:
    points = vertices_from(vertices, f"{name}.vertices")
    if isinstance(faces, np.ndarray) or not _is_polygons(faces):
        if np.ndim(faces) != 2 or np.shape(faces)[1] <= 3:
            return Mesh(points, faces_from(faces, f"{name}.faces"))
    rows = [faces_row(row, f"{name}.faces") for row in faces]
    sizes = np.array([len(row) for row in rows], dtype=np.uint32)
    corners = np.concatenate(rows) if rows else np.empty(0, dtype=np.int64)
    return _from_polygons(points, sizes, corners, name)


def _is_polygons(faces: Any) -> bool:
    """Whether these are rows of different lengths."""
    return isinstance(faces, (list, tuple)) and len({len(row) for row in faces if hasattr(row, "__len__")}) > 1


def faces_row(row: Any, name: str) -> Any:
    """The corners of one polygon."""
    ids = np.asarray(row)
    if ids.ndim != 1 or ids.dtype.kind not in "iu":
        raise TypeError(f"{name}: a polygon is a list of vertex ids, got {row!r}")
    return ids.astype(np.int64)


def _from_pyvista(mesh: Any, name: str) -> Mesh:
    if getattr(mesh, "n_strips", 0):
        mesh = mesh.triangulate()
    points = vertices_from(mesh.points, f"{name}.points")
    flat = np.asarray(mesh.faces)
    if flat.size and flat.size % 4 == 0 and (flat[::4] == 3).all():
        return Mesh(points, np.ascontiguousarray(flat.reshape(-1, 4)[:, 1:]))
    starts = []
    at = 0
    while at < len(flat):
        starts.append(at)
        at += int(flat[at]) + 1
    sizes = flat[starts].astype(np.uint32)
    corners = np.delete(flat, starts)
    return _from_polygons(points, sizes, corners, name)


def _from_polygons(points: Any, sizes: Any, corners: Any, name: str) -> Mesh:
    if len(corners) and not 0 <= int(corners.min()) <= int(corners.max()) < len(points):
        wrong = int(corners.min()) if corners.min() < 0 else int(corners.max())
        raise InputError(f"{name}.faces: {wrong} names a missing vertex; there are {len(points)}")
    return Mesh(**_native.triangulate(name, points, sizes, corners.astype(np.uint32)))
