#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""python_bench.py: what the Python module costs: tex.bake() beside bake() in C++, and `import tex`.

    tests/bench/python_bench.py [BUILD [ROUNDS]]    default: build/release 9

Each round bakes 4096 x 4096 heights on one thread, in bake_bench and in an interpreter. Both keep freed memory for the
next run (see verb_main.cpp). Prints the medians of the times, and the median of the ratio within a round. Needs numpy.
"""

import os
import pathlib
import re
import statistics
import subprocess
import sys

BAKE = """
import ctypes, statistics, time
M_TRIM_THRESHOLD, M_MMAP_MAX = -1, -4
libc = ctypes.CDLL(None)
assert libc.mallopt(M_MMAP_MAX, 0) and libc.mallopt(M_TRIM_THRESHOLD, 2**31 - 1)
import numpy, tex
heights = numpy.random.default_rng(1).random((4096, 4096), dtype=numpy.float32)
times = []
for run in range(15):
    begin = time.perf_counter()
    normals = tex.bake(heights, bumpiness=8, threads=1)
    del normals
    times.append(time.perf_counter() - begin)
print(statistics.median(times))
"""
IMPORT = """
import time
import numpy
begin = time.perf_counter()
import tex
print(time.perf_counter() - begin)
"""


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/release").resolve()
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    environment = {**os.environ, "PYTHONPATH": str(build / "python"), "MALLOC_ARENA_MAX": "1"}

    def interpreter(text):
        return float(subprocess.run([sys.executable, "-P", "-c", text], env=environment, check=True, text=True,
                                    capture_output=True).stdout)

    def program():
        table = subprocess.run([build / "bake_bench", "--benchmark_filter=^Bake/kernel:1/size:4096$",
                                "--benchmark_min_time=0.5"], check=True, text=True, capture_output=True).stdout
        return 4096 * 4096 / 1e6 / float(re.search(r"^\| Bake, central \| (\d+) \|", table, re.M)[1])

    cpp, python, imports = [], [], []
    for _ in range(rounds):
        cpp.append(program())
        python.append(interpreter(BAKE))
        imports.append(interpreter(IMPORT))
    ratio = statistics.median(p / c for p, c in zip(python, cpp))
    print(f"bake() in C++ {1e3 * statistics.median(cpp):.1f} ms, tex.bake() {1e3 * statistics.median(python):.1f} ms, "
          f"ratio {ratio:.2f}; import tex {1e3 * statistics.median(imports):.1f} ms beyond numpy's")


if __name__ == "__main__":
    main()
