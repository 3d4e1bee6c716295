"""The zip is a valid extension; it installs, turns on and off and on again, with the engine importable."""

import os
import pathlib
import subprocess
import sys

import bpy
import harness


def test_zip_is_valid():
    tool = pathlib.Path(bpy.utils.system_resource("SCRIPTS")) / "addons_core/bl_pkg/cli/blender_ext.py"
    done = subprocess.run([sys.executable, tool, "validate", package()], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_installs_and_turns_on_and_off():
    import addon_utils

    repo = {"repo": "user_default", "enable_on_install": False}
    assert bpy.ops.extensions.package_install_files(filepath=package(), **repo) == {"FINISHED"}
    module = harness.enable()
    assert hasattr(bpy.types, "FUSION_OT_add_boolean") and hasattr(bpy.types.Object, "fusion")
    assert len(mine()) == 9
    addon_utils.disable(harness.NAME, default_set=True)
    assert not hasattr(bpy.types, "FUSION_OT_add_boolean") and not hasattr(bpy.types.Object, "fusion")
    assert mine() == []
    assert harness.enable() is not None and len(mine()) == 9
    import fusion_mesh

    assert "extensions" in fusion_mesh.__file__, fusion_mesh.__file__
    assert module.__name__ == harness.NAME
    bpy.ops.wm.save_userpref()


def mine():
    """The handlers of the extension."""
    kinds = [getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers) if not name.startswith("_")]
    lists = [kind for kind in kinds if isinstance(kind, list)]
    return [one for kind in lists for one in kind if getattr(one, "__module__", "").startswith(harness.NAME)]


def package():
    return os.environ["FUSION_EXTENSION"]


harness.run(globals(), with_extension=False)
