"""Checks meshes independently of this workspace: closed, oriented, 2-manifold (numpy), free of self-intersections (libigl, exact).

Reads OFF files named on the command line and prints one line for each: its name, a tab, "ok" or what is wrong.
"""

import sys

import numpy as np
from igl.copyleft.cgal import remesh_self_intersections


def read_off(path):
    with open(path) as file:
        words = file.read().split()
    assert words[0] == "OFF"
    vertices, faces = int(words[1]), int(words[2])
    numbers = 4 + 3 * vertices
    points = np.array(words[4:numbers], dtype=float).reshape(-1, 3)
    corners = np.array(words[numbers : numbers + 4 * faces], dtype=np.int64).reshape(-1, 4)
    assert (corners[:, 0] == 3).all()
    return points, np.ascontiguousarray(corners[:, 1:])


def faults(points, faces):
    if not np.isfinite(points).all():
        yield "a coordinate is not finite"
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    keys = directed[:, 0] * len(points) + directed[:, 1]
    twins = directed[:, 1] * len(points) + directed[:, 0]
    if len(np.unique(keys)) != len(keys):
        yield "an edge is used twice in one direction"
    if not np.isin(twins, keys).all():
        yield "an edge has no opposite: open or misoriented"
    yield from pinched(points, faces)
    crossing = remesh_self_intersections(points, faces, detect_only=True)[2]
    if len(crossing):
        a, b = crossing[0]
        where = points[faces[a]].mean(axis=0)
        yield f"{len(crossing)} pairs of faces intersect, first {a} and {b} near {where[0]:.9g},{where[1]:.9g},{where[2]:.9g}"


def pinched(points, faces):
    """Every vertex must have one fan: as many distinct link edges as one cycle has."""
    following = {}
    for a, b, c in faces:
        for v, start, end in ((a, b, c), (b, c, a), (c, a, b)):
            following.setdefault(v, {})[start] = end
    for v, link in following.items():
        start = at = next(iter(link))
        length = 0
        while True:
            at = link.get(at)
            length += 1
            if at is None or at == start or length > len(link):
                break
        if length != len(link):
            yield f"vertex {v} has more than one fan"
            return


for name in sys.argv[1:]:
    try:
        problems = list(faults(*read_off(name)))
    except Exception as error:  # A checker that fails must not pass for a mesh that is sound.
        problems = [f"cannot check: {error}"]
    print(f"{name}\t{'; '.join(problems) or 'ok'}", flush=True)
