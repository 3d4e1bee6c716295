"""Attributes of edges: a result's edge that lies on an edge of an input has its marks."""

import numpy as np

_ON_EDGE = 1


def sources(stack, made, edges):
    """The input edge on which each edge of the result lies; -1 for none."""
    first = np.where(made.point_kinds <= _ON_EDGE, made.point_sources[:, 0], -1)
    second = np.where(made.point_kinds == _ON_EDGE, made.point_sources[:, 1], first)
    ends = np.stack([first[edges], second[edges]], axis=2).reshape(len(edges), 4)
    low, high = ends.min(axis=1), ends.max(axis=1)
    on_one = ((ends == low[:, None]) | (ends == high[:, None])).all(axis=1) & (low >= 0) & (low < high)
    if len(stack.edges) == 0:
        return np.full(len(edges), -1)
    span = len(stack.points)
    keys = stack.edges.min(axis=1) * span + stack.edges.max(axis=1)
    order = np.argsort(keys)
    wanted = low * span + high
    place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    found = order[place]
    return np.where(on_one & (keys[found] == wanted), found, -1)


def carried(values, edge_sources):
    """An attribute of edges: 0 where there was no edge."""
    picked = values[np.maximum(edge_sources, 0)].copy()
    picked[edge_sources < 0] = 0
    return picked
