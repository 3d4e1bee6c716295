"""Jobs on a cluster of two nodes on this machine, of which one dies midway.

Run with pytest, or as a program, where ``fusion-mesh`` and ``ray[data]`` are installed. ``FUSION_CLI`` is the program to run, if not the one of the
wheel; ``JOBS`` the number of jobs, 120 if it is not set; ``RAY_TEST_SOURCES`` a folder with a package ``fusion_mesh`` to use in place of the wheel.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time

try:
    import ray
except ImportError:
    import pytest

    pytest.skip("Ray is not installed", allow_module_level=True)

SOURCES = os.environ.get("RAY_TEST_SOURCES")
if SOURCES:
    sys.path.insert(0, SOURCES)
    os.environ["PYTHONPATH"] = os.pathsep.join([SOURCES, os.environ.get("PYTHONPATH", "")])
# Tasks give way to everything else on the machine by default.
os.environ.setdefault("RAY_worker_niceness", "0")

COUNT = int(os.environ.get("JOBS", "120"))
SYSTEM = {
    "health_check_initial_delay_ms": 1000,
    "health_check_period_ms": 500,
    "health_check_timeout_ms": 500,
    "health_check_failure_threshold": 3,
}
"""A dead node is noticed late by default."""


def program() -> str:
    """The ``fusion-cli`` under test."""
    found = os.environ.get("FUSION_CLI") or shutil.which("fusion-cli")
    assert found, "set FUSION_CLI to the program"
    return os.path.abspath(found)


def box(size: float) -> str:
    """A box as OFF."""
    corners = [[size * ((i >> k & 1) - 0.5) for k in range(3)] for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
    lines = [" ".join(map(repr, p)) for p in corners] + [f"3 {a} {b} {c}" for a, b, c in faces]
    return "OFF\n8 12 0\n" + "\n".join(lines) + "\n"


def document(step: str) -> str:
    """A document of one box and one step."""
    out = '\n[[output]]\nof = "a"\nfile = "out.off"\n'
    return 'version = 2\n[[part]]\nname = "a"\nmesh = "a.off"\n[[step]]\nof = "a"\n' + step + out


def write_jobs(folder: str, count: int) -> str:
    """Jobs that end, that fail, that take too long, and that take too much memory."""
    with open(os.path.join(folder, "a.off"), "w") as file:
        file.write(box(1.0))
    lines = []
    for i in range(count):
        step = f'do = "cut"\nplane = {{ point = [0, 0, {0.9 * i / count - 0.45!r}], normal = [0, 0, 1] }}'
        if i % 10 == 3:
            step = 'do = "cut"\nplane = { point = [0, 0, 7], normal = [0, 0, 1] }'
        if i % 60 == 17:
            # Millions of triangles: into the limit of memory or of time, whichever comes first.
            step = f'do = "remesh"\nedge_length = {0.0005 if i % 120 == 17 else 0.004!r}'
        lines.append(json.dumps({"id": f"part/{i}", "document": document(step)}))
    path = os.path.join(folder, "jobs.jsonl")
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")
    return path


def read(path: str) -> dict[str, dict]:
    """Results by id; each may be there once."""
    with open(path) as file:
        lines = [json.loads(line) for line in file]
    found = {line["id"]: line for line in lines}
    assert len(found) == len(lines), "a job is there twice"
    return found


def fate(outcome: dict) -> tuple:
    """What must be the same wherever a job runs."""
    if outcome["state"] in ("timeout", "memory"):
        return ("limit",)
    return (outcome["state"], outcome["code"], tuple((o["file"], o["bytes"], o["blake3"]) for o in outcome["outputs"]))


def test_a_node_dies_and_every_job_is_done_once() -> None:
    """The results of a cluster that loses a node and gets another are those of one machine."""
    from ray.cluster_utils import Cluster

    folder = tempfile.mkdtemp()
    jobs = write_jobs(folder, COUNT)
    limits = ["--timeout", "20", "--memory", "700"]
    whole = os.path.join(folder, "whole", "r.jsonl")
    os.mkdir(os.path.dirname(whole))
    subprocess.run([program(), "batch", jobs, "--results", whole, "--workers", "1", *limits], check=True)
    from fusion_mesh.ray import run

    node = {"num_cpus": 1, "object_store_memory": 100 << 20}
    head = {**node, "include_dashboard": False, "_system_config": SYSTEM}
    cluster = Cluster(initialize_head=True, head_node_args=head)
    second = cluster.add_node(**node)
    results = os.path.join(folder, "r.jsonl")
    counts: dict[str, int] = {}
    try:
        ray.init(address=cluster.address, log_to_driver=False)
        thread = threading.Thread(
            target=lambda: counts.update(
                run(jobs, results, output=os.path.join(folder, "made"), timeout=20, memory=700, program=program())
            )
        )
        thread.start()
        wait(lambda: os.path.exists(results) and len(open(results).readlines()) > COUNT // 4)
        cluster.remove_node(second, allow_graceful=False)
        at_death = len(open(results).readlines())
        assert at_death < COUNT, "the node died too late to show anything"
        cluster.add_node(**node)
        thread.join()
    finally:
        ray.shutdown()
        cluster.shutdown()
    found, expected = read(results), read(whole)
    assert {id: fate(o) for id, o in found.items()} == {id: fate(o) for id, o in expected.items()}
    assert sum(counts.values()) == COUNT and len(found) == COUNT
    made = os.listdir(os.path.join(folder, "made"))
    assert sorted(made) == sorted(os.path.basename(o["folder"]) for o in found.values() if o["outputs"])
    print(f"{COUNT} jobs, a node killed after {at_death}: {counts}")
    resume(jobs, results)
    shutil.rmtree(folder)


def resume(jobs: str, results: str) -> None:
    """The command line on results that are cut in a line: finished lines stay."""
    with open(results, "rb") as file:
        lines = file.readlines()
    # The long ones first: they are not done again.
    limits = [line for line in lines if b'"done"' not in line]
    rest = [line for line in lines if b'"done"' in line]
    kept = limits + rest[:-3]
    with open(results, "wb") as file:
        file.writelines([*kept, rest[-3][:40]])
    line = [sys.executable, "-m", "fusion_mesh.ray", jobs, "--results", results, "--program", program(), "--resume"]
    subprocess.run(line, check=True)
    with open(results, "rb") as file:
        again = file.readlines()
    assert again[: len(kept)] == kept and len(read(results)) == len(lines)


def test_parquet_holds_the_same_as_lines() -> None:
    """Without a cluster of its own: Ray starts on this machine."""
    import pyarrow.dataset as ds

    folder = tempfile.mkdtemp()
    jobs = write_jobs(folder, 4)
    results = "file://" + os.path.join(folder, "r.parquet")
    line = [sys.executable, "-m", "fusion_mesh.ray", jobs, "--results", results, "--output", "file://" + folder + "/made"]
    subprocess.run([*line, "--program", program()], check=True)
    table = ds.dataset(os.path.join(folder, "r.parquet")).to_table()
    states = dict(zip(table["id"].to_pylist(), table["state"].to_pylist()))
    assert states == {f"part/{i}": "failed" if i == 3 else "done" for i in range(4)}
    outputs = dict(zip(table["id"].to_pylist(), table["outputs"].to_pylist()))
    assert os.path.getsize(os.path.join(folder, "made", "part%2F0", "out.off")) == outputs["part/0"][0]["bytes"]
    subprocess.run([*line, "--program", program(), "--resume"], check=True)
    assert ds.dataset(os.path.join(folder, "r.parquet")).count_rows() == 4
    shutil.rmtree(folder)


def wait(is_so, seconds: float = 300) -> None:
    """Wait until something is so."""
    start = time.monotonic()
    while not is_so():
        assert time.monotonic() - start < seconds, "it takes too long"
        time.sleep(0.02)


if __name__ == "__main__":
    test_a_node_dies_and_every_job_is_done_once()
    test_parquet_holds_the_same_as_lines()
