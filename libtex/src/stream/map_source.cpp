// SPDX-License-Identifier: Apache-2.0

#include "stream/map_source.h"

#include <utility>

#include "formats/picture.h"
#include "stream/source_stage.h"

namespace tex::inline v1 {

// A stream is read into memory, because the map may have to be read twice.
Result<void> FileMap::open_file() {
    if (file_ == nullptr) {
        Result<InputFile> file = open_input(path_, options_);
        if (!file) return file.error();
        own_.emplace(std::move(*file));
        file_ = &*own_;
    }
    if (!was_opened_) {
        was_opened_ = true;
        return file_->settle(largest_file(options_));
    }
    texture_.reset();
    return file_->rewind();
}

Result<void> FileMap::open() {
    if (Result<void> opened = open_file(); !opened) return opened;
    Result<TextureRows> texture = open_texture_rows(*file_, options_);
    if (!texture) return texture.error();
    texture_ = std::move(*texture);
    if (extent_.value_or(extent(0)) != extent(0)) return Error{ErrorCode::io, path_, "changed while it was read"};
    extent_ = extent(0);
    return {};
}

StoredChannels FileMap::add_to(Flow& flow, int level, const std::vector<bool>& wanted) {
    RowSource& source = rows(level);
    std::vector<bool> planes(source.names().size(), false);
    for (std::size_t c = 0; c < texture_->planes.size(); ++c) {
        if (wanted[c]) planes[texture_->planes[c]] = true;
    }
    source.choose_planes(planes);
    return {&add_source(flow, source, path_), texture_->planes, texture_->rounds};
}

Result<void> FileMap::look(const TakeChannels& take) {
    Plane<float> rounded;
    if (texture_->rounds) rounded = Plane<float>(Extent{extent(0).width, 4});
    bool is_enough = false;
    const Result<void> seen = rows(0).visit(path_, [&](const Image& image, int, int count) -> Result<void> {
        for (int k = 0; k < count; ++k) {
            const float* channels[4] = {};
            for (std::size_t c = 0; c < texture_->planes.size(); ++c) {
                channels[c] = image.planes[texture_->planes[c]].row(k);
                if (!texture_->rounds) continue;
                float* const row = rounded.row(static_cast<int>(c));
                round_to_texels(channels[c], extent(0).width, row);
                channels[c] = row;
            }
            is_enough = !take(channels);
            if (is_enough) return Error{ErrorCode::cancelled, {}, {}};  // ends the visit
        }
        return {};
    });
    return is_enough ? Result<void>() : seen;
}

Result<Texture> FileMap::read(bool base_only, const Execution&) {
    if (Result<void> opened = open_file(); !opened) return opened.error();
    Result<Texture> texture = read_texture(*file_, options_);
    if (texture && base_only) texture->levels.resize(1);
    return texture;
}

Error FileMap::after_all_rows(const Error& error) { return tex::after_all_rows(rows(0), path_, error); }

}  // namespace tex::inline v1
