# SPDX-License-Identifier: Apache-2.0
# The library and the commands, built from the clone in which this file lies:
#
#   with import <nixpkgs> { }; callPackage ./samples/packaging/nix { }
{
  lib,
  stdenv,
  cmake,
  ninja,
  pkg-config,
  assimp,
  draco,
  fmt,
  isa-l,
  libdeflate,
  libhwy,
  libjpeg,
  libpng,
  libseccomp,
  libtiff,
  libwebp,
  nlohmann_json,
  onetbb,
  opencolorio,
  openexr,
  openimageio,
  tomlplusplus,
  zstd,
}:

let
  version = "1.0.0";
  commands = [
    "bake-normals"
    "blend-normals"
    "build-normals"
    "check-normals"
    "compare-normals"
    "convert-normals"
    "integrate-normals"
    "mip-normals"
    "pack-normals"
    "preview-normals"
    "repair-normals"
    "scale-normals"
    "transfer-normals"
    "unpack-normals"
  ];
in
stdenv.mkDerivation {
  pname = "libtex";
  inherit version;

  # The clone without .git and the folder in which CMake builds.
  src = lib.cleanSourceWith {
    src = lib.cleanSource ../../..;
    filter = path: type: type != "directory" || baseNameOf path != "build";
  };

  nativeBuildInputs = [
    cmake
    ninja
    pkg-config
  ];
  buildInputs = [
    assimp
    draco
    fmt
    isa-l
    libdeflate
    libhwy
    libjpeg
    libpng
    libseccomp
    libtiff
    libwebp
    nlohmann_json
    onetbb
    opencolorio
    openexr
    openimageio
    tomlplusplus
    zstd
  ];
  cmakeFlags = [ "-DBUILD_TESTING=OFF" ];

  doInstallCheck = true;
  installCheckPhase = ''
    for command in ${toString commands}; do
      "$out/bin/$command" --version | grep -F ${version}
    done
    for file in include/tex/tex.h lib/libtex.so lib/pkgconfig/libtex.pc libexec/libtex/tex-reader \
      libexec/libtex/tex-reader-oiio libexec/libtex/tex-mesh-reader share/man/man7/normal-maps.7*; do
      ls "$out"/$file
    done
  '';

  meta = {
    description = "Tangent-space normal maps: bake, mip, pack, check";
    license = lib.licenses.asl20;
    platforms = lib.platforms.linux;
    mainProgram = "bake-normals";
  };
}
