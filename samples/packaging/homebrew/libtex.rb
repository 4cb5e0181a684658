# SPDX-License-Identifier: Apache-2.0
# The library and the commands, for Homebrew on Linux, built from the clone that HOMEBREW_LIBTEX_SOURCE names.
class Libtex < Formula
  desc "Tangent-space normal maps: bake, mip, pack, check"
  license "Apache-2.0"
  # There is no release to download, so there is no stable version: brew install --HEAD.
  head "file://#{ENV.fetch("HOMEBREW_LIBTEX_SOURCE", "/set/HOMEBREW_LIBTEX_SOURCE/to/your/clone")}",
       using: :git, branch: "main"

  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "pkgconf" => :build
  depends_on "tomlplusplus" => :build
  depends_on "assimp"
  depends_on "draco"
  depends_on "fmt"
  depends_on "highway"
  depends_on "isa-l"
  depends_on "jpeg-turbo"
  depends_on "libdeflate"
  depends_on "libpng"
  depends_on "libseccomp"
  depends_on "libtiff"
  depends_on :linux
  depends_on "opencolorio"
  depends_on "openexr"
  depends_on "openimageio"
  depends_on "tbb"
  depends_on "webp"
  depends_on "zstd"

  COMMANDS = %w[
    bake-normals blend-normals build-normals check-normals compare-normals convert-normals integrate-normals
    mip-normals pack-normals preview-normals repair-normals scale-normals transfer-normals unpack-normals
  ].freeze
  FILES = %w[
    include/tex/tex.h lib/libtex.so lib/pkgconfig/libtex.pc libexec/libtex/tex-reader
    libexec/libtex/tex-reader-oiio libexec/libtex/tex-mesh-reader share/man/man7/normal-maps.7
  ].freeze

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DBUILD_TESTING=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    COMMANDS.each { |command| assert_match "1.0.0", shell_output("#{bin}/#{command} --version") }
    FILES.each { |file| assert_path_exists prefix/file }
    system bin/"bake-normals", test_fixtures("test.png"), "-o", "normals.dds"
    assert_path_exists testpath/"normals.dds"
  end
end
