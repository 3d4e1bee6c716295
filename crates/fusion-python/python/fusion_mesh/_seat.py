"""One worker process of ``fusion-cli``: started when there is a job for it, watched while it works, replaced when it is gone."""

from __future__ import annotations

import io
import json
import os
import queue
import shutil
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from typing import Any

LOOK = 0.02
"""Seconds between two looks at a worker."""

GRACE = 0.2
"""Seconds for a worker that has closed its pipes to be gone."""


@dataclass(frozen=True)
class Terms:
    """How a worker is started, and what a job may take."""

    program: str | None = None
    threads: int = 1
    cache: str | None = None
    timeout: float | None = None
    memory: float | None = None


def find_program(program: str | None) -> str:
    """The program to run: the one named, the one beside this Python, or the one on the search path."""
    if program:
        return program
    beside = os.path.dirname(sys.executable)
    found = shutil.which("fusion-cli", path=beside) or shutil.which("fusion-cli")
    if found is None:
        raise FileNotFoundError("fusion-cli is neither beside this Python nor on the search path: install fusion-mesh on every node")
    return found


class Seat:
    """A place for a worker. One job at a time."""

    def __init__(self, terms: Terms) -> None:
        self.terms = terms
        self._process: subprocess.Popen[bytes] | None = None
        self._answers: queue.Queue[bytes | None] = queue.Queue()
        self._last_words = bytearray()

    def run(self, job: dict[str, Any], base: str, folder: str) -> dict[str, Any]:
        """Have a job done, whatever becomes of the worker.

        Parameters
        ----------
        job
            A line of the jobs file.
        base
            What its paths are relative to.
        folder
            An empty local folder for its outputs.

        Returns
        -------
        dict
            A line of the results, as ``fusion-cli batch`` writes it.
        """
        process = self._process
        if process is None or process.poll() is not None:
            process = self._start()
        request = json.dumps({"job": job, "base": base, "folder": folder}).encode() + b"\n"
        start = time.monotonic()
        try:
            assert process.stdin is not None
            process.stdin.write(request)
            process.stdin.flush()
        except OSError:
            pass  # It is gone, which shows below.
        outcome = self._wait(process, start, job)
        if "parameters" not in outcome and job.get("parameters"):
            outcome["parameters"] = job["parameters"]
        return outcome

    def close(self) -> None:
        """End the worker."""
        if self._process is not None:
            self._end(self._process, GRACE)

    def _start(self) -> subprocess.Popen[bytes]:
        line = [find_program(self.terms.program), "worker", "--quiet", "--threads", str(self.terms.threads)]
        if self.terms.cache:
            line += ["--cache", self.terms.cache]
        pipe = subprocess.PIPE
        process = subprocess.Popen(line, stdin=pipe, stdout=pipe, stderr=pipe, start_new_session=True)
        answers: queue.Queue[bytes | None] = queue.Queue()
        words = bytearray()

        def read_answers() -> None:
            assert process.stdout is not None
            for answer in process.stdout:
                answers.put(answer)
            answers.put(None)

        def read_words() -> None:
            assert isinstance(process.stderr, io.BufferedReader)
            while said := process.stderr.read1(4096):
                words.extend(said)
                del words[:-2000]

        for read in (read_answers, read_words):
            threading.Thread(target=read, daemon=True).start()
        self._process, self._answers, self._last_words = process, answers, words
        return process

    def _wait(self, process: subprocess.Popen[bytes], start: float, job: dict[str, Any]) -> dict[str, Any]:
        terms = self.terms

        def lost(state: str, code: int, name: str, message: str, remedy: str | None) -> dict[str, Any]:
            milliseconds = round(1e3 * (time.monotonic() - start), 3)
            return failure(str(job["id"]), state, code, name, message, remedy, milliseconds)

        while True:
            try:
                answer = self._answers.get(timeout=LOOK)
            except queue.Empty:
                answer = b""
            if answer:
                outcome = as_object(answer)
                if outcome.get("id") == str(job["id"]):
                    return outcome
                self._end(process, 0.0)
                said = "the worker answered what is no result of this job: " + answer[:200].decode(errors="replace")
                return lost("crashed", 1, "crashed", said, None)
            if answer is None:
                code = self._end(process, GRACE)
                how = f"was ended by signal {-code}" if code < 0 else f"exited with code {code}"
                words = bytes(self._last_words).decode(errors="replace").strip()
                said = f"the worker {how}" + (f": {words}" if words else "")
                return lost("crashed", 128 - code if code < 0 else code, "crashed", said, "report this document and its parts")
            elapsed = time.monotonic() - start
            if terms.timeout is not None and elapsed >= terms.timeout:
                self._end(process, 0.0)
                return lost("timeout", 4, "time_limit", f"ended after {elapsed:.1f} s by --timeout", "allow more time, or ask for less")
            held = resident_megabytes(process.pid) if terms.memory is not None else None
            if held is not None and terms.memory is not None and held > terms.memory:
                self._end(process, 0.0)
                said = f"ended at {held:.0f} MB of memory by --memory"
                return lost("memory", 4, "memory_limit", said, "allow more memory, or ask for less")

    def _end(self, process: subprocess.Popen[bytes], grace: float) -> int:
        self._process = None
        try:
            assert process.stdin is not None
            process.stdin.close()
        except OSError:
            pass
        try:
            return process.wait(grace) if grace > 0 else self._kill(process)
        except subprocess.TimeoutExpired:
            return self._kill(process)

    @staticmethod
    def _kill(process: subprocess.Popen[bytes]) -> int:
        process.kill()
        return process.wait()


def as_object(text: bytes) -> dict[str, Any]:
    """A JSON object, or an empty one for what is none."""
    try:
        value = json.loads(text)
    except ValueError:
        return {}
    return value if isinstance(value, dict) else {}


def failure(id: str, state: str, code: int, name: str, message: str, remedy: str | None, milliseconds: float) -> dict[str, Any]:
    """A line of the results for a job that has no more to tell than one sentence."""
    told: dict[str, Any] = {"code": name, "severity": "error", "message": message, "at": None, "numbers": {}, "remedy": remedy}
    return {
        "id": id,
        "state": state,
        "code": code,
        "milliseconds": milliseconds,
        "outputs": [],
        "diagnostics": [told],
        "figures": {},
    }


def resident_megabytes(process: int) -> float | None:
    """Megabytes that a process holds in memory, on Linux; else `None`."""
    try:
        with open(f"/proc/{process}/status") as status:
            for line in status:
                if line.startswith("VmRSS:"):
                    return int(line.split()[1]) * 1024 / 1e6
    except OSError:
        pass
    return None
