# SPDX-License-Identifier: Apache-2.0
"""Makes a wheel of the module tex (PEP 517), with libtex and the reader programs inside.

The libraries that libtex links (libpng, OpenEXR, oneTBB ...) are not inside: the wheel is for machines that have the
same packages. They are inside if the build is static (TEX_STATIC), as that of samples/packaging/portable.sh is: then
the wheel needs the C library alone, and its name says which versions of it will do (PEP 600).
TEX_BUILD=FOLDER packs what a build folder with TEX_PYTHON=ON holds already; TEX_NOTICES=FOLDER has the licences of what
is inside.
"""

import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MODE = 0o100755 << 16  # programs stay executable


def build():
    """The build folder, up to date."""
    if "TEX_BUILD" in os.environ:
        return Path(os.environ["TEX_BUILD"])
    folder = ROOT / "build/wheel"
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DTEX_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"]
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, *generator, *options], check=True)
    programs = ["tex-reader", "tex-reader-oiio", "tex-mesh-reader"]
    subprocess.run(["cmake", "--build", folder, "--target", "tex_python", "tex_python_stubs", *programs], check=True)
    return folder


def collect(folder, stage):
    """Installs the package into `stage`; returns its files and their names in the wheel."""
    subprocess.run(["cmake", "--install", folder, "--component", "python", "--prefix", stage], check=True,
                   stdout=sys.stderr)
    package = next(stage.rglob("_tex.*.so")).parent
    beside = [folder / name for name in ("tex-reader", "tex-reader-oiio", "tex-mesh-reader", "libtex.so.1")]
    return {f"tex/{path.name}": path for path in sorted([*package.iterdir(), *filter(Path.exists, beside)])}


def version():
    return re.search(r"project\(libtex VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)


# What PEP 600 lets a wheel expect of every system, as far as libtex needs it.
ALWAYS_THERE = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "libgcc_s.so.1", "ld-linux-x86-64.so.2"}


def platform(binaries):
    """The platform in the name of a wheel with these binaries: manylinux if they need the C library alone."""
    needed, newest = set(), 5
    for binary in binaries:
        dump = subprocess.run(["objdump", "-p", binary], check=True, capture_output=True, text=True).stdout
        needed |= set(re.findall(r"NEEDED\s+(\S+)", dump))
        newest = max([newest, *map(int, re.findall(r"\bGLIBC_2\.(\d+)", dump))])
    plain = re.sub("[-.]", "_", sysconfig.get_platform())  # linux_x86_64
    return plain if needed - ALWAYS_THERE else plain.replace("linux_", f"manylinux_2_{newest}_", 1)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    facts = f"tex-{version()}.dist-info"
    with tempfile.TemporaryDirectory() as stage:
        paths = collect(build(), Path(stage))
        files = {name: path.read_bytes() for name, path in paths.items()}
        binaries = [paths[name] for name, data in files.items() if data.startswith(b"\x7fELF")]
        tag = f"{python}-{python}-{platform(binaries)}"
    if "TEX_NOTICES" in os.environ:
        notices = Path(os.environ["TEX_NOTICES"])
        files |= {f"{facts}/licenses/{path.name}": path.read_bytes() for path in sorted(notices.iterdir())}
    files[f"{facts}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: tex\nVersion: {version()}\n"
        "Summary: Tangent-space normal maps: bake, mip, pack, check\nLicense: Apache-2.0\n"
        "Requires-Python: >=3.11\nRequires-Dist: numpy>=1.24\n"
    ).encode()
    files[f"{facts}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: libtex\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = f"{facts}/RECORD"
    rows = []
    name = f"tex-{version()}-{tag}.whl"
    with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            entry = zipfile.ZipInfo(path)  # of 1980: equal builds give equal wheels
            entry.external_attr = MODE
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            rows.append(f"{path},sha256={digest},{len(data)}\n")
        wheel.writestr(zipfile.ZipInfo(record), "".join(rows) + f"{record},,\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("the module is built in a clone of libtex")
