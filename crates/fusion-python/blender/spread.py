"""Values for points that have none, from the points around them."""

import numpy as np

_ROUNDS = 8


def spread(values, is_known, edges):
    """Fills the rows of `values` that are not known: from known neighbours outward, then evened out. Known rows stay.

    `edges` are pairs of points. What no known point reaches becomes 0.
    """
    values = np.where(is_known[:, None], np.nan_to_num(values), 0.0)
    touched = edges[~is_known[edges].all(axis=1)]
    if len(touched) == 0:
        return values
    ids = np.flatnonzero(np.bincount(touched.ravel(), minlength=len(values)))
    place = np.empty(len(values), np.int64)
    place[ids] = np.arange(len(ids))
    # From each point that is to be filled to its neighbours.
    a, b = place[np.concatenate([touched, touched[:, ::-1]])].T
    free = ~is_known[ids]
    a, b = a[free[a]], b[free[a]]
    field, have = values[ids], is_known[ids]
    while True:
        usable = have[b] & ~have[a]
        fresh = np.bincount(a[usable], minlength=len(ids)) > 0
        if not fresh.any():
            break
        field[fresh] = _means(field, a[usable], b[usable])[fresh]
        have |= fresh
    usable = have[a] & have[b]
    a, b = a[usable], b[usable]
    filled = free & have
    for _ in range(_ROUNDS):
        field[filled] = _means(field, a, b)[filled]
    values[ids] = field
    return values


def _means(field, a, b):
    """For each point the mean over its neighbours."""
    count = np.maximum(np.bincount(a, minlength=len(field)), 1)
    return np.stack([np.bincount(a, weights=c[b], minlength=len(field)) for c in field.T], axis=1) / count[:, None]
