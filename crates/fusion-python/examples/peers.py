"""Unions from arrays to arrays, beside what `pip` has installed. Prints the table of docs/benchmarks.md, "From Python".

    pip install numpy manifold3d meshlib trueform trimesh pyvista
    python peers.py [PATH OF THE RUST EXAMPLE fusion/stage]

Each program gets float64 positions and int64 faces, as trimesh keeps them, and gives NumPy arrays back. "peak" is what the process takes
beside what it had before, at most, in a process of its own.
"""

import importlib.metadata
import json
import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

ROUNDS = int(os.environ.get("ROUNDS", "5"))
LEVELS = {"2 × 81,920 triangles": 6, "2 × 327,680 triangles": 7}
SHIFT = (0.7, 0.3, 0.2)


def sphere(levels):
    """An icosahedron, its faces split in four again and again, on the unit sphere."""
    g = (1 + 5**0.5) / 2
    v = np.array([[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g], [0, -1, -g], [0, 1, -g],
                  [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]])
    f = np.array([[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6],
                  [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10],
                  [8, 6, 7], [9, 8, 1]])
    for _ in range(levels):
        edges = np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
        pairs, which = np.unique(edges, axis=0, return_inverse=True)
        middle = (len(v) + which).reshape(3, -1).T
        v = np.vstack([v, v[pairs].mean(axis=1)])
        a, b, c = f.T
        ab, bc, ca = middle.T
        f = np.vstack([np.c_[a, ab, ca], np.c_[ab, b, bc], np.c_[ca, bc, c], np.c_[ab, bc, ca]])
    return np.ascontiguousarray(v / np.linalg.norm(v, axis=1)[:, None]), np.ascontiguousarray(f, dtype=np.int64)


def fusion(v, f, w, g):
    import fusion_mesh as fm

    made = fm.union((v, f), (w, g))
    return made.vertices, made.faces


def fusion_uint32(v, f, w, g):
    import fusion_mesh as fm

    made = fm.union((v, f.astype(np.uint32)), (w, g.astype(np.uint32)))
    return made.vertices, made.faces


def manifold3d(v, f, w, g):
    import manifold3d as m

    solids = [m.Manifold(m.Mesh64(p, t.astype(np.uint64))) for p, t in ((v, f), (w, g))]
    made = (solids[0] + solids[1]).to_mesh64()
    return np.asarray(made.vert_properties), np.asarray(made.tri_verts)


def trimesh(v, f, w, g):
    import trimesh as t

    made = t.boolean.union([t.Trimesh(v, f, process=False), t.Trimesh(w, g, process=False)], engine="manifold")
    return made.vertices, made.faces


def meshlib(v, f, w, g):
    import meshlib.mrmeshnumpy as mn
    import meshlib.mrmeshpy as mm

    made = mm.boolean(mn.meshFromFacesVerts(f, v), mn.meshFromFacesVerts(g, w), mm.BooleanOperation.Union).mesh
    return mn.getNumpyVerts(made), mn.getNumpyFaces(made.topology)


def trueform(v, f, w, g):
    import trueform as tf

    (faces, points), *_ = tf.boolean_union(tf.Mesh(f, v), tf.Mesh(g, w))
    return np.asarray(points), np.asarray(faces)


def pyvista(v, f, w, g):
    import pyvista as pv

    made = pv.PolyData.from_regular_faces(v, f).boolean_union(pv.PolyData.from_regular_faces(w, g))
    return np.asarray(made.points), made.regular_faces


def open3d(v, f, w, g):
    import open3d as o3

    meshes = []
    for p, t in ((v, f), (w, g)):
        mesh = o3.t.geometry.TriangleMesh()
        mesh.vertex.positions, mesh.triangle.indices = o3.core.Tensor(p), o3.core.Tensor(t)
        meshes.append(mesh)
    made = meshes[0].boolean_union(meshes[1])
    return made.vertex.positions.numpy(), made.triangle.indices.numpy()


# What is timed, the package whose version is told, rounds (0: all), and a note.
PROGRAMS = [
    ("fusion_mesh", fusion, "fusion-mesh", 0, "int64 faces"),
    ("fusion_mesh", fusion_uint32, "fusion-mesh", 0, "uint32 faces, converted by NumPy first"),
    ("trueform", trueform, "trueform", 0, ""),
    ("manifold3d", manifold3d, "manifold3d", 0, ""),
    ("trimesh with manifold3d", trimesh, "trimesh", 0, ""),
    ("MeshLib", meshlib, "meshlib", 0, "32 bits"),
    ("PyVista", pyvista, "pyvista", 1, ""),
    ("Open3D", open3d, "open3d", 1, ""),
]


def held(key):
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith(key))


def volume(points, faces):
    a, b, c = (np.asarray(points, dtype=float)[np.asarray(faces, dtype=np.int64)[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def alone(which, levels, rounds):
    """In a process of its own: clock, processor, peak memory, triangles, volume, and the stages of ours."""
    run = PROGRAMS[which][1]
    (v, f), (small_v, small_f) = sphere(levels), sphere(2)
    w = v + np.array(SHIFT)
    run(small_v, small_f, small_v + np.array(SHIFT), small_f)
    best = [float("inf"), float("inf")]
    before, peak = held("VmRSS"), None
    for _ in range(rounds):
        start, used = time.perf_counter(), resource.getrusage(resource.RUSAGE_SELF)
        made = run(v, f, w, f)
        clock, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_SELF)
        best[0] = min(best[0], clock)
        best[1] = min(best[1], after.ru_utime + after.ru_stime - used.ru_utime - used.ru_stime)
        peak = held("VmHWM") - before if peak is None else peak
    print(json.dumps({"clock": best[0], "processor": best[1], "peak": peak, "faces": len(made[1]), "volume": volume(*made)}))


def rust(stage, levels):
    """The same stage in Rust, without Python."""
    v, f = sphere(levels)
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for name, points in (("a.off", v), ("b.off", v + np.array(SHIFT))):
            paths.append(os.path.join(folder, name))
            with open(paths[-1], "w") as file:
                file.write(f"OFF\n{len(points)} {len(f)} 0\n")
                np.savetxt(file, points, fmt="%.17g")
                np.savetxt(file, np.c_[np.full(len(f), 3), f], fmt="%d")
        return json.loads(subprocess.run([stage, "union", *paths], check=True, capture_output=True).stdout)


def main():
    print("| union | program | clock | processor | ours = 1 | peak | triangles | |\n|---|---|---|---|---|---|---|---|")
    for job, levels in LEVELS.items():
        ours = None
        for which, (name, _, package, rounds, note) in enumerate(PROGRAMS):
            asked = [sys.executable, os.path.abspath(__file__), "--alone", str(which), str(levels), str(rounds or ROUNDS)]
            try:
                version = importlib.metadata.version(package)
            except importlib.metadata.PackageNotFoundError:
                version = ""
            answer = subprocess.run(asked, capture_output=True, text=True)
            if answer.returncode:
                reason = (answer.stderr.strip().splitlines() or [f"exit code {answer.returncode}"])[-1][:70]
                print(f"| {job} | {name} {version} | | | | | | {reason} |", flush=True)
                continue
            made = json.loads(answer.stdout.splitlines()[-1])
            ours = ours or made
            notes = ", ".join(filter(None, [note, "once" if rounds == 1 else ""]))
            off = abs(made["volume"] / ours["volume"] - 1)
            notes += f"; volume off by {off:.0%}" if off > 1e-3 else ""
            figures = [f"{1e3 * made['clock']:,.0f} ms", f"{1e3 * made['processor']:,.0f} ms"]
            figures += [f"{made['processor'] / ours['processor']:.2f}", f"{made['peak'] / 1e6:,.0f} MB", f"{made['faces']:,}", notes]
            print(f"| {job} | {name} {version} | " + " | ".join(figures) + " |", flush=True)
        if len(sys.argv) > 1:
            made = rust(sys.argv[1], levels)
            figures = [f"{1e3 * made['clock']:,.0f} ms", f"{1e3 * made['processor']:,.0f} ms"]
            print(f"| {job} | fusion in Rust, the same stage | {' | '.join(figures)} | {made['processor'] / ours['processor']:.2f} | | | |")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--alone"]:
        alone(*map(int, sys.argv[2:]))
    else:
        main()
