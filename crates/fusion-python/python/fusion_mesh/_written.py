"""Files written as a whole or not at all."""

from __future__ import annotations

import os
import tempfile

from ._errors import OutputError
from ._types import Path


def write(path: Path, content: bytes) -> None:
    """Write a file beside its place and rename it."""
    place = os.fspath(path)
    beside = None
    try:
        handle, beside = tempfile.mkstemp(prefix=".fusion-", dir=os.path.dirname(place) or ".")
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.chmod(beside, _mode(place))
        os.replace(beside, place)
    except OSError as error:
        if beside is not None and os.path.exists(beside):
            os.remove(beside)
        raise OutputError(f"{place} cannot be written: {error.strerror or error}") from None


def _mode(place: str) -> int:
    """That of the file that is there, or what a new file gets."""
    try:
        return os.stat(place).st_mode & 0o7777
    except OSError:
        mask = os.umask(0)
        os.umask(mask)
        return 0o666 & ~mask
