"""What `pip install` of the wheel gives: scripts, entry points, files."""

import importlib.metadata
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

import fusion_mesh as fm

SITE = Path(fm.__file__).parent.parent


@pytest.fixture(scope="module")
def files():
    """The files of the installed wheel by their names in it."""
    try:
        found = importlib.metadata.distribution("fusion-mesh").files
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the package is not installed from a wheel")
    return [file.as_posix() for file in found]


@pytest.fixture
def script(files):
    """The program `fusion-cli` of the wheel."""
    folders = [SITE / "bin", SITE / "Scripts", Path(sysconfig.get_path("scripts"))]
    return next(path for folder in folders if folder.exists() for path in folder.iterdir() if path.stem == "fusion-cli")


def environment():
    return {**os.environ, "PYTHONPATH": str(SITE)}


def test_the_wheel_holds_the_engine_once_and_its_types(files):
    binaries = [name for name in files if name.endswith((".so", ".pyd", ".dylib", ".dll"))]
    assert len(binaries) == 1 and binaries[0].startswith("fusion_mesh/_native"), binaries
    assert {"fusion_mesh/py.typed", "fusion_mesh/_native.pyi", "fusion_mesh/_operations.py"} <= set(files)


def test_its_program_gives_the_bytes_of_the_function_and_of_the_program(script, tmp_path):
    a, b = fm.box((2, 2, 2)), fm.box((1, 1, 3))
    a.save(tmp_path / "a.ply")
    b.save(tmp_path / "b.ply")
    line = [str(script), "union", "a.ply", "b.ply", "--radius", "2%", "-o", "out.ply"]
    subprocess.run(line, check=True, cwd=tmp_path, env=environment())
    fm.union(a, b, radius="2%").save(tmp_path / "own.ply")
    assert (tmp_path / "out.ply").read_bytes() == (tmp_path / "own.ply").read_bytes()
    missing = subprocess.run([str(script), "info", "no.ply"], capture_output=True, cwd=tmp_path, env=environment())
    assert missing.returncode == 3
    program = os.environ.get("FUSION_CLI")
    if program and Path(program).exists():
        line[0], line[-1] = program, "other.ply"
        subprocess.run(line, check=True, cwd=tmp_path)
        assert (tmp_path / "out.ply").read_bytes() == (tmp_path / "other.ply").read_bytes()


def test_pyvista_finds_it_without_an_import(files):
    pytest.importorskip("pyvista", minversion="0.48")
    code = "import pyvista; print(pyvista.Cube().clean().fusion.blend(radius=0.1).is_manifold)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment())
    assert run.stdout.strip() == "True", run.stderr
