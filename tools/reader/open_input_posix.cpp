// SPDX-License-Identifier: Apache-2.0

#include "open_input.h"

#include "formats/reader/reader_protocol.h"

namespace tex::reader {
namespace {

constexpr char kInputPath[] = "/proc/self/fd/4";
static_assert(kInputDescriptor == 4);

}  // namespace

bool read_whole_input(std::vector<unsigned char>& bytes) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(kInputPath, "rbe"), std::fclose);
    if (!file || std::fseek(file.get(), 0, SEEK_END) != 0) return false;
    const long size = std::ftell(file.get());
    if (size <= 0 || std::fseek(file.get(), 0, SEEK_SET) != 0) return false;
    bytes.resize(static_cast<std::size_t>(size));
    return std::fread(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
}

TIFF* open_tiff_input() { return TIFFOpen(kInputPath, "rm"); }  // m: the file may change while it is mapped

Imf::MultiPartInputFile open_exr_input(std::unique_ptr<Imf::IStream>&, int threads) {
    return {kInputPath, threads, false};
}

}  // namespace tex::reader
