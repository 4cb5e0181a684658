// SPDX-License-Identifier: Apache-2.0
// output.h: the writer: pictures of normals as DDS, KTX2 and ASTC files. The pixels of all levels are kept until the
// file is closed; then it appears whole, or not at all.

#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/types.h>

#include "attributes.h"

namespace tex::oiio {

class Output final : public OIIO::ImageOutput {
public:
    Output() = default;
    ~Output() override;
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    [[nodiscard]] const char* format_name() const override;
    [[nodiscard]] int supports(OIIO::string_view feature) const override;
    bool open(const std::string& name, const OIIO::ImageSpec& spec, OpenMode mode) override;
    bool close() override;
    bool write_scanline(int y, int z, OIIO::TypeDesc format, const void* data, OIIO::stride_t xstride) override;
    bool write_tile(int x, int y, int z, OIIO::TypeDesc format, const void* data, OIIO::stride_t xstride,
                    OIIO::stride_t ystride, OIIO::stride_t zstride) override;

private:
    [[nodiscard]] Result<void> begin(const std::string& name, const OIIO::ImageSpec& spec);
    [[nodiscard]] Result<void> add_level(const OIIO::ImageSpec& spec);
    [[nodiscard]] bool has_alpha() const;
    [[nodiscard]] Result<bool> is_multiplied_by_alpha() const;
    [[nodiscard]] Result<void> finish_level();
    [[nodiscard]] Result<void> choose_channels(const OIIO::ImageSpec& spec);
    [[nodiscard]] std::vector<std::byte>& sent() { return extras_.empty() ? pixels_.levels.back().bytes : sent_; }
    void split_level();
    [[nodiscard]] Result<MipChain> levels();
    [[nodiscard]] Result<void> finish();
    [[nodiscard]] bool next_is(std::int64_t part);
    bool report(const Result<void>& done);

    bool open_ = false;
    bool failed_ = false;  // close() has not reported it yet
    std::string name_;
    Container container_ = Container::dds;
    Wanted wanted_;
    Texture pixels_;  // as they were sent, without channels that have names of their own:
    struct Sent {
        std::size_t channel;
        Extra extra;
        std::vector<Plane<float>> levels;
    };
    std::vector<Sent> extras_;
    std::vector<std::byte> sent_;  // all channels of a level, if there are extra ones
    bool multiplied_ = false;      // by alpha
    std::int64_t next_ = 0;        // the number of the scanline or tile of this level that comes next
    std::int64_t end_ = 0;         // the number of them
};

}  // namespace tex::oiio
