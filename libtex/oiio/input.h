// SPDX-License-Identifier: Apache-2.0
// input.h: the reader: DDS, KTX2 and ASTC files as pictures of OpenImageIO, with their levels as MIP levels.

#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <string>
#include <vector>

#include <tex/format.h>
#include <tex/pack.h>
#include <tex/types.h>

namespace tex::oiio {

// A file is held as it is stored; of its pixels, those of the level that was read last.
class Input final : public OIIO::ImageInput {
public:
    [[nodiscard]] const char* format_name() const override;
    [[nodiscard]] int supports(OIIO::string_view feature) const override;
    [[nodiscard]] bool valid_file(const std::string& name) const override;
    bool open(const std::string& name, OIIO::ImageSpec& spec) override;
    bool open(const std::string& name, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) override;
    bool close() override;
    [[nodiscard]] int current_miplevel() const override { return level_; }
    bool seek_subimage(int subimage, int level) override;
    bool read_native_scanline(int subimage, int level, int y, int z, void* data) override;

private:
    // What the pixels are.
    enum class Pixels {
        stored,    // the bytes of the file
        channels,  // the channels of decoded blocks, as floats
        normals,   // normals as colours of 16 bits
        floats,    // the same as floats, of files that hold floats
    };

    [[nodiscard]] Result<void> load(const std::string& name, const OIIO::ImageSpec& config);
    [[nodiscard]] Result<void> make_pixels();
    [[nodiscard]] Result<void> make_channels();
    [[nodiscard]] Result<void> make_normals();
    [[nodiscard]] Result<NormalMap> unpacked(int level) const;
    [[nodiscard]] Result<void> find_extras(bool has_lengths);
    [[nodiscard]] OIIO::TypeDesc type() const;

    mutable bool named_ = false;  // by its name with the suffix .tex: see supports()
    std::string path_;
    Texture texture_;
    Pixels what_ = Pixels::stored;
    ExtraSet extras_;  // the data beside the normals, which are further channels
    int level_ = 0;
    std::vector<std::byte> pixels_;  // of level made_, rows from the top, unless they are the stored ones
    int made_ = -1;
};

}  // namespace tex::oiio
