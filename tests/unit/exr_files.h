// SPDX-License-Identifier: Apache-2.0
// exr_files.h: EXR files written by OpenEXR, for tests.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <tex/types.h>

namespace tex {

class ExrSink final : public Imf::OStream {
public:
    explicit ExrSink(std::vector<std::byte>& bytes) : Imf::OStream(""), bytes_(bytes) {}
    void write(const char data[], int n) override {
        bytes_.resize(std::max(bytes_.size(), at_ + static_cast<std::size_t>(n)));
        std::memcpy(bytes_.data() + at_, data, static_cast<std::size_t>(n));
        at_ += static_cast<std::size_t>(n);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }

private:
    std::vector<std::byte>& bytes_;
    std::size_t at_ = 0;
};

inline float exr_value(int i, int j, int c) {
    return static_cast<float>(i * 3 - j * 5 + c * 7) / 16.0f;
}  // exact as half

// A file written by OpenEXR: channels of one type, and a data window that begins at (-3, 5).
inline std::vector<std::byte> exr_file(Extent extent, const std::vector<std::string>& names, Imf::PixelType type,
                                       Imf::Compression compression, bool tiled = false,
                                       Imf::LineOrder order = Imf::DECREASING_Y) {
    const Imath::Box2i window({-3, 5}, {-3 + extent.width - 1, 5 + extent.height - 1});
    Imf::Header header(window, window, 1.0f, {0, 0}, 1.0f, order, compression);
    Imf::FrameBuffer buffer;
    std::vector<std::vector<float>> floats(names.size());
    std::vector<std::vector<std::uint32_t>> integers(names.size());
    std::vector<std::vector<Imath::half>> halves(names.size());
    for (std::size_t c = 0; c < names.size(); ++c) {
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) {
                floats[c].push_back(exr_value(i, j, static_cast<int>(c)));
                halves[c].push_back(Imath::half(floats[c].back()));
                integers[c].push_back(static_cast<std::uint32_t>(i) * 123456789u + static_cast<std::uint32_t>(j));
            }
        }
        const std::size_t size = type == Imf::HALF ? 2 : 4;
        void* base = floats[c].data();
        if (type == Imf::HALF) base = halves[c].data();
        if (type == Imf::UINT) base = integers[c].data();
        header.channels().insert(names[c], Imf::Channel(type));
        buffer.insert(names[c],
                      Imf::Slice::Make(type, base, window, size, size * static_cast<std::size_t>(extent.width)));
    }
    std::vector<std::byte> bytes;
    ExrSink sink(bytes);
    if (tiled) {
        header.lineOrder() = Imf::INCREASING_Y;
        header.setTileDescription(Imf::TileDescription(16, 8, Imf::ONE_LEVEL));
        Imf::TiledOutputFile file(sink, header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(sink, header);
        file.setFrameBuffer(buffer);
        file.writePixels(extent.height);
    }
    return bytes;
}

}  // namespace tex
