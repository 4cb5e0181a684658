// SPDX-License-Identifier: Apache-2.0
// map_file.h: a map of normals that is read row by row or held in memory as a whole: a file, or another source.

#pragma once

#include <memory>
#include <optional>
#include <string>

#include <tex/source.h>

#include "files/input_file.h"
#include "formats/texture_rows.h"
#include "stream/layout_finder.h"
#include "stream/map_source.h"

namespace tex {

class MapFile {
public:
    // The path or the source must outlive this object.
    MapFile(const std::string& path, const SourceOptions& options) : path_(path), options_(options) {}
    MapFile(MapSource& made, const SourceOptions& options) : path_(made.path()), options_(options), made_(&made) {}
    MapFile(const MapFile&) = delete;
    MapFile& operator=(const MapFile&) = delete;

    // Opens the file, so that rows() can be read. Errors: those of read_normals() that the header shows.
    Result<void> open();
    // Reads the whole map into chain() instead of row by row. Errors: as read_normals().
    Result<void> hold(bool base_only, const Execution& execution);

    // Call this before each reading of the rows: it decides how to unpack them from what is known about the layout.
    // Errors: as read_normals().
    Result<void> prepare();
    // Call this after each reading: returns false if the layout was a different one, which is now known.
    bool was_right();
    // Opens the file again, for another reading. Errors: io, and those of open().
    Result<void> open_again();
    // Reads the rows until the layout is known, then opens the file again and calls prepare(). For callers that cannot
    // take back what they made from the rows. Errors: those of reading.
    Result<void> settle_layout();

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] RowSource* rows() const { return texture_ ? texture_->levels.front().get() : nullptr; }
    [[nodiscard]] TextureRows& texture() { return *texture_; }
    [[nodiscard]] MipChain& chain() { return chain_; }
    [[nodiscard]] const SourceInfo& info() const { return info_; }  // after hold() or prepare()
    [[nodiscard]] const Sources& sources() const { return sources_; }
    [[nodiscard]] const UnpackRule& rule() const { return rule_; }
    [[nodiscard]] const SourceOptions& options() const { return options_; }
    // Null if the layout does not depend on the texels.
    [[nodiscard]] LayoutFinder* finder() { return finder_ && finder_->depends_on_texels() ? &*finder_ : nullptr; }

private:
    Result<void> open_texture();
    Result<void> measure_y(MapSource& map);

    const std::string& path_;
    SourceOptions options_;            // y is no longer to be measured after open()
    MapSource* const made_ = nullptr;  // instead of a file
    std::optional<InputFile> file_;
    std::optional<TextureRows> texture_;
    KnownLayout known_;
    std::optional<LayoutFinder> finder_;
    Sources sources_;
    UnpackRule rule_;
    SourceInfo info_;
    MipChain chain_;
};

}  // namespace tex
