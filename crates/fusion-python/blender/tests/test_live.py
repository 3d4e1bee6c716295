"""Live objects follow, and nothing else changes."""

import os
import tempfile

import bpy
from harness import boolean, cube, cylinder, is_closed, run, select, update, volume


def drilled(**options):
    block, drill = cube(), cylinder(radius=0.3)
    return block, drill, boolean(block, drill, **{"radius": 0.1, **options})


def middle(thing, chosen):
    """The mean place of some of a mesh's points."""
    points = [v.co for v in thing.data.vertices if chosen(v.co)]
    return sum((p.x for p in points)) / len(points)


def hole(co):
    return co.x**2 + co.y**2 < 0.9 and abs(co.z) < 1.001


def state(thing):
    return [tuple(v.co) for v in thing.data.vertices], [tuple(p.vertices) for p in thing.data.polygons]


def test_result_follows_a_cutter_that_moves():
    block, drill, result = drilled()
    before = state(block), state(drill)
    assert is_closed(result) and abs(middle(result, hole)) < 0.01
    whole = volume(result)
    drill.location.x = 0.25
    update()
    assert abs(middle(result, hole) - 0.25) < 0.01 and abs(volume(result) - whole) < 1e-4
    drill.location.x = 5
    update()
    assert abs(volume(result) - 8) < 1e-5
    assert (state(block), state(drill)) == before
    assert block.data.users == 1 and block.display_type == "WIRE"


def test_result_follows_an_edit_and_an_option():
    block, drill, result = drilled()
    for vertex in block.data.vertices:
        vertex.co.x *= 2
    block.data.update()
    update()
    assert 15 < volume(result) < 16
    sharp = volume(result)
    result.fusion.boolean.radius = 0.2
    update()
    assert volume(result) < sharp - 0.01
    result.fusion.operation = "union"
    update()
    assert volume(result) > 16 or volume(result) > sharp


def test_result_goes_with_the_first_source():
    block, drill, result = drilled()
    made = state(result)
    block.location, drill.location = (3, 1, 0), (3, 1, 0)
    update()
    assert tuple(result.location) == (3, 1, 0) and state(result) == made


def test_what_does_not_change_is_not_made_again():
    block, drill, result = drilled()
    result.data.vertices[0].co.x += 0.5
    update()
    moved = state(result)
    block.update_tag()
    update()
    assert state(result) == moved


def test_undo_and_redo():
    block, drill, result = drilled()
    names = block.name, drill.name, result.name
    bpy.ops.ed.undo_push(message="made")
    before = state(result)
    drill.location.x = 0.25
    update()
    after = state(result)
    assert after != before
    bpy.ops.ed.undo_push(message="moved")
    bpy.ops.ed.undo()
    block, drill, result = (bpy.data.objects[name] for name in names)
    update()
    assert drill.location.x == 0 and state(result) == before
    bpy.ops.ed.redo()
    block, drill, result = (bpy.data.objects[name] for name in names)
    update()
    assert abs(drill.location.x - 0.25) < 1e-6 and state(result) == after


def test_save_and_reload():
    _, drill, result = drilled()
    names, made = (drill.name, result.name), state(result)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        drill, result = (bpy.data.objects[name] for name in names)
        assert result.fusion.kind == "BOOLEAN" and abs(result.fusion.boolean.radius - 0.1) < 1e-6
        assert state(result) == made
        drill.location.x = 0.25
        update()
        assert abs(middle(result, hole) - 0.25) < 0.01


def test_a_duplicate_has_a_life_of_its_own():
    _, drill, result = drilled()
    for linked in (False, True):
        select(result)
        bpy.ops.object.duplicate(linked=linked)
        twin = bpy.context.object
        twin.fusion.boolean.radius = 0.2
        update()
        assert twin.data != result.data and volume(twin) < volume(result) - 0.005
    drill.location.x = 0.25
    update()
    assert abs(middle(result, hole) - 0.25) < 0.01 and abs(middle(twin, hole) - 0.25) < 0.01


def test_duplicates_with_sources_follow_their_own():
    block, drill, result = drilled()
    select(block, drill, result)
    bpy.ops.object.duplicate()
    twins = bpy.context.selected_objects
    twin = next(thing for thing in twins if thing.fusion.kind == "BOOLEAN")
    own = [entry.object for entry in twin.fusion.sources]
    assert set(own) == set(twins) - {twin}
    own[1].location.x = 0.25
    update()
    assert abs(middle(twin, hole) - 0.25) < 0.01 and abs(middle(result, hole)) < 0.01


def test_bake_and_remove():
    block, drill, result = drilled()
    made = state(result)
    select(result)
    assert bpy.ops.fusion.bake() == {"FINISHED"}
    assert result.fusion.kind == "NONE" and state(result) == made
    assert block.display_type == "TEXTURED" and not drill.hide_render
    drill.location.x = 0.25
    update()
    assert state(result) == made

    other = boolean(block, drill, radius=0.1)
    name = other.name
    assert bpy.ops.fusion.remove() == {"FINISHED"}
    assert name not in bpy.data.objects and block.display_type == "TEXTURED"


def test_a_source_that_is_deleted_is_told():
    block, drill, result = drilled()
    made = state(result)
    select(drill)
    bpy.ops.object.delete()
    update()
    assert result.fusion.is_error and "not in any scene" in result.fusion.message and result.fusion.remedy
    assert state(result) == made
    other = cylinder(radius=0.2)
    result.fusion.sources[1].object = other
    update()
    assert not result.fusion.is_error and state(result) != made


def test_deleting_the_result_leaves_the_sources():
    block, drill, result = drilled()
    select(result)
    bpy.ops.object.delete()
    drill.location.x = 0.25
    update()
    assert len(bpy.context.scene.objects) == 2


def test_a_result_in_another_scene_follows():
    block, drill, result = drilled()
    other = bpy.data.scenes.new("other")
    other.collection.objects.link(result)
    drill.location.x = 0.25
    update()
    assert abs(middle(other.objects[result.name], hole) - 0.25) < 0.01


def test_a_live_object_can_be_a_source():
    _, drill, result = drilled()
    top = cylinder(radius=0.2, at=(0.7, 0.7, 0))
    second = boolean(result, top, radius=0.05)
    first = volume(second)
    drill.scale = (1.5, 1.5, 1)
    update()
    update()
    assert volume(second) < first - 0.5


def test_animation_follows():
    _, drill, result = drilled()
    for frame, x in ((1, 0.0), (11, 0.3)):
        drill.location.x = x
        drill.keyframe_insert("location", frame=frame)
    for frame in (1, 6, 11):
        bpy.context.scene.frame_set(frame)
        assert abs(middle(result, hole) - drill.location.x) < 0.01
    assert abs(drill.location.x - 0.3) < 1e-6


def test_parts_can_be_hidden():
    block, drill, result = drilled()
    for thing in (block, drill):
        thing.hide_set(True)
    drill.location.x = 0.25
    update()
    assert abs(middle(result, hole) - 0.25) < 0.01


def test_edges_by_angle_and_by_mark():
    block = cube()
    select(block)
    assert bpy.ops.fusion.add_blend(radius=0.2) == {"FINISHED"}
    round_all = bpy.context.object
    for edge in block.data.edges:
        a, b = (block.data.vertices[v].co for v in edge.vertices)
        edge.use_edge_sharp = a.z == b.z == 1
    select(block)
    assert bpy.ops.fusion.add_blend(radius=0.2, edges="sharp_edge") == {"FINISHED"}
    round_top = bpy.context.object
    assert is_closed(round_all) and is_closed(round_top)
    assert volume(round_all) < volume(round_top) < 8
    assert min(v.co.z for v in round_top.data.vertices) == -1
    corner = [v.co for v in round_top.data.vertices if v.co.z == -1 and abs(abs(v.co.x) - 1) < 1e-6]
    assert len(corner) >= 4
    for edge in block.data.edges:
        edge.use_edge_sharp = False
    block.data.update()
    update()
    assert round_top.fusion.is_error and "no edge is chosen" in round_top.fusion.message


run(globals())
