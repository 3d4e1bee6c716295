"""Two open tubes joined by one surface."""

import json
import subprocess

import numpy as np

from inputs import tube

# Edges of the two loops, rows of the two tubes.
SIZES = [((64, 48), (20, 26)), ((200, 160), (62, 78)), ((640, 500), (195, 250))]
TILT = np.radians(20.0)


def tubes(loops, rows):
    """The lower tube opens upward; the upper one is thinner, aside and tilted, and opens downward onto it. Edges are alike everywhere."""
    edge = 2 * np.pi / loops[0]
    radius = edge * loops[1] / (2 * np.pi)
    low, f = tube(loops[0], rows[0], 1.0, edge * rows[0])
    high, g = tube(loops[1], rows[1], radius, edge * rows[1])
    turn = np.array([[np.cos(TILT), 0, np.sin(TILT)], [0, 1, 0], [-np.sin(TILT), 0, np.cos(TILT)]])
    return (low, f), (high @ turn.T + [0.3, 0.0, edge * rows[0] + 1.0], g)


def joins(table):
    for loops, rows in SIZES:
        (v, f), (w, g) = tubes(loops, rows)
        job = f"join of loops of {loops[0]} and {loops[1]} edges, {len(f) + len(g):,} triangles"
        paths, out = [table.file("a.ply", v, f), table.file("b.ply", w, g)], table.path("o.ply")
        both, faces = np.vstack([v, w]), np.vstack([f, g + len(v)])
        open_loops = ["--loop", loop_at(table, paths[0], v[-loops[0]:], 0), "--loop", loop_at(table, paths[1], w[: loops[1]], 1)]
        call = ["compose", *paths, "-o", out, *open_loops]
        table.ours(job, call, [])
        stages = ["connect", "fit", "tessellate", "remesh", "weld"]
        table.ours(job, call, stages, lambda: judged(*read(out), both, faces))

        def meshlib():
            import meshlib.mrmeshnumpy as mn
            import meshlib.mrmeshpy as mm

            edge = 2 * np.pi / loops[0]
            settings = mm.StitchHolesNicelySettings()

            def run():
                mesh = mn.meshFromFacesVerts(faces, both)
                settings.triangulateParams.metric = mm.getUniversalMetric(mesh)
                settings.subdivideSettings.maxEdgeLen = 4 / 3 * edge
                settings.subdivideSettings.maxEdgeSplits = 10_000_000
                holes = mesh.topology.findHoleRepresentiveEdges()
                near = lambda points: min(holes, key=lambda e: np.linalg.norm(middle(mesh, e) - points.mean(0)))
                mm.stitchHolesNicely(mesh, near(v[-loops[0]:]), near(w[: loops[1]]), settings)
                return mesh

            def middle(mesh, hole):
                walk = mm.trackRightBoundaryLoop(mesh.topology, hole)
                points = [mesh.points.vec[mesh.topology.org(e).get()] for e in walk]
                return np.mean([[p.x, p.y, p.z] for p in points], axis=0)
            return run

        def arrays(mesh):
            import meshlib.mrmeshnumpy as mn
            return judged(mn.getNumpyVerts(mesh), mn.getNumpyFaces(mesh.topology), both, faces)

        table.peer(job, "meshlib (32 bits)", meshlib, arrays)


def loop_at(table, path, points, part):
    """The number by which the program knows the loop with these points."""
    said = subprocess.run([table.program, "info", path, "--json"], check=True, capture_output=True)
    loops = json.loads(said.stdout)["boundary_loops"]
    off = [np.linalg.norm(points - loop["at"], axis=1).min() for loop in loops]
    return f"{part}:{int(np.argmin(off))}"


def read(path):
    import trimesh

    mesh = trimesh.load(path, process=False)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def judged(points, faces, before, old):
    """How good the new triangles are, and how much the surface bends across the loops."""
    fresh = faces[len(old):] if np.array_equal(faces[: len(old)], old) else unknown(points, faces, before, old)
    a, b, c = (points[fresh[:, k]].astype(float) for k in range(3))
    sides = np.stack([np.linalg.norm(p - q, axis=1) for p, q in ((a, b), (b, c), (c, a))])
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    quality = 2 * 3**0.5 * (2 * area / sides.sum(0)) / sides.max(0)
    bend = seam_angles(points, faces, fresh)
    return f"{len(fresh):,} new, mean quality {quality.mean():.3f}, bend across the loops {np.degrees(bend.mean()):.1f}°"


def unknown(points, faces, before, old):
    """The faces that were not there before, by their corners' coordinates."""
    name = lambda p: np.ascontiguousarray(p, dtype=np.float32).view([("", np.float32)] * 3).ravel()
    known = {tuple(sorted(map(bytes, corners))) for corners in name(before)[old]}
    return np.array([t for t, corners in zip(faces, name(points)[faces]) if tuple(sorted(map(bytes, corners))) not in known])


def seam_angles(points, faces, fresh):
    """Angles between the normals of new and old faces that share an edge."""
    normal = lambda f: np.cross(points[f[:, 1]] - points[f[:, 0]], points[f[:, 2]] - points[f[:, 0]]).astype(float)
    directed = lambda f: np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]).astype(np.int64)
    key = lambda e: e[:, 0] * len(points) + e[:, 1]
    new = set(map(tuple, fresh))
    kept = faces[[tuple(f) not in new for f in faces]]
    ahead, back = key(directed(fresh)), key(directed(kept)[:, ::-1])
    _, i, j = np.intersect1d(ahead, back, return_indices=True)
    n, m = normal(fresh)[i % len(fresh)], normal(kept)[j % len(kept)]
    across = (n * m).sum(1) / np.linalg.norm(n, axis=1) / np.linalg.norm(m, axis=1)
    return np.arccos(np.clip(across, -1, 1))
