#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""packaging.py STAGE SCRATCH: tests samples/packaging without vcpkg, Nix's packages and Homebrew.

The three descriptions of the package are evaluated with stand-ins for what these systems bring. Their dependencies must
be those that CMake asks for, and their own tests must pass with STAGE, where libtex is installed.
"""
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PACKAGING = ROOT / "samples/packaging"


class Dependency(NamedTuple):
    cmake: str  # in find_package() or pkg_check_modules(); none for headers that every compiler finds
    debian: str
    vcpkg: str  # none if vcpkg has no such port, or if the library does not need it
    nix: str
    homebrew: str  # none if Homebrew has no such formula


LIBRARY = [
    Dependency("PNG", "libpng-dev", "libpng", "libpng", "libpng"),
    Dependency("OpenEXR", "libopenexr-dev", "openexr", "openexr", "openexr"),
    Dependency("TBB", "libtbb-dev", "tbb", "onetbb", "tbb"),
    Dependency("hwy", "libhwy-dev", "highway", "libhwy", "highway"),
    Dependency("nlohmann_json", "nlohmann-json3-dev", "nlohmann-json", "nlohmann_json", "nlohmann-json"),
    Dependency("OpenColorIO", "libopencolorio-dev", "opencolorio", "opencolorio", "opencolorio"),
    Dependency("libdeflate", "libdeflate-dev", "libdeflate", "libdeflate", "libdeflate"),
    Dependency("libisal", "libisal-dev", "isal", "isa-l", "isa-l"),
    Dependency("libzstd", "libzstd-dev", "zstd", "zstd", "zstd"),
]
COMMANDS = [
    Dependency("fmt", "libfmt-dev", "", "fmt", "fmt"),
    Dependency("TIFF", "libtiff-dev", "", "libtiff", "libtiff"),
    Dependency("JPEG", "libjpeg62-turbo-dev", "", "libjpeg", "jpeg-turbo"),
    Dependency("libwebp", "libwebp-dev", "", "libwebp", "webp"),
    Dependency("OpenImageIO", "libopenimageio-dev", "", "openimageio", "openimageio"),
    Dependency("libseccomp", "libseccomp-dev", "", "libseccomp", "libseccomp"),
    Dependency("assimp", "libassimp-dev", "", "assimp", "assimp"),
    Dependency("draco", "libdraco-dev", "", "draco", "draco"),
    Dependency("", "libtomlplusplus-dev", "", "tomlplusplus", "tomlplusplus"),
]

failures = 0


def check(passed: bool, why: str) -> None:
    global failures
    if not passed:
        failures += 1
        print(f"packaging.py: {why}", file=sys.stderr)


def same(what: str, found, wanted) -> None:
    """Reports the difference between two lists; their order does not count."""
    found, wanted = sorted(found), sorted(wanted)
    check(found == wanted, f"{what}: only here {set(found) - set(wanted)}, missing {set(wanted) - set(found)}")


def run(*words, **how) -> str:
    """What a program prints. The test ends if it fails."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **how)
    if done.returncode != 0:
        sys.exit(f"packaging.py: {words[0]} fails:\n{done.stdout}{done.stderr}")
    return done.stdout


def column(name: str, *tables) -> list[str]:
    return [getattr(row, name) for table in tables for row in table if getattr(row, name)]


CMAKE = (ROOT / "CMakeLists.txt").read_text()
VERSION = re.search(r"^project\(libtex VERSION (\S+)", CMAKE, re.M)[1]
OPTIONS = set(re.findall(r"\boption\((\w+)", CMAKE))
INSTALLED = (ROOT / "tests/consumer/manifest.txt").read_text().split()
PROGRAMS = [path.removeprefix("bin/") for path in INSTALLED if path.startswith("bin/")]


def options_exist(system: str, words) -> None:
    """Each -DTEX_... and -DBUILD_... is an option of libtex."""
    named = [found[1] for word in words if (found := re.match(r"-D((?:TEX|BUILD)_\w+)=(?:ON|OFF)$", word))]
    check(bool(named), f"{system} sets no option of libtex")
    for name in named:
        check(name in OPTIONS, f"{system} sets {name}, which is no option of libtex")


def test_table() -> None:
    """The table above has what CMakeLists.txt asks for and what .ci/packages.sh installs."""
    library, rest = CMAKE.split("# -- the library ---")[1].split("# -- the commands ---", 1)
    library = re.sub(r"^if\(WIN32.*?^endif\(\)$", "", library, flags=re.M | re.S)  # there, decoders are in the library
    asked = r"(?:find_package\(|find_library\(\w+ |pkg_check_modules\(\w+ REQUIRED IMPORTED_TARGET )(\w+)"
    same("packages that CMake finds for the library", re.findall(asked, library),
         column("cmake", LIBRARY) + ["PkgConfig"])
    same("packages that CMake finds for the commands", re.findall(asked, rest.split("# -- the Python module")[0]),
         column("cmake", COMMANDS))
    listed = re.search(r"^build_packages=\((.*?)\)", (ROOT / ".ci/packages.sh").read_text(), re.M | re.S)[1].split()
    same(".ci/packages.sh", listed, column("debian", LIBRARY, COMMANDS) + ["g++", "cmake", "ninja-build", "pkg-config"])


def test_vcpkg(stage: Path, scratch: Path) -> None:
    port = PACKAGING / "vcpkg/libtex"
    try:
        manifest = json.loads((port / "vcpkg.json").read_text())
    except json.JSONDecodeError as error:
        return check(False, f"vcpkg.json is not JSON: {error}")
    # What vcpkg demands of a manifest: a name, one version, known fields, dependencies with names, sorted.
    known = {"name", "version-semver", "description", "license", "supports", "dependencies"}
    same("fields of vcpkg.json", manifest, known)
    check(manifest["name"] == port.name, "vcpkg.json and its folder have different names")
    check(manifest["version-semver"] == VERSION, f"vcpkg.json is about {manifest['version-semver']}, not {VERSION}")
    names = [one if isinstance(one, str) else one["name"] for one in manifest["dependencies"]]
    check(names == sorted(names), "vcpkg.json: the dependencies are not sorted")
    for name in names:
        check(re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", name) is not None, f"vcpkg.json: {name} cannot be a port")
    host = [one["name"] for one in manifest["dependencies"] if isinstance(one, dict) and one == {**one, "host": True}]
    same("tools of vcpkg.json", host, ["vcpkg-cmake", "vcpkg-cmake-config"])
    same("ports of vcpkg.json", [name for name in names if name not in host], column("vcpkg", LIBRARY))

    packages, calls = scratch / "vcpkg", scratch / "calls.txt"
    run("cmake", "-D", f"STAGE={stage}", "-D", f"CURRENT_PACKAGES_DIR={packages}", "-D", f"CALLS={calls}",
        "-D", f"PORT_DIR={port}", "-P", HERE / "vcpkg.cmake")
    configure = next(line.split(";") for line in calls.read_text().splitlines() if "configure" in line)
    check(configure[configure.index("SOURCE_PATH") + 1] == str(ROOT), f"the port does not build {ROOT}: {configure}")
    options_exist("portfile.cmake", configure)
    for path in ["include/tex/tex.h", "lib/pkgconfig/libtex.pc", "debug/lib/libtex.so", "share/libtex/copyright",
                 "share/libtex/libtex-config.cmake", "share/libtex/usage"]:
        check((packages / path).exists(), f"the port does not leave {path}")
    for path in ["debug/include", "debug/share", "share/doc"]:
        check(not (packages / path).exists(), f"the port leaves {path}")
    # The project that tests find_package() is written as the text of the port says, but names a version.
    project = (ROOT / "tests/consumer/project/CMakeLists.txt").read_text()
    project = re.sub(r"\(libtex [0-9.]+ ", "(libtex ", project)
    for words in ["find_package(libtex CONFIG REQUIRED)", "libtex::tex)"]:
        check(words in (port / "usage").read_text() and words in project, f"usage and tests/consumer differ: {words}")


def test_nix(stage: Path) -> None:
    file = PACKAGING / "nix/default.nix"
    evaluate = ["nix-instantiate", "--store", "dummy://", "--eval", "--strict", "--json", HERE / "evaluate.nix",
                "--arg", "file", file]
    declared = json.loads(run(*evaluate))
    check(declared["version"] == VERSION, f"default.nix is about {declared['version']}, not {VERSION}")
    same("buildInputs of default.nix", declared["buildInputs"], column("nix", LIBRARY, COMMANDS))
    same("nativeBuildInputs of default.nix", declared["nativeBuildInputs"], ["cmake", "ninja", "pkg-config"])
    check(declared["src"] == {"folder": str(ROOT), "kept": ["libtex", "tools"]}, f"default.nix: {declared['src']}")
    options_exist("default.nix", declared["cmakeFlags"])
    looped = re.search(r"for command in (.*); do", declared["installCheckPhase"])[1].split()
    same("commands of default.nix", looped, PROGRAMS)
    run("bash", "-euo", "pipefail", "-c", declared["installCheckPhase"], env={**os.environ, "out": str(stage)})


def test_homebrew(stage: Path, scratch: Path) -> None:
    clean = {name: value for name, value in os.environ.items() if not name.startswith("HOMEBREW_")}
    words = ["ruby", HERE / "formula.rb", PACKAGING / "homebrew/libtex.rb", stage, scratch, ROOT / "samples/bricks.png"]
    declared = json.loads(run(*words, env={**clean, "HOMEBREW_LIBTEX_SOURCE": str(ROOT)}).splitlines()[-1])
    check(declared["head"] == [f"file://{ROOT}", {"using": "git", "branch": "main"}], f"libtex.rb: {declared['head']}")
    same("libtex.rb", declared["dependencies"],
         column("homebrew", LIBRARY, COMMANDS) + ["cmake", "ninja", "pkgconf", "linux"])
    same("commands of libtex.rb", declared["commands"], PROGRAMS)
    options_exist("libtex.rb", declared["started"][0])
    check(f'"{VERSION}"' in (PACKAGING / "homebrew/libtex.rb").read_text(), f"libtex.rb does not test for {VERSION}")


def main() -> int:
    stage, scratch = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    for program in ["nix-instantiate", "ruby"]:
        if not shutil.which(program):
            sys.exit(f"packaging.py: {program} is not installed. Install the Debian packages nix-bin and ruby.")
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    scratch = scratch.resolve()
    test_table()
    test_vcpkg(stage, scratch)
    test_nix(stage)
    test_homebrew(stage, scratch)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
