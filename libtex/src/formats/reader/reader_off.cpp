// SPDX-License-Identifier: Apache-2.0
// Replaces the other sources of this folder in a build without the reader programs (TEX_READER=OFF): whatever needs one
// is unsupported.

#include "formats/reader/reader.h"
#include "formats/reader/reader_mesh.h"
#include "formats/reader/reader_rows.h"

namespace tex::inline v1 {
namespace {

Error no_reader(const std::string& path = {}) {
    return {ErrorCode::unsupported, path, "needs tex-reader; this libtex was built without it (TEX_READER=OFF)"};
}

}  // namespace

Result<ReaderInfo> reader_info(const ReadOptions&) { return no_reader(); }

Result<InputFile> decode_with_reader(InputFile& file, const std::string&, const ReadOptions&) {
    return no_reader(file.path());
}

Result<std::unique_ptr<RowSource>> open_reader_rows(InputFile& file, const ReadOptions&) {
    return no_reader(file.path());
}

Result<std::vector<std::byte>> read_with_mesh_reader(const std::string& path, std::span<const std::byte>,
                                                     const ReadOptions&) {
    return no_reader(path);
}

Result<std::vector<std::byte>> decode_draco_with_reader(const std::string& path, std::span<const std::byte>,
                                                        const ReadOptions&) {
    return no_reader(path);
}

Result<ReaderPicture> ReaderPicture::open(Container, const TextureHead&, const WriteOptions&) { return no_reader(); }
Result<void> ReaderPicture::put(int, std::span<const std::byte>) const { return no_reader(); }
Result<std::vector<std::byte>> ReaderPicture::encode() const { return no_reader(); }

Result<std::vector<std::byte>> encode_with_reader(const Texture&, Container, const WriteOptions&) {
    return no_reader();
}

}  // namespace tex::inline v1
