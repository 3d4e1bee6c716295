"""Whatever holds a mesh is one; whatever does not is refused by name."""

import warnings

import numpy as np
import pytest
from conftest import same

import fusion_mesh as fm

BOX = fm.box((1, 2, 3))


class Holder:
    """Anything with two attributes."""

    def __init__(self, vertices, faces):
        self.vertices, self.faces = vertices, faces


def test_arrays_of_the_right_type_are_not_copied():
    mesh = fm.as_mesh(Holder(BOX.vertices, BOX.faces))
    assert np.shares_memory(mesh.vertices, BOX.vertices) and np.shares_memory(mesh.faces, BOX.faces)
    wide = BOX.faces.astype(np.int64)
    assert np.shares_memory(fm.as_mesh((BOX.vertices, wide)).faces, wide)


@pytest.mark.parametrize("dtype", ["int8", "uint8", "int16", "int32", "int64", "uint32", "uint64", ">i4"])
def test_faces_of_any_integer(dtype):
    assert fm.info((BOX.vertices, BOX.faces.astype(dtype))) == fm.info(BOX)


@pytest.mark.parametrize("dtype", ["float32", "float64", ">f8", "longdouble", "int64"])
def test_vertices_of_any_real_number(dtype):
    assert fm.info(((2 * BOX.vertices).astype(dtype), BOX.faces))["volume"] == 48


def test_any_order_and_read_only():
    vertices = np.asfortranarray(BOX.vertices)
    faces = np.ascontiguousarray(BOX.faces)
    faces.flags.writeable = False
    strided = np.repeat(BOX.vertices, 2, axis=0)[::2]
    for points in (vertices, strided, BOX.vertices.tolist()):
        assert same(fm.blend((points, faces), radius=0.1).mesh, fm.blend(BOX, radius=0.1).mesh)


def test_polygons_are_cut_into_triangles():
    points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    for faces in (quads, np.array(quads), [*quads[:-1], [1, 5, 7], [1, 7, 3]]):
        assert fm.info((points, faces))["volume"] == pytest.approx(1)


def test_pyvista_and_back():
    pyvista = pytest.importorskip("pyvista")
    poly = pyvista.Cube().clean()
    assert fm.info(poly)["volume"] == pytest.approx(1)
    assert fm.info(poly.triangulate())["closed"]
    result = fm.union(poly, fm.box((0.5, 0.5, 2)), radius=0.05).to_pyvista()
    assert result.is_manifold and set(np.unique(result["part"])) == {-1, 0, 1}


def test_pyvista_accessor():
    pyvista = pytest.importorskip("pyvista", minversion="0.48")
    import fusion_mesh._accessor  # noqa: F401  without an installed entry point

    poly = pyvista.Cube().clean().triangulate()
    assert poly.fusion.blend(radius=0.1).is_manifold
    assert poly.fusion.info()["faces"] == 12


class Open3D:
    """What Open3D's legacy mesh looks like."""

    vertices = BOX.vertices
    triangles = BOX.faces.astype(np.int32)


def test_open3d_like():
    assert fm.info(Open3D()) == fm.info(BOX)


def test_paths_and_results(tmp_path):
    BOX.save(tmp_path / "box.obj")
    assert fm.info(tmp_path / "box.obj") == fm.info(BOX) == fm.info(str(tmp_path / "box.obj"))
    assert fm.info(fm.blend(BOX, radius=0.1))["closed"]


def test_attributes_come_through(tmp_path):
    groups = np.arange(12, dtype=np.uint32) // 2
    uvs = np.random.default_rng(1).random((12, 3, 2))
    names = [f"side {i}" for i in range(6)]
    mesh = fm.Mesh(BOX.vertices, BOX.faces, uvs=uvs, face_groups=groups, group_names=names)
    result = fm.union(mesh, fm.box((0.5, 0.5, 5)))
    assert result.mesh.uvs.shape == (len(result.faces), 3, 2)
    whole = result.origins.faces["kind"] == 0
    mine = whole & (result.origins.faces["part"] == 0)
    assert mine.any()
    before = result.origins.faces["face"][mine]
    assert np.array_equal(result.mesh.uvs[mine], uvs[before])
    told = [result.mesh.group_names[g] for g in result.mesh.face_groups[mine]]
    assert told == [names[g] for g in groups[before]]
    result.save(tmp_path / "out.obj")
    assert "side 3" in fm.as_mesh(tmp_path / "out.obj").group_names


NAN = BOX.vertices.copy()
NAN[3, 1] = np.nan
LOW = BOX.faces.astype(np.int64)
LOW[2, 0] = -1
HIGH = BOX.faces.astype(np.int64)
HIGH[5, 2] = 8
HUGE = BOX.faces.astype(np.uint64)
HUGE[0, 0] = 2**63

BAD = [
    ("NaN", (NAN, BOX.faces), ValueError, "vertex 3"),
    ("infinite", (np.where(np.isnan(NAN), np.inf, NAN), BOX.faces), ValueError, "vertex 3"),
    ("two columns", (BOX.vertices[:, :2], BOX.faces), ValueError, "(N, 3)"),
    ("flat vertices", (BOX.vertices.ravel(), BOX.faces), ValueError, "(N, 3)"),
    ("three dimensions", (BOX.vertices[None], BOX.faces), ValueError, "(N, 3)"),
    ("flat faces", (BOX.vertices, BOX.faces.ravel()), ValueError, "(M, 3)"),
    ("edges for faces", (BOX.vertices, BOX.faces[:, :2]), ValueError, "(M, 3)"),
    ("complex", (BOX.vertices.astype(complex), BOX.faces), TypeError, "real numbers"),
    ("text", (BOX.vertices.astype(str), BOX.faces), TypeError, "real numbers"),
    ("objects", (BOX.vertices.astype(object), BOX.faces), TypeError, "real numbers"),
    ("truth values", (BOX.vertices > 0, BOX.faces), TypeError, "real numbers"),
    ("float faces", (BOX.vertices, BOX.faces.astype(float)), TypeError, "integers"),
    ("negative index", (BOX.vertices, LOW), ValueError, "face 2"),
    ("large index", (BOX.vertices, HIGH), ValueError, "face 5"),
    ("huge index", (BOX.vertices, HUGE), ValueError, "missing vertex"),
    ("no vertices", (np.empty((0, 3)), np.empty((0, 3), int)), ValueError, "no vertices"),
    ("no faces", (BOX.vertices, np.empty((0, 3), int)), ValueError, "no faces"),
    ("ragged vertices", ([[0, 0, 0], [1, 0]], BOX.faces), (ValueError, TypeError), "vertices"),
    ("polygon out of range", (BOX.vertices, [[0, 1, 2, 99], [0, 1, 2]]), ValueError, "99"),
    ("polygon of text", (BOX.vertices, [["a", "b", "c"], [0, 1, 2, 3]]), (TypeError, ValueError), "polygon"),
    ("a number", 7, TypeError, "int"),
    ("nothing", None, TypeError, "NoneType"),
    ("an object without vertices", object(), TypeError, "object"),
    ("a missing file", "no such file.obj", ValueError, "no such file.obj"),
    ("a file of no format", "mesh.docx", ValueError, "docx"),
]


@pytest.mark.parametrize("mesh, kind, words", [b[1:] for b in BAD], ids=[b[0] for b in BAD])
def test_bad_meshes_are_refused_by_name(mesh, kind, words):
    for call, name in (
        (lambda: fm.info(mesh), "mesh"),
        (lambda: fm.union(BOX, mesh), "meshes[1]"),
        (lambda: fm.blend(mesh, radius=0.1), "mesh"),
        (lambda: fm.render(mesh), "mesh"),
    ):
        with pytest.raises(kind) as refused:
            call()
        assert words in str(refused.value)
        assert name in str(refused.value) or isinstance(mesh, str)


def test_assigned_arrays_are_checked_again():
    mesh = fm.box()
    mesh.faces = mesh.faces + 100
    with pytest.raises(fm.InputError, match="missing vertex"):
        fm.info(mesh)
    mesh.faces = None
    with pytest.raises((TypeError, ValueError), match="mesh.faces"):
        fm.info(mesh)


def test_bad_attributes_are_refused():
    uvs = np.zeros((11, 3, 2))
    with pytest.raises(ValueError, match="uvs"):
        fm.remesh(fm.Mesh(BOX.vertices, BOX.faces, uvs=uvs), edge_length=1)
    groups = np.full(12, 3, dtype=np.uint32)
    with pytest.raises(ValueError, match="face_groups"):
        fm.remesh(fm.Mesh(BOX.vertices, BOX.faces, face_groups=groups, group_names=["a"]), edge_length=1)


@pytest.mark.filterwarnings("error")
def test_warnings_are_warnings(boxes):
    apart = fm.box((1, 1, 1), (9, 0, 0))
    with pytest.warns(fm.FusionWarning):
        result = fm.union(boxes[0], apart, radius=0.1)
    assert result.report["warnings"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fm.FusionWarning)
        fm.union(boxes[0], apart, radius=0.1)
