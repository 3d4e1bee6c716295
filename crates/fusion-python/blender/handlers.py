"""What makes live objects follow: changes, undo, loading, saving, frames."""

import bpy
from bpy.app.handlers import persistent

from . import live, snapshot

_INTERVAL = 0.02
_state = {"rendering": False, "inside": False}


@persistent
def _updated(scene, depsgraph):
    if _state["inside"]:
        return
    geometry, moved = set(), set()
    for update in depsgraph.updates:
        uid = update.id.original.session_uid
        if update.is_updated_geometry or update.is_updated_shading:
            geometry.add(uid)
        if update.is_updated_transform:
            moved.add(uid)
    snapshot.forget(geometry)
    touched = geometry | moved
    for thing in scene.objects:
        if live.is_live(thing) and _is_touched(thing, touched):
            live.request(thing)
    _go_on()


def _is_touched(thing, touched):
    if thing.fusion.is_stale:
        return True
    found = [entry.object for entry in thing.fusion.sources]
    return any(s is None or s.session_uid in touched or not s.users_scene for s in found)


def _go_on():
    if not live.is_busy():
        return
    if bpy.app.background or _state["rendering"]:
        # There is nobody to whom time matters, and no loop that would call a timer.
        _state["inside"] = True
        try:
            live.complete()
        finally:
            _state["inside"] = False
    elif not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=0.0)


def _tick():
    live.pump()
    _redraw()
    return _INTERVAL if live.is_busy() else None


def _redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


@persistent
def _changed_whole(*_):
    """Undo, redo and loading put another state in the place of all objects."""
    live.cancel()
    snapshot.forget()
    for scene in bpy.data.scenes:
        for thing in scene.objects:
            if live.is_live(thing):
                live.request(thing)
    _go_on()


@persistent
def _save(*_):
    if live.is_busy():
        live.complete()


@persistent
def _render_begins(*_):
    _state["rendering"] = True


@persistent
def _render_ends(*_):
    _state["rendering"] = False


_HANDLERS = {
    "depsgraph_update_post": _updated,
    "frame_change_post": _updated,
    "undo_post": _changed_whole,
    "redo_post": _changed_whole,
    "load_post": _changed_whole,
    "save_pre": _save,
    "render_init": _render_begins,
    "render_complete": _render_ends,
    "render_cancel": _render_ends,
}


def register():
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    live.cancel()
    snapshot.forget()
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    for name, handler in _HANDLERS.items():
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
