"""From the arguments of a function to its result."""

from __future__ import annotations

import warnings
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import _native
from ._edges import Edges
from ._errors import FusionWarning
from ._inputs import Part, as_mesh, parts
from ._progress import Bar, listener
from ._result import Result
from ._types import MeshLike, Progress

_STACK = 3


def run(
    operation: str,
    meshes: Sequence[MeshLike],
    names: Sequence[str],
    options: Mapping[str, Any],
    precision: str,
    threads: Optional[int],
    progress: Progress,
) -> Result:
    """Run an operation, and tell its warnings."""
    if not meshes:
        raise TypeError("meshes: at least one is needed")
    given, inputs = gathered(options, parts(meshes, names))
    heard = listener(progress)
    try:
        answer = _native.run(operation, given, inputs, precision, count(threads), heard)
    finally:
        if isinstance(heard, Bar):
            heard.close()
    for warning in answer["report"]["warnings"]:
        warnings.warn(warning, FusionWarning, stacklevel=_STACK)
    return Result(answer, precision)


def gathered(options: Mapping[str, Any], inputs: List[Part]) -> Tuple[Dict[str, Any], List[Part]]:
    """The options as the engine reads them. Meshes in regions become further parts."""
    given: Dict[str, Any] = {}
    for name, value in options.items():
        convert = _CONVERSIONS.get(name)
        if value is not None:
            given[name] = value if convert is None else convert(value, inputs)
    return given, inputs


def count(threads: Optional[int]) -> Optional[int]:
    """A number of threads."""
    if threads is None:
        return None
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)):
        raise TypeError(f"threads: expected a whole number, got {type(threads).__name__}")
    if not 1 <= threads <= 1024:
        raise ValueError(f"threads: {threads} is not a number from 1 to 1024")
    return int(threads)


def chosen(edges: Any, options: Dict[str, Any]) -> Dict[str, Any]:
    """The options of a blend with those of a selection of edges."""
    if edges is None:
        return options
    if not isinstance(edges, Edges):
        raise TypeError(f"edges: expected what fusion_mesh.edges() gives, got {type(edges).__name__}")
    return {**options, **edges.options}


def _list(value: Any, _: List[Part]) -> Any:
    """One item may stand for a list of one."""
    return value if isinstance(value, (list, tuple, np.ndarray)) else [value]


def _points(value: Any, _: List[Part]) -> Any:
    if isinstance(value, dict):
        return [value]
    numbers = isinstance(value, (list, tuple, np.ndarray)) and len(value) == 3 and all(np.ndim(x) == 0 for x in value)
    return [value] if numbers and not any(isinstance(x, dict) for x in value) else value


def _plane(value: Any, _: List[Part]) -> Any:
    return value if isinstance(value, dict) or len(value) != 2 else {"point": value[0], "normal": value[1]}


def _loops(value: Any, _: List[Part]) -> Any:
    single = isinstance(value, str) or (len(value) == 2 and all(np.ndim(x) == 0 and not isinstance(x, str) for x in value))
    listed = [value] if single else value
    return [loop if isinstance(loop, str) else ":".join(str(int(number)) for number in loop) for loop in listed]


def _within(value: Any, _: List[Part]) -> Any:
    return _solid(value, "within")


def _drop(value: Any, _: List[Part]) -> Any:
    return _solid(value, "drop")


def _solid(value: Any, name: str) -> Any:
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        return value
    mesh = as_mesh(value, name)
    return {"positions": mesh.vertices, "faces": mesh.faces}


def _rotation(value: Any, _: List[Part]) -> Any:
    return value if isinstance(value, dict) or len(value) != 2 else {"axis": value[0], "angle": value[1]}


def _sources(value: Any, inputs: List[Part]) -> Any:
    regions = []
    for region in value if isinstance(value, (list, tuple)) else [value]:
        if isinstance(region, dict) and "mesh" in region:
            others = {key: item for key, item in region.items() if key != "mesh"}
            regions.append({**others, "part": str(len(inputs))})
            inputs.append(("source", as_mesh(region["mesh"], "source")))
        elif isinstance(region, str) or hasattr(region, "__fspath__"):
            regions.append({"file": region})
        else:
            regions.append(region)
    return regions


def _target(value: Any, _: List[Part]) -> Any:
    return {"file": value} if isinstance(value, str) or hasattr(value, "__fspath__") else value


def _seams(value: Any, _: List[Part]) -> Any:
    origins = value.origins if isinstance(value, Result) else value
    faces = getattr(origins, "faces", None)
    if faces is None:
        return value
    return [None if part < 0 else part for part in faces["part"].tolist()]


_CONVERSIONS = {
    "along": _points,
    "drop": _drop,
    "ids": _list,
    "loops": _loops,
    "near": _points,
    "path": _points,
    "plane": _plane,
    "profile_at": _list,
    "radius_at": _list,
    "rotate": _rotation,
    "seams": _seams,
    "silhouette": _list,
    "source": _sources,
    "target": _target,
    "within": _within,
}
