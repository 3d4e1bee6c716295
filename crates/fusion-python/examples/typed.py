"""What a strict type checker has to accept."""

from typing import List

import numpy as np

import fusion_mesh as fm


def rounded(sizes: List[float]) -> fm.Result:
    """Boxes on top of each other as one solid, all edges rounded."""
    boxes = [fm.box((size, size, 1.0), (0.0, 0.0, 0.8 * level)) for level, size in enumerate(sizes)]
    tower = fm.union(*boxes, radius="2%", profile="g2", threads=2)
    upright = fm.edges(angle=40).along((0, 0, 1)).convex()
    return fm.blend(tower, upright, radius=0.05, radius_at={"at": (0, 0, 0), "radius": 0.05}, overlap="shrink")


result = rounded([3.0, 2.0])
points: np.ndarray = result.vertices
new = result.origins.faces["kind"] == 3
try:
    fm.blend(result, radius=10.0, near=(1.0, 1.0, 0.0), overlap="error")
except fm.InfeasibleError as error:
    print(error.place, error.workable_radius, error.curves)
print(points.shape, int(new.sum()), result.report["validity"])


def model(mesh: fm.Mesh) -> fm.Evaluation:
    """A document with a parameter."""
    document = fm.Document()
    document.parameter("soft", "2%")
    document.part("block", mesh, translate=(0.0, 0.0, 1.0))
    document.step("blend", "block", fm.edges().convex(), radius="$soft", name="round")
    return document.evaluate(cache=fm.Cache(memory=0.1), threads=1)


made: fm.Evaluation = model(fm.box())
turned: fm.Result = fm.pose(made["round"], rotate=((0, 0, 1), 30.0), scale=2.0)
print([step["known"] for step in made.steps], turned.faces.shape)
