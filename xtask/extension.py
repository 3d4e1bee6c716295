"""Packs the Blender extension: its files and one wheel with the engine, for this platform.

    python extension.py SOURCE OUTPUT.zip (--package FOLDER --version V | --wheel FILE)

FOLDER holds `fusion_mesh` with its native module; a wheel is packed from it. A wheel of maturin's is taken as it is.
"""

import argparse
import base64
import hashlib
import io
import pathlib
import platform
import shutil
import subprocess
import sysconfig
import tempfile
import zipfile

NATIVE = {".so", ".pyd", ".dylib"}
LEFT_OUT = {"__pycache__", "tests"}
# Archives of the same files have the same bytes.
MOMENT = (2020, 1, 1, 0, 0, 0)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--package", type=pathlib.Path)
    parser.add_argument("--version")
    parser.add_argument("--wheel", type=pathlib.Path)
    args = parser.parse_args()
    if args.wheel:
        name, wheel = args.wheel.name, args.wheel.read_bytes()
    else:
        name, wheel = packed(args.package, args.version)
    args.output.parent.mkdir(parents=True, exist_ok=True)
    beside = args.output.with_suffix(".part")
    with zipfile.ZipFile(beside, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in files(args.source):
            data = path.read_bytes()
            if path.name == "blender_manifest.toml":
                data += f'platforms = ["{blenders_platform()}"]\nwheels = ["./wheels/{name}"]\n'.encode()
            add(archive, path.relative_to(args.source).as_posix(), data)
        # A wheel is packed already.
        add(archive, f"wheels/{name}", wheel, zipfile.ZIP_STORED)
    beside.replace(args.output)
    print(args.output)


def packed(package, version):
    """A wheel's name and bytes."""
    tag = f"cp39-abi3-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    info = f"fusion_mesh-{version}.dist-info"
    contents = {f"fusion_mesh/{p.relative_to(package).as_posix()}": stripped(p) for p in files(package)}
    contents[f"{info}/METADATA"] = f"Metadata-Version: 2.1\nName: fusion-mesh\nVersion: {version}\n".encode()
    wheel = f"Wheel-Version: 1.0\nGenerator: cargo xtask blender\nRoot-Is-Purelib: false\nTag: {tag}\n"
    contents[f"{info}/WHEEL"] = wheel.encode()
    record = [f"{path},sha256={digest(data)},{len(data)}" for path, data in contents.items()]
    contents[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for path, data in contents.items():
            add(archive, path, data)
    return f"fusion_mesh-{version}-{tag}.whl", memory.getvalue()


def add(archive, path, data, method=None):
    entry = zipfile.ZipInfo(path, MOMENT)
    entry.external_attr = 0o644 << 16
    archive.writestr(entry, data, method if method is not None else archive.compression)


def files(folder):
    """All files, in order of name, but for tests and caches."""
    found = (p for p in sorted(folder.rglob("*")) if p.is_file())
    return [p for p in found if not LEFT_OUT & set(p.relative_to(folder).parts)]


def stripped(path):
    """A file; a native module without what only a debugger reads, where there is a tool for that."""
    if path.suffix not in NATIVE or not shutil.which("strip"):
        return path.read_bytes()
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / path.name
        shutil.copy(path, copy)
        subprocess.run(["strip", "-S", copy], check=False, capture_output=True)
        return copy.read_bytes()


def digest(data):
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def blenders_platform():
    """The name that Blender has for this platform."""
    system = {"Linux": "linux", "Windows": "windows", "Darwin": "macos"}[platform.system()]
    machine = "arm64" if platform.machine().lower() in {"arm64", "aarch64"} else "x64"
    return f"{system}-{machine}"


main()
