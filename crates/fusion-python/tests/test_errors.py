"""One exception for each exit code, with the same facts as data."""

import pickle

import pytest

import fusion_mesh as fm


def test_a_ball_that_does_not_fit_says_which_does():
    with pytest.raises(fm.InfeasibleError) as refused:
        fm.blend(fm.box((1, 1, 1)), radius=0.6, overlap="error")
    error = refused.value
    assert error.diagnostic["code"] == "radius_too_large" and len(error.place) == 3
    assert 0 < error.workable_radius <= 0.5
    assert fm.blend(fm.box((1, 1, 1)), radius=error.workable_radius, overlap="error").report["validity"]["closed"]
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.place) == (str(error), error.place)


def test_a_curve_that_is_not_there_is_named():
    with pytest.raises(fm.InfeasibleError) as refused:
        fm.blend(fm.box(), fm.edges().ids(99), radius=0.1)
    assert refused.value.curves == [99] and refused.value.remedy


@pytest.mark.parametrize(
    "options, words",
    [
        ({}, "radius"),
        ({"radius": -1}, "radius"),
        ({"radius": float("nan")}, "radius"),
        ({"radius": "2mm"}, "radius"),
        ({"radius": 0.1, "angle": 400}, "angle"),
        ({"radius": 0.1, "profile": "round"}, "profile"),
        ({"radius": 0.1, "overlap": "trim"}, "full"),
        ({"radius": 0.1, "near": (0, 0, float("inf"))}, "near"),
        ({"radius": 0.1, "near": "here"}, "near"),
        ({"radius": 0.1, "ids": [0.5]}, "ids"),
        ({"radius": 0.1, "convex": True, "concave": True}, "convex"),
        ({"radius": 0.1, "precision": "f16"}, "precision"),
        ({"radius": 0.1, "threads": 0}, "threads"),
    ],
)
def test_options_that_cannot_be_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        fm.blend(fm.box(), **options)


@pytest.mark.parametrize("options", [{"radios": 1}, {"radius": object()}, {"threads": 1.5}, {"progress": 3}])
def test_options_of_the_wrong_type(options):
    with pytest.raises(TypeError, match=next(iter(options))):
        fm.blend(fm.box(), **{"radius": 0.1, **options})
    with pytest.raises(TypeError, match="edges"):
        fm.blend(fm.box(), 40, radius=0.1)


def test_files_that_cannot_be():
    with pytest.raises(fm.InputError, match="profile"):
        fm.blend(fm.box(), radius=0.1, profile="missing.toml")
    with pytest.raises(fm.OutputError):
        fm.box().save("no such folder/box.ply")
    with pytest.raises(fm.OutputError):
        fm.render(fm.box(), "no such folder/box.png", size=32)
    with pytest.raises(fm.OutputError):
        fm.Document().save("no such folder/box.toml")
    with pytest.raises(fm.InputError, match="docx"):
        fm.box().save("box.docx")


def test_open_and_tangled_meshes_are_infeasible():
    box = fm.box()
    torn = fm.Mesh(box.vertices, box.faces[:-1])
    with pytest.raises(fm.InfeasibleError) as refused:
        fm.union(torn, fm.box((0.5, 0.5, 2)))
    assert refused.value.place is not None
    turned = fm.Mesh(box.vertices, [face[::-1] if i == 3 else face for i, face in enumerate(box.faces.tolist())])
    with pytest.raises(fm.InfeasibleError) as refused:
        fm.blend(turned, radius=0.1)
    assert refused.value.diagnostic["code"] == "not_manifold"


def test_every_class_is_a_fusion_error():
    for kind in (fm.UsageError, fm.InputError, fm.InfeasibleError, fm.InvalidResultError, fm.OutputError):
        assert issubclass(kind, fm.FusionError)
    assert issubclass(fm.InputError, ValueError) and not issubclass(fm.InfeasibleError, ValueError)


def test_results_that_32_bits_would_fold_are_not_saved(tmp_path):
    far = fm.box((1e-3, 1e-3, 1e-3), (1e6, 0, 0))
    result = fm.blend(far, radius=1e-4)
    result.save(tmp_path / "fine.ply")
    with pytest.raises(fm.InvalidResultError, match="32 bits"):
        result.save(tmp_path / "folded.stl")
    assert not (tmp_path / "folded.stl").exists()


def test_the_program_gives_its_exit_codes(cli, tmp_path):
    fm.box().save(tmp_path / "box.ply")
    box, out = tmp_path / "box.ply", tmp_path / "out.ply"
    for code, arguments in (
        (0, ["info", box]),
        (2, ["blend", box]),
        (3, ["info", tmp_path / "missing.ply"]),
        (4, ["blend", box, "--radius", 5, "--overlap", "error", "-o", out]),
        (6, ["blend", box, "--radius", 0.1, "-o", tmp_path / "none" / "out.ply"]),
    ):
        answer = cli(*arguments, check=False)
        assert answer.returncode == code, answer.stderr
    assert not out.exists()
