"""Scenes that ask for the impossible: a report, and nothing else changes."""

import bpy
from harness import boolean, cube, cylinder, refused, run, select, update


def scene():
    """All that there is, to be compared."""
    objects = {}
    for thing in bpy.context.scene.objects:
        if thing.fusion.kind == "NONE" and thing.type == "MESH":
            points = [tuple(v.co) for v in thing.data.vertices]
            objects[thing.name] = repr(points), len(thing.data.polygons), tuple(map(tuple, thing.matrix_world))
    return objects


def told(*things, **options):
    """The report of a boolean that cannot be; the result stays empty and the scene as it was."""
    before = scene()
    select(*things)
    report = refused(bpy.ops.fusion.add_boolean, **{"radius": 0.1, **options})
    result = bpy.context.object
    assert result.fusion.kind == "BOOLEAN" and result.fusion.is_error and len(result.data.polygons) == 0
    assert scene() == before
    assert result.fusion.message in report or report
    return report


def mesh(points, faces):
    data = bpy.data.meshes.new("mesh")
    data.from_pydata(points, [], faces)
    thing = bpy.data.objects.new("mesh", data)
    bpy.context.collection.objects.link(thing)
    update()
    return thing


def test_no_faces():
    assert "no faces" in told(cube(), mesh([], []))
    bpy.context.object.fusion.kind = "NONE"
    assert "no faces" in told(cube(), mesh([(0, 0, 0), (1, 0, 0)], []))


def test_three_faces_on_an_edge():
    fins = [(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0)]
    report = told(cube(), mesh(fins, [(0, 1, 2), (0, 1, 3), (0, 1, 4)]))
    assert "manifold" in report or "edge" in report, report


def test_an_open_mesh():
    block = cube()
    bpy.ops.mesh.primitive_grid_add()
    assert "is open" in told(block, bpy.context.object)


def test_a_place_that_is_no_number():
    bad = cube(at=(1, 0, 0))
    bad.data.vertices[3].co.x = float("nan")
    bad.data.update()
    assert "vertex 3" in told(cube(), bad)


def test_scaled_to_nothing():
    flat = cube()
    flat.scale = (1, 1, 0)
    update()
    assert "scaled to nothing" in told(flat, cylinder())


def test_a_radius_that_does_not_fit_says_which_does():
    select(cube())
    assert bpy.ops.fusion.add_blend(radius=0.2) == {"FINISHED"}
    result = bpy.context.object
    result.fusion.blend.radius, result.fusion.blend.overlap = 1.5, "error"
    update()
    assert result.fusion.is_error and 0.2 < result.fusion.workable <= 1 and "radius" in result.fusion.remedy
    assert bpy.ops.fusion.apply_remedy() == {"FINISHED"}
    assert not result.fusion.is_error and abs(result.fusion.blend.radius - 0.75) < 0.25 and len(result.data.polygons) > 6


def test_a_problem_has_a_marker_at_its_place_which_goes_with_it():
    block, drill = cube(), cylinder(radius=0.3)
    result = boolean(block, drill, radius=0.1)
    made = len(result.data.polygons)
    result.fusion.boolean.overlap, result.fusion.boolean.radius = "error", 0.9
    update()
    assert result.fusion.is_error and len(result.data.polygons) == made
    marker = result.fusion.marker
    assert marker is not None and marker.name in bpy.context.scene.objects
    assert max(map(abs, marker.location)) <= 1.5
    result.fusion.boolean.radius = 0.1
    update()
    assert not result.fusion.is_error and result.fusion.marker is None
    assert not [thing for thing in bpy.data.objects if "problem" in thing.name]


def test_shared_mesh_data():
    block = cube()
    twin = bpy.data.objects.new("twin", block.data)
    twin.location = (0.5, 0.5, 0.5)
    bpy.context.collection.objects.link(twin)
    update()
    before = scene()
    result = boolean(block, twin, operation="union", radius=0.05)
    assert scene() == before and block.data.users == 2 and len(result.data.polygons) > 6


def test_edit_mode():
    """Operators that need object mode are not offered; a live object goes on while its source is edited."""
    block, drill = cube(), cylinder(radius=0.3)
    result = boolean(block, drill, radius=0.1)
    made = len(result.data.polygons)
    select(block)
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.fusion.add_boolean.poll() and not bpy.ops.fusion.bake.poll()
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    update()
    assert not result.fusion.is_error
    bpy.ops.object.mode_set(mode="OBJECT")
    update()
    assert len(block.data.polygons) == 24 and len(result.data.polygons) > made


def test_hidden_and_disabled_objects():
    block, drill = cube(), cylinder(radius=0.3)
    result = boolean(block, drill, radius=0.1)
    drill.hide_viewport = True
    update()
    result.fusion.boolean.radius = 0.12
    update()
    assert not result.fusion.is_error


def test_an_object_of_a_library():
    import os
    import tempfile

    block = cube()
    block.name = "linked block"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "library.blend")
        bpy.data.libraries.write(path, {block})
        bpy.data.objects.remove(block)
        with bpy.data.libraries.load(path, link=True) as (have, want):
            want.objects = ["linked block"]
        linked = want.objects[0]
        bpy.context.collection.objects.link(linked)
        update()
        drill = cylinder(radius=0.3)
        select(linked, drill)
        bpy.ops.fusion.add_boolean(radius=0.1)
        result = bpy.context.object
        assert not result.fusion.is_error and len(result.data.polygons) > 6


def test_operators_report_and_change_nothing():
    fins = [(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0)]
    bad = mesh(fins, [(0, 1, 2), (0, 1, 3), (0, 1, 4)])
    names = ("remesh", "cut", "sharpen", "cluster", "compose", "detail", "max_radius")
    for name in names:
        before, count = scene(), len(bpy.data.objects)
        select(bad)
        report = refused(getattr(bpy.ops.fusion, name))
        assert report.strip() and scene() == before and len(bpy.data.objects) == count, name


run(globals())
