"""Validates and installs the extension, then runs each test file in a process of its own.

    python run.py EXTENSION.zip [NAME…]
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).parent
SECONDS = 300


def main():
    package, names = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    failed = []
    with tempfile.TemporaryDirectory() as folder:
        environment = {
            **os.environ,
            "BLENDER_USER_RESOURCES": folder,
            "FUSION_EXTENSION": str(package),
            "PYTHONUNBUFFERED": "1",
        }
        first = HERE / "test_install.py"
        others = sorted(path for path in HERE.glob("test_*.py") if path != first)
        chosen = [path for path in others if not names or path.stem.removeprefix("test_") in names]
        # Only what installs it can go first; the others use what it has installed.
        for path in [first, *chosen]:
            start = time.monotonic()
            try:
                code = subprocess.run([sys.executable, path], env=environment, timeout=SECONDS, check=False).returncode
            except subprocess.TimeoutExpired:
                code = f"no end after {SECONDS} s"
            print(f"{path.name}: {'passed' if code == 0 else f'FAILED ({code})'}, {time.monotonic() - start:.0f} s", flush=True)
            if code != 0:
                failed.append(path.name)
                if path == first:
                    break
    return f"failed: {', '.join(failed)}" if failed else 0


sys.exit(main())
