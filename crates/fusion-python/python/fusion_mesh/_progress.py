"""Progress: a callable, or a bar."""

from __future__ import annotations

import sys
import time
from typing import Any, Callable, Optional

from ._types import Progress

WIDTH = 30
PATIENCE = 0.5


def listener(progress: Progress) -> Optional[Callable[[str, float], Optional[bool]]]:
    """What the engine calls."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return Bar()
    if callable(progress):
        return progress
    raise TypeError(f"progress: expected a callable, True or None, got {type(progress).__name__}")


class Bar:
    """A line on standard error, for jobs of more than half a second; notebooks show it as well."""

    def __init__(self, stream: Any = None) -> None:
        self.stream = sys.stderr if stream is None else stream
        self.start = time.monotonic()
        self.shown = False

    def __call__(self, stage: str, share: float) -> None:
        seconds = time.monotonic() - self.start
        if seconds < PATIENCE:
            return
        full = int(share * WIDTH)
        self.stream.write(f"\r{stage:<24} [{'#' * full}{' ' * (WIDTH - full)}] {share:4.0%} {seconds:6.1f} s")
        self.stream.flush()
        self.shown = True

    def close(self) -> None:
        """Ends the line."""
        if self.shown:
            self.stream.write("\n")
            self.stream.flush()
