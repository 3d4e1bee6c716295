"""A job of the engine in a thread of its own."""

import threading
import time
import warnings
from dataclasses import dataclass

import numpy as np


@dataclass
class Made:
    """A result with the ids of a `Stack`, however many parts there were."""

    points: np.ndarray
    faces: np.ndarray
    point_kinds: np.ndarray
    point_sources: np.ndarray
    """Three input points for each point."""
    point_weights: np.ndarray
    face_kinds: np.ndarray
    face_sources: np.ndarray
    """The input triangle of each triangle; -1 for new ones."""
    face_parts: np.ndarray
    corner_weights: np.ndarray
    report: dict
    warnings: list

    @property
    def edges(self):
        """Every edge of every triangle, twice where two share it."""
        return _edges(self.faces)

    @property
    def new_edges(self):
        """Those of new triangles."""
        return _edges(self.faces[self.face_sources < 0])


def _edges(faces):
    return faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).astype(np.int64)


class Job:
    """Runs a function of the engine on a stack. `cancel` makes it end soon; nothing else is shared with the thread."""

    def __init__(self, function, stack, options, polygons=False):
        # The engine's allocator belongs to the thread that loads it: one that goes on living.
        import fusion_mesh  # noqa: F401

        self._cancelled = threading.Event()
        self._arguments = (function, stack, options, polygons)
        self.stage, self.share = "", 0.0
        self._start = time.monotonic()
        self.made = self.error = None
        self._thread = threading.Thread(target=self._run, name="fusion", daemon=True)
        self._thread.start()

    @property
    def age(self):
        """Seconds since the start."""
        return time.monotonic() - self._start

    @property
    def is_done(self):
        """Whether there is a result or an error."""
        return not self._thread.is_alive()

    def cancel(self):
        """Asks the job to end."""
        self._cancelled.set()

    def wait(self, seconds=None):
        """Waits for the end; gives whether it came."""
        self._thread.join(seconds)
        return self.is_done

    def _progress(self, stage, share):
        self.stage, self.share = stage, share
        return not self._cancelled.is_set()

    def _run(self):
        try:
            made = run(*self._arguments, progress=self._progress)
            if not self._cancelled.is_set():
                self.made = made
        # Whatever goes wrong is told by the thread that asked.
        except BaseException as error:  # noqa: BLE001
            self.error = error


def run(function, stack, options, polygons=False, progress=None):
    """Calls a function of `fusion_mesh` on all parts of a stack."""
    import fusion_mesh as fm

    meshes = [_mesh(fm, stack, number, polygons) for number in range(len(stack.point_offsets) - 1)]
    if function == "max_radius":
        return fm.max_radius(*meshes, progress=progress, **options)
    with warnings.catch_warnings():
        # They are in the report as well.
        warnings.simplefilter("ignore")
        result, told = _rounded(fm, getattr(fm, function), meshes, {"progress": progress, **options})
    return _made(result, stack, told + result.report["warnings"])


def _rounded(fm, function, meshes, arguments):
    """A result that is sound in 32 bits, which is what Blender keeps; else one that is sound before it is rounded."""
    try:
        return function(*meshes, precision="f32", **arguments), []
    except fm.InvalidResultError:
        result = function(*meshes, precision="f64", **arguments)
        return result, ["Rounded to Blender's 32 bits, some faces have no area or touch others"]


# The first two weights of each corner of a triangle. Sent as texture coordinates, they come back blended by the engine.
_WEIGHTS = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])


def _mesh(fm, stack, number, polygons):
    points, faces = stack.part(number)
    uvs = np.broadcast_to(_WEIGHTS, (len(faces), 3, 2))
    mesh = fm.Mesh(points, faces, uvs=np.ascontiguousarray(uvs))
    if polygons:
        mesh.polygons = stack.polygons(number)
    return mesh


def _made(result, stack, told):
    points, faces = result.origins.vertices, result.origins.faces
    parts = np.maximum(points["part"], 0)
    kinds = points["kind"]
    ids = points["ids"].astype(np.int64)
    sources = np.zeros((len(kinds), 3), np.int64)
    on_edge = kinds <= 1
    sources[on_edge, 0] = ids[on_edge, 0]
    sources[kinds == 1, 1] = ids[kinds == 1, 1]
    sources[kinds == 0, 1] = ids[kinds == 0, 0]
    sources[on_edge, 2] = sources[on_edge, 0]
    sources[on_edge] += stack.point_offsets[parts[on_edge], None]
    in_face = kinds == 2
    triangle = ids[in_face, 0] + stack.triangle_offsets[parts[in_face]]
    sources[in_face] = stack.corner_points[stack.triangles[triangle]]
    face_sources = faces["face"].astype(np.int64) + stack.triangle_offsets[np.maximum(faces["part"], 0)]
    uvs = result.mesh.uvs
    weights = np.full((len(faces), 3, 2), np.nan) if uvs is None else uvs
    return Made(
        points=result.vertices,
        faces=result.faces,
        point_kinds=kinds,
        point_sources=sources,
        point_weights=points["weights"],
        face_kinds=faces["kind"],
        face_sources=np.where(faces["part"] < 0, -1, face_sources),
        face_parts=faces["part"],
        corner_weights=np.concatenate([weights, 1.0 - weights.sum(axis=2, keepdims=True)], axis=2),
        report=result.report,
        warnings=told,
    )
