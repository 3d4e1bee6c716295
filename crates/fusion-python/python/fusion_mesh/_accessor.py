"""``mesh.fusion`` on PyVista's meshes: the operations as methods.

PyVista 0.48 and later find it by the entry point ``pyvista.accessors``; nothing needs to be imported.
"""

from __future__ import annotations

from typing import Any, Callable

import pyvista

import fusion_mesh

from . import _functions

_ONE = ("blend", "sharpen", "cut", "detail", "cluster", "remesh", "repair", "pose")
_SEVERAL = ("union", "difference", "intersection", "compose")


class FusionAccessor:
    """The operations on one mesh. What makes a mesh gives a ``pyvista.PolyData`` with cell data ``part``."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def info(self, **options: Any) -> Any:
        """See `fusion_mesh.info`."""
        return _functions.info(self._mesh, **options)

    def features(self, **options: Any) -> Any:
        """See `fusion_mesh.features`."""
        return _functions.features(self._mesh, **options)

    def max_radius(self, *others: Any, **options: Any) -> Any:
        """See `fusion_mesh.max_radius`."""
        return _functions.max_radius(self._mesh, *others, **options)


def _method(name: str) -> Callable[..., Any]:
    function = getattr(fusion_mesh, name)

    def method(self: FusionAccessor, *others: Any, **options: Any) -> Any:
        return function(self._mesh, *others, **options).to_pyvista()

    method.__name__ = name
    method.__doc__ = f"See `fusion_mesh.{name}`."
    return method


for _name in _ONE + _SEVERAL:
    setattr(FusionAccessor, _name, _method(_name))

pyvista.register_dataset_accessor("fusion", pyvista.PolyData)(FusionAccessor)
