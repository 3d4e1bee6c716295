"""Values for points that have none, from the points around them."""

import numpy as np

_ROUNDS = 24


def spread(values, is_known, edges):
    """Fills the rows of `values` that are not known: from known neighbours outward, then evened out. Known rows stay.

    `edges` are pairs of points. What no known point reaches becomes 0.
    """
    values = np.where(is_known[:, None], np.nan_to_num(values), 0.0)
    unknown = ~is_known
    touched = edges[unknown[edges].any(axis=1)]
    if len(touched) == 0:
        return values
    ids, local = np.unique(touched, return_inverse=True)
    local = local.reshape(-1, 2)
    field, have, free = values[ids], is_known[ids], unknown[ids]
    a, b = np.concatenate([local, local[:, ::-1]]).T
    while True:
        total, count = _sums(field, have, a, b)
        fresh = free & ~have & (count > 0)
        if not fresh.any():
            break
        field[fresh] = total[fresh] / count[fresh, None]
        have |= fresh
    for _ in range(_ROUNDS):
        total, count = _sums(field, have, a, b)
        even = free & have & (count > 0)
        field[even] = total[even] / count[even, None]
    values[ids] = field
    return values


def _sums(field, have, a, b):
    """For each point the sum over the neighbours that have a value, and how many."""
    count = np.bincount(a, weights=have[b], minlength=len(field))
    columns = [np.bincount(a, weights=np.where(have[b], c[b], 0.0), minlength=len(field)) for c in field.T]
    return np.stack(columns, axis=1), count
