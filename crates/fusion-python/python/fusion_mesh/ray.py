"""The jobs of ``fusion-cli batch`` on a Ray cluster: the same lines in, the same lines out, the same bytes.

Each job is a Ray task with a stated number of CPUs. The task hands it to a ``fusion-cli`` worker process of its node, so that a crash, a
hang or too much memory costs one line, and a node that dies costs nothing: its tasks are done again elsewhere.

.. code-block:: console

   $ python -m fusion_mesh.ray jobs.jsonl --results results.jsonl --timeout 60
   $ python -m fusion_mesh.ray jobs.jsonl --results s3://bucket/results.parquet --output s3://bucket/models --resume

Every node needs ``fusion-mesh`` of one version, and sees the documents and meshes under the same paths. Results and outputs go to local
(or shared) folders and to whatever else ``pyarrow.fs`` opens.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import posixpath
import shutil
import sys
import tempfile
import time
from typing import Any

import pyarrow.fs as pafs
import ray

from fusion_mesh._jobs import folder_name, open_place, open_sink, parse
from fusion_mesh._seat import Seat, Terms, failure

_seat: Seat | None = None
"""The worker of this process of Ray, kept from task to task."""


def run(
    jobs: str,
    results: str,
    *,
    output: str | None = None,
    cache: str | None = None,
    timeout: float | None = None,
    memory: float | None = None,
    num_cpus: float = 1,
    max_retries: int = 5,
    resume: bool = False,
    program: str | None = None,
    progress: bool = True,
) -> dict[str, int]:
    """Run jobs on the cluster that Ray is connected to, or on this machine if there is none.

    Parameters
    ----------
    jobs
        The jobs file, local or an address. Paths in it are relative to it; those in a remote one must be absolute.
    results
        ``.jsonl`` or ``.parquet``. A local ``.jsonl`` grows line by line; everything else is a folder of parts.
    output
        The folder of the jobs' folders; that of the results if not given.
    cache
        A folder of finished steps that all nodes share.
    timeout, memory
        Most seconds, and most megabytes of resident memory, of a job.
    num_cpus
        What a job takes of its node. Its worker has as many threads.
    max_retries
        How often a job is started again whose node or Ray process has died.
    resume
        Keep the results that are there, and do the rest.
    program
        The ``fusion-cli`` to run; found beside Python or on the search path if not given.
    progress
        Whether to print a line every five seconds.

    Returns
    -------
    dict
        How many jobs ended in each state, of those that ran now.
    """
    system, path = open_place(jobs)
    with system.open_input_stream(path) as stream:
        lines = parse(stream.read(), jobs)
    base = os.path.dirname(path) if isinstance(system, pafs.LocalFileSystem) else "/"
    sink = open_sink(results, resume)
    beside = results.rsplit("/", 1)[0] if "/" in results else "."
    place = output or beside
    if "://" not in place:
        place = os.path.abspath(place)
    strangers = sink.done() - {job["id"] for job in lines}
    if strangers:
        raise ValueError(f"{results} has a result of `{min(strangers)}`, which is no job of {jobs}")
    left = [job for job in lines if job["id"] not in sink.done()]
    if not ray.is_initialized():
        ray.init()
    terms = Terms(program, max(1, int(num_cpus)), cache and os.path.abspath(cache), timeout, memory)
    prefix = ".fusion-ray-" + hashlib.blake2b(os.path.abspath(results).encode(), digest_size=6).hexdigest() + "-"
    _sweep(place, prefix)
    task = ray.remote(_do).options(num_cpus=num_cpus, max_retries=max_retries, retry_exceptions=False)
    counts: dict[str, int] = {}
    try:
        meter = _Meter(len(left), progress)
        for outcome in _all(task, left, (base, place, prefix, terms)):
            _shorten(outcome, beside)
            sink.add(outcome)
            counts[outcome["state"]] = counts.get(outcome["state"], 0) + 1
            meter.step(outcome["state"])
    finally:
        sink.close()
    _sweep(place, prefix)
    return counts


def _sweep(place: str, prefix: str) -> None:
    """Remove what tasks left whose nodes died."""
    system, root = open_place(place)
    if isinstance(system, pafs.LocalFileSystem) and os.path.isdir(root):
        for name in os.listdir(root):
            if name.startswith(prefix):
                shutil.rmtree(os.path.join(root, name), ignore_errors=True)


def _all(task: Any, jobs: list[dict[str, Any]], where: tuple[str, str, str, Terms]) -> Any:
    """Outcomes as they come, with few more tasks under way than there are CPUs."""
    waiting = iter(jobs)
    pending: dict[Any, dict[str, Any]] = {}
    while True:
        room = 8 + int(4 * ray.cluster_resources().get("CPU", 1))
        while len(pending) < room and (job := next(waiting, None)) is not None:
            pending[task.remote(job, *where)] = job
        if not pending:
            return
        ready, _ = ray.wait(list(pending), num_returns=1, timeout=1.0)
        if ready:
            more, _ = ray.wait(list(pending), num_returns=len(pending), timeout=0)
            ready = list(dict.fromkeys(ready + more))
        for reference in ready:
            job = pending.pop(reference)
            try:
                yield ray.get(reference)
            except ray.exceptions.RayTaskError:
                # The machine is at fault, not the job: nothing is written of it.
                raise
            except ray.exceptions.RayError as error:
                said = f"its task was lost more often than it may be started again: {error}"
                yield failure(job["id"], "crashed", 1, "crashed", said.splitlines()[0], "look at the nodes", 0.0)


def _do(job: dict[str, Any], base: str, place: str, prefix: str, terms: Terms) -> dict[str, Any]:
    """One job, on whatever node this is."""
    global _seat
    if _seat is None or _seat.terms != terms:
        if _seat is not None:
            _seat.close()
        _seat = Seat(terms)
    system, root = open_place(place)
    name = folder_name(job["id"])
    local = isinstance(system, pafs.LocalFileSystem)
    if local:
        os.makedirs(root, exist_ok=True)
    folder = tempfile.mkdtemp(prefix=prefix, dir=root if local else None)
    try:
        outcome = _seat.run(job, base, folder)
        if outcome["state"] == "done" and outcome["outputs"]:
            kept = posixpath.join(root, name)
            if local:
                os.chmod(folder, 0o755)
                _replace(folder, os.path.join(root, name))
            else:
                system.create_dir(kept, recursive=True)
                pafs.copy_files(folder, kept, destination_filesystem=system)
            outcome["folder"] = place.rstrip("/") + "/" + name
        return outcome
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _replace(folder: str, kept: str) -> None:
    """Give a folder its name in the place of an older one, which another start of the same job may have put there just now."""
    for attempt in range(10):
        shutil.rmtree(kept, ignore_errors=True)
        try:
            os.rename(folder, kept)
            return
        except OSError:
            if attempt == 9:
                raise
            time.sleep(0.05 * (attempt + 1))


def _shorten(outcome: dict[str, Any], beside: str) -> None:
    """The folder as seen from the results, where it lies below them."""
    root = beside if "://" in beside else os.path.abspath(beside)
    if outcome.get("folder", "").startswith(root + "/"):
        outcome["folder"] = outcome["folder"][len(root) + 1 :]


class _Meter:
    """A line every five seconds."""

    def __init__(self, total: int, shown: bool) -> None:
        self._start = self._told = time.monotonic()
        self._total, self._done, self._failed, self._shown = total, 0, 0, shown

    def step(self, state: str) -> None:
        self._done += 1
        self._failed += state != "done"
        now = time.monotonic()
        if self._shown and (now - self._told >= 5 or self._done == self._total):
            self._told = now
            rate = self._done / max(now - self._start, 1e-3)
            left = (self._total - self._done) / rate
            print(
                f"{self._done} of {self._total} jobs, {rate:.1f} a second, {left:.0f} s left, {self._failed} failed",
                file=sys.stderr,
                flush=True,
            )


def main(arguments: list[str] | None = None) -> int:
    """The command line. Exit codes are those of ``fusion-cli batch``."""
    parser = argparse.ArgumentParser(prog="python -m fusion_mesh.ray", description="Runs jobs of fusion-cli batch on a Ray cluster.")
    parser.add_argument("jobs", metavar="JOBS.jsonl")
    parser.add_argument("--results", required=True, metavar="RESULTS", help=".jsonl or .parquet, local or an address")
    parser.add_argument("--output", metavar="DIR", help="folder of the jobs' folders, local or an address")
    parser.add_argument("--cache", metavar="DIR", help="folder of finished steps, shared by all nodes")
    parser.add_argument("--timeout", type=float, metavar="S", help="end a job after this many seconds")
    parser.add_argument("--memory", type=float, metavar="MB", help="end a job that holds more megabytes in memory (Linux)")
    parser.add_argument("--num-cpus", type=float, default=1, metavar="N", help="CPUs of a job (1)")
    parser.add_argument("--max-retries", type=int, default=5, metavar="N", help="starts again after the loss of a node (5)")
    parser.add_argument("--resume", action="store_true", help="keep the results that are there, do the rest")
    parser.add_argument("--address", help="of the cluster; RAY_ADDRESS, or this machine, if not given")
    parser.add_argument("--program", metavar="FILE", help="the fusion-cli to run on every node")
    parser.add_argument("--strict", action="store_true", help="exit with 4 if a job is not done")
    given = vars(parser.parse_args(arguments))
    address, strict = given.pop("address"), given.pop("strict")
    try:
        ray.init(address=address, log_to_driver=False)
        counts = run(**given)
    except (ValueError, FileNotFoundError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 3
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 6
    except KeyboardInterrupt:
        print("error: cancelled; --resume goes on from here", file=sys.stderr)
        return 130
    told = ", ".join(f"{count} {state}" for state, count in sorted(counts.items()))
    print(f"{sum(counts.values())} jobs: {told or 'nothing was left to do'}", file=sys.stderr)
    return 4 if strict and set(counts) - {"done"} else 0


if __name__ == "__main__":
    # Under its own name, so that nodes import it rather than being sent it.
    from fusion_mesh.ray import main as named_main

    sys.exit(named_main())
