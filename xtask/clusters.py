"""Clusters beside edge-first blending of the same polyhedra, as a Markdown table.

usage: cargo xtask fixtures && python3 xtask/clusters.py target/release/fusion-cli target/fixtures

The ball takes the largest of 8, 4, 2 and 1 thousandths of the diagonal times ten that the swept strip blends on every edge with the
full radius. Times are processor seconds of the whole program, reading and the exact check for self-intersections included.
"""

import json
import pathlib
import resource
import subprocess
import sys
import tempfile

POLYHEDRA = [
    "pressure-meter", "vase", "flower-pot", "door-knob", "cube", "truncated-tetrahedron", "icosidodecahedron",
    "truncated-cube", "snub-cube", "convex-concave-1", "convex-concave-4",
]
SHARES = ["8%", "4%", "2%", "1%"]


def run(program, arguments, report):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, *arguments, "--report", report], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return (json.load(open(report)) if done.returncode == 0 else None), seconds, done.stderr.strip()


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    print("| polyhedron | edges, vertices | edge-first: strips + corners | radius | triangles | s "
          "| clusters: patches + strips | triangles | s | contact |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as work:
        report, output = f"{work}/r.json", f"{work}/o.ply"
        for name in POLYHEDRA:
            part = folder / f"cluster-{name}.obj"
            curves = f"{work}/curves.json"
            subprocess.run([program, "features", part, "--angle", "1", "--no-radii", "-o", curves], check=True)
            ends = [tuple(p) for c in json.load(open(curves))["curves"] for p in c["ends"]]
            edges = len(ends) // 2
            row = [name.replace("-", " "), f"{edges}, {len(set(ends))}"]
            for share in SHARES:
                made, seconds, said = run(program, ["blend", part, "-o", output, "--angle", "1", "--radius", share,
                                                    "--surface", "stitch", "--overlap", "error"], report)
                if made:
                    figures = made["figures"]
                    row += [f"{figures['strips']:.0f} + {figures['corners']:.0f}", share,
                            str(made["output"]["faces"]), f"{seconds:.2f}"]
                    break
            else:
                print(f"{name}: {said}", file=sys.stderr)
                row += ["refused", "", "", ""]
            clusters = folder / f"cluster-{name}.toml"
            chosen = ["--clusters", clusters] if clusters.exists() else []
            made, seconds, said = run(program, ["cluster", part, "-o", output, "--tolerance", "0.0005", *chosen], report)
            if made:
                figures = made["figures"]
                row += [f"{figures['patches']:.0f} + {figures['strips']:.0f}", str(made["output"]["faces"]),
                        f"{seconds:.2f}", f"{figures['contact_slope']:.3f}"]
            else:
                print(f"{name}: {said}", file=sys.stderr)
                row += ["refused", "", "", ""]
            print("| " + " | ".join(row) + " |", flush=True)


main()
