"""Times the drag of a cutter around a closed loop: `python drag.py [CUTS [STEPS]]`, after `run.py` has shown that it works.

Prints the median of a step, of which reading, the engine and writing, and the memory of the process on the way.
"""

import importlib
import math
import os
import statistics
import sys
import time

import harness


def main():
    cuts = int(sys.argv[1]) if len(sys.argv) > 1 else 6
    steps = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    harness.enable()
    harness.empty()
    engine, live, snapshot, build = (
        importlib.import_module(f"{harness.NAME}.{name}") for name in ("engine", "live", "snapshot", "build")
    )
    spent = {"read": [], "engine": [], "write": []}
    timed(snapshot, "take", spent["read"])
    timed(engine, "run", spent["engine"])
    timed(build, "fill", spent["write"])
    block, drill = harness.cube(cuts=cuts), harness.cylinder(radius=0.2, vertices=32)
    result = harness.boolean(block, drill, radius=0.05)
    whole, busy, memory = [], [], []
    for values in spent.values():
        values.clear()
    for step in range(steps):
        angle = 2 * math.pi * step / steps
        start, began = time.perf_counter(), time.process_time()
        drill.location.xy = 0.5 * math.cos(angle), 0.5 * math.sin(angle)
        harness.update()
        whole.append(time.perf_counter() - start)
        busy.append(time.process_time() - began)
        memory.append(resident())
        assert not result.fusion.is_error, result.fusion.message
        assert len(whole) == len(spent["engine"])
    ours = [sum(parts) for parts in zip(*spent.values())]
    print(f"faces of the block: {len(block.data.polygons)}; of the result: {len(result.data.polygons)}")
    print(f"step: {told(whole)}, of processor time {told(busy)}; Blender's own part: {told([w - o for w, o in zip(whole, ours)])}")
    print("; ".join(f"{name}: {told(values)}" for name, values in spent.items()))
    print(f"memory: {memory[min(9, steps - 1)]} MB after 10 steps, {memory[-1]} MB after {steps}, most {max(memory)} MB")
    print(f"load of the machine: {os.getloadavg()[0]:.1f}")
    sys.stdout.flush()
    os._exit(0)


def timed(module, name, times):
    """Replaces a function by one that notes its times."""
    function = getattr(module, name)

    def wrapper(*arguments, **options):
        start = time.perf_counter()
        try:
            return function(*arguments, **options)
        finally:
            times.append(time.perf_counter() - start)

    setattr(module, name, wrapper)


def told(times):
    return f"{1000 * statistics.median(times):.0f} ms"


def resident():
    """Megabytes of memory in use."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") >> 20


main()
