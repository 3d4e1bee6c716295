"""Memory stays flat, files are closed, and inputs are read where they are."""

import gc
import os
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import fusion_mesh as fm

UNIONS = int(os.environ.get("FUSION_UNIONS", "800"))
"""10 000 when measured by hand; the tests of every change have less time."""

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")


def status(key):
    """A number of bytes from /proc/self/status: VmRSS, what is held now, or VmHWM, the most that ever was."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(f"{key}:"):
            return int(line.split()[1]) * 1024
    raise KeyError(key)


def test_memory_is_flat_over_many_unions(tmp_path, boxes):
    boxes[0].save(tmp_path / "block.ply")
    inputs = [boxes, (tmp_path / "block.ply", boxes[1])]
    document = fm.Document()
    document.part("block", boxes[0])
    document.part("post", boxes[1])
    document.step("union", ["block", "post"])
    quarters = []
    for i in range(UNIONS):
        result = fm.union(*inputs[i % 2])
        assert len(result.origins.vertices) == len(result.vertices)
        with pytest.raises(fm.UsageError):
            fm.blend(boxes[0], radius=-1)
        if i % 20 == 0:
            document.set("1.tolerance", 0.001 + i * 1e-9)
            document.evaluate(cache=fm.Cache(memory=0))
        if (i + 1) % (UNIONS // 4) == 0:
            gc.collect()
            quarters.append(status("VmRSS"))
    files = len(os.listdir("/proc/self/fd"))
    fm.union(*inputs[1])
    assert len(os.listdir("/proc/self/fd")) == files
    print([round(q / 1e6, 1) for q in quarters])
    # The first quarter fills pools; after that a leak of one small mesh for each union would show.
    assert quarters[-1] - quarters[0] < 4e6 + 400 * (UNIONS - UNIONS // 4), quarters


def test_inputs_are_copied_once_and_only_by_the_engine():
    """What Python allocates for a large input, and what the process takes at most."""
    mesh = fm.sphere(1.0, segments=1000)
    size = mesh.vertices.nbytes + mesh.faces.nbytes
    assert size > 15e6

    class Holder:
        vertices, faces = mesh.vertices, mesh.faces

    tracemalloc.start()
    held = fm.as_mesh(Holder)
    taken = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert taken < 100_000 and np.shares_memory(held.vertices, mesh.vertices)
    # NumPy tells tracemalloc of its arrays, so a copy of the faces that are converted shows.
    wide = mesh.faces.astype(np.uint64)
    tracemalloc.start()
    fm.as_mesh((mesh.vertices, wide))
    assert tracemalloc.get_traced_memory()[1] > mesh.faces.nbytes
    tracemalloc.stop()
