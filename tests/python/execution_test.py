# SPDX-License-Identifier: Apache-2.0
"""Threads, progress, cancellation, errors."""

import errno
import inspect
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import tex
from conftest import SAMPLES

LARGE = np.tile(np.random.default_rng(2).random((512, 512), dtype=np.float32), (4, 4))


def test_the_bytes_are_the_same_for_every_number_of_threads():
    results = {np.ascontiguousarray(tex.bake(LARGE, threads=threads)).tobytes() for threads in (0, 1, 2, 5)}
    assert len(results) == 1


def test_progress_grows_to_one_on_the_callers_thread():
    fractions, threads = [], set()

    def progress(fraction):
        fractions.append(fraction)
        threads.add(threading.get_ident())

    tex.pack(tex.bake(LARGE), effort="best", progress=progress)
    assert fractions == sorted(fractions) and fractions[-1] == 1.0 and len(fractions) > 2
    assert threads == {threading.get_ident()}


def test_false_cancels():
    n = tex.bake(LARGE)
    with pytest.raises(tex.CancelledError) as caught:
        tex.pack(n, effort="best", progress=lambda fraction: False)
    assert caught.value.code == "cancelled"


@pytest.mark.parametrize("answer", [False, np.False_], ids=["bool", "numpy"])
def test_every_report_cancels(answer):
    n = tex.bake(LARGE[:1024, :1024])
    dxt = tex.decode_file(tex.encode_file(tex.Texture("rgba8-unorm", (1024, 1024), [bytes(4 << 20)]), "dds"))
    for call in (
        lambda **how: tex.slope_range(n, **how),
        lambda **how: tex.height_field(LARGE, deband="on", **how),
        lambda **how: tex.deband(LARGE, **how),
        lambda **how: tex.guess_swizzle(dxt, **how),
        lambda **how: tex.encode_blocks(n, effort="best", **how),
        lambda **how: tex.bake(LARGE[:8, :8], **how),
    ):
        fractions = []
        assert call(progress=fractions.append) is not None and fractions[0] == 0 and fractions[-1] == 1
        for at in {0, len(fractions) // 2, len(fractions) - 1}:
            told = []

            def progress(fraction):
                told.append(fraction)
                return answer if fraction >= fractions[at] else None

            with pytest.raises(tex.CancelledError):
                call(progress=progress)
            assert told[-1] >= fractions[at]
    for other in (None, 0, True, np.True_, ""):
        assert tex.bake(LARGE, progress=lambda fraction: other) is not None


def test_an_exception_of_the_callback_cancels_and_is_raised():
    def progress(fraction):
        raise LookupError(f"at {fraction}")

    with pytest.raises(LookupError, match="at 0"):
        tex.pack(tex.bake(LARGE), effort="best", progress=progress)


def test_a_cancelled_file_is_not_written(tmp_path, bricks):
    output = tmp_path / "n.dds"
    with pytest.raises((tex.CancelledError, RuntimeError)):
        tex.bake_file(bricks, output, pack={"effort": "best", "metric": "angle"}, progress=lambda f: False)
    assert not output.exists()


def test_progress_must_be_callable():
    with pytest.raises(TypeError, match="progress"):
        tex.bake(LARGE, progress=3)


LOOP = """
import numpy, sys, tex
n = tex.bake(numpy.random.default_rng(1).random((2048, 2048), dtype=numpy.float32))
print("ready", flush=True)
while True:
    {}
"""


@pytest.mark.parametrize("call", ["tex.pack(n, effort='best', metric='angle')",
                         "tex.encode_blocks(n, effort='best', metric='angle')", "tex.run('bake-normals', ['{}', '-o', "
                         "'/dev/null', '--container', 'dds', '--effort', 'best', '--metric', 'angle'])"])
def test_control_c_cancels(call):
    code = LOOP.format(call.format(SAMPLES / "bricks.png"))
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == -signal.SIGINT and err.endswith("KeyboardInterrupt\n"), err


def test_eight_threads_at_once():
    expected = np.ascontiguousarray(tex.bake(LARGE[:512, :512], bumpiness=3)).tobytes()
    packed = tex.encode_file(tex.pack(tex.bake(LARGE[:512, :512], bumpiness=3)), "dds")
    wrong = []

    def work():
        for _ in range(10):
            fractions = []
            n = tex.bake(LARGE[:512, :512], bumpiness=3, progress=fractions.append)
            if np.ascontiguousarray(n).tobytes() != expected or tex.encode_file(tex.pack(n), "dds") != packed:
                wrong.append("bytes")
            if fractions != sorted(fractions) or fractions[-1] != 1.0:
                wrong.append(fractions)

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_other_threads_run_meanwhile():
    n = tex.bake(LARGE)
    counted = 0
    done = threading.Event()

    def work():
        tex.pack(n, effort="best")
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.wait(0.001):
        counted += 1
    thread.join()
    assert counted > 3


ERRORS = [
    (tex.IoError, OSError, "io", lambda: tex.read_texture("none/at/all.dds")),
    (tex.BadDataError, ValueError, "bad-data", lambda: tex.decode_file(b"DDS nonsense", "x.dds")),
    (tex.UnsupportedError, ValueError, "unsupported", lambda: tex.encode_file(tex.pack(LARGE[:4, :12].reshape(4, 4, 3)), "png")),
    (tex.BadOptionError, ValueError, "bad-option", lambda: tex.height_field(LARGE, channel="a")),
]


@pytest.mark.parametrize(("kind", "base", "code", "call"), ERRORS, ids=[row[2] for row in ERRORS])
def test_errors_are_exceptions_with_code_file_and_reason(kind, base, code, call):
    with pytest.raises(kind) as caught:
        call()
    error = caught.value
    assert isinstance(error, tex.Error) and isinstance(error, base)
    assert error.code == code and error.reason in str(error) and str(error).startswith(error.file)
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is kind and (str(again), again.file, again.reason) == (str(error), error.file, error.reason)


def test_io_errors_name_their_file():
    with pytest.raises(OSError) as caught:
        tex.read_image(os.fsencode("none\udcff.png").decode(errors="surrogateescape"))
    assert caught.value.filename == caught.value.file == "none\udcff.png"


def test_io_errors_have_an_errno_if_the_disk_is_full():
    with pytest.raises(tex.IoError) as caught:
        tex.write_file("/dev/full", b"text")
    assert caught.value.errno == errno.ENOSPC and caught.value.strerror == caught.value.reason
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.errno, again.strerror, again.filename) == (errno.ENOSPC, caught.value.reason, "/dev/full")
    with pytest.raises(tex.IoError) as caught:
        tex.read_image("none.png")
    assert caught.value.errno is None and caught.value.strerror == caught.value.reason
    assert "Otherwise None" in tex.IoError.__doc__


def test_every_code_has_its_class():
    codes = {each.code for each in tex.Error.__subclasses__()}
    assert codes == {"io", "bad-data", "unsupported", "bad-option", "out-of-memory", "cancelled"}


CHILDREN = """
import multiprocessing, numpy, tex
def work(seed):
    return tex.bake(numpy.random.default_rng(seed).random((64, 64), dtype=numpy.float32)).sum()
if __name__ == "__main__":
    work(0)
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        print(len(pool.map(work, range(4))), pool.map(tex.can_compress, ["ktx2", "dds"]))
"""


def test_processes_can_be_spawned(tmp_path):
    script = tmp_path / "children.py"
    script.write_text(CHILDREN, encoding="utf-8")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout == "4 [True, False]\n", done.stderr


def test_functions_are_pickled_by_their_names():
    functions = [getattr(tex, name) for name in tex.__all__ if inspect.isroutine(getattr(tex, name))]
    assert len(functions) > 80
    for function in functions:
        assert pickle.loads(pickle.dumps(function)) is function
    texture = tex.pack(np.float32([[[0, 0, 1]]]))
    assert repr(pickle.loads(pickle.dumps(texture.__repr__))()) == repr(texture.__repr__())
