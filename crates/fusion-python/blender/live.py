"""Live objects: jobs that are started when a source changes, cancelled by newer changes, and put into the result."""

import bpy
import numpy as np
from mathutils import Matrix

from . import build, problems, snapshot
from .engine import Job

# A job this young may end although there is a newer change: else nothing would be seen as long as the mouse moves.
PATIENCE = 0.5
_pending = {}
_jobs = {}


def is_live(thing):
    """Whether an object follows sources."""
    return thing.fusion.kind != "NONE" and thing.fusion.is_live and thing.library is None


def request(thing):
    """Asks for a live object to be made again."""
    _pending[thing.session_uid] = True


def is_busy():
    """Whether anything is to be done."""
    return bool(_pending or _jobs)


def progress():
    """Stage and share of the job that was started last; None if there is none."""
    job = next(reversed(_jobs.values()), None)
    return None if job is None else (job[0].stage, job[0].share)


def pump():
    """Starts what is asked for and takes in what is done. Called on the main thread; never waits."""
    _take_in()
    for uid in list(_pending):
        if uid in _jobs and not _jobs[uid][0].is_done and _jobs[uid][0].age < PATIENCE:
            continue
        del _pending[uid]
        thing = _by_uid(uid)
        if thing is not None and thing.fusion.kind != "NONE":
            _guarded(_start, thing)
    _take_in()


def _take_in():
    for uid, (job, taken) in list(_jobs.items()):
        if job.is_done:
            del _jobs[uid]
            thing = _by_uid(uid)
            if thing is not None:
                _guarded(_finish, thing, job, taken)


def _guarded(step, thing, *arguments):
    """One object's trouble is told on it, and does not stop the others."""
    try:
        step(thing, *arguments)
    except Exception as error:  # noqa: BLE001
        problems.show(thing, problems.told(error), None)
        thing.fusion.key = ""


def complete():
    """Waits until every live object is up to date."""
    while is_busy():
        pump()
        for job, _ in list(_jobs.values()):
            job.wait()


def cancel():
    """Stops all jobs."""
    _pending.clear()
    for job, _ in _jobs.values():
        job.cancel()
    _jobs.clear()


def _by_uid(uid):
    return next((thing for thing in bpy.data.objects if thing.session_uid == uid), None)


def _start(thing):
    running = _jobs.pop(thing.session_uid, None)
    if running is not None:
        running[0].cancel()
    if thing.fusion.is_stale:
        thing.fusion.is_stale = False
    taken = snapshot.take(thing)
    if taken.key == thing.fusion.key:
        build.set_new_material(thing.data, thing.fusion.material)
        _place(thing, taken.frame)
        return
    job = Job(taken.function, taken.stack, taken.options)
    _jobs[thing.session_uid] = job, taken


def _finish(thing, job, taken):
    if job.error is not None:
        problem = problems.told(job.error)
        if problem is not None:
            problems.show(thing, problem, taken.frame)
            thing.fusion.key = taken.key
        return
    if job.made is None:
        return
    if thing.data.users > 1:
        # A linked duplicate has sources of its own.
        thing.data = thing.data.copy()
    build.fill(thing, taken.stack, job.made, thing.fusion.material)
    thing.fusion.key = taken.key
    _place(thing, taken.frame)
    problems.clear(thing, job.made.warnings)
    snapshot.forget([thing.session_uid])
    for other in bpy.data.objects:
        if is_live(other) and any(entry.object == thing for entry in other.fusion.sources):
            request(other)


def _place(thing, frame):
    if not np.allclose(np.array(thing.matrix_world), frame, atol=1e-7):
        thing.matrix_world = Matrix(frame.tolist())
