"""Checks surfaces of random fields against scikit-image's marching cubes (Lewiner) and against a finer grid.

Reads a JSON list of fields, {"counts": [nx, ny, nz], "values": [...] (x first), "euler": χ, "components": n} with the numbers of the
surface under test, and prints for each one word and what was found:
"same" where Lewiner's surface has the same Euler characteristic and components, "theirs" where it differs and the trilinear field
sampled more finely agrees with the surface under test (or Lewiner's is no manifold), "ours" where the finer grid agrees with
Lewiner's alone, "neither" where it agrees with none.
"""

import json
import sys

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from skimage.measure import marching_cubes

# Samples of finer grids on each cell's side: the next is tried where one agrees with neither, or with Lewiner alone.
FINER = (9, 25)


def topology(values):
    """Euler characteristic and components of Lewiner's surface, and whether it is a closed manifold by its edges."""
    points, faces, _, _ = marching_cubes(values.astype(np.float32), 0.0, method="lewiner", allow_degenerate=False)
    used = np.unique(faces)
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    pairs, uses = np.unique(edges, axis=0, return_counts=True)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    labels = connected_components(graph, directed=False)[1]
    return (len(used) - len(pairs) + len(faces), len(np.unique(labels[used]))), bool((uses == 2).all())


def finer(values, times):
    for axis in range(3):
        n = values.shape[axis]
        at = np.linspace(0, n - 1, (n - 1) * times + 1)
        low = np.minimum(at.astype(int), n - 2)
        t = (at - low).reshape([-1 if a == axis else 1 for a in range(3)])
        values = np.take(values, low, axis) * (1 - t) + np.take(values, low + 1, axis) * t
    return values


for field in json.load(open(sys.argv[1])):
    values = np.array(field["values"]).reshape(field["counts"][::-1])
    ours = (field["euler"], field["components"])
    theirs, manifold = topology(values)
    if ours == theirs and manifold:
        word = "same"
    else:
        for times in FINER:
            truth, _ = topology(finer(values, times))
            word = "theirs" if truth == ours else "ours" if truth == theirs and manifold else "neither"
            if word == "theirs":
                break
    print(word, "ours", *ours, "theirs", *theirs, "manifold" if manifold else "not manifold", flush=True)
