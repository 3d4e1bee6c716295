"""What an operation gives."""

from __future__ import annotations

import base64
import html
import json
import os
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

from . import _native
from ._errors import InvalidResultError
from ._mesh import Mesh
from ._picture import thumbnail
from ._types import FloatArray, IntArray, Path

if TYPE_CHECKING:
    import trimesh

__all__ = ["Origins", "Result"]

KINDS = {"input": 0, "edge": 1, "piece": 1, "face": 2, "new": 3}

_VERTEX = np.dtype([("kind", "u1"), ("part", "i4"), ("ids", "u4", (2,)), ("weights", "f8", (3,)), ("stage", "i4")])
_FACE = np.dtype([("kind", "u1"), ("part", "i4"), ("face", "u4"), ("stage", "i4")])


class Origins(NamedTuple):
    """Where every vertex and face of a result came from.

    ``vertices`` and ``faces`` are structured arrays, one entry for each vertex and face. ``part`` is the input counted from 0,
    -1 for what no input had; ``stage`` is an index into `stages`, -1 for what came from an input.

    ``vertices["kind"]`` is 0 for a vertex of an input (``ids[0]``, the same bits), 1 for a point on an edge (between ``ids[0]``
    and ``ids[1]``, with ``weights[:2]``), 2 for a point in a face (``ids[0]``, with ``weights``), and 3 for a new one.
    ``faces["kind"]`` is 0 for a whole face of an input (``face``), 1 for a piece of one, and 3 for a new one. Ids that are not
    there are 4294967295.
    """

    vertices: npt.NDArray[Any]
    faces: npt.NDArray[Any]
    stages: List[str]


class Result:
    """What an operation gives: the mesh, and what was done.

    Attributes
    ----------
    mesh : Mesh
        The result. Its arrays are its own.
    report : dict
        The report that ``fusion-cli --report`` writes; docs/report.md lists its keys.
    """

    def __init__(self, answer: Mapping[str, Any], precision: str) -> None:
        self.mesh = Mesh(**answer["mesh"])
        self.report: Dict[str, Any] = answer["report"]
        self._origins: Any = answer["origins"]
        self._nets: Optional[str] = answer["nets"]
        self._precision = precision

    @property
    def vertices(self) -> FloatArray:
        """Those of `mesh`."""
        return self.mesh.vertices

    @property
    def faces(self) -> IntArray:
        """Those of `mesh`."""
        return self.mesh.faces

    @property
    def origins(self) -> Origins:
        """Where every vertex and face came from; see `Origins`."""
        if not isinstance(self._origins, Origins):
            columns = self._origins
            tables = [_table(columns["vertices"], _VERTEX), _table(columns["faces"], _FACE)]
            self._origins = Origins(tables[0], tables[1], columns["stages"])
        return self._origins

    @property
    def diagnostics(self) -> List[Dict[str, Any]]:
        """What there is to tell, as data: ``code``, ``severity``, ``message``, ``at``, ``numbers``, ``remedy``."""
        told: List[Dict[str, Any]] = self.report["diagnostics"]
        return told

    @property
    def nets(self) -> Optional[Any]:
        """Control nets of the patches that `cluster` makes; docs/cluster.md lists the keys. ``None`` for other operations."""
        return None if self._nets is None else json.loads(self._nets)

    def save(self, path: Path) -> List[str]:
        """Write the mesh; see `Mesh.save`.

        STL and glTF hold 32 bits. A result that was not made with ``precision="f32"`` is checked as they hold it, before
        anything is written.

        Raises
        ------
        InvalidResultError
            Rounded to 32 bits the mesh would not be valid.
        """
        if self._precision != "f32":
            self._check_rounded(path)
        return self.mesh.save(path)

    def to_trimesh(self) -> "trimesh.Trimesh":
        """The mesh as a ``trimesh.Trimesh``."""
        return self.mesh.to_trimesh()

    def to_pyvista(self) -> Any:
        """The mesh as a ``pyvista.PolyData``, with the input that each face came from as cell data ``part`` (-1: new)."""
        poly = self.mesh.to_pyvista()
        poly.cell_data["part"] = self.origins.faces["part"]
        return poly

    def __repr__(self) -> str:
        mesh, command = self.mesh, self.report["command"]
        return f"<fusion_mesh.Result of {command}: {len(mesh.vertices)} vertices, {len(mesh.faces)} faces>"

    def _repr_html_(self) -> str:
        owners = self.origins.faces["part"].tolist()
        picture = base64.b64encode(thumbnail(self.mesh, "origin", owners)).decode("ascii")
        validity = self.report["validity"]
        milliseconds = sum(stage["milliseconds"] for stage in self.report["stages"])
        rows = {
            "vertices": f"{len(self.mesh.vertices)} ({self.report['kept_vertices']} kept)",
            "faces": f"{len(self.mesh.faces)} ({self.report['changed_faces']} changed)",
            "closed": validity["closed"],
            "self-intersections": validity["self_intersections"],
            "time": f"{milliseconds:.0f} ms",
        }
        cells = "".join(f"<tr><th>{key}</th><td>{html.escape(str(value))}</td></tr>" for key, value in rows.items())
        image = f'<img width="320" alt="the result" src="data:image/png;base64,{picture}">'
        return f"{image}<table><caption>{html.escape(str(self.report['command']))}</caption>{cells}</table>"

    def _check_rounded(self, path: Path) -> None:
        rounded = _native.as_written(("mesh", self.mesh), os.fspath(path))
        if rounded is None:
            return
        info = _native.info(("mesh", Mesh(**rounded)))
        validity = self.report["validity"]
        same = {key: info[key] == validity[key] for key in ("manifold", "closed") if validity[key] is not None}
        crossings = info["self_intersections"] or 0
        if not all(same.values()) or crossings > (validity["self_intersections"] or 0):
            message = f"rounded to 32 bits, as {os.fspath(path)} holds it, the mesh is not valid"
            raise InvalidResultError(message, {"code": "invalid", "remedy": 'make it with precision="f32"'})


def _table(columns: Mapping[str, Any], dtype: Any) -> npt.NDArray[Any]:
    table = np.empty(len(columns["kind"]), dtype=dtype)
    for name in dtype.names:
        table[name] = columns[name]
    return table
