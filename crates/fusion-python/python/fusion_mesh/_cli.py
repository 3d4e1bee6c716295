"""The program ``fusion-cli``."""

from __future__ import annotations

import sys

from . import _native


def main() -> int:
    """Run the command line of this process."""
    return _native.cli(["fusion-cli", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
