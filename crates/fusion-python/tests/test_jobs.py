"""Threads, progress, Ctrl-C."""

import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import same

import fusion_mesh as fm

LONG = """
import fusion_mesh as fm, signal, sys, time
# Who runs this in the background may have had Ctrl-C ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
ball = fm.sphere(1.0, segments=500)
other = fm.sphere(1.0, (0.7, 0.1, 0.2), segments=500)
print("begun", flush=True)
try:
    while True:
        fm.union(ball, other, radius=0.1)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    sys.exit(7)
"""


def test_any_number_of_threads_gives_the_same_bits(boxes):
    one = fm.union(*boxes, radius=0.1, threads=1)
    assert same(one.mesh, fm.union(*boxes, radius=0.1, threads=3).mesh)
    assert same(one.mesh, fm.union(*boxes, radius=0.1).mesh)


def test_four_callers_at_once(boxes):
    expected = fm.union(*boxes, radius=0.1).mesh
    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda _: fm.union(*boxes, radius=0.1), range(16)))
    assert all(same(result.mesh, expected) for result in results)


def test_python_goes_on_while_the_engine_works():
    ball, other = fm.sphere(1.0, segments=400), fm.sphere(1.0, (0.7, 0, 0), segments=400)
    done = threading.Event()
    worker = threading.Thread(target=lambda: (fm.union(ball, other), done.set()))
    worker.start()
    ticks = 0
    while not done.is_set():
        ticks += 1
        time.sleep(0.001)
    worker.join()
    assert ticks > 5


def test_progress_is_told_and_can_end_the_job():
    ball, other = fm.sphere(1.0, segments=500), fm.sphere(1.0, (0.7, 0, 0), segments=500)
    heard = []
    fm.union(ball, other, radius=0.2, progress=lambda stage, share: heard.append((stage, share)))
    assert heard and all(isinstance(stage, str) and 0 <= share <= 1 for stage, share in heard)

    def stop(stage, share):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        fm.union(ball, other, radius=0.2, progress=stop)
    with pytest.raises(KeyboardInterrupt):
        fm.union(ball, other, radius=0.2, progress=lambda stage, share: False)


def test_a_bar_is_a_line(capsys):
    from fusion_mesh._progress import Bar

    bar = Bar(sys.stderr)
    bar.start -= 1
    bar("blend", 0.5)
    bar.close()
    assert "blend" in capsys.readouterr().err
    fm.info(fm.box(), progress=True)


@pytest.mark.skipif(sys.platform == "win32", reason="a console's Ctrl-C cannot be sent to one process there")
def test_control_c_ends_a_long_job():
    child = subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE, text=True)
    watchdog = threading.Timer(120, child.kill)
    watchdog.start()
    assert child.stdout.readline() == "begun\n"
    time.sleep(1.0)
    start = time.monotonic()
    child.send_signal(signal.SIGINT)
    assert child.stdout.readline() == "interrupted\n"
    seconds = time.monotonic() - start
    assert child.wait() == 7
    watchdog.cancel()
    print(f"ended {1000 * seconds:.0f} ms after Ctrl-C")
    # A tenth of a second on a machine of one's own; builders run many things at once.
    assert seconds < 2.0


def test_results_own_their_memory():
    result = fm.blend(fm.box(), radius=0.1)
    vertices = result.vertices
    copy = vertices.copy()
    del result
    fm.blend(fm.box(), radius=0.2)
    vertices += 0
    assert np.array_equal(vertices, copy)
