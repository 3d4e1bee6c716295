"""What arguments may be. Only type checkers look at most of this."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
"""An array of float64."""
IntArray = npt.NDArray[Any]
"""An array of integers."""

MeshLike = Any
"""A `Mesh` or `Result`; anything with ``.vertices`` and ``.faces``; ``(V, F)``; a PyVista ``PolyData``; an Open3D mesh; a path."""

Length = Union[float, str]
"""Model units, or a share of the diagonal of the box around all inputs, such as ``"2%"``."""
Radius = Union[float, str, Sequence[Union[float, str]]]
"""A length, or two: what the ball keeps from the left and from the right side of a curve."""
Point = Union[Sequence[float], FloatArray]
"""Three numbers."""
Points = Union[Sequence[Point], FloatArray]
"""A list of points, or an array of shape (N, 3)."""
Path = Union[str, "os.PathLike[str]"]
"""A file."""
Table = Dict[str, Any]
"""A dictionary with the keys that the option names."""
Region = Union[Path, Table]
"""``{"near": p, "radius": r}``, ``{"group": name}``, ``{"origin": stage}``, ``{"faces": ids}``, or a file of face ids."""
LoopName = Union[str, Tuple[int, int]]
"""A boundary loop: ``(part, loop)``, or ``"part:loop"``."""
Progress = Union[Callable[[str, float], Optional[bool]], bool, None]
"""Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
``True`` shows a bar."""
