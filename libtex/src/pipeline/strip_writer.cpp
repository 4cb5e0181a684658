// SPDX-License-Identifier: Apache-2.0

#include "pipeline/strip_writer.h"

#include <utility>

#include "base/guard.h"
#include "base/pack_rows.h"
#include "containers/dds.h"
#include "containers/ktx2.h"

namespace tex {

StripWriter::StripWriter(AtomicFile file, FileLayout layout, const PackOptions& pack)
    : file_(std::move(file)), layout_(std::move(layout)), pack_(pack) {}

Result<StripWriter> StripWriter::open(const std::string& path, Container container, Extent extent, int levels,
                                      const PackOptions& pack, const WriteOptions& options) {
    const EncodingInfo encoding = encoding_info(pack.encoding);
    const TextureHead head{encoding.format, extent, levels, encoding.swizzle, true, pack.y_axis, true};
    FileLayout layout = container == Container::dds ? dds_layout(head, options) : ktx2_layout(head);
    Result<AtomicFile> file = AtomicFile::open(path, {options.sync, options.no_clobber});
    if (!file) return file.error();
    if (const Result<void> written = file->write_at(0, layout.head); !written) return written.error();
    return StripWriter(std::move(*file), std::move(layout), pack);
}

Result<void> StripWriter::write(Strip& strip) {
    return guarded([&]() -> Result<void> {
        const Format format = encoding_info(pack_.encoding).format;
        const Extent extent{strip.map.extent().width, strip.height};
        const std::size_t size = level_bytes(format, extent);
        const std::size_t stored_size = stored_level_bytes(format, extent, layout_.rearrange);
        const bool rearranged = layout_.rearrange != Rearrange::none;
        strip.bytes.resize(size + (rearranged ? stored_size : 0));
        pack_rows(strip.map, strip.height, pack_, 0, strip.height, strip.bytes.data());
        std::span<const std::byte> stored(strip.bytes.data(), size);
        if (rearranged) {
            std::byte* target = strip.bytes.data() + size;
            rearrange_texels(format, layout_.rearrange, strip.bytes.data(), size / format_info(format).block_bytes, target);
            stored = {target, stored_size};
        }
        // Strips begin with whole rows of blocks.
        const std::size_t before = stored_level_bytes(format, {extent.width, strip.first}, layout_.rearrange);
        return file_.write_at(layout_.levels[static_cast<std::size_t>(strip.level)].offset + before, stored);
    });
}

}  // namespace tex
