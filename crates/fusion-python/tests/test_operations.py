"""Every operation, beside the program and beside what is known of the result."""

import numpy as np
import pytest
from conftest import same

import fusion_mesh as fm


def test_five_lines_of_trimesh_give_the_bytes_of_the_program(tmp_path, cli):
    trimesh = pytest.importorskip("trimesh")
    a = trimesh.creation.box((2, 2, 2))
    b = trimesh.creation.box((1, 1, 3))
    result = fm.union(a, b, radius="2%", profile="g2")
    filleted = result.to_trimesh()
    assert filleted.is_watertight and filleted.is_winding_consistent
    # A fillet fills the corner that runs around the post: more than the sharp union, whose volume is known.
    assert 9 < filleted.volume < 9.5

    for name, mesh in (("a", a), ("b", b)):
        fm.as_mesh(mesh).save(tmp_path / f"{name}.ply")
    out = tmp_path / "out.ply"
    cli("union", tmp_path / "a.ply", tmp_path / "b.ply", "--radius", "2%", "--profile", "g2", "-o", out)
    assert same(fm.as_mesh(out), result.mesh)
    result.save(tmp_path / "own.ply")
    assert (tmp_path / "own.ply").read_bytes() == out.read_bytes()


def test_radii_that_no_binary_number_holds_are_those_of_the_program(tmp_path, cli):
    block = fm.box((1, 1, 1))
    block.save(tmp_path / "box.ply")
    for radius in ("0.1", "0.07", "0.123456789"):
        cli("blend", tmp_path / "box.ply", "--radius", radius, "-o", tmp_path / "round.ply")
        assert same(fm.blend(block, radius=float(radius)).mesh, fm.as_mesh(tmp_path / "round.ply"))


def test_booleans_have_the_volumes_of_their_sets(boxes):
    a, b = boxes
    for function, volume in ((fm.union, 9), (fm.difference, 6), (fm.intersection, 2)):
        result = function(a, b)
        assert fm.info(result)["volume"] == pytest.approx(volume, abs=1e-12)
        assert result.report["command"] == function.__name__


def test_a_blended_cube_has_the_volume_of_calculus():
    r = 0.1
    block = fm.blend(fm.box((1, 1, 1)), radius=r, tolerance=2e-3)
    # Quarter rounds along twelve edges between the corners, and an eighth of a ball in each of eight corners.
    sharp = 12 * (1 - 2 * r) * (1 - np.pi / 4) * r**2 + 8 * (1 - np.pi / 6) * r**3
    assert fm.info(block)["volume"] == pytest.approx(1 - sharp, abs=4e-4)


def test_edges_are_selected_as_objects():
    block = fm.box((2, 1, 1))
    chosen = fm.edges(angle=40).within(fm.box((3, 3, 0.2), (0, 0, 0.5))).convex()
    result = fm.blend(block, chosen, radius=0.1)
    assert result.report["figures"]["curves"] == 4
    assert fm.blend(block, fm.edges().near((1, 0.5, 0)), radius=0.1).report["figures"]["curves"] == 1
    assert fm.blend(block, fm.edges().ids(0, 1), radius=0.1).report["figures"]["curves"] == 2
    with pytest.raises(fm.InfeasibleError) as refused:
        fm.blend(block, fm.edges().concave(), radius=0.1)
    assert refused.value.diagnostic["code"] == "nothing_chosen"
    # A selection does not change when another is made from it.
    whole = fm.edges()
    whole.convex()
    assert "convex" not in whole.options


def test_seams_of_an_earlier_union_are_blended(boxes):
    joined = fm.union(*boxes)
    result = fm.blend(joined, seams=joined, radius=0.1)
    assert result.report["figures"]["curves"] == 2


def test_origins_place_every_vertex(boxes):
    result = fm.union(*boxes, radius=0.1)
    vertices, faces, stages = result.origins
    assert len(vertices) == len(result.vertices) and len(faces) == len(result.faces)
    kept = vertices["kind"] == 0
    assert kept.any() and kept.sum() == result.report["kept_vertices"]
    for part, mesh in enumerate(boxes):
        mine = kept & (vertices["part"] == part)
        assert np.array_equal(result.vertices[mine], mesh.vertices[vertices["ids"][mine, 0]])
    on_edges = vertices["kind"] == 1
    for vertex in np.flatnonzero(on_edges):
        mesh = boxes[vertices["part"][vertex]]
        ends = mesh.vertices[vertices["ids"][vertex]]
        point = vertices["weights"][vertex, :2] @ ends
        assert np.allclose(point, result.vertices[vertex], atol=1e-12)
    assert (faces["kind"] != 0).sum() == result.report["changed_faces"]
    assert {stages[s] for s in faces["stage"][faces["kind"] == 3]} <= set(stages)


def test_parts_of_a_composition_are_named_by_numbers():
    upper = fm.cut(fm.sphere(1, (0, 0, 2)), plane=((0, 0, 1.5), (0, 0, -1)))
    lower = fm.cut(fm.sphere(1, (0, 0, 0)), plane={"point": (0, 0, 0.5), "normal": (0, 0, 1)})
    whole = fm.compose(lower, upper, loops=[(0, 0), (1, 0)])
    assert whole.report["validity"]["closed"]
    assert same(whole.mesh, fm.compose(lower, upper, loops=["0:0", "1:0"]).mesh)


def test_detail_comes_from_another_mesh():
    smooth = fm.sphere(1.0, segments=48)
    bumpy = fm.sphere(1.0, segments=48)
    bumpy.vertices = bumpy.vertices * (1 + 0.02 * np.sin(40 * bumpy.vertices[:, :1]))
    region = {"near": (0, 0, 1), "radius": 0.5}
    result = fm.detail(smooth, target=region, source={"mesh": bumpy, "near": (0, 0, 1), "radius": 0.8})
    moved = np.linalg.norm(result.vertices - smooth.vertices, axis=1)
    far = np.linalg.norm(smooth.vertices - [0, 0, 1], axis=1) > 0.8
    assert moved[far].max() == 0 and moved.max() > 0.002


def test_poses_are_those_of_the_program(tmp_path, cli):
    block = fm.box((1, 2, 3))
    block.save(tmp_path / "box.ply")
    rotated = ["--scale", 2, "--rotate", "0,0,1,30", "--translate", "1,0,0"]
    cli("pose", tmp_path / "box.ply", *rotated, "-o", tmp_path / "out.ply")
    moved = fm.pose(block, scale=2, rotate=((0, 0, 1), 30), translate=(1, 0, 0))
    assert same(moved.mesh, fm.as_mesh(tmp_path / "out.ply"))
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    assert np.allclose(moved.vertices, 2 * block.vertices @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + (1, 0, 0))
    dropped = fm.pose(fm.sphere(0.5), translate=(0, 0, 9), drop=fm.box((2, 2, 2)))
    assert dropped.vertices[:, 2].min() == pytest.approx(1, abs=1e-12)
    with pytest.raises(fm.UsageError, match="drop"):
        fm.pose(fm.sphere(0.5), translate=(9, 0, 0), drop=fm.box((2, 2, 2)))


def test_a_sharp_profile_takes_a_fillet_back(tmp_path, cli):
    soft = fm.blend(fm.box((1, 1, 1)), fm.edges().near((0.5, 0.5, 0)), radius=0.2)
    point = fm.edges().near((0.45, 0.45, 0))
    sharp = fm.blend(soft, point, profile="sharp")
    assert fm.info(sharp)["volume"] == pytest.approx(1, abs=1e-12)
    assert same(sharp.mesh, fm.sharpen(soft, near=(0.45, 0.45, 0)).mesh)
    soft.save(tmp_path / "soft.ply")
    cli("blend", tmp_path / "soft.ply", "--profile", "sharp", "--near", "0.45,0.45,0", "-o", tmp_path / "sharp.ply")
    assert same(sharp.mesh, fm.as_mesh(tmp_path / "sharp.ply"))
    document = fm.Document()
    document.part("soft", soft)
    document.step("blend", "soft", point, profile="sharp")
    assert same(document.evaluate()["soft"].mesh, sharp.mesh)


def test_what_limits_a_radius_is_named(boxes):
    # The ball rolls on the rims of both boxes, however large it is.
    free = fm.max_radius(*boxes)
    assert free.at is None and "size of the curves" in free.limited_by
    for radius in (0.75 * free.radius, free.radius):
        assert fm.union(*boxes, radius=radius, overlap="error").report["validity"]["closed"]
    bounded = fm.max_radius(fm.box((1, 1, 1)))
    assert bounded.at is not None and len(bounded.limited_by) > 3


def test_largest_radius():
    assert fm.max_radius(fm.box((1, 1, 1))).radius == pytest.approx(0.5, rel=0.02)


def test_largest_radius_of_seams_agrees_with_the_program(tmp_path, cli, boxes):
    import json

    for name, mesh in zip("ab", boxes):
        mesh.save(tmp_path / f"{name}.ply")
    printed = json.loads(cli("union", tmp_path / "a.ply", tmp_path / "b.ply", "--max-radius", "--json").stdout)
    limit = fm.max_radius(*boxes)
    assert (limit.radius, limit.limited_by) == (printed["max_radius"], printed["limited_by"])


def test_features_agree_with_the_program(tmp_path, cli):
    import json

    block = fm.box((1, 2, 3))
    block.save(tmp_path / "box.ply")
    printed = json.loads(cli("features", tmp_path / "box.ply", "--json").stdout)
    assert fm.features(block) == printed["curves"]


def test_info_agrees_with_the_program(tmp_path, cli):
    import json

    ball = fm.sphere(1.0)
    ball.save(tmp_path / "ball.ply")
    assert fm.info(ball) == json.loads(cli("info", tmp_path / "ball.ply", "--json").stdout)


def test_control_nets_come_with_clusters():
    assert fm.cluster(fm.box()).nets
    assert fm.remesh(fm.sphere(), edge_length=0.3).nets is None
