"""Measures of this workspace beside libigl's: normals, areas, Laplacians, harmonic maps, curvature, geodesics, winding numbers, signed
distance, self-intersections, booleans.

Reads a JSON file of cases, as `cargo xtask regress --reference` writes it, and prints one line for each measure: its name, the mesh, the
largest difference, what is allowed, and "ok" or "wrong", with tabs between them. Differences are relative to the size of what is measured.
"""

import json
import sys

import igl
import numpy as np
from igl.copyleft.cgal import mesh_boolean, remesh_self_intersections


def arrays(mesh):
    return np.array(mesh["positions"], dtype=float).reshape(-1, 3), np.array(mesh["faces"], dtype=np.int64).reshape(-1, 3)


def apart(ours, theirs):
    """The largest difference, by the size of the largest number."""
    ours, theirs = np.asarray(ours, dtype=float), np.asarray(theirs, dtype=float)
    return abs(ours - theirs).max() / abs(theirs).max()


def surface(case, v, f):
    """What is measured on a surface: name, difference, what is allowed."""
    corners = igl.PerVertexNormalsWeightingType.PER_VERTEX_NORMALS_WEIGHTING_TYPE_ANGLE
    yield "face normals", apart(case["face_normals"], igl.per_face_normals(v, f, np.zeros(3))), 1e-12
    # libigl's angles are accurate to the root of rounding alone.
    yield "vertex normals", apart(case["vertex_normals"], igl.per_vertex_normals(v, f, corners)), 1e-7
    yield "face areas", apart(case["face_areas"], igl.doublearea(v, f) / 2), 1e-12
    mass = igl.massmatrix(v, f, igl.MassMatrixType.MASSMATRIX_TYPE_VORONOI).diagonal()
    yield "vertex areas", apart(case["vertex_areas"], mass), 1e-12
    laplacian = igl.cotmatrix(v, f)
    i, j, w = np.array(case["weights"]).T
    yield "cotangent weights", apart(w, np.asarray(laplacian[i.astype(int), j.astype(int)]).ravel()), 1e-12
    yield "weights missed", abs(2 * len(w) - (laplacian.nnz - len(v))), 0


def curvature(case, v, f):
    ours = np.array(case["mean_curvatures"])
    first, second = igl.principal_curvature(v, f, radius=2)[2:4]
    # A quadric fitted to two rings against the five-point formula: alike in the middle, not at every vertex.
    off = abs(abs(ours) - abs(first + second) / 2) / abs(ours).max()
    yield "mean of principal curvatures, median", np.median(off), 0.05
    lumped = igl.massmatrix(v, f, igl.MassMatrixType.MASSMATRIX_TYPE_VORONOI).diagonal()
    vectors = -(igl.cotmatrix(v, f) @ v) / (2 * lumped[:, None])
    yield "mean curvature vectors", apart(case["curvature_vectors"], vectors), 1e-10


def geodesics(case, v, f):
    every = np.arange(len(v))
    exact = igl.exact_geodesic(v, f, VS=np.array([case["from"]]), VT=every)
    # A front unfolded triangle by triangle is near, not exact.
    yield "geodesics", apart(case["distances"], exact), 0.01


def harmonic(case, v, f):
    fixed, values = np.array(case["fixed"]), np.array(case["values"])
    yield "harmonic maps", apart(case["map"], igl.harmonic(v, f, fixed, values, 1)), 1e-10


def points(case, v, f):
    at, ours = np.array(case["points"]), np.array(case["signed_distances"])
    by_winding = igl.winding_number(v, f, at) > 0.5
    yield "winding numbers, sides", float((by_winding != (ours < 0)).sum()), 0
    pseudonormal = igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
    yield "signed distances", apart(ours, igl.signed_distance(at, v, f, pseudonormal)[0]), 1e-12


def meetings(case, v, f):
    ours = {tuple(sorted(pair)) for pair in case["meetings"]}
    theirs = {tuple(sorted(pair)) for pair in remesh_self_intersections(v, f, detect_only=True)[2].tolist()}
    yield f"self-intersections ({len(theirs)} pairs)", float(len(ours ^ theirs)), 0


def measures(v, f):
    a, b, c = v[f[:, 0]], v[f[:, 1]], v[f[:, 2]]
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6, np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def boolean(case, v, f):
    made = mesh_boolean(v, f, *arrays(case["other"]), case["operation"])[:2]
    ours = arrays(case["result"])
    (volume, area), (their_volume, their_area) = measures(*ours), measures(*made)
    size = np.ptp(made[0], axis=0).max()
    yield f"volume of the {case['operation']}", abs(volume - their_volume) / size**3, 1e-13
    yield f"area of the {case['operation']}", abs(area - their_area) / size**2, 1e-13
    far = max(igl.point_mesh_squared_distance(p, *m)[0].max() for p, m in ((ours[0], made), (made[0], ours)))
    yield f"distance between the results of {case['operation']}", far**0.5 / size, 1e-13


KINDS = {"surface": surface, "curvature": curvature, "geodesics": geodesics, "harmonic": harmonic, "points": points,
         "meetings": meetings, "boolean": boolean}

with open(sys.argv[1]) as file:
    cases = json.load(file)
for case in cases:
    for name, difference, allowed in KINDS[case["kind"]](case, *arrays(case["mesh"])):
        verdict = "ok" if difference <= allowed else "wrong"
        print(f"{name}\t{case['name']}\t{difference:.1e}\t{allowed:.0e}\t{verdict}", flush=True)
