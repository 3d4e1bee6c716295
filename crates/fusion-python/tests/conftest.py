"""Shared meshes."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fusion_mesh as fm

EXAMPLES = Path(__file__).parent.parent / "examples"


@pytest.fixture
def boxes():
    """A box, and a post through it."""
    return fm.box((2, 2, 2)), fm.box((1, 1, 3))


@pytest.fixture
def cli():
    """Runs the program of the wheel in a process of its own."""

    def run(*arguments, check=True):
        command = [sys.executable, "-m", "fusion_mesh._cli", *map(str, arguments)]
        return subprocess.run(command, check=check, capture_output=True, text=True)

    return run


def same(a, b):
    """Whether two meshes have the same bits and faces."""
    return np.array_equal(a.vertices, b.vertices) and np.array_equal(a.faces, b.faces)
