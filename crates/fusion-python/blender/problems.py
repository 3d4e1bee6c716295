"""What went wrong, as a message on the object, a marker at its place and a remedy."""

import bpy
import numpy as np

_SHARE = 0.03


class Problem(Exception):
    """There is no result. `at` is a place in the frame of the result."""

    def __init__(self, message, at=None, remedy="", workable=0.0):
        super().__init__(message)
        self.at, self.remedy, self.workable = at, remedy, workable


def told(error):
    """An error of the engine; None if the job was only stopped."""
    if isinstance(error, Problem):
        return error
    if isinstance(error, KeyboardInterrupt):
        return None
    diagnostic = getattr(error, "diagnostic", None)
    if diagnostic is None:
        return Problem(f"{type(error).__name__}: {error}", remedy="Report this with the file")
    workable = getattr(error, "workable_radius", None) or 0.0
    return Problem(str(error), error.place, error.remedy or "", workable)


def show(thing, problem, frame):
    """Writes a problem onto an object, and puts a marker at its place."""
    settings = thing.fusion
    if (settings.message, settings.is_error) != (str(problem), True):
        # Only then: what is written makes Blender look again.
        settings.message, settings.is_error = str(problem), True
        settings.remedy, settings.workable = problem.remedy, problem.workable
    if problem.at is None or frame is None:
        _remove_marker(thing)
        return
    marker = settings.marker
    if marker is None or marker.name not in bpy.data.objects:
        marker = bpy.data.objects.new(f"{thing.name} problem", None)
        marker.empty_display_type = "SPHERE"
        marker.show_in_front = True
        marker.show_name = True
        for collection in thing.users_collection:
            collection.objects.link(marker)
        settings.marker = marker
    marker.location = (np.array(frame) @ [*problem.at, 1.0])[:3]
    marker.empty_display_size = max(max(thing.dimensions) * _SHARE, 1e-3)


def clear(thing, warnings=()):
    """Takes message and marker away; what the engine warns of stays as the message."""
    settings = thing.fusion
    message = "\n".join(warnings)
    if (settings.message, settings.is_error) != (message, False):
        settings.message, settings.is_error, settings.remedy, settings.workable = message, False, "", 0.0
    _remove_marker(thing)


def _remove_marker(thing):
    marker = thing.fusion.marker
    if marker is not None:
        thing.fusion.marker = None
        bpy.data.objects.remove(marker)
