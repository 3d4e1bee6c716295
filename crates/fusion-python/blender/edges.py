"""Marked edges as curves: lists of points, each joined to the next by an edge."""

import numpy as np


def marked(surface, name):
    """Whether each edge of a surface is marked; None if the surface has no layer of that name."""
    if name == "SELECTED":
        return surface.selected_edges
    layer = next((x for x in surface.layers if x.domain == "EDGE" and x.name == name), None)
    return None if layer is None else layer.values.reshape(len(layer.values), -1).any(axis=1)


def chains(edges):
    """Joins edges to curves, which end where other than two meet. Gives `(points, is_closed)` for each curve."""
    around = {}
    for a, b in edges.tolist():
        around.setdefault(a, []).append(b)
        around.setdefault(b, []).append(a)
    left = {frozenset(edge) for edge in edges.tolist()}
    ends = [p for p in around if len(around[p]) != 2]
    curves = []
    for start in ends + list(around):
        for following in around[start]:
            if frozenset((start, following)) in left:
                curves.append(_walk(start, following, around, left))
    return curves


def _walk(start, following, around, left):
    points = [start]
    while frozenset((points[-1], following)) in left:
        left.discard(frozenset((points[-1], following)))
        points.append(following)
        if len(around[following]) != 2 or following == start:
            break
        following = next(p for p in around[following] if p != points[-2])
    is_closed = points[-1] == start and len(points) > 3
    return (points[:-1] if is_closed else points), is_closed


def curves(stack, is_marked):
    """The option `curves` of a blend."""
    chosen = stack.edges[np.flatnonzero(is_marked)]
    return [{"points": stack.points[points].tolist(), "closed": closed} for points, closed in chains(chosen)]
