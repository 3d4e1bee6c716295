"""The native core."""

from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, final

from ._mesh import Mesh
from ._types import FloatArray, IntArray

__all__ = [
    "Cache",
    "__version__",
    "as_written",
    "cli",
    "document_evaluate",
    "document_extended",
    "document_outline",
    "document_with_parameter",
    "document_with_value",
    "features",
    "info",
    "max_radius",
    "read",
    "render",
    "run",
    "triangulate",
    "write",
]

__version__: str

def run(
    operation: str,
    options: Dict[str, Any],
    parts: Sequence[Tuple[str, Mesh]],
    precision: str,
    threads: Optional[int] = None,
    progress: Optional[Callable[[str, float], Optional[bool]]] = None,
) -> Dict[str, Any]: ...
def max_radius(
    operation: str,
    options: Dict[str, Any],
    parts: Sequence[Tuple[str, Mesh]],
    threads: Optional[int] = None,
    progress: Optional[Callable[[str, float], Optional[bool]]] = None,
) -> Tuple[float, str, Optional[List[float]]]: ...
def info(
    part: Tuple[str, Mesh],
    threads: Optional[int] = None,
    progress: Optional[Callable[[str, float], Optional[bool]]] = None,
) -> Dict[str, Any]: ...
def features(
    part: Tuple[str, Mesh],
    angle: float,
    radii: bool,
    threads: Optional[int] = None,
    progress: Optional[Callable[[str, float], Optional[bool]]] = None,
) -> List[Dict[str, Any]]: ...
def render(
    part: Tuple[str, Mesh],
    view: Dict[str, Any],
    threads: Optional[int] = None,
    progress: Optional[Callable[[str, float], Optional[bool]]] = None,
) -> bytes: ...
def read(path: str) -> Dict[str, Any]: ...
def write(part: Tuple[str, Mesh], path: str) -> Tuple[List[str], List[str]]: ...
def as_written(part: Tuple[str, Mesh], path: str) -> Optional[Dict[str, Any]]: ...
def triangulate(name: str, vertices: FloatArray, sizes: IntArray, corners: IntArray) -> Dict[str, Any]: ...
def cli(arguments: Sequence[str]) -> int: ...

@final
class Cache:
    def __new__(cls, memory: int, folder: Optional[str] = None, limit: int = 0) -> Cache: ...

def document_outline(text: str) -> Dict[str, Any]: ...
def document_extended(text: str, tables: Dict[str, Any]) -> str: ...
def document_with_parameter(text: str, name: str, value: Any) -> str: ...
def document_with_value(text: str, name: str, value: Any) -> str: ...
def document_evaluate(
    text: str,
    sources: Tuple[str, Sequence[Tuple[str, Mesh]]],
    cache: Cache,
    precision: Optional[str] = None,
    threads: Optional[int] = None,
    progress: Optional[Callable[[str, float], Optional[bool]]] = None,
) -> Dict[str, Any]: ...
