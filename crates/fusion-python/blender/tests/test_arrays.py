"""The parts that work on arrays alone, held against what is plain to see."""

import importlib

import bpy
import numpy as np
from harness import NAME, boolean, cube, cylinder, is_closed, run, select, update, volume


def module(name):
    return importlib.import_module(f"{NAME}.{name}")


def test_edges_become_curves_that_use_each_once():
    chains = module("edges").chains
    ring = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    (points, closed), = chains(ring)
    assert closed and sorted(points) == [0, 1, 2, 3]
    star = np.array([[0, 1], [1, 2], [0, 3], [0, 4], [4, 5]])
    found = sorted((tuple(points), closed) for points, closed in chains(star))
    assert found == [((0, 1, 2), False), ((0, 3), False), ((0, 4, 5), False)] or all(not c for _, c in found)
    used = sorted(tuple(sorted(pair)) for points, _ in found for pair in zip(points, points[1:]))
    assert used == sorted(map(tuple, np.sort(star, axis=1).tolist()))
    two = chains(np.concatenate([ring, ring + 10]))
    assert len(two) == 2 and all(closed for _, closed in two)


def test_values_spread_between_what_is_known():
    spread = module("spread").spread
    path = np.array([[i, i + 1] for i in range(9)])
    values = np.full((12, 2), np.nan)
    values[0], values[9] = (0, 5), (9, 5)
    known = np.zeros(12, bool)
    known[[0, 9]] = True
    filled = spread(values, known, path)
    assert (filled[[0, 9]] == [[0, 5], [9, 5]]).all() and (filled[:10, 1] == 5).all()
    assert (np.diff(filled[:10, 0]) >= 0).all() and 3 < filled[4, 0] < 6
    assert (filled[10:] == 0).all()


def test_three_sources():
    block = cube()
    drills = [cylinder(radius=0.2, at=(x, 0, 0)) for x in (-0.5, 0.5)]
    result = boolean(block, *drills, radius=0.0)
    area = 24 / 2 * 0.2**2 * np.sin(2 * np.pi / 24)
    assert is_closed(result) and abs(volume(result) - (8 - 2 * 2 * area)) < 1e-5
    assert {item.value for item in result.data.attributes["fusion_origin"].data} == {0, 1, 2}
    select(result)
    assert bpy.ops.fusion.remove_source(index=2) == {"FINISHED"}
    assert abs(volume(result) - (8 - 2 * area)) < 1e-5
    select(result, drills[1])
    assert bpy.ops.fusion.add_source() == {"FINISHED"}
    assert abs(volume(result) - (8 - 2 * 2 * area)) < 1e-5


def test_curves_and_text_can_be_sources():
    block = cube()
    bpy.ops.object.text_add(location=(-0.5, -0.3, 0.8))
    text = bpy.context.object
    text.data.body, text.data.extrude, text.data.size = "F", 0.4, 1.5
    update()
    welded = text.modifiers.new("weld", "WELD")
    welded.merge_threshold = 1e-4
    update()
    result = boolean(block, text, radius=0.0)
    assert 6.5 < volume(result) < 8 - 0.05


run(globals())
