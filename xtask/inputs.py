"""Inputs that measurements share: surfaces as points and triangles, constraints of fields, and files of them."""

import numpy as np


def sphere(levels, shift=(0.0, 0.0, 0.0)):
    """A subdivided icosahedron."""
    g = (1 + 5**0.5) / 2
    v = np.array([[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g], [0, -1, -g], [0, 1, -g],
                  [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]])
    f = np.array([[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2],
                  [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5],
                  [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1]])
    for _ in range(levels):
        edges = np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
        unique, index = np.unique(edges, axis=0, return_inverse=True)
        ab, bc, ca = (index.reshape(3, -1) + len(v))
        v = np.vstack([v, (v[unique[:, 0]] + v[unique[:, 1]]) / 2])
        a, b, c = f.T
        f = np.vstack([np.stack(t, axis=1) for t in [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]])
    v = v / np.linalg.norm(v, axis=1, keepdims=True)
    return np.ascontiguousarray(v + shift), np.ascontiguousarray(f.astype(np.int32))


def grid(m, n, wrapped):
    """Triangles between m rings of n points, the last joined to the first if `wrapped`."""
    i, j = np.meshgrid(np.arange(m if wrapped else m - 1), np.arange(n), indexing="ij")
    a, b = i * n + j, i * n + (j + 1) % n
    c, d = (i + 1) % m * n + j, (i + 1) % m * n + (j + 1) % n
    return np.stack([np.stack([a, b, d], -1), np.stack([a, d, c], -1)], 2).reshape(-1, 3)


def torus(triangles, shift):
    m = round((triangles / 4) ** 0.5)
    n = 2 * m
    s, t = np.meshgrid(2 * np.pi * (np.arange(n) + 0.3) / n, 2 * np.pi * np.arange(m) / m, indexing="xy")
    around = 1 + 0.4 * np.cos(t)
    points = np.stack([around * np.cos(s), around * np.sin(s), 0.4 * np.sin(t)], -1).reshape(-1, 3)
    return points + shift, grid(m, n, True)


def tube(around, rows, radius, length, shift=(0.0, 0.0, 0.0)):
    """An open tube along z, its first ring at the bottom."""
    turn, height = np.meshgrid(2 * np.pi * np.arange(around) / around, np.linspace(0, length, rows + 1), indexing="xy")
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], -1).reshape(-1, 3)
    return points + shift, grid(rows + 1, around, False)


def bumpy_surface(directions):
    """Where rays from the origin leave the bumpy ball."""
    x, y = directions[:, :1], directions[:, 1:2]
    return directions * (1 + 0.1 * np.sin(5 * x) * np.cos(4 * y))


def bumpy(count):
    """Constraints on a bumpy ball and off it: rows of places and values."""
    golden, i = np.pi * (3 - 5**0.5), np.arange(count // 2)
    z = 1 - (4 * i + 2) / count
    s = np.sqrt(1 - z * z)
    d = np.stack([s * np.cos(golden * i), s * np.sin(golden * i), z], -1)
    return off_and_on(d, 0.1 * (12 / count) ** 0.5)


def off_and_on(directions, tau):
    """Constraints where rays leave the bumpy ball, and a distance `tau` further along them."""
    on = bumpy_surface(directions)
    values = np.repeat([0.0, tau], len(on))
    return np.hstack([np.vstack([on, on + tau * directions]), values[:, None]])


def write(path, points, faces):
    """A binary PLY file."""
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = np.empty(len(faces), dtype=[("n", "u1"), ("v", "<i4", 3)])
    rows["n"], rows["v"] = 3, faces
    with open(path, "wb") as out:
        out.write(head.encode() + points.astype("<f8").tobytes() + rows.tobytes())
