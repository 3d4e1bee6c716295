"""Selections of edges as values."""

from __future__ import annotations

from typing import Any, Dict, Optional

from ._types import Length, MeshLike, Path, Point

__all__ = ["Edges", "edges"]


class Edges:
    """Which edges are blended. Every method gives a narrower or wider selection and leaves this one as it is.

    Examples
    --------
    Every ridge over 40 degrees inside a box:

    >>> import fusion_mesh as fm
    >>> ridges = fm.edges(angle=40).convex().longer("5%")
    >>> ridges
    edges(angle=40, convex=True, longer='5%')
    """

    def __init__(self, options: Dict[str, Any]) -> None:
        self.options = options

    def near(self, point: Point, radius: Optional[Length] = None) -> "Edges":
        """The feature curve nearest to a point; called again, one more, each with a radius of its own if wanted."""
        named: Any = point if radius is None else {"at": point, "radius": radius}
        return self._with(near=[*self.options.get("near", []), named])

    def ids(self, *ids: int) -> "Edges":
        """The feature curves with these ids, as `features` lists them at the same angle."""
        return self._with(ids=[*self.options.get("ids", []), *ids])

    def curves(self, file: Path) -> "Edges":
        """The curves in a file, as ``fusion-cli features`` writes them."""
        return self._with(curves=file)

    def chain(self) -> "Edges":
        """Also the feature curves that smoothly continue those named."""
        return self._with(chain=True)

    def longer(self, length: Length) -> "Edges":
        """Only curves longer than this."""
        return self._with(longer=length)

    def along(self, direction: Point) -> "Edges":
        """Only curves parallel to this direction; called again, to one of several."""
        return self._with(along=[*self.options.get("along", []), direction])

    def within(self, mesh: MeshLike) -> "Edges":
        """Only curves inside or on a closed solid."""
        return self._with(within=mesh)

    def convex(self) -> "Edges":
        """Only ridges, as the edges of a box."""
        return self._with(convex=True)

    def concave(self) -> "Edges":
        """Only valleys, as between a post and a plate."""
        return self._with(concave=True)

    def __repr__(self) -> str:
        return f"edges({', '.join(f'{key}={value!r}' for key, value in self.options.items())})"

    def _with(self, **options: Any) -> "Edges":
        return Edges({**self.options, **options})


def edges(angle: float = 40.0) -> Edges:
    """All edges whose two faces turn by at least an angle, as a selection to narrow.

    Parameters
    ----------
    angle : float
        Least angle between the normals of two neighbouring faces, in degrees.

    Returns
    -------
    Edges
        For `blend` and `max_radius`.

    Examples
    --------
    >>> import fusion_mesh as fm
    >>> block = fm.box((2, 1, 1))
    >>> upright = fm.edges().along((0, 0, 1))
    >>> fm.blend(block, upright, radius=0.1).report["figures"]["curves"]
    4.0
    """
    return Edges({"angle": angle})
