"""The surfaces of all inputs of a job as one, in the frame of the result."""

from dataclasses import dataclass

import numpy as np

from .surface import Layer


@dataclass
class Stack:
    """Surfaces one after the other: ids of the second start where those of the first end."""

    points: np.ndarray
    corner_points: np.ndarray
    starts: np.ndarray
    sizes: np.ndarray
    edges: np.ndarray
    triangles: np.ndarray
    triangle_polygons: np.ndarray
    polygon_parts: np.ndarray
    material_ids: np.ndarray
    mirrored: np.ndarray
    """Whether each part is turned inside out by its matrix, so that its triangles run the other way round."""
    point_offsets: np.ndarray
    triangle_offsets: np.ndarray
    layers: list
    groups: dict
    materials: list
    normals: np.ndarray
    active_uv: str
    active_color: str

    def part(self, number):
        """Positions and triangles of one part, as the engine takes them."""
        first, last = self.point_offsets[number], self.point_offsets[number + 1]
        rows = slice(self.triangle_offsets[number], self.triangle_offsets[number + 1])
        faces = self.corner_points[self.triangles[rows]] - first
        return self.points[first:last], np.ascontiguousarray(faces, dtype=np.int32)

    def polygons(self, number):
        """The polygons of one part as `fusion_mesh.Mesh` takes them; None for one that is turned inside out."""
        if self.mirrored[number]:
            return None
        ids = np.flatnonzero(self.polygon_parts == number)
        starts = self.starts[ids]
        ends = np.append(starts, starts[-1] + self.sizes[ids[-1]])
        rows = slice(self.triangle_offsets[number], self.triangle_offsets[number + 1])
        corners = self.corner_points[ends[0] : ends[-1]] - self.point_offsets[number]
        return [(ends - ends[0]).tolist(), corners.tolist(), (self.triangle_polygons[rows] - ids[0]).tolist()]


def stack(surfaces, matrices):
    """Puts surfaces into one frame; `matrices` are 4 × 4."""
    points = [s.points @ m[:3, :3].T + m[:3, 3] for s, m in zip(surfaces, matrices)]
    mirrored = np.array([np.linalg.det(m[:3, :3]) < 0 for m in matrices])
    offsets = {
        "points": _offsets(len(s.points) for s in surfaces),
        "corners": _offsets(len(s.corner_points) for s in surfaces),
        "polygons": _offsets(len(s.starts) for s in surfaces),
        "triangles": _offsets(len(s.triangles) for s in surfaces),
    }
    triangles = [s.triangles[:, ::-1] if turned else s.triangles for s, turned in zip(surfaces, mirrored)]
    materials, material_ids = _materials(surfaces)
    return Stack(
        points=np.concatenate(points),
        corner_points=_shifted([s.corner_points for s in surfaces], offsets["points"]),
        starts=_shifted([s.starts for s in surfaces], offsets["corners"]),
        sizes=np.concatenate([s.sizes for s in surfaces]),
        edges=_shifted([s.edges for s in surfaces], offsets["points"]),
        triangles=_shifted(triangles, offsets["corners"]),
        triangle_polygons=_shifted([s.triangle_polygons for s in surfaces], offsets["polygons"]),
        polygon_parts=np.repeat(np.arange(len(surfaces)), [len(s.starts) for s in surfaces]),
        material_ids=material_ids,
        mirrored=mirrored,
        point_offsets=offsets["points"],
        triangle_offsets=offsets["triangles"],
        layers=_layers(surfaces),
        groups=_groups(surfaces),
        materials=materials,
        normals=_normals(surfaces, matrices),
        active_uv=next((s.active_uv for s in surfaces if s.active_uv), ""),
        active_color=next((s.active_color for s in surfaces if s.active_color), ""),
    )


def _offsets(counts):
    return np.concatenate([[0], np.cumsum(list(counts))]).astype(np.int64)


def _shifted(arrays, offsets):
    return np.concatenate([array.astype(np.int64) + offset for array, offset in zip(arrays, offsets)])


def _materials(surfaces):
    """All materials in order of first use, and the slot of every polygon."""
    slots, ids = [], []
    for surface in surfaces:
        own = surface.materials or [None]
        for name in own:
            if name not in slots:
                slots.append(name)
        table = np.array([slots.index(name) for name in own])
        ids.append(table[np.clip(surface.material_ids, 0, len(own) - 1)])
    return slots, np.concatenate(ids)


_COUNTS = {"POINT": "points", "EDGE": "edges", "FACE": "starts", "CORNER": "corner_points"}


def _layers(surfaces):
    """Every attribute that an input has, 0 on those that have it not."""
    made = {}
    for surface in surfaces:
        for layer in surface.layers:
            made.setdefault(layer.name, layer)
    layers = []
    for name, first in made.items():
        values = []
        for surface in surfaces:
            own = [x for x in surface.layers if (x.name, x.domain, x.type) == (name, first.domain, first.type)]
            rows = len(getattr(surface, _COUNTS[first.domain]))
            missing = np.zeros((rows, *first.values.shape[1:]), first.values.dtype)
            values.append(own[0].values if own else missing)
        layers.append(Layer(name, first.domain, first.type, np.concatenate(values)))
    return layers


def _groups(surfaces):
    names = dict.fromkeys(name for surface in surfaces for name in surface.groups)
    empty = [np.zeros(len(s.points), np.float32) for s in surfaces]
    return {n: np.concatenate([s.groups.get(n, e) for s, e in zip(surfaces, empty)]) for n in names}


def _normals(surfaces, matrices):
    """Custom normals of all corners, 0 where a part has none; None where no part has any."""
    if all(s.normals is None for s in surfaces):
        return None
    made = []
    for surface, matrix in zip(surfaces, matrices):
        if surface.normals is None:
            made.append(np.zeros((len(surface.corner_points), 3)))
            continue
        turned = surface.normals @ np.linalg.inv(matrix[:3, :3])
        length = np.linalg.norm(turned, axis=1, keepdims=True)
        made.append(turned / np.where(length > 0, length, 1.0))
    return np.concatenate(made)
