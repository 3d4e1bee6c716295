"""Functions that make no new mesh."""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _native
from ._edges import Edges
from ._inputs import as_mesh, parts
from ._mesh import Mesh
from ._picture import view_of
from ._progress import Bar, listener
from ._result import Result
from ._run import chosen, count, gathered
from ._types import MeshLike, Path, Point, Progress
from ._written import write

__all__ = ["MaxRadius", "box", "features", "info", "max_radius", "render", "sphere"]


class MaxRadius(NamedTuple):
    """The largest radius that works, and what is in the way of a larger one."""

    radius: float
    """In model units, within half a percent."""
    limited_by: str
    """What goes wrong beyond it, or that no larger ball was tried."""
    at: Optional[Tuple[float, float, float]]
    """Where; ``None`` if all balls up to the size of the curves work, as they do where they can roll on the edges of both sides."""


def info(mesh: MeshLike, *, threads: Optional[int] = None, progress: Progress = None) -> Dict[str, Any]:
    """Measure a mesh: counts, shape, volume, defects.

    Parameters
    ----------
    mesh : mesh-like
        Any mesh, sound or not.
    threads : int, optional
        Number of threads; all processors where not given.
    progress : callable or bool, optional
        See `union`.

    Returns
    -------
    dict
        What ``fusion-cli info --json`` prints: ``vertices``, ``faces``, ``components``, ``boundary_loops``, ``genus``,
        ``volume``, ``area``, ``closed``, ``manifold``, ``self_intersections``, ``defects`` and others.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> fm.info(fm.box((1, 2, 2)))["volume"]
    4.0
    """
    part = ("mesh", as_mesh(mesh))
    with _Shown(progress) as heard:
        return _native.info(part, count(threads), heard)


def features(
    mesh: MeshLike,
    *,
    angle: float = 40.0,
    radii: bool = True,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> List[Dict[str, Any]]:
    """List the feature curves of a mesh: edges along which it turns by an angle, joined to curves.

    Parameters
    ----------
    mesh : mesh-like
        An oriented 2-manifold.
    angle : float
        Least angle between the normals of two neighbouring faces, in degrees.
    radii : bool
        Whether to find the largest radius for each curve, which takes time.
    threads : int, optional
        Number of threads; all processors where not given.
    progress : callable or bool, optional
        See `union`.

    Returns
    -------
    list of dict
        ``id``, ``length``, ``convexity``, ``closed``, ``near``, ``max_radius``, ``vertices``, ``points`` and others for each.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> curves = fm.features(fm.box((1, 2, 2)), radii=False)
    >>> len(curves), curves[0]["convexity"]
    (12, 'convex')
    """
    part = ("mesh", as_mesh(mesh))
    with _Shown(progress) as heard:
        return _native.features(part, float(angle), bool(radii), count(threads), heard)


def max_radius(
    *meshes: MeshLike,
    edges: Optional[Edges] = None,
    threads: Optional[int] = None,
    progress: Progress = None,
    **options: Any,
) -> MaxRadius:
    """Find the largest radius at which edges, or the seams of several solids, can be blended.

    Parameters
    ----------
    *meshes : mesh-like
        One mesh, whose edges are meant, or several, whose seams are.
    edges : Edges, optional
        Which edges of one mesh; see `edges`.
    threads : int, optional
        Number of threads; all processors where not given.
    progress : callable or bool, optional
        See `union`.
    **options
        Options of `blend`, or with several meshes of `union` and ``operation="difference"`` or ``"intersection"``.

    Returns
    -------
    MaxRadius
        ``radius``, ``limited_by`` and ``at``.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> limit = fm.max_radius(fm.box((1, 1, 1)))
    >>> 0.45 < limit.radius <= 0.5
    True
    """
    if not meshes:
        raise TypeError("max_radius: give a mesh, or several solids")
    one = len(meshes) == 1
    operation = "blend" if one else "boolean"
    names = ["mesh"] if one else [f"meshes[{i}]" for i in range(len(meshes))]
    given, inputs = gathered(chosen(edges, dict(options)), parts(meshes, names))
    with _Shown(progress) as heard:
        radius, what, at = _native.max_radius(operation, given, inputs, count(threads), heard)
    return MaxRadius(radius, what, None if at is None else (at[0], at[1], at[2]))


def render(
    mesh: MeshLike,
    path: Optional[Path] = None,
    *,
    color: str = "plain",
    view: Optional[Point] = None,
    up: Optional[Point] = None,
    parallel: bool = False,
    wireframe: bool = False,
    size: Union[int, Tuple[int, int]] = 1024,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> bytes:
    """Draw a still picture.

    Parameters
    ----------
    mesh : mesh-like
        What to draw.
    path : path, optional
        A PNG file to write.
    color : {"plain", "curvature", "origin", "quality", "zebra"}
        What colour shows; ``"origin"``, the input that each face came from, needs a `Result`.
    view : point, optional
        Direction from the mesh to the eye.
    up : point, optional
        What is up in the picture; y where not given.
    parallel : bool
        Look along parallel rays.
    wireframe : bool
        Draw the edges.
    size : int or pair of int
        Width and height in pixels.
    threads : int, optional
        Number of threads; all processors where not given.
    progress : callable or bool, optional
        See `union`.

    Returns
    -------
    bytes
        The PNG file.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> fm.render(fm.sphere(1.0), size=64)[:4]
    b'\\x89PNG'
    """
    sides = [int(side) for side in (size if isinstance(size, tuple) else (size, size))]
    if len(sides) != 2 or not all(16 <= side <= 8192 for side in sides):
        raise ValueError(f"size: {size} is not a number of pixels from 16 to 8192, or two")
    owners: Any = None
    if color == "origin":
        if not isinstance(mesh, Result):
            raise TypeError('color: "origin" needs a Result, which knows where its faces came from')
        owners = mesh.origins.faces["part"].tolist()
    look = view_of(
        color=color,
        parts=owners,
        view=_direction(view, "view"),
        up=_direction(up, "up"),
        parallel=bool(parallel),
        wireframe=bool(wireframe),
        size=sides,
    )
    part = ("mesh", as_mesh(mesh))
    with _Shown(progress) as heard:
        png = _native.render(part, look, count(threads), heard)
    if path is not None:
        write(path, png)
    return png


def box(size: Point = (1.0, 1.0, 1.0), center: Point = (0.0, 0.0, 0.0)) -> Mesh:
    """A box of 12 triangles.

    Parameters
    ----------
    size : point
        Its three sides.
    center : point
        Its centre.

    Returns
    -------
    Mesh
        Oriented outward.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> fm.box((1, 2, 3))
    <fusion_mesh.Mesh: 8 vertices, 12 faces>
    """
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = np.array([triangle for a, b, c, d in quads for triangle in ([a, b, c], [a, c, d])], dtype=np.uint32)
    return Mesh(corners * np.asarray(size, dtype=float) + np.asarray(center, dtype=float), faces)


def sphere(radius: float = 1.0, center: Point = (0.0, 0.0, 0.0), *, segments: int = 48) -> Mesh:
    """A sphere of rings and segments, with its poles on the z axis.

    Parameters
    ----------
    radius : float
        Its radius.
    center : point
        Its centre.
    segments : int
        Number of segments around; half as many rings.

    Returns
    -------
    Mesh
        Oriented outward.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> fm.info(fm.sphere(2.0))["closed"]
    True
    """
    rings = max(int(segments), 4) // 2
    around = 2 * np.pi * np.arange(2 * rings) / (2 * rings)
    down = np.pi * np.arange(1, rings) / rings
    ring = [
        [np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)]
        for t in down
        for a in around
    ]
    points = np.array([[0.0, 0.0, 1.0], *ring, [0.0, 0.0, -1.0]])
    n, last = 2 * rings, len(points) - 1
    faces: List[Sequence[int]] = []
    for k in range(n):
        after = (k + 1) % n
        faces.append((0, 1 + k, 1 + after))
        for r in range(rings - 2):
            a, b = 1 + r * n + k, 1 + r * n + after
            faces.extend([(a, a + n, b), (b, a + n, b + n)])
        low = 1 + (rings - 2) * n
        faces.append((last, low + after, low + k))
    return Mesh(points * float(radius) + np.asarray(center, dtype=float), np.array(faces, dtype=np.uint32))


def _direction(value: Optional[Point], name: str) -> Optional[List[float]]:
    if value is None:
        return None
    numbers = np.asarray(value, dtype=float)
    if numbers.shape != (3,) or not np.isfinite(numbers).all() or not numbers.any():
        raise ValueError(f"{name}: expected three finite numbers, not all 0")
    return [float(x) for x in numbers]


class _Shown:
    """Progress as the engine hears it; a bar is ended at the end."""

    def __init__(self, progress: Progress) -> None:
        self.heard = listener(progress)

    def __enter__(self) -> Any:
        return self.heard

    def __exit__(self, *_: object) -> None:
        if isinstance(self.heard, Bar):
            self.heard.close()
