"""What can go wrong, one class for each exit code of ``fusion-cli``."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Tuple

__all__ = [
    "FusionError",
    "FusionWarning",
    "InfeasibleError",
    "InputError",
    "InvalidResultError",
    "OutputError",
    "UsageError",
]


class FusionWarning(UserWarning):
    """The result may not be what was wanted."""


class FusionError(Exception):
    """There is no result.

    Attributes
    ----------
    diagnostic : dict
        The same as data: ``code``, ``severity``, ``message``, ``at``, ``numbers``, ``remedy``.
    """

    def __init__(self, message: str, diagnostic: Optional[Mapping[str, Any]] = None) -> None:
        super().__init__(message)
        self.diagnostic: Dict[str, Any] = dict(diagnostic or {})

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (str(self), self.diagnostic)

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def place(self) -> Optional[Tuple[float, float, float]]:
        """Where, in model units, if it is at one place."""
        at = self.diagnostic.get("at")
        return None if at is None else (at[0], at[1], at[2])

    @property
    def remedy(self) -> Optional[str]:
        """What to do about it, if that is known."""
        remedy = self.diagnostic.get("remedy")
        return None if remedy is None else str(remedy)


class UsageError(FusionError, ValueError):
    """An option has a value that it cannot have (exit code 2)."""


class InputError(FusionError, ValueError):
    """An input is unreadable or malformed (exit code 3)."""


class InfeasibleError(FusionError):
    """The operation is impossible on this input (exit code 4).

    ``str(error)`` says where and why; `place` and `workable_radius` are the same as numbers.
    """

    @property
    def workable_radius(self) -> Optional[float]:
        """The largest radius tried that works everywhere, if one does."""
        radius = self._numbers().get("workable")
        return None if radius is None else float(radius)

    @property
    def curves(self) -> List[int]:
        """The ids of the curves it is about, if it names any."""
        return [int(self._numbers()[key]) for key in ("curve", "id") if key in self._numbers()]

    def _numbers(self) -> Dict[str, float]:
        return dict(self.diagnostic.get("numbers") or {})


class InvalidResultError(FusionError):
    """A result was made and failed its own validation (exit code 5)."""


class OutputError(FusionError):
    """A file cannot be written (exit code 6)."""
