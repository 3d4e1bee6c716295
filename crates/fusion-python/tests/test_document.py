"""Documents built, loaded, saved and evaluated, beside the functions and beside the program."""

import json
import threading

import numpy as np
import pytest
from conftest import same

import fusion_mesh as fm


@pytest.fixture
def filleted(boxes):
    """A block and a post, joined with a radius that a parameter gives, and cut open."""
    document = fm.Document()
    document.parameter("soft", 0.1)
    document.part("block", boxes[0])
    document.part("post", boxes[1], translate=(0.25, 0, 0))
    document.step("union", ["block", "post"], name="both", radius="$soft")
    document.step("cut", "both", plane=((0, 0, -0.5), (0, 0, -1)), name="open")
    return document


def test_a_document_gives_what_the_functions_give(filleted, boxes):
    joined = fm.union(boxes[0], fm.pose(boxes[1], translate=(0.25, 0, 0)), radius=0.1)
    expected = fm.cut(joined, plane=((0, 0, -0.5), (0, 0, -1)))
    made = filleted.evaluate()
    assert len(made) == 1 and same(made["open"].mesh, expected.mesh)
    assert [step["command"] for step in made.steps] == ["union", "cut"]
    # Origins are those of the parts, not of the steps between.
    vertices = made["open"].origins.vertices
    kept = (vertices["kind"] == 0) & (vertices["part"] == 0)
    assert kept.any()
    assert np.array_equal(made["open"].vertices[kept], boxes[0].vertices[vertices["ids"][kept, 0]])


def test_an_edit_takes_only_the_steps_it_touches(filleted):
    assert [step["known"] for step in filleted.evaluate().steps] == [False, False]
    again = filleted.evaluate()
    assert [step["known"] for step in again.steps] == [True, True]
    filleted.set("2.plane", {"point": (0, 0, -0.25), "normal": (0, 0, -1)})
    edited = filleted.evaluate()
    assert [step["known"] for step in edited.steps] == [True, False]
    fresh = fm.Document(filleted.text)
    fresh._meshes = filleted._meshes
    assert same(fresh.evaluate()["open"].mesh, edited["open"].mesh)
    filleted.set("soft", "3%")
    assert [step["known"] for step in filleted.evaluate().steps] == [False, False]


def test_edited_arrays_are_other_parts(filleted):
    before = filleted.evaluate()["open"]
    post = filleted._meshes["post.ply"]
    post.vertices = post.vertices * (1, 1, 1.1)
    after = filleted.evaluate()
    assert not after.steps[0]["known"]
    assert after["open"].vertices[:, 2].max() > before.vertices[:, 2].max()


def test_a_saved_document_gives_the_bytes_of_the_program(filleted, tmp_path, cli):
    filleted.output("open.ply")
    filleted.output("both.glb", of="both")
    files = filleted.save(tmp_path / "model.toml")
    assert files[-1] == str(tmp_path / "model.toml") and len(files) == 3
    own = tmp_path / "own"
    own.mkdir()
    made = filleted.evaluate()
    assert len(made.save(own)) == 2
    cli("run", tmp_path / "model.toml", "--report", tmp_path / "report.json")
    for name in ("open.ply", "both.glb"):
        assert (own / name).read_bytes() == (tmp_path / name).read_bytes()
    steps = json.loads((tmp_path / "report.json").read_text())["steps"]
    assert [s["output"] for s in steps] == [s["output"] for s in made.steps]
    loaded = fm.Document.load(tmp_path / "model.toml")
    assert loaded.text == filleted.text and same(loaded.evaluate()[0].mesh, made[0].mesh)
    assert loaded.parameters == {"soft": 0.1}
    assert [part["name"] for part in loaded.parts] == ["block", "post"]
    assert [(o["of"], o["file"]) for o in loaded.outputs] == [("open", "open.ply"), ("both", "both.glb")]


def test_a_folder_keeps_results_for_other_processes(filleted, tmp_path, cli):
    cache = tmp_path / "cache"
    first = filleted.evaluate(cache=fm.Cache(cache))
    assert list(cache.glob("*.entry"))
    again = filleted.evaluate(cache=fm.Cache(cache))
    assert [step["known"] for step in again.steps] == [True, True]
    assert same(first[0].mesh, again[0].mesh)
    # An entry that is not what was written is not believed.
    for entry in cache.glob("*.entry"):
        data = bytearray(entry.read_bytes())
        data[-9] ^= 1
        entry.write_bytes(data)
    mended = filleted.evaluate(cache=fm.Cache(cache))
    assert [step["known"] for step in mended.steps] == [False, False]
    assert same(first[0].mesh, mended[0].mesh)


def test_threads_share_a_cache(filleted):
    cache = fm.Cache()
    found = [None] * 4

    def work(i):
        found[i] = filleted.evaluate(cache=cache, threads=1 + i % 2)[0].mesh

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(same(found[0], mesh) for mesh in found)


def test_parts_ride_on_primitives():
    document = fm.Document()
    document.primitive("neck", shape="cone", base=(0, 0, 1), axis=(0, 0, 1), radius=(0.5, 0.25), height=2.0)
    document.part("body", fm.sphere(1.0))
    document.part("head", fm.box((0.4, 0.4, 0.4)), on={"primitive": "neck", "at": (0, 1.5)})
    heads = document.evaluate()["head"].vertices
    # On the middle of the cone's upper end, at height 3.
    assert heads[:, 2].min() > 1.5


def test_solids_that_options_name_are_in_memory(boxes, tmp_path, cli):
    window = fm.box((3, 3, 0.2), (0, 0, 1))
    document = fm.Document()
    document.part("block", boxes[0])
    document.part("ball", fm.sphere(0.5, (0, 0, 9)), drop=boxes[1])
    document.step("blend", "block", fm.edges(angle=40).within(window).convex(), radius="2%")
    document.output("round.ply", of="block")
    document.output("dropped.ply", of="ball")
    made = document.evaluate()
    assert made.steps[0]["figures"]["curves"] == 4
    assert made["ball"].vertices[:, 2].min() == pytest.approx(1.5, abs=1e-12)
    files = document.save(tmp_path / "model.toml")
    assert len(files) == 5
    cli("run", tmp_path / "model.toml")
    for name, file in (("ball", "dropped.ply"), ("block", "round.ply")):
        assert same(made[name].mesh, fm.as_mesh(tmp_path / file))


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda d: d.step("blend", "block", radios=1), "radius"),
        (lambda d: d.step("blende", "block", radius=1), "blend"),
        (lambda d: d.step("blend", "blok", radius=1), "block"),
        (lambda d: d.step("blend", "block", radius=-1), "radius"),
        (lambda d: d.step("blend", "block", radius="$hard"), "hard"),
        (lambda d: d.part("block", fm.box()), "block"),
        (lambda d: d.part("a:b", fm.box()), "colon"),
        (lambda d: d.set("sofd", 1), "soft"),
        (lambda d: d.set("9.radius", 1), "step"),
        (lambda d: d.set("soft", -1), "radius"),
        (lambda d: d.output("x.ply", of="nobody"), "nobody"),
        (lambda d: d.step("detail", "block", target={"faces": [1]}, source={"mesh": fm.box()}), "source"),
        (lambda d: fm.Document("version = 1"), "version = 2"),
        (lambda d: fm.Document("version = "), "line 1"),
        (lambda d: fm.Document.load("no such document.toml"), "no such document"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(filleted, call, words):
    before = (filleted.text, filleted.parts, filleted.steps)
    with pytest.raises((fm.UsageError, fm.InputError), match=words):
        call(filleted)
    assert (filleted.text, filleted.parts, filleted.steps) == before


def test_a_step_that_fails_is_named(boxes):
    document = fm.Document()
    document.part("block", boxes[0])
    document.step("blend", "block", radius=5, overlap="error")
    with pytest.raises(fm.InfeasibleError, match="step 1, blend of block") as refused:
        document.evaluate()
    assert refused.value.place is not None
    missing = fm.Document()
    missing.part("block", "no such file.ply")
    with pytest.raises(fm.InputError, match="no such file.ply"):
        missing.evaluate()
    with pytest.raises(fm.InputError, match="no such file.ply"):
        missing.save("model.toml")
    with pytest.raises(TypeError, match="cache"):
        document.evaluate(cache="here")


def test_parameters_that_nothing_refers_to_are_told(boxes):
    document = fm.Document()
    document.parameter("idle", 3)
    document.part("block", boxes[0])
    with pytest.warns(fm.FusionWarning, match="idle"):
        document.evaluate()


def test_progress_ends_an_evaluation(filleted):
    stages = []

    def stop(stage, share):
        stages.append(stage)
        return False

    with pytest.raises(KeyboardInterrupt):
        fm.union(fm.sphere(1, segments=300), fm.sphere(0.9, (0.5, 0.1, 0.07), segments=300), radius=0.05, progress=stop)
    with pytest.raises(TypeError, match="progress"):
        filleted.evaluate(progress=3)
