"""Evaluates control nets from their definition, independently of this workspace, and compares.

Reads a JSON file with "nets" (as `fusion-cli cluster --nets` writes them) and "samples": for each patch a list of
[x, y, X, Y, Z], a place in the patch's domain and the surface point to compare with. Prints the largest distance, as a
share of the nets' extent, and how many points there were.
"""

import json
import sys
from math import cos, factorial, pi, sin

import numpy as np


def bernstein(n, i, t):
    return factorial(n) // (factorial(i) * factorial(n - i)) * t**i * (1 - t) ** (n - i)


def tensor(net, x, y):
    n1, n2 = net["degree"]
    return sum(
        (bernstein(n1, i, x) * bernstein(n2, j, y))[:, None] * np.array(b)
        for (i, j), b in zip(net["indices"], net["points"])
    )


def s_patch(net, x, y):
    m, n = net["sides"], net["degree"]
    corners = [(cos(2 * pi * k / m), sin(2 * pi * k / m)) for k in range(m)]

    def area(k):
        (ax, ay), (bx, by) = corners[k], corners[(k + 1) % m]
        return ((ax - x) * (by - y) - (bx - x) * (ay - y)) / 2

    sigma = [area(k) for k in range(m)]
    # The product over all sides but the two that meet in corner k.
    weights = [np.prod([sigma[i] for i in range(m) if i not in (k, (k - 1) % m)], axis=0) for k in range(m)]
    whole = sum(weights)
    l = [w / whole for w in weights]
    total = 0
    for index, b in zip(net["indices"], net["points"]):
        basis = factorial(n)
        for i in index:
            basis //= factorial(i)
        for i, lk in zip(index, l):
            basis = basis * lk**i
        total = total + basis[:, None] * np.array(b)
    return total


data = json.load(open(sys.argv[1]))
worst, count = 0.0, 0
for net, samples in zip(data["nets"]["patches"], data["samples"]):
    samples = np.array(samples)
    evaluate = tensor if net["kind"] == "tensor" else s_patch
    points = evaluate(net, samples[:, 0], samples[:, 1])
    extent = np.ptp(np.array(net["points"]), axis=0).max()
    worst = max(worst, np.abs(points - samples[:, 2:]).max() / extent)
    count += len(samples)
print(f"{worst:.3e} {count}")
