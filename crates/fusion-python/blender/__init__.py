"""Fusion: booleans and blends that stay live, and the other operations of the engine on Blender's objects.

| file | holds |
|---|---|
| `options.py` | Blender properties made from `options.json`, and their values as the engine takes them |
| `settings.py` | what a live object remembers |
| `surface.py` | an object's evaluated mesh as arrays |
| `stack.py` | the arrays of all inputs of a job in one frame |
| `polygons.py`, `layers.py`, `spread.py`, `marks.py` | the result's polygons and attributes, from where its triangles came from |
| `build.py` | arrays into a Blender mesh |
| `edges.py` | marked edges as curves |
| `engine.py` | a job in a thread |
| `problems.py` | an error as a message, a marker and a remedy |
| `live.py`, `handlers.py` | live objects, and what makes them follow |
| `snapshot.py` | what a live object is made of now |
| `live_operators.py` | operators of live objects |
| `operation.py`, `job_operators.py`, `gather.py` | operators that make a new object, and what they take from the scene |
| `panel.py` | the panel in the sidebar |
"""

from . import handlers, job_operators, live_operators, panel, settings

_MODULES = (settings, live_operators, job_operators, panel, handlers)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
