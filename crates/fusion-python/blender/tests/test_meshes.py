"""What Blender's meshes have comes back where nothing changed."""

import bpy
import numpy as np
from harness import boolean, corners, cube, cylinder, is_closed, run, turned, volume


def divided():
    """A cube of 1536 quads with all that a mesh can carry."""
    thing = cube(cuts=4)
    mesh = thing.data
    for name in ("red", "blue"):
        mesh.materials.append(bpy.data.materials.new(name))
    for polygon in mesh.polygons:
        polygon.material_index = int(polygon.center.x > 0)
        polygon.use_smooth = polygon.center.z > 0
    color = mesh.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    color.data.foreach_set("color", np.linspace(0, 1, 4 * len(mesh.vertices), dtype=np.float32))
    number = mesh.attributes.new("number", "INT", "FACE")
    number.data.foreach_set("value", np.arange(len(mesh.polygons), dtype=np.int32))
    heavy = thing.vertex_groups.new(name="heavy")
    for vertex in mesh.vertices:
        heavy.add([vertex.index], 0.25 + 0.5 * (vertex.co.y > 0), "REPLACE")
    for edge in mesh.edges:
        a, b = (mesh.vertices[v].co for v in edge.vertices)
        edge.use_edge_sharp = a.x == b.x == 1.0
        edge.use_seam = a.y == b.y == -1.0
    return thing


def test_quads_away_from_the_seam_come_back_with_all_they_have():
    block, drill = divided(), cylinder()
    result = boolean(block, drill, radius=0.1)
    mesh, source = result.data, block.data
    assert is_closed(result)
    had = {key: polygon for key, polygon in zip(corners(block), source.polygons)}
    back = [(polygon, had[key]) for key, polygon in zip(corners(result), mesh.polygons) if key in had]

    # Away from the seam: beyond the fillet's reach, the axis being Z.
    points = {v.index: np.array(v.co) for v in source.vertices}
    away = [p for p in source.polygons if min(np.hypot(*points[v][:2]) for v in p.vertices) > 0.6]
    kept = {old.index for _, old in back}
    share = sum(p.index in kept for p in away) / len(away)
    assert share >= 0.95, share

    paint, new_paint = source.attributes["paint"].data, mesh.attributes["paint"].data
    number, new_number = source.attributes["number"].data, mesh.attributes["number"].data
    uv, new_uv = source.uv_layers[0].uv, mesh.uv_layers["UVMap"].uv
    for new, old in back:
        assert new.material_index == old.material_index and new.use_smooth == old.use_smooth
        assert new_number[new.index].value == number[old.index].value
        places = [points[v] for v in old.vertices]
        for corner, vertex in zip(new.loop_indices, new.vertices):
            at = np.array(mesh.vertices[vertex].co)
            k = int(np.argmin([np.linalg.norm(at - p) for p in places]))
            assert tuple(at) == tuple(places[k])
            assert tuple(new_uv[corner].vector) == tuple(uv[old.loop_start + k].vector)
            assert tuple(new_paint[vertex].color) == tuple(paint[old.vertices[k]].color)
    assert mesh.uv_layers.active.name == "UVMap"

    weights = {v.index: v.groups[0].weight for v in mesh.vertices if v.groups}
    for new, _ in back:
        for vertex in new.vertices:
            assert weights[vertex] == 0.25 + 0.5 * (mesh.vertices[vertex].co.y > 0)


def test_marks_of_edges_come_back():
    block, drill = divided(), cylinder()
    mesh = boolean(block, drill, radius=0.1).data
    ends = [[mesh.vertices[v].co for v in edge.vertices] for edge in mesh.edges]
    # Marked edges lie in two sides of the cube, where nothing was cut: the drill runs along Z.
    sharp = [edge.use_edge_sharp for edge in mesh.edges]
    seam = [edge.use_seam for edge in mesh.edges]
    assert sharp == [a.x == b.x == 1.0 for a, b in ends] and any(sharp)
    assert seam == [a.y == b.y == -1.0 for a, b in ends] and any(seam)


def test_new_faces_have_a_slot_uvs_an_origin_and_are_smooth():
    block, drill = divided(), cylinder()
    result = boolean(block, drill, radius=0.1)
    mesh = result.data
    origin = np.empty(len(mesh.polygons), np.int32)
    mesh.attributes["fusion_origin"].data.foreach_get("value", origin)
    new = np.flatnonzero(origin == -1)
    assert len(new) > 100 and set(origin) == {-1, 0, 1}
    slot = len(mesh.materials) - 1
    assert all((mesh.polygons[f].material_index == slot) == (origin[f] == -1) for f in range(len(origin)))
    assert all(mesh.polygons[f].use_smooth for f in new)
    chosen = bpy.data.materials.new("chosen")
    result.fusion.material = chosen
    bpy.context.view_layer.update()
    assert mesh.materials[slot] == chosen
    uvs = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].uv.foreach_get("vector", uvs)
    corners_of_new = np.concatenate([mesh.polygons[f].loop_indices for f in new])
    uvs = uvs.reshape(-1, 2)[corners_of_new]
    assert np.isfinite(uvs).all() and (uvs >= 0).all() and (uvs <= 1).all() and (uvs.std(axis=0) > 0.01).all()


def test_pieces_have_uvs_of_the_plane_they_lie_in():
    """On each side of a cube Blender's UVs are linear in the place, so those of pieces can be told."""
    block, drill = divided(), cylinder()
    mesh = boolean(block, drill, radius=0.1).data
    uv, origin = mesh.uv_layers["UVMap"].uv, mesh.attributes["fusion_origin"].data

    def rows(thing, polygons):
        points = [(*thing.vertices[v].co, 1.0) for p in polygons for v in p.vertices]
        return np.array(points), np.array([thing.uv_layers[0].uv[c].vector[:] for p in polygons for c in p.loop_indices])

    def is_top(thing, polygon):
        return all(abs(thing.vertices[v].co.z - 1.0) < 1e-6 for v in polygon.vertices)

    points, values = rows(block.data, [p for p in block.data.polygons if is_top(block.data, p)])
    linear = np.linalg.lstsq(points, values, rcond=None)[0]
    pieces = [p for p in mesh.polygons if len(p.vertices) == 3 and origin[p.index].value == 0 and is_top(mesh, p)]
    assert len(pieces) > 10
    for piece in pieces:
        for corner, vertex in zip(piece.loop_indices, piece.vertices):
            told = np.array([*mesh.vertices[vertex].co, 1.0]) @ linear
            assert np.abs(told - uv[corner].vector).max() < 1e-5


def test_polygons_of_many_corners_and_a_flipped_cutter_come_back():
    """Of a prism of 24 sides that bores a blind hole, the bottom and the walls' lower parts show inside out."""
    block, drill = cube(), cylinder(depth=2.0, at=(0, 0, 0.5))
    result = boolean(block, drill, radius=0.0)
    assert is_closed(result)
    sizes = np.bincount([len(p.vertices) for p in result.data.polygons])
    assert sizes[24] == 1 and sizes[4] == 5
    bottom = next(p for p in result.data.polygons if len(p.vertices) == 24)
    assert bottom.normal.z > 0.999
    area = 24 / 2 * 0.4**2 * np.sin(2 * np.pi / 24)
    assert abs(volume(result) - (8 - 1.5 * area)) < 1e-5


def test_a_mirrored_object_is_not_inside_out():
    block, drill = cube(cuts=2), cylinder(radius=0.3)
    block.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    result = boolean(block, drill, radius=0.05)
    assert is_closed(result) and 6 < volume(result) < 8
    quads = [p for p in result.data.polygons if len(p.vertices) == 4]
    assert len(quads) > 60


def test_scale_counts_and_place_does_not():
    """A radius is a length of the scene, however the first object is scaled and placed."""
    block, drill = cube(cuts=2), cylinder(radius=0.3)
    plain = volume(boolean(block, drill, radius=0.1, as_wire=False))
    block.data.transform(block.matrix_world.inverted())
    block.scale = (0.5, 0.5, 0.5)
    for vertex in block.data.vertices:
        vertex.co *= 2
    block.rotation_euler = (0, 0, 0.0)
    bpy.context.view_layer.update()
    scaled = boolean(block, drill, radius=0.1, as_wire=False)
    assert abs(volume(scaled) - plain) < 1e-4
    assert tuple(scaled.scale) == (1, 1, 1)


def test_custom_normals_stay():
    block, drill = cube(cuts=3), cylinder(radius=0.3)
    mesh = block.data
    wanted = [tuple(mesh.vertices[v].co.normalized()) for v in (loop.vertex_index for loop in mesh.loops)]
    mesh.normals_split_custom_set(wanted)
    result = boolean(block, drill, radius=0.1).data
    had = {turned(list(key)): True for key in corners(block)}
    off = []
    for key, polygon in zip(corners(bpy.context.object), result.polygons):
        if key in had:
            for corner, vertex in zip(polygon.loop_indices, polygon.vertices):
                off.append((result.corner_normals[corner].vector - result.vertices[vertex].co.normalized()).length)
    assert len(off) > 500 and np.quantile(off, 0.95) < 0.01, np.quantile(off, 0.95)


def test_modifiers_below_are_respected():
    block, drill = cube(), cylinder(radius=0.3)
    modifier = block.modifiers.new("array", "ARRAY")
    modifier.count, modifier.relative_offset_displace = 2, (2.0, 0, 0)
    bpy.context.view_layer.update()
    result = boolean(block, drill, radius=0.05)
    assert 15 < volume(result) < 16


run(globals())
