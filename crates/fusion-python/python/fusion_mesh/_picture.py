"""Still pictures, as the engine takes them."""

from __future__ import annotations

from typing import Any, Dict, List, Optional

from . import _native


def view_of(
    *,
    color: str = "plain",
    parts: Optional[List[int]] = None,
    view: Any = None,
    up: Any = None,
    parallel: bool = False,
    wireframe: bool = False,
    size: List[int],
) -> Dict[str, Any]:
    """How a picture is taken. `parts` has the input of each face, -1 for new ones, for the colour ``"origin"``."""
    return {
        "color": color,
        "parts": parts,
        "view": view,
        "up": up,
        "parallel": parallel,
        "wireframe": wireframe,
        "size": size,
    }


def thumbnail(mesh: Any, color: str = "plain", parts: Optional[List[int]] = None) -> bytes:
    """A PNG of a `Mesh` for a notebook, 480 pixels wide and high."""
    return _native.render(("mesh", mesh), view_of(color=color, parts=parts, size=[480, 480]), None, None)
