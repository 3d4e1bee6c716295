"""Packs a wheel of a module that is built already, so that its scripts and entry points can be tested without building it again.

    python wheel.py MODULE PACKAGE PROJECT.json VERSION FOLDER

PROJECT.json is the table `project` of pyproject.toml. Prints the path of the wheel. Release wheels are made by maturin.
"""

import base64
import hashlib
import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile


def stripped(module):
    """The module's bytes, without what only a debugger reads, where there is a tool for that."""
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "module")
        shutil.copy(module, copy)
        if shutil.which("strip"):
            subprocess.run(["strip", "-S", copy], check=False, capture_output=True)
        with open(copy, "rb") as opened:
            return opened.read()


def texts(project, version, tag):
    """The files that describe the wheel."""
    about = [
        "Metadata-Version: 2.1",
        f"Name: {project['name']}",
        f"Version: {version}",
        f"Summary: {project['description']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {need}" for need in project["dependencies"]),
    ]
    points = {"console_scripts": project["scripts"], **project["entry-points"]}
    groups = [f"[{group}]\n" + "".join(f"{name} = {target}\n" for name, target in each.items()) for group, each in points.items()]
    wheel = f"Wheel-Version: 1.0\nGenerator: xtask\nRoot-Is-Purelib: false\nTag: {tag}\n"
    return {"METADATA": "\n".join(about) + "\n", "entry_points.txt": "\n".join(groups), "WHEEL": wheel}


def main(module, package, project, version, folder):
    with open(project, encoding="utf-8") as file:
        project = json.load(file)
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    tag, name = f"cp39-abi3-{platform}", project["name"].replace("-", "_")
    path = os.path.join(folder, f"{name}-{version}-{tag}.whl")
    suffix = "pyd" if os.name == "nt" else "abi3.so"
    info = f"{name}-{version}.dist-info"
    records = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as wheel:

        def add(place, data):
            wheel.writestr(place, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            records.append(f"{place},sha256={digest},{len(data)}")

        for file in sorted(os.listdir(package)):
            if os.path.isfile(os.path.join(package, file)):
                with open(os.path.join(package, file), "rb") as opened:
                    add(f"{os.path.basename(package)}/{file}", opened.read())
        add(f"{os.path.basename(package)}/_native.{suffix}", stripped(module))
        for file, text in texts(project, version, tag).items():
            add(f"{info}/{file}", text.encode())
        wheel.writestr(f"{info}/RECORD", "\n".join([*records, f"{info}/RECORD,,", ""]))
    print(path)


main(*sys.argv[1:])
