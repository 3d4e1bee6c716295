"""Lines of jobs and of results, and where both are kept: local folders and whatever else ``pyarrow.fs`` opens."""

from __future__ import annotations

import json
import os
import posixpath
import time
import uuid
from collections.abc import Iterable
from typing import Any, Protocol

import pyarrow as pa
import pyarrow.dataset as ds
import pyarrow.fs as pafs
import pyarrow.parquet as pq

DEVICES = {"con", "prn", "aux", "nul", "com", "lpt"}
SAFE = set(b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.,=+@")
PART = 1000
"""Results in a part of a data set."""
PART_SECONDS = 10.0
"""A part is written no later than this after its first result."""

SCHEMA = pa.schema(
    [
        ("id", pa.string()),
        ("state", pa.string()),
        ("code", pa.int32()),
        ("milliseconds", pa.float64()),
        ("parameters", pa.string()),
        ("folder", pa.string()),
        ("outputs", pa.list_(pa.struct([("file", pa.string()), ("bytes", pa.int64()), ("blake3", pa.string())]))),
        ("diagnostics", pa.string()),
        ("figures", pa.string()),
        ("inputs", pa.list_(pa.string())),
    ]
)
"""Columns of Parquet results. What has no fixed shape is JSON text."""


def open_place(place: str) -> tuple[pafs.FileSystem, str]:
    """The file system and the path of a local path or of an address such as ``s3://bucket/path``."""
    if "://" in place:
        system, path = pafs.FileSystem.from_uri(place)
        return system, str(path)
    return pafs.LocalFileSystem(), os.path.abspath(place)


def folder_name(id: str) -> str:
    """The folder of a job, as ``fusion-cli batch`` names it."""
    data = id.encode()
    stem = id.lower().split(".")[0].rstrip("0123456789")
    device = stem in DEVICES

    def is_safe(i: int, byte: int) -> bool:
        dot_at_end = byte == ord(".") and i in (0, len(data) - 1)
        return byte in SAFE and not dot_at_end and not (device and i == 0)

    return "".join(chr(b) if is_safe(i, b) else f"%{b:02X}" for i, b in enumerate(data))


def parse(text: bytes, name: str) -> list[dict[str, Any]]:
    """Read a jobs file.

    Raises
    ------
    ValueError
        With every line that cannot be used.
    """
    jobs, faults = [], []
    seen: dict[str, int] = {}
    for number, line in enumerate(text.removeprefix(b"\xef\xbb\xbf").split(b"\n"), 1):
        if not line.strip():
            continue
        try:
            job = json.loads(line)
            check(job)
            job["id"] = str(job["id"])
            if job["id"] in seen:
                raise ValueError(f"the id `{job['id']}` is taken by line {seen[job['id']]}")
            seen[job["id"]] = number
            jobs.append(job)
        except ValueError as error:
            faults.append(f"{name}: line {number}: {error}")
    if faults:
        raise ValueError("\n".join(faults[:10]) + "\nno job was started")
    return jobs


def check(job: Any) -> None:
    """Refuse what is no job."""
    if not isinstance(job, dict):
        raise ValueError("must be an object")
    unknown = set(job) - {"id", "document", "parameters"}
    if unknown:
        raise ValueError(f"unknown key `{min(unknown)}`")
    id = job.get("id")
    if isinstance(id, bool) or not isinstance(id, (str, int, float)) or not 1 <= len(str(id).strip().encode()) <= 150:
        raise ValueError("`id` must be a string of 1 to 150 bytes or a number")
    if not isinstance(job.get("document"), (str, dict)) or not job["document"]:
        raise ValueError("`document` must be a path, a text or an object")
    if not isinstance(job.get("parameters", {}), dict):
        raise ValueError("`parameters` must be an object")


class Sink(Protocol):
    """Where results go."""

    def done(self) -> set[str]:
        """Ids that are there already."""

    def add(self, outcome: dict[str, Any]) -> None:
        """Add a result."""

    def close(self) -> None:
        """Write what is not yet written."""


def open_sink(place: str, resume: bool) -> Sink:
    """Lines appended to a local file; parts of a data set for Parquet, and wherever files cannot grow."""
    system, path = open_place(place)
    if isinstance(system, pafs.LocalFileSystem) and not path.endswith(".parquet"):
        return Lines(path, resume)
    return Parts(system, path, resume)


class Lines:
    """A JSON object a line, as ``fusion-cli batch`` writes them."""

    def __init__(self, path: str, resume: bool) -> None:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        self._done: set[str] = set()
        if os.path.exists(path) and os.path.getsize(path) > 0 and not resume:
            number = 1
            while os.path.exists(f"{path}.{number}"):
                number += 1
            os.rename(path, f"{path}.{number}")
        self._file = open(path, "a+b", buffering=0)
        self._file.seek(0)
        text = self._file.read()
        end = text.rfind(b"\n") + 1
        for number, line in enumerate(text[:end].splitlines(), 1):
            try:
                id = json.loads(line)["id"]
            except (ValueError, KeyError, TypeError) as error:
                raise ValueError(f"{path}: line {number} is no result of a job; nothing was changed") from error
            if id in self._done:
                raise ValueError(f"{path}: line {number} is a second result of the job `{id}`; nothing was changed")
            self._done.add(id)
        self._file.truncate(end)

    def done(self) -> set[str]:
        """Ids of finished lines."""
        return self._done

    def add(self, outcome: dict[str, Any]) -> None:
        """Append a line."""
        line = json.dumps(outcome, separators=(",", ":"), ensure_ascii=False).encode() + b"\n"
        end = self._file.seek(0, os.SEEK_END)
        try:
            while line:
                line = line[self._file.write(line) :]
        except OSError:
            self._file.truncate(end)
            raise

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class Parts:
    """A folder of files with up to `PART` results each: a data set for pyarrow, pandas, DuckDB and others."""

    def __init__(self, system: pafs.FileSystem, path: str, resume: bool) -> None:
        self._system, self._path = system, path
        self._parquet = path.endswith(".parquet")
        self._rows: list[dict[str, Any]] = []
        self._since = time.monotonic()
        info = system.get_file_info(pafs.FileSelector(path, allow_not_found=True))
        parts = [i.path for i in info if i.base_name.startswith("part-")]
        if parts and not resume:
            raise FileExistsError(f"there are results in {path}: go on with --resume, or take another name")
        self._done = self._read(parts)
        system.create_dir(path, recursive=True)

    def _read(self, parts: list[str]) -> set[str]:
        if not parts:
            return set()
        if self._parquet:
            return set(ds.dataset(parts, filesystem=self._system).to_table(columns=["id"])["id"].to_pylist())
        done: set[str] = set()
        for part in parts:
            with self._system.open_input_stream(part) as stream:
                done.update(json.loads(line)["id"] for line in stream.read().splitlines())
        return done

    def done(self) -> set[str]:
        """Ids of all parts."""
        return self._done

    def add(self, outcome: dict[str, Any]) -> None:
        """Keep a result for the next part."""
        if not self._rows:
            self._since = time.monotonic()
        self._rows.append(outcome)
        if len(self._rows) >= PART or time.monotonic() - self._since >= PART_SECONDS:
            self._write()

    def close(self) -> None:
        """Write the last part."""
        if self._rows:
            self._write()

    def _write(self) -> None:
        ending = "parquet" if self._parquet else "jsonl"
        # A part is there whole or not at all: written under a name that is not read, then moved.
        name = f"part-{time.time_ns():020}-{uuid.uuid4().hex[:8]}.{ending}"
        hidden, path = posixpath.join(self._path, "_" + name), posixpath.join(self._path, name)
        if self._parquet:
            pq.write_table(to_table(self._rows), hidden, filesystem=self._system)
        else:
            lines = b"".join(json.dumps(row, ensure_ascii=False).encode() + b"\n" for row in self._rows)
            with self._system.open_output_stream(hidden) as stream:
                stream.write(lines)
        self._system.move(hidden, path)
        self._rows = []


def to_table(outcomes: Iterable[dict[str, Any]]) -> pa.Table:
    """Results as a table of `SCHEMA`."""
    shapeless = ("parameters", "diagnostics", "figures")

    def row(outcome: dict[str, Any]) -> dict[str, Any]:
        told = {name: json.dumps(outcome[name]) for name in shapeless if name in outcome}
        return {**{name: outcome.get(name) for name in SCHEMA.names}, **told}

    return pa.Table.from_pylist([row(outcome) for outcome in outcomes], schema=SCHEMA)
