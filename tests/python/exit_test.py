# SPDX-License-Identifier: Apache-2.0
"""The end of a program while its threads are in verbs."""

import subprocess
import sys

import pytest

PROGRAM = """
import sys, threading, time
import numpy as np, tex
big = np.random.default_rng(1).random((1500, 1500), dtype=np.float32)
n = tex.bake(big)
begun = threading.Event()
def told(fraction):
    begun.set()
def stuck(fraction):
    begun.set()
    time.sleep(1000)
def loop(call):
    begun.set()
    while True:
        call()
CALLS = {
    "progress": lambda: tex.pack(n, effort="best", progress=told),
    "stuck": lambda: tex.pack(n, effort="best", progress=stuck),
    "bake": lambda: loop(lambda: tex.bake(big)),
    "blocks": lambda: loop(lambda: tex.encode_blocks(n, effort="best")),
    "file": lambda: loop(lambda: tex.encode_file(tex.pack(n, "rgb8"), "png")),
    "copies": lambda: loop(lambda: tex.scale(n.astype(np.float64), 2)),
    "run": lambda: loop(lambda: tex.run("bake-normals", [sys.argv[2], "-o", "-", "--effort", "best"])),
}
for _ in range(2):
    threading.Thread(target=CALLS[sys.argv[1]], daemon=True).start()
begun.wait()
time.sleep(0.1)
print("end")
"""


@pytest.mark.parametrize("call", ["progress", "stuck", "bake", "blocks", "file", "copies", "run"])
def test_a_program_ends_while_threads_are_in_verbs(call, bricks):
    done = subprocess.run([sys.executable, "-c", PROGRAM, call, bricks], capture_output=True, text=True, timeout=120,
                          check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "end\n", "")


JOINED = """
import atexit, threading
thread = threading.Thread(target=lambda: [tex.bake(big) for _ in range(10**6)], daemon=True)
atexit.register(lambda: (thread.join(), print("joined", tex.bake(big).shape)))
import numpy as np, tex
big = np.zeros((512, 512), np.float32)
thread.start()
"""


def test_threads_can_be_joined_at_exit_and_the_main_thread_still_bakes():
    done = subprocess.run([sys.executable, "-c", JOINED], capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "joined (512, 512, 3)\n", "")
