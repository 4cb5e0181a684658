#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What is inside the portable archive, the one for Windows or the npm package: an SPDX 2.3 document, and the licence of each part.

Reads what the linker took from which static library (--trace), and ends with an error if it took something that the
table below does not have.
"""

import argparse
import datetime
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple


class Part(NamedTuple):
    licence: str  # an SPDX expression of what is linked, not of the tools and tests beside it
    libraries: str = ""  # names of static libraries, without lib and .a; none: headers, which are always inside
    package: str = ""  # the Debian package whose file is linked; none: portable/libraries.sh built it


GCC = "GPL-3.0-or-later WITH GCC-exception-3.1"
PARTS = {  # by the name of the Debian source package
    "glibc": Part("LGPL-2.1-or-later", "c c_nonshared m pthread dl rt mvec m-2.36 crt", "libc6-dev"),
    "gcc-12": Part(GCC, "stdc++ gcc gcc_eh gcc_s atomic", "libgcc-12-dev"),
    "libpng1.6": Part("libpng-2.0", "png png16"),
    "zlib": Part("Zlib", "z", "zlib1g-dev"),
    "libdeflate": Part("MIT", "deflate", "libdeflate-dev"),
    "libzstd": Part("BSD-3-Clause", "zstd", "libzstd-dev"),
    "libjpeg-turbo": Part("IJG AND BSD-3-Clause AND Zlib", "jpeg", "libjpeg62-turbo-dev"),
    "libseccomp": Part("LGPL-2.1-only", "seccomp", "libseccomp-dev"),
    "xz-utils": Part("LicenseRef-public-domain", "lzma", "liblzma-dev"),
    "libwebp": Part("BSD-3-Clause", "webp", "libwebp-dev"),
    "lerc": Part("Apache-2.0", "Lerc", "liblerc-dev"),
    "expat": Part("MIT", "expat", "libexpat1-dev"),
    "nlohmann-json3": Part("MIT", "", "nlohmann-json3-dev"),
    "tomlplusplus": Part("MIT", "", "libtomlplusplus-dev"),
    "imath": Part("BSD-3-Clause", "Imath-3_1 Imath"),
    "openexr": Part("BSD-3-Clause", "OpenEXR-3_1 OpenEXR OpenEXRCore-3_1 OpenEXRCore Iex-3_1 Iex IlmThread-3_1 IlmThread"),
    "libisal": Part("BSD-3-Clause", "isal"),
    "onetbb": Part("Apache-2.0", "tbb"),
    "highway": Part("Apache-2.0", "hwy"),
    "fmtlib": Part("MIT", "fmt"),
    "tiff": Part("libtiff", "tiff"),
    "yaml-cpp": Part("MIT", "yaml-cpp"),
    "opencolorio": Part("BSD-3-Clause", "OpenColorIO"),
    "pystring": Part("BSD-3-Clause", "pystring"),
}
# The archive for Windows: what portable/libraries.sh builds has no package there, either.
WINDOWS = {name: part._replace(package="") for name, part in PARTS.items()
           if name not in ("glibc", "gcc-12", "zlib", "nlohmann-json3", "tomlplusplus")}
WINDOWS |= {
    "nlohmann-json3": PARTS["nlohmann-json3"],
    "tomlplusplus": PARTS["tomlplusplus"],
    "gcc-mingw-w64": Part(GCC, "stdc++ gcc gcc_eh", "gcc-mingw-w64-x86-64-posix-runtime"),
    "mingw-w64": Part("ZPL-2.1 AND MIT AND LicenseRef-public-domain",
                      "mingw32 mingwex moldname msvcrt m pthread kernel32 user32 advapi32 shell32", "mingw-w64-x86-64-dev"),
    "onetbb": Part("Apache-2.0", "tbb12"),
    "libz-mingw-w64": Part("Zlib", "z", "libz-mingw-w64-dev"),
}
# The npm package: everything but the C library and what the compiler adds is built by npm/libraries.sh.
WASM = {name: PARTS[name]._replace(package="") for name in
        ("libpng1.6", "zlib", "libdeflate", "libzstd", "imath", "openexr", "libisal", "highway")}
WASM |= {
    "nlohmann-json3": PARTS["nlohmann-json3"],
    "tomlplusplus": PARTS["tomlplusplus"],
    "fmtlib": Part("MIT", "", "libfmt-dev"),
    "llvm-toolchain-19": Part("Apache-2.0 WITH LLVM-exception", "c++ c++abi clang_rt.builtins-wasm32",
                              "libclang-rt-19-dev-wasm32"),
    "wasi-libc": Part("Apache-2.0 WITH LLVM-exception AND MIT AND BSD-2-Clause AND CC0-1.0",
                      "c m wasi-emulated-signal wasi-emulated-mman wasi-emulated-process-clocks wasi-emulated-getpid",
                      "wasi-libc"),
}
OWN = {"tex", "tex_cli", "libtex-commands.dll"}


def linked(trace: Path) -> set[str]:
    """The names of the static libraries from which the linker took something."""
    names = set(re.findall(r"\((?:[^()\s]*/)?lib([^()/\s]+)\.a\)", trace.read_text()))
    names |= set(re.findall(r"^(?:\S*/)?lib([^()/\s]+)\.a\b", trace.read_text(), re.M))
    if not names:
        sys.exit(f"inventory.py: {trace} shows no static library")
    return names


def source_folder(sources: Path, name: str) -> Path:
    return next(path for path in sources.iterdir() if path.is_dir() and path.name.lower().startswith(name + "-"))


def version_of(name: str, part: Part, sources: Path) -> str:
    if part.package:
        asked = ["dpkg-query", "-W", "-f", "${source:Version}", part.package]
        return subprocess.run(asked, check=True, capture_output=True, text=True).stdout
    recipe = next(iter(sorted(sources.glob(f"{name}_*.dsc"))), None)
    if recipe is not None:
        return re.search(r"^Version: (\S+)", recipe.read_text(), re.M)[1]
    return re.search(r"_(.+)\.orig\.tar", next(sources.glob(f"{name}_*.orig.tar.*")).name)[1]


def copy_licence(name: str, part: Part, sources: Path, to: Path) -> None:
    if part.package:
        candidates = [Path("/usr/share/doc") / part.package / "copyright"]
    else:
        folder = source_folder(sources, name)
        candidates = [folder / file for file in ("debian/copyright", "LICENSE", "LICENSE.txt", "LICENSE.md")]
    shutil.copyfile(next(path for path in candidates if path.is_file()), to / f"{name}.txt")


def identifier(name: str) -> str:
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def package(name: str, version: str, licence: str, source: str) -> dict:
    return {"SPDXID": identifier(name), "name": name, "versionInfo": version, "downloadLocation": source,
            "filesAnalyzed": False, "licenseConcluded": licence, "licenseDeclared": licence,
            "copyrightText": "NOASSERTION"}


def main() -> None:
    reader = argparse.ArgumentParser()
    reader.add_argument("--system", default="linux-x86_64",
                        choices=("linux-x86_64", "linux-aarch64", "windows-x86_64", "wasm32"))
    for option in ("version", "date"):
        reader.add_argument("--" + option, required=True)
    for option in ("sources", "trace", "out"):
        reader.add_argument("--" + option, type=Path, required=True)
    given = reader.parse_args()

    parts = {"windows-x86_64": WINDOWS, "wasm32": WASM}.get(given.system, PARTS)
    names = linked(given.trace)
    known = set(OWN).union(*(part.libraries.split() for part in parts.values()))
    if unknown := names - known:
        sys.exit(f"inventory.py: linked, but not in the table: {', '.join(sorted(unknown))}")

    licences = given.out / "licences"
    licences.mkdir()
    whole = f"libtex-{given.version}-{given.system}"
    packages = [package("libtex", given.version, "Apache-2.0", "NOASSERTION")]
    for name, part in parts.items():
        if part.libraries and not names.intersection(part.libraries.split()):
            continue
        version = version_of(name, part, given.sources)
        pool = f"http://deb.debian.org/debian/pool/main/{name[:4] if name.startswith('lib') else name[0]}/{name}/"
        packages.append(package(name, version, part.licence, pool))
        copy_licence(name, part, given.sources, licences)
    for text in ("Apache-2.0", "GPL-3", "LGPL-2.1"):  # to which the licences above refer
        shutil.copyfile(Path("/usr/share/common-licenses") / text, licences / f"{text}.txt")
    when = datetime.datetime.fromtimestamp(int(given.date), datetime.timezone.utc)
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": whole,
        "documentNamespace": f"https://spdx.org/spdxdocs/{whole}-{given.date}",
        "creationInfo": {"created": when.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: libtex-portable.sh"]},
        "packages": packages,
        "relationships": [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                           "relatedSpdxElement": "SPDXRef-libtex"}]
        + [{"spdxElementId": "SPDXRef-libtex", "relationshipType": "STATIC_LINK", "relatedSpdxElement": one["SPDXID"]}
           for one in packages[1:]],
        "hasExtractedLicensingInfos": [{"licenseId": "LicenseRef-public-domain",
                                        "extractedText": "In the public domain: liblzma, and parts of the runtime of mingw-w64."}],
    }
    (given.out / "libtex.spdx.json").write_text(json.dumps(document, indent=1) + "\n")


main()
