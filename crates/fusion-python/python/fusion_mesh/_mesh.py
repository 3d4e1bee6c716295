"""Triangle meshes as plain arrays."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _native
from ._picture import thumbnail
from ._types import FloatArray, IntArray

if TYPE_CHECKING:
    import trimesh

__all__ = ["Mesh"]


class Mesh:
    """A triangle mesh: two arrays, and what a file may hold beside them.

    Parameters
    ----------
    vertices : array of float64, shape (N, 3)
        Positions in model units.
    faces : array of integers, shape (M, 3)
        Corners of each triangle, counter-clockwise seen from outside.
    uvs, normals, colors : arrays of float64, shapes (M, 3, 2), (M, 3, 3), (M, 3, 4), optional
        Attributes of face corners; NaN where a corner has none.
    face_groups : array of uint32, shape (M,), optional
        Index into `group_names` for each face.
    face_materials : array of uint32, shape (M,), optional
        Index into `materials` for each face.

    Notes
    -----
    Arrays of the right type and order are kept as they are, not copied. An operation copies them once, into the engine's
    memory, and converts int64 faces while it does.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> corner = fm.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> corner
    <fusion_mesh.Mesh: 4 vertices, 4 faces>
    """

    def __init__(
        self,
        vertices: Any,
        faces: Any,
        *,
        uvs: Any = None,
        normals: Any = None,
        colors: Any = None,
        face_groups: Any = None,
        group_names: Sequence[str] = (),
        face_materials: Any = None,
        materials: Sequence[Any] = (),
        polygons: Optional[Sequence[Any]] = None,
        notes: Sequence[str] = (),
    ) -> None:
        self.vertices: FloatArray = vertices_from(vertices, "vertices")
        self.faces: IntArray = faces_from(faces, "faces")
        self.uvs: Optional[FloatArray] = _floats(uvs)
        self.normals: Optional[FloatArray] = _floats(normals)
        self.colors: Optional[FloatArray] = _floats(colors)
        self.face_groups: Optional[IntArray] = _ids(face_groups)
        self.group_names: List[str] = list(group_names)
        self.face_materials: Optional[IntArray] = _ids(face_materials)
        self.materials: List[Any] = list(materials)
        self.polygons: Optional[List[Any]] = None if polygons is None else list(polygons)
        self.notes: Tuple[str, ...] = tuple(notes)

    def __repr__(self) -> str:
        return f"<fusion_mesh.Mesh: {len(self.vertices)} vertices, {len(self.faces)} faces>"

    def save(self, path: Union[str, "os.PathLike[str]"]) -> List[str]:
        """Write a mesh file; the extension tells the format.

        Parameters
        ----------
        path : path
            ``.obj``, ``.stl``, ``.ply``, ``.off``, ``.glb``, ``.gltf`` or ``.3mf``. An existing file stays as it was if
            anything fails.

        Returns
        -------
        list of str
            Every file that was written, side files first.

        Raises
        ------
        OutputError
            The file cannot be written.
        """
        files, _ = _native.write(("mesh", self), os.fspath(path))
        return [os.fspath(file) for file in files]

    def to_trimesh(self) -> "trimesh.Trimesh":
        """The mesh as a ``trimesh.Trimesh``, vertices and faces as they are."""
        import trimesh

        return trimesh.Trimesh(vertices=self.vertices, faces=self.faces.astype(np.int64), process=False)

    def to_pyvista(self) -> Any:
        """The mesh as a ``pyvista.PolyData``."""
        import pyvista

        faces: Any = self.faces.astype(np.int64)
        return pyvista.PolyData.from_regular_faces(self.vertices, faces)

    def _repr_png_(self) -> bytes:
        return thumbnail(self)


def vertices_from(array: Any, name: str) -> FloatArray:
    """Positions in the engine's type and order; the array itself where it is so already."""
    values = _array(array, name)
    if values.dtype.kind not in "fiu":
        raise TypeError(f"{name}: expected real numbers of shape (N, 3), got {_told(values)}")
    if values.ndim != 2 or values.shape[1] != 3:
        raise ValueError(f"{name}: expected shape (N, 3), got {_told(values)}")
    return np.ascontiguousarray(values, dtype=np.float64)


def faces_from(array: Any, name: str) -> IntArray:
    """Triangles in a type and order that the engine reads; the array itself where it is so already."""
    values = _array(array, name)
    if values.dtype.kind not in "iu":
        raise TypeError(f"{name}: expected integers of shape (M, 3), got {_told(values)}")
    if values.ndim != 2 or values.shape[1] != 3:
        raise ValueError(f"{name}: expected shape (M, 3), got {_told(values)}")
    if values.dtype not in (np.dtype(np.uint32), np.dtype(np.int32), np.dtype(np.int64)):
        if values.dtype == np.uint64 and values.size and int(values.max()) >= 2**63:
            raise ValueError(f"{name}: {int(values.max())} names a missing vertex")
        values = values.astype(np.int64)
    return np.ascontiguousarray(values)


def _array(array: Any, name: str) -> Any:
    try:
        values = np.asarray(array)
    except ValueError as error:
        raise ValueError(f"{name}: rows of different lengths do not make an array ({error})") from None
    if np.ma.isMaskedArray(array):
        raise TypeError(f"{name}: a masked array has no value where it is masked; fill it first")
    # Other byte orders are not the machine's.
    return values if values.dtype.isnative else values.astype(values.dtype.newbyteorder("="))


def _told(values: Any) -> str:
    return f"{values.dtype} of shape {values.shape}"


def _floats(array: Any) -> Optional[FloatArray]:
    return None if array is None else np.ascontiguousarray(array, dtype=np.float64)


def _ids(array: Any) -> Optional[IntArray]:
    return None if array is None else np.ascontiguousarray(array, dtype=np.uint32)
