"""Join and blend triangle meshes: booleans, rolling-ball fillets, smooth compositions.

>>> import fusion_mesh as fm
>>> both = fm.union(fm.box((2, 2, 2)), fm.box((1, 1, 3)), radius=0.1)
>>> both.report["validity"]["closed"]
True
"""

from __future__ import annotations

from ._document import Cache, Document, Evaluation
from ._edges import Edges, edges
from ._errors import (
    FusionError,
    FusionWarning,
    InfeasibleError,
    InputError,
    InvalidResultError,
    OutputError,
    UsageError,
)
from ._functions import MaxRadius, box, features, info, max_radius, render, sphere
from ._inputs import as_mesh
from ._mesh import Mesh
from ._native import __version__
from ._operations import *  # noqa: F403
from ._operations import __all__ as _operations
from ._result import Origins, Result

__all__ = [
    "Cache",
    "Document",
    "Edges",
    "Evaluation",
    "FusionError",
    "FusionWarning",
    "InfeasibleError",
    "InputError",
    "InvalidResultError",
    "MaxRadius",
    "Mesh",
    "Origins",
    "OutputError",
    "Result",
    "UsageError",
    "__version__",
    "as_mesh",
    "box",
    "edges",
    "features",
    "info",
    "max_radius",
    "render",
    "sphere",
]
__all__ += _operations
