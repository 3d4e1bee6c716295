"""Time and memory of the program against the size of its input, as pictures in docs/images and a Markdown table.

usage: cargo xtask bench --scaling, or: python3 xtask/scaling.py PROGRAM FIT IMAGES, FIT being rbf-solve's example
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

from inputs import bumpy, torus, write

LIMIT = 100.0  # seconds, beyond which a job and all larger ones are left out
TRIANGLES = [1_000, 4_000, 16_000, 64_000, 256_000, 1_000_000, 4_000_000]
CONSTRAINTS = [500, 2_000, 3_000, 10_000, 30_000, 100_000, 200_000]
COLORS = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b"]


def apart(job):
    """Runs a job in a process of its own: what this one has ever held counts as memory of those it starts."""
    child = os.fork()
    if child == 0:
        job()
        os._exit(0)
    if os.waitpid(child, 0)[1]:
        raise RuntimeError("an input was not written")


def run(command):
    """Seconds, peak mebibytes and what it prints; None if the job fails or takes too long."""
    since = time.perf_counter()
    with tempfile.TemporaryFile() as out:
        child = subprocess.Popen(command, stdout=out)
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                break
            if time.perf_counter() - since > LIMIT:
                child.kill()
                os.wait4(child.pid, 0)
                return None
            time.sleep(0.0005)
        seconds = time.perf_counter() - since
        out.seek(0)
        return (seconds, usage.ru_maxrss / 1024, out.read()) if status == 0 else None


def triangles(program, folder):
    """For each verb: (triangles, seconds, mebibytes)."""
    a, b, out = (os.path.join(folder, name) for name in ("a.ply", "b.ply", "out.ply"))
    verbs = {
        "blend, one seam": ["union", a, b, "-o", out, "--radius", "1%"],
        "union": ["union", a, b, "-o", out],
        "remesh": ["remesh", a, "-o", out, "--edge-length"],
        "cut": ["cut", a, "-o", out, "--plane", "0.1,0,0,1,0.2,0.1"],
        "features": ["features", a, "--no-radii"],
    }
    found = {verb: [] for verb in verbs}
    for size in TRIANGLES:
        for path, shift in ((a, 0.0), (b, np.array([0.9, 0.35, 0.2]))):
            apart(lambda: write(path, *torus(size, shift)))
        m = round(math.sqrt(size / 4))
        for verb, arguments in list(verbs.items()):
            length = [str(2.6 / m)] if verb == "remesh" else []
            made = run([program, *arguments, *length, "--quiet"])
            if made is None:
                del verbs[verb]
                print(f"{verb} of {size}: none", file=sys.stderr)
                continue
            found[verb].append((4 * m * m * (2 if b in arguments else 1), made[0], made[1]))
    return found


def constraints(fit, folder):
    """For each kernel: (constraints, seconds, mebibytes)."""
    places, points = (os.path.join(folder, name) for name in ("places", "points"))
    np.random.default_rng(1).uniform(-1.2, 1.2, (1000, 3)).tofile(points)
    kernels = ["biharmonic", "triharmonic"]
    found = {f"{kernel} fit": [] for kernel in kernels}
    for count in CONSTRAINTS:
        apart(lambda: bumpy(count).tofile(places))
        for kernel in list(kernels):
            made = run([fit, kernel, places, points])
            if made is None:
                kernels.remove(kernel)
                print(f"{kernel} fit of {count}: none", file=sys.stderr)
                continue
            found[f"{kernel} fit"].append((count, json.loads(made[2])["fit"], made[1]))
    return found


def plot(path, title, along, up, curves):
    """Curves over logarithmic axes, as SVG."""
    wide, high, left, low = 640, 400, 70, 50
    flat = [p for points in curves.values() for p in points]
    spans = [(math.floor(math.log10(min(v))), math.ceil(math.log10(max(v)))) for v in zip(*flat)]
    def place(value, span, size, start):
        return start + size * (math.log10(value) - span[0]) / max(span[1] - span[0], 1)
    x = lambda v: place(v, spans[0], wide - left - 170, left)
    y = lambda v: high - low - place(v, spans[1], high - low - 40, 0)
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" font-family="sans-serif" font-size="12">',
           f'<rect width="{wide}" height="{high}" fill="white"/><text x="{left}" y="20" font-size="14">{title}</text>']
    for axis, span in enumerate(spans):
        for power in range(span[0], span[1] + 1):
            value, label = 10.0**power, f'10<tspan dy="-5" font-size="9">{power}</tspan>'
            if axis == 0:
                svg.append(f'<path d="M{x(value):.1f} 35V{high - low}" stroke="#ddd"/>'
                           f'<text x="{x(value):.1f}" y="{high - low + 18}" text-anchor="middle">{label}</text>')
            else:
                svg.append(f'<path d="M{left} {y(value):.1f}H{wide - 170}" stroke="#ddd"/>'
                           f'<text x="{left - 8}" y="{y(value) + 4:.1f}" text-anchor="end">{label}</text>')
    svg.append(f'<text x="{(left + wide - 170) / 2}" y="{high - 12}" text-anchor="middle">{along}</text>'
               f'<text transform="translate(16 {high / 2}) rotate(-90)" text-anchor="middle">{up}</text>')
    for k, (name, points) in enumerate(curves.items()):
        way = " ".join(f"{x(p):.1f},{y(q):.1f}" for p, q in points)
        svg.append(f'<polyline points="{way}" fill="none" stroke="{COLORS[k]}" stroke-width="2"/>')
        svg.extend(f'<circle cx="{x(p):.1f}" cy="{y(q):.1f}" r="3" fill="{COLORS[k]}"/>' for p, q in points)
        svg.append(f'<text x="{wide - 160}" y="{50 + 20 * k}" fill="{COLORS[k]}">{name}</text>')
    with open(path, "w") as out:
        out.write("\n".join(svg) + "\n</svg>\n")


def table(head, found):
    print(f"\n| {head} | seconds / peak MiB at each size |\n|---|---|")
    for name, rows in found.items():
        print(f"| {name} | " + ", ".join(f"{n:,.0f}: {s:.2g} / {m:.0f}" for n, s, m in rows) + " |")


def main():
    program, fit, images = sys.argv[1:]
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {time.strftime('%Y-%m-%d')}; whole programs with reading and writing, of fits the fit alone.")
    with tempfile.TemporaryDirectory() as folder:
        for file, title, along, found in [
            ("scaling", "Torus, or two of them", "triangles in", triangles(program, folder)),
            ("scaling-constraints", "Points on a bumpy ball and off it", "constraints", constraints(fit, folder)),
        ]:
            table(along, found)
            curves = lambda k: {name: [(r[0], r[k]) for r in rows] for name, rows in found.items() if rows}
            plot(os.path.join(images, f"{file}-time.svg"), title, along, "seconds", curves(1))
            plot(os.path.join(images, f"{file}-memory.svg"), title, along, "peak memory, MiB", curves(2))


main()
