"""Examples run, types are right, and what is promised about the package's files holds."""

import doctest
import importlib
import importlib.util
import inspect
import json
import os
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import fusion_mesh as fm

ROOT = Path(__file__).parent.parent
# What needs packages that may not be there.
OPTIONAL = ("_accessor.py", "_jobs.py", "ray.py")
NAMES = sorted(m.name for m in pkgutil.iter_modules(fm.__path__) if m.name not in ("_native", "_accessor"))


@pytest.mark.parametrize("name", ["", *NAMES])
def test_examples_of_docstrings_run(name):
    if f"{name}.py" in OPTIONAL:
        pytest.importorskip("pyarrow")
    module = importlib.import_module(f"fusion_mesh.{name}" if name else "fusion_mesh")
    result = doctest.testmod(module, optionflags=doctest.ELLIPSIS)
    assert result.failed == 0


def test_every_function_is_documented():
    for name in fm.__all__:
        thing = getattr(fm, name)
        assert name == "__version__" or inspect.getdoc(thing), name
        if inspect.isfunction(thing):
            text = inspect.getdoc(thing)
            for parameter in inspect.signature(thing).parameters.values():
                assert re.search(rf"\b{parameter.name}\b", text), f"{name}: {parameter.name}"
            assert ">>>" in text, name


PAGES = [ROOT / "README.md", ROOT.parent.parent / "README.md", *sorted((ROOT.parent.parent / "docs").glob("*.md"))]
BLOCKS = {page: re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL) for page in PAGES}


@pytest.mark.parametrize("page", [page for page in PAGES if BLOCKS[page]], ids=lambda page: f"{page.parent.name}/{page.name}")
@pytest.mark.filterwarnings("error::fusion_mesh.FusionWarning")
def test_pages_run(page, tmp_path, monkeypatch):
    if importlib.util.find_spec("pyvista"):
        # An installed wheel has an entry point for this.
        importlib.import_module("fusion_mesh._accessor")
    monkeypatch.chdir(tmp_path)
    # The models that pages name.
    fm.sphere(1.0).save("bunny.obj")
    fm.sphere(0.8, (0.9, 0.2, 0.1)).save("spot.obj")
    known = {}
    for block in BLOCKS[page]:
        code = compile(block, str(page), "exec")
        needs = set(re.findall(r"^import (\w+)|^from (\w+)", block, flags=re.MULTILINE))
        if all(importlib.util.find_spec(name) for pair in needs for name in pair if name):
            exec(code, known)


def mypy(*arguments):
    """Runs mypy on the package as it is imported here, without looking into other packages."""
    environment = {**os.environ, "MYPYPATH": str(Path(fm.__file__).parent.parent)}
    settings = ["--config-file", str(ROOT / "pyproject.toml"), "--cache-dir", os.devnull]
    return subprocess.run([sys.executable, "-m", "mypy", *settings, *arguments], capture_output=True, text=True, env=environment)


def test_a_strict_type_checker_passes():
    pytest.importorskip("mypy")
    checked = mypy("-p", "fusion_mesh", "--strict")
    assert checked.returncode == 0, checked.stdout + checked.stderr
    checked = mypy(str(ROOT / "examples" / "typed.py"), "--strict")
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_pyright_passes():
    # The package that pip knows under this name loads the checker itself; without a network it cannot.
    pytest.importorskip("pyright")
    examples = [str(ROOT / "examples" / "typed.py"), *map(str, Path(fm.__file__).parent.glob("*.py"))]
    examples = [path for path in examples if Path(path).name not in OPTIONAL]
    environment = {**os.environ, "PYTHONPATH": str(Path(fm.__file__).parent.parent)}
    run = [sys.executable, "-m", "pyright", "--pythonpath", sys.executable, "--outputjson", *examples]
    try:
        checked = subprocess.run(run, capture_output=True, text=True, env=environment, timeout=120)
        found = json.loads(checked.stdout)
    except (ValueError, subprocess.TimeoutExpired) as error:
        pytest.skip(f"pyright does not start: {error}")
    errors = [d for d in found["generalDiagnostics"] if d["severity"] == "error"]
    assert not errors, "\n".join(f"{d['file']}:{d['range']['start']['line'] + 1}: {d['message']}" for d in errors)


def test_stubs_are_those_of_the_module():
    pytest.importorskip("mypy")
    environment = {**os.environ, "MYPYPATH": str(Path(fm.__file__).parent.parent)}
    run = [sys.executable, "-m", "mypy.stubtest", "fusion_mesh._native", "--ignore-disjoint-bases"]
    checked = subprocess.run(run, capture_output=True, text=True, env=environment)
    if "unrecognized arguments" in checked.stderr:
        checked = subprocess.run(run[:-1], capture_output=True, text=True, env=environment)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_only_numpy_is_needed():
    code = (
        "import sys; before = set(sys.modules); import fusion_mesh, fusion_mesh._cli; "
        "print(sorted({m.split('.')[0] for m in set(sys.modules) - before} - set(sys.stdlib_module_names)))"
    )
    if sys.version_info < (3, 10):
        pytest.skip("sys.stdlib_module_names")
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert printed.strip() == "['fusion_mesh', 'numpy']"


def test_a_picture_stands_for_a_result():
    page = fm.union(fm.box((2, 2, 2)), fm.box((1, 1, 3)), radius=0.1)._repr_html_()
    assert "data:image/png;base64," in page and "<td>True</td>" in page
    assert fm.box()._repr_png_().startswith(b"\x89PNG")
