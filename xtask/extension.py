"""Packs the Blender extension: its files and one wheel with the engine, for this platform.

    python extension.py SOURCE OUTPUT.zip WHEEL
"""

import argparse
import pathlib
import platform
import zipfile

LEFT_OUT = {"__pycache__", "tests"}
# Archives of the same files have the same bytes.
MOMENT = (2020, 1, 1, 0, 0, 0)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("wheel", type=pathlib.Path)
    args = parser.parse_args()
    args.output.parent.mkdir(parents=True, exist_ok=True)
    beside = args.output.with_suffix(".part")
    with zipfile.ZipFile(beside, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in files(args.source):
            data = path.read_bytes()
            if path.name == "blender_manifest.toml":
                data += f'platforms = ["{blenders_platform()}"]\nwheels = ["./wheels/{args.wheel.name}"]\n'.encode()
            add(archive, path.relative_to(args.source).as_posix(), data)
        # A wheel is packed already.
        add(archive, f"wheels/{args.wheel.name}", args.wheel.read_bytes(), zipfile.ZIP_STORED)
    beside.replace(args.output)
    print(args.output)


def add(archive, path, data, method=None):
    entry = zipfile.ZipInfo(path, MOMENT)
    entry.external_attr = 0o644 << 16
    archive.writestr(entry, data, method if method is not None else archive.compression)


def files(folder):
    """All files, in order of name, but for tests and caches."""
    found = (p for p in sorted(folder.rglob("*")) if p.is_file())
    return [p for p in found if not LEFT_OUT & set(p.relative_to(folder).parts)]


def blenders_platform():
    """The name that Blender has for this platform."""
    system = {"Linux": "linux", "Windows": "windows", "Darwin": "macos"}[platform.system()]
    machine = "arm64" if platform.machine().lower() in {"arm64", "aarch64"} else "x64"
    return f"{system}-{machine}"


main()
