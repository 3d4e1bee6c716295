"""The same inputs through this program and through packaged peers, as a Markdown table.

usage: cargo xtask bench --peers, or: python3 xtask/peers.py PROGRAM FIT STAGE [JOB...], FIT and STAGE being the examples of
rbf-solve and fusion of those names; all jobs where none is named

Each job runs a few times and the best counts. Wall-clock time means little on a busy machine, so processor seconds of all threads
are given as well, from arrays to arrays; of joins, of our whole program with reading, checking and writing, so that ours are an
upper bound.
"""

import os
import sys
import tempfile
import time

from jobs.fields import fits, zero_sets
from jobs.files import reading
from jobs.joins import joins
from jobs.solids import booleans, curves
from jobs.surfaces import harmonic, remeshing, smoothing
from table import Table

JOBS = [reading, booleans, curves, joins, remeshing, smoothing, harmonic, fits, zero_sets]


def main():
    program, fit, stage, *wanted = sys.argv[1:]
    # Some peers talk.
    sys.stdout = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {time.strftime('%Y-%m-%d')}.\n")
    with tempfile.TemporaryDirectory() as folder:
        table = Table(program, fit, stage, folder)
        for job in JOBS:
            if not wanted or job.__name__ in wanted:
                job(table)
        table.print()


if __name__ == "__main__":
    main()
