// SPDX-License-Identifier: Apache-2.0

#include "stream/map_file.h"

#include <utility>
#include <vector>

#include "stream/filled_map.h"
#include "stream/measured_y.h"
#include "stream/normal_source.h"
#include "stream/row_stream.h"
#include "stream/source_layout.h"

namespace tex {

Result<void> MapFile::open_texture() {
    Result<TextureRows> opened = made_ != nullptr ? made_->open() : open_texture_rows(*file_, options_.read);
    if (options_.fill_background) opened = fill_background(std::move(opened), options_, {});
    if (!opened) return opened.error().of(path_);
    texture_ = std::move(*opened);
    return {};
}

Result<void> MapFile::measure_y(MapSource& map) {
    if (!options_.measure_y) return {};
    Result<SourceOptions> measured = with_measured_y(map, options_);
    if (!measured) return measured.error();
    options_.unpack.y_axis = measured->unpack.y_axis;
    options_.measure_y = options_.file_y_first = false;
    return {};
}

// A stream is read into memory, because the map may have to be read as a whole, or twice.
Result<void> MapFile::open() {
    if (made_ != nullptr) {
        if (Result<void> measured = measure_y(*made_); !measured) return measured;
        return open_texture();
    }
    Result<InputFile> file = InputFile::open(path_);
    if (!file) return file.error();
    file_.emplace(std::move(*file));
    if (Result<void> settled = file_->settle(largest_file(options_.read)); !settled) return settled;
    if (options_.measure_y) {
        OpenFileMap map(*file_, options_.read);
        if (Result<void> measured = measure_y(map); !measured) return measured;
        if (Result<void> again = file_->rewind(); !again) return again;
    }
    return open_texture();
}

Result<void> MapFile::hold(bool base_only, const Execution& execution) {
    texture_.reset();
    if (made_ != nullptr) {
        Result<Source> source = read_normals(*made_, options_, base_only, execution);
        if (!source) return source.error();
        chain_ = std::move(source->chain);
        info_ = std::move(source->info);
        return {};
    }
    if (!file_) {
        Result<InputFile> file = InputFile::open(path_);
        if (!file) return file.error();
        file_.emplace(std::move(*file));
    } else if (Result<void> again = file_->rewind(); !again) {
        return again;
    }
    Result<Source> source = read_normals(*file_, options_, base_only, execution);
    file_.reset();
    if (!source) return source.error();
    chain_ = std::move(source->chain);
    info_ = std::move(source->info);
    return {};
}

Result<void> MapFile::prepare() {
    const auto fails = [this](const Error& error) { return after_all_rows(*rows(), path_, error.of(path_)); };
    const Texture& head = texture_->head;
    if (const Result<void> fit = check_channels(head); !fit) return fails(fit.error());
    finder_.emplace(*texture_, options_, known_);
    const FormatInfo format = format_info(head.format);
    const Result<Sources> sources = sources_of(finder_->layout().swizzle, (1u << format.channels) - 1);
    if (!sources) return fails(sources.error());
    sources_ = *sources;
    info_ = source_info(head, finder_->layout().swizzle, options_);
    rule_ = rule_of(unpack_options(info_, options_), format.sample, format.bits, info_.y_axis);
    rule_.is_unsigned = finder_->layout().is_unsigned;
    if (finder() != nullptr) return {};
    std::vector<bool> wanted(rows()->names().size(), false);
    for (const int c : {sources_.x, sources_.y, sources_.z}) {
        if (c >= 0) wanted[texture_->planes[static_cast<std::size_t>(c)]] = true;
    }
    rows()->choose_planes(wanted);
    return {};
}

bool MapFile::was_right() {
    const std::optional<KnownLayout> correction = finder() == nullptr ? std::nullopt : finder_->correction();
    if (correction) known_ = *correction;
    return !correction;
}

Result<void> MapFile::open_again() {
    const Extent extent = rows()->extent();
    finder_.reset();
    texture_.reset();
    if (file_) {
        if (Result<void> again = file_->rewind(); !again) return again;
    }
    if (Result<void> opened = open_texture(); !opened) return opened;
    if (texture_ && rows()->extent() == extent) return {};
    return Error{ErrorCode::io, path_, "changed while it was read"};
}

Result<void> MapFile::settle_layout() {
    while (true) {
        if (Result<void> ready = prepare(); !ready) return ready;
        LayoutFinder* const open = finder();
        if (open == nullptr) return {};
        Result<void> seen = rows()->visit(path_, [&](const Image& image, int, int count) {
            for (int k = 0; k < count; ++k) {
                const float* channels[4] = {};
                for (std::size_t c = 0; c < texture_->planes.size(); ++c)
                    channels[c] = image.planes[texture_->planes[c]].row(k);
                open->add_row(channels);
            }
            return Result<void>();
        });
        if (!seen) return seen;
        const bool right = was_right();
        if (Result<void> again = open_again(); !again) return again;
        if (right) return prepare();
    }
}

}  // namespace tex
