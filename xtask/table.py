"""Jobs timed through this program and through peers, one row each."""

import importlib.metadata
import json
import os
import resource
import subprocess
import time

import numpy as np

from inputs import write

ROUNDS = 3


def timed(job, who=resource.RUSAGE_SELF, rounds=ROUNDS):
    """The best clock and processor seconds, and what the job gave last."""
    best, made = (float("inf"), float("inf")), None
    for _ in range(rounds):
        before, start = resource.getrusage(who), time.perf_counter()
        made = job()
        wall, after = time.perf_counter() - start, resource.getrusage(who)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best = (min(best[0], wall), min(best[1], cpu))
    return *best, made


class Table:
    """`program` is fusion-cli, `fit` and `stage` are the examples of those names, `folder` is for files on the way."""

    def __init__(self, program, fit, stage, folder):
        self.program, self.fit, self.stage, self.folder, self.rows = program, fit, stage, folder, []

    def path(self, name):
        return os.path.join(self.folder, name)

    def file(self, name, points, faces):
        """Writes a surface and gives its path."""
        write(self.path(name), points, faces)
        return self.path(name)

    def numbers(self, name, array):
        """Writes 64-bit floats and gives their path."""
        np.ascontiguousarray(array, dtype=np.float64).tofile(self.path(name))
        return self.path(name)

    def add(self, job, name, wall, cpu=None, note=""):
        self.rows.append((job, name, wall, cpu, note))

    def ours(self, job, arguments, stages, judge=None):
        """The whole program; on the clock the stages named, or all. `judge` makes a note once it has run."""
        report, walls = self.path("report.json"), []

        def run():
            subprocess.run([self.program, *arguments, "--report", report, "--quiet"], check=True, capture_output=True)
            made = json.load(open(report))["stages"]
            walls.append(sum(s["milliseconds"] for s in made if s["name"] in stages) / 1e3)

        wall, cpu, _ = timed(run, resource.RUSAGE_CHILDREN)
        notes = [*stages, *([judge()] if judge else [])]
        self.add(job, "fusion" if stages else "fusion, whole program", min(walls) if stages else wall, cpu, ", ".join(notes))

    def ours_alone(self, job, arguments, judge=None):
        """One stage from arrays to arrays, timed by itself."""
        ran = subprocess.run([self.stage, *arguments], check=True, capture_output=True)
        made = json.loads(ran.stdout)
        self.add(job, "fusion", made["clock"], made["processor"], judge(made["made"]) if judge else "")

    def peer(self, job, name, prepare, judge=None, rounds=ROUNDS):
        """`prepare` imports the package and gives the job; `judge` makes a note of what the job gave."""
        try:
            version = importlib.metadata.version(name.split()[0])
            wall, cpu, made = timed(prepare(), rounds=rounds)
            notes = [*(["once"] if rounds == 1 else []), *([judge(made)] if judge else [])]
            self.add(job, f"{name} {version}", wall, cpu, "; ".join(notes))
        except Exception as error:  # A peer that is not there or refuses is a row, not a failure.
            self.add(job, name, None, None, f"{type(error).__name__}: {str(error)[:60]}")

    def print(self):
        """Ratios are of processor times, or of clocks where ours is timed inside a program that does more."""
        ours = {job: (wall, cpu) for job, name, wall, cpu, _ in self.rows if name == "fusion"}
        print("| job | program | clock | processor | ours = 1 | |\n|---|---|---|---|---|---|")
        for job, name, wall, cpu, note in self.rows:
            figures = ["", "", ""]
            if wall is not None:
                figures[0] = f"{1e3 * wall:,.0f} ms" if wall > 0.01 else f"{1e3 * wall:.1f} ms"
                our_wall, our_cpu = ours[job]
                if cpu is not None:
                    figures[1] = f"{1e3 * cpu:,.0f} ms"
                figures[2] = f"{cpu / our_cpu:.1f}" if cpu and our_cpu else f"{wall / our_wall:.1f} (clock)"
            print("| " + " | ".join([job, name, *figures, note]) + " |")
