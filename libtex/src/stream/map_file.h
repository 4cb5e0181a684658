// SPDX-License-Identifier: Apache-2.0
// map_file.h: a file of normals that comes row by row or is held as a whole map.

#pragma once

#include <memory>
#include <optional>
#include <string>

#include <tex/source.h>

#include "files/input_file.h"
#include "formats/texture_rows.h"
#include "stream/layout_finder.h"

namespace tex {

class MapFile {
public:
    // Both must outlive this.
    MapFile(const std::string& path, const SourceOptions& options) : path_(path), options_(options) {}
    MapFile(const MapFile&) = delete;
    MapFile& operator=(const MapFile&) = delete;

    // Opens the file, after which rows() is there. Errors: those of read_normals() that a header tells.
    Result<void> open();
    // Reads all of the map into chain(), instead of rows. Errors: as read_normals().
    Result<void> hold(bool base_only, const Execution& execution);

    // Before each reading of the rows: how they are to be unpacked, from what is known of the layout. Errors: as
    // read_normals().
    Result<void> prepare();
    // After it: false if the layout was another one, which is known now.
    bool was_right();
    // Opens the file again, for another reading. Errors: io, and those of open().
    Result<void> open_again();

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] RowSource* rows() const { return texture_ ? texture_->levels.front().get() : nullptr; }
    [[nodiscard]] TextureRows& texture() { return *texture_; }
    [[nodiscard]] MipChain& chain() { return chain_; }
    [[nodiscard]] const SourceInfo& info() const { return info_; }  // after hold() or prepare()
    [[nodiscard]] const Sources& sources() const { return sources_; }
    [[nodiscard]] const UnpackRule& rule() const { return rule_; }
    // Null if the texels have no say in the layout.
    [[nodiscard]] LayoutFinder* finder() { return finder_ && finder_->depends_on_texels() ? &*finder_ : nullptr; }

private:
    Result<void> open_texture();

    const std::string& path_;
    const SourceOptions& options_;
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
