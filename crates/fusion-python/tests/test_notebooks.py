"""The cells of every notebook run, one after the other."""

import json
from pathlib import Path

import pytest

import fusion_mesh as fm

NOTEBOOKS = sorted((Path(__file__).parent.parent / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path, tmp_path, monkeypatch):
    if "trimesh" in path.read_text(encoding="utf-8"):
        pytest.importorskip("trimesh")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "__main__"}
    shown = 0
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        assert cell.get("outputs", []) == [], "notebooks are kept without outputs"
        if cell["cell_type"] != "code":
            continue
        lines = "".join(cell["source"]).rstrip().split("\n")
        # As a notebook does, the value of a last line is shown.
        try:
            last = compile(lines[-1], str(path), "eval")
            first = lines[:-1]
        except SyntaxError:
            last, first = None, lines
        exec(compile("\n".join(first), str(path), "exec"), names)
        value = eval(last, names) if last else None
        if isinstance(value, fm.Result):
            assert "data:image/png" in value._repr_html_()
            shown += 1
    assert shown
