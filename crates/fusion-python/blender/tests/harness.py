"""What every test file shares: Blender with the extension on, scenes to begin with, and an end that Blender survives."""

import os
import sys
import traceback

import bpy

NAME = "bl_ext.user_default.fusion"


def enable():
    """Turns the extension on; gives its module."""
    import addon_utils

    module = addon_utils.enable(NAME, default_set=True)
    assert module is not None, f"{NAME} cannot be enabled"
    return module


def run(names, with_extension=True):
    """Runs all functions called `test_…` in order, each in an empty scene, and ends the process."""
    if with_extension:
        enable()
    wanted = sys.argv[1:]
    failed = 0
    for name, test in list(names.items()):
        if not name.startswith("test_") or (wanted and name not in wanted):
            continue
        empty()
        try:
            test()
        except BaseException:  # noqa: BLE001
            failed += 1
            print(f"--- {name}", flush=True)
            traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender does not always survive the interpreter's own end.
    os._exit(1 if failed else 0)


def empty():
    """A scene without objects."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def cube(size=2.0, at=(0, 0, 0), cuts=0):
    """A cube of quads, divided this many times."""
    bpy.ops.mesh.primitive_cube_add(size=size, location=at)
    thing = bpy.context.object
    if cuts:
        modifier = thing.modifiers.new("divide", "SUBSURF")
        modifier.subdivision_type, modifier.levels = "SIMPLE", cuts
        bpy.ops.object.modifier_apply(modifier=modifier.name)
    return thing


def cylinder(radius=0.4, depth=3.0, vertices=24, at=(0, 0, 0), turned=0.1):
    """A cylinder along Z; turned a little, so that nothing lies on a diagonal of the cube."""
    bpy.ops.mesh.primitive_cylinder_add(radius=radius, depth=depth, vertices=vertices, location=at, rotation=(0, 0, turned))
    return bpy.context.object


def select(*things):
    """Selects objects; the first becomes the active one."""
    for other in bpy.context.view_layer.objects:
        other.select_set(False)
    for thing in things:
        thing.select_set(True)
    bpy.context.view_layer.objects.active = things[0]


def boolean(*things, **options):
    """A live boolean of objects."""
    select(*things)
    assert bpy.ops.fusion.add_boolean(**options) == {"FINISHED"}
    return bpy.context.object


def update():
    """What Blender does after every change."""
    bpy.context.view_layer.update()


def corners(thing, places=5):
    """Every polygon as its points, rounded, from its smallest point on."""
    points = [tuple(round(x, places) + 0.0 for x in v.co) for v in thing.data.vertices]
    return [turned([points[i] for i in p.vertices]) for p in thing.data.polygons]


def turned(items):
    """A cycle from its smallest item on."""
    first = items.index(min(items))
    return tuple(items[first:] + items[:first])


def volume(thing):
    """The volume inside, by Blender's own count."""
    import bmesh

    mesh = bmesh.new()
    mesh.from_mesh(thing.data)
    value = mesh.calc_volume(signed=True)
    mesh.free()
    return value


def is_closed(thing):
    """Whether every edge has two faces."""
    import bmesh

    mesh = bmesh.new()
    mesh.from_mesh(thing.data)
    closed = all(len(edge.link_faces) == 2 for edge in mesh.edges)
    mesh.free()
    return closed and not thing.data.validate()


def refused(operator, **options):
    """The report of an operator that ends with an error; fails if it does not."""
    try:
        operator(**options)
    except RuntimeError as error:
        return str(error)
    raise AssertionError("no error was reported")
