"""Every operator on a scene where its result is known."""

import math
import os
import pathlib
import subprocess
import tempfile

import bpy
import numpy as np
from harness import boolean, cube, cylinder, is_closed, run, select, volume
from mathutils import Vector


def sphere(at=(0, 0, 0), segments=32, rings=24, radius=1.0):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=rings, radius=radius, location=at)
    return bpy.context.object


def loops(thing):
    """How many closed boundary curves a mesh has, and how many points they have together."""
    count = {}
    for polygon in thing.data.polygons:
        for key in polygon.edge_keys:
            count[key] = count.get(key, 0) + 1
    rim = [key for key, faces in count.items() if faces == 1]
    around = {}
    for a, b in rim:
        around.setdefault(a, set()).add(b)
        around.setdefault(b, set()).add(a)
    seen, found = set(), 0
    for start in around:
        if start not in seen:
            found += 1
            todo = [start]
            while todo:
                point = todo.pop()
                if point not in seen:
                    seen.add(point)
                    todo.extend(around[point])
    return found


def test_cut_by_the_cursor_plane():
    ball = sphere()
    bpy.context.scene.cursor.location = (0, 0, 0.3)
    select(ball)
    assert bpy.ops.fusion.cut(by="CURSOR") == {"FINISHED"}
    part = bpy.context.object
    assert part != ball and loops(part) == 1
    assert max(v.co.z for v in part.data.vertices) < 0.3 + 1e-6 < max(v.co.z for v in ball.data.vertices)


def test_cut_by_picked_vertices():
    ball = sphere()
    for vertex in ball.data.vertices:
        vertex.select = False
    ring = [v for v in ball.data.vertices if abs(v.co.z) < 1e-6]
    for vertex in (ring[0], ring[10], ring[21]):
        vertex.select = True
    select(ball)
    assert bpy.ops.fusion.cut(by="PICKED") == {"FINISHED"}
    half = bpy.context.object
    assert loops(half) == 1 and 0.4 < len(half.data.polygons) / len(ball.data.polygons) < 0.7


def halves():
    made = []
    for at, height, normal in ((-1, -0.5, 0.0), (1, 0.5, math.pi)):
        ball = sphere(at=(0, 0, 1.5 * at))
        bpy.context.scene.cursor.location = (0, 0, 1.5 * at - 0.5 * at)
        bpy.context.scene.cursor.rotation_euler = (normal, 0, 0)
        select(ball)
        assert bpy.ops.fusion.cut(by="CURSOR") == {"FINISHED"}
        made.append(bpy.context.object)
    bpy.context.scene.cursor.rotation_euler = (0, 0, 0)
    return made


def test_compose_two_openings():
    lower, upper = halves()
    select(lower, upper)
    assert bpy.ops.fusion.compose() == {"FINISHED"}
    whole = bpy.context.object
    assert is_closed(whole)
    height = max(v.co.z for v in whole.data.vertices) - min(v.co.z for v in whole.data.vertices)
    assert abs(height - 5.0) < 1e-4
    origin = [item.value for item in whole.data.attributes["fusion_origin"].data]
    assert set(origin) == {-1, 0, 1}


def test_compose_with_a_curve_as_silhouette():
    lower, upper = halves()
    select(lower, upper)
    bpy.ops.fusion.compose()
    plain = bpy.context.object
    data = bpy.data.curves.new("stroke", "CURVE")
    data.dimensions = "3D"
    line = data.splines.new("POLY")
    points = [(0.87, 0, -1.0), (1.3, 0, -0.4), (1.3, 0, 0.4), (0.87, 0, 1.0)]
    line.points.add(len(points) - 1)
    for point, at in zip(line.points, points):
        point.co = (*at, 1)
    stroke = bpy.data.objects.new("stroke", data)
    bpy.context.collection.objects.link(stroke)
    bpy.context.view_layer.update()
    select(lower, upper, stroke)
    assert bpy.ops.fusion.compose(from_view=False, view=(0, 1, 0)) == {"FINISHED"}
    drawn = bpy.context.object
    assert is_closed(drawn)

    def widest(thing):
        frame = thing.matrix_world
        return max((frame @ v.co).x for v in thing.data.vertices if abs((frame @ v.co).z) < 0.5)

    assert widest(drawn) > widest(plain) + 0.1


def test_remesh_gives_edges_of_the_length_asked_for():
    ball = sphere()
    select(ball)
    assert bpy.ops.fusion.remesh(use_edge_length=True, edge_length=0.2) == {"FINISHED"}
    mesh = bpy.context.object.data
    assert is_closed(bpy.context.object)
    lengths = [(mesh.vertices[a].co - mesh.vertices[b].co).length for a, b in (e.vertices for e in mesh.edges)]
    assert abs(np.median(lengths) - 0.2) < 0.05


def test_sharpen_takes_a_blend_back():
    block = cube()
    for edge in block.data.edges:
        a, b = (block.data.vertices[v].co for v in edge.vertices)
        edge.use_edge_sharp = a.x == b.x == 1 and a.y == b.y == 1
    select(block)
    assert bpy.ops.fusion.add_blend(radius=0.3, edges="sharp_edge") == {"FINISHED"}
    rounded = bpy.context.object
    select(rounded)
    bpy.ops.fusion.bake()
    lost = 8 - volume(rounded)
    assert abs(lost - 2 * 0.09 * (1 - math.pi / 4)) < 0.003
    bpy.context.scene.cursor.location = (0.91, 0.91, 0)
    assert bpy.ops.fusion.sharpen() == {"FINISHED"}
    assert abs(volume(bpy.context.object) - 8) < 1e-4


def test_cluster_rounds_a_cube_and_keeps_its_box():
    block = cube()
    select(block)
    assert bpy.ops.fusion.cluster() == {"FINISHED"}
    made = bpy.context.object
    assert is_closed(made) and 6 < volume(made) < 8
    assert max(v.co.x for v in made.data.vertices) == 1.0


def test_detail_goes_from_group_to_group():
    ball = sphere(segments=64, rings=48)
    bumps = [v for v in ball.data.vertices if v.co.z < -0.7]
    for vertex in bumps:
        vertex.co *= 1 + 0.03 * math.sin(25 * vertex.co.x) * math.sin(25 * vertex.co.y)
    ball.data.update()
    groups = (("target", lambda co: co.z > 0.92), ("source", lambda co: co.z < -0.72))
    for name, chosen in groups:
        ball.vertex_groups.new(name=name).add([v.index for v in ball.data.vertices if chosen(v.co)], 1.0, "REPLACE")
    select(ball)
    assert bpy.ops.fusion.detail() == {"FINISHED"}
    made = bpy.context.object.data

    def rough(mesh):
        return np.std([v.co.length for v in mesh.vertices if v.co.z > 0.93])

    assert rough(ball.data) < 1e-5 and rough(made) > 1e-3
    below = [tuple(v.co) for v in ball.data.vertices if v.co.z < 0.5]
    assert set(below) <= {tuple(v.co) for v in made.vertices}


def test_largest_radius_of_edges_and_of_seams():
    manager = bpy.context.window_manager
    block = cube()
    select(block)
    assert bpy.ops.fusion.max_radius() == {"FINISHED"}
    assert 0.9 < manager.fusion_largest_radius <= 1.0
    drill = cylinder(radius=0.3)
    select(block, drill)
    assert bpy.ops.fusion.max_radius(boolean="difference") == {"FINISHED"}
    # A rim of radius 0.3 in a side of 2: a ball of 0.7 reaches the cube's own edges.
    assert 0.2 < manager.fusion_largest_radius < 0.7


def test_results_have_the_bytes_of_the_program():
    """The same solids through files: vertices alike to the last bit of Blender's 32, triangles alike but for their order."""
    block, drill = cube(cuts=2), cylinder(radius=0.3)
    drill.data.transform(drill.matrix_world)
    drill.matrix_world.identity()
    result = boolean(block, drill, radius=0.1)
    program = os.environ.get("FUSION_CLI", "")
    if not pathlib.Path(program).is_file():
        print("skipped: FUSION_CLI does not name the program")
        return
    with tempfile.TemporaryDirectory() as folder:
        names = []
        for thing in (block, drill):
            names.append(os.path.join(folder, f"{thing.name}.obj"))
            write_obj(names[-1], thing.data)
        out = os.path.join(folder, "out.obj")
        line = [program, "difference", *names, "--radius", "0.1", "-o", out, "--quiet"]
        subprocess.run(line, check=True)
        points, faces = read_obj(out)
    own = np.array([v.co for v in result.data.vertices], dtype=np.float32)
    assert len(own) == len(points)
    same = own == points.astype(np.float32)
    assert same.all(), f"{(~same).any(axis=1).sum()} of {len(own)} vertices differ"
    assert sum(len(p.vertices) - 2 for p in result.data.polygons) == len(faces)
    told = {frozenset(face) for face in faces}
    assert all(frozenset(p.vertices) in told for p in result.data.polygons if len(p.vertices) == 3)


def write_obj(path, mesh):
    """The triangles that Blender sees, with every bit of the coordinates."""
    mesh.calc_loop_triangles()
    with open(path, "w", encoding="utf-8") as file:
        file.writelines("v {!r} {!r} {!r}\n".format(*v.co) for v in mesh.vertices)
        file.writelines("f {} {} {}\n".format(*(i + 1 for i in t.vertices)) for t in mesh.loop_triangles)


def read_obj(path):
    points, faces = [], []
    for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return np.array(points), faces


def test_jobs_can_be_stopped():
    """A job that is cancelled ends soon and gives nothing."""
    import importlib

    from harness import NAME

    engine, operation = (importlib.import_module(f"{NAME}.{name}") for name in ("engine", "operation"))
    block = cube(cuts=6)
    request = operation.Request("remesh", [block], {"edge_length": 0.01})
    job = engine.Job(request.function, request.stack, request.options)
    assert not job.wait(0.3)
    job.cancel()
    assert job.wait(5) and job.made is None


def moved(live, result, drill, x):
    """What the timer does in a window after a change: start, and do not wait."""
    drill.matrix_world.translation = Vector((x, 0, 0))
    live.request(result)
    live.pump()
    return live._jobs[result.session_uid][0]


def bored(result):
    """The place of the hole along X."""
    inner = [v.co for v in result.data.vertices if abs(v.co.x) < 0.999 and abs(v.co.y) < 0.999]
    walls = [p.x for p in inner if abs(p.z) < 1.001 and p.y**2 < 0.2]
    return (min(walls) + max(walls)) / 2


def following():
    import importlib

    from harness import NAME

    drill = cylinder(radius=0.3)
    return importlib.import_module(f"{NAME}.live"), drill, boolean(cube(), drill, radius=0.1)


def test_a_newer_change_stops_the_job_of_an_older_one():
    live, drill, result = following()
    patience, live.PATIENCE = live.PATIENCE, 0.0
    jobs = [moved(live, result, drill, x) for x in (0.1, 0.2, 0.3)]
    live.PATIENCE = patience
    assert all(job._cancelled.is_set() for job in jobs[:2]) and not jobs[2]._cancelled.is_set()
    live.complete()
    assert abs(bored(result) - 0.3) < 0.02


def test_a_young_job_may_end_before_a_newer_change():
    """Else nothing would be seen as long as a cutter moves."""
    live, drill, result = following()
    patience, live.PATIENCE = live.PATIENCE, 1e9
    first, second = moved(live, result, drill, 0.1), moved(live, result, drill, 0.3)
    assert first is second and first.wait(60)
    live.pump()
    assert abs(bored(result) - 0.1) < 0.02
    live.complete()
    live.PATIENCE = patience
    assert abs(bored(result) - 0.3) < 0.02


run(globals())
