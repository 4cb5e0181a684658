// SPDX-License-Identifier: Apache-2.0
// map_source.h: where a map of normals comes from: a file, or the steps of a manifest that make it (made_map.h).

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tex/file.h>
#include <tex/pipeline.h>

#include "files/input_file.h"
#include "formats/texture_rows.h"
#include "stream/unpack_stage.h"

namespace tex::inline v1 {

class MapSource {
public:
    MapSource() = default;
    MapSource(const MapSource&) = delete;
    MapSource& operator=(const MapSource&) = delete;
    virtual ~MapSource() = default;

    [[nodiscard]] virtual const std::string& path() const = 0;  // for messages

    // Makes the map ready to be read once from its first row, however often this is called. May throw std::bad_alloc.
    virtual Result<void> open() = 0;
    // What follows holds after open(). The levels of the head are empty.
    [[nodiscard]] virtual const Texture& head() const = 0;
    [[nodiscard]] virtual int levels() const = 0;
    [[nodiscard]] virtual Extent extent(int level) const = 0;
    // Whether y points up in the rows, whatever the head says: steps hand over normals as they are in memory.
    [[nodiscard]] virtual bool has_y_up() const { return false; }
    // The layout, if the rows no longer show it: those of a filled map have been changed.
    [[nodiscard]] virtual std::optional<Swizzle> found_swizzle() const { return std::nullopt; }
    // Adds stages that make the rows of a level, as they are stored. `wanted` are the channels that will be read.
    virtual StoredChannels add_to(Flow& flow, int level, const std::vector<bool>& wanted) = 0;
    // Reads the rows of the base level in order, until take(), which gets the channels of a row, returns false.
    using TakeChannels = std::function<bool(const float* const (&channels)[4])>;
    virtual Result<void> look(const TakeChannels& take) = 0;
    // Reads the whole map, or its base level alone.
    virtual Result<Texture> read(bool base_only, const Execution& execution) = 0;
    // Returns `error`, which says that an option does not fit the map, unless its file is also damaged: that error
    // comes first.
    virtual Error after_all_rows(const Error& error) = 0;
    // Adds what the steps have found out, when all rows have been made.
    virtual void report(StepsReport&) const {}
};

// A map in a file.
class FileMap final : public MapSource {
public:
    // The file, which must not have been read yet, and the options must outlive this object.
    FileMap(InputFile& file, const ReadOptions& options) : file_(&file), path_(file.path()), options_(options) {}
    // The file at this path, which must outlive this object.
    FileMap(const std::string& path, const ReadOptions& options) : path_(path), options_(options) {}

    [[nodiscard]] const std::string& path() const override { return path_; }
    Result<void> open() override;
    [[nodiscard]] const Texture& head() const override { return texture_->head; }
    [[nodiscard]] int levels() const override { return static_cast<int>(texture_->levels.size()); }
    [[nodiscard]] Extent extent(int level) const override { return rows(level).extent(); }
    StoredChannels add_to(Flow& flow, int level, const std::vector<bool>& wanted) override;
    Result<void> look(const TakeChannels& take) override;
    Result<Texture> read(bool base_only, const Execution& execution) override;
    Error after_all_rows(const Error& error) override;

private:
    // Opens the file, or goes back to its start.
    Result<void> open_file();
    [[nodiscard]] RowSource& rows(int level) const { return *texture_->levels[static_cast<std::size_t>(level)]; }

    std::optional<InputFile> own_;
    InputFile* file_ = nullptr;  // null until the file at the path is open
    bool was_opened_ = false;
    const std::string& path_;
    const ReadOptions& options_;
    std::optional<TextureRows> texture_;
    std::optional<Extent> extent_;  // of the base level, when it was first opened
};

// The texels of the base level of `map` with their background filled (SourceOptions::fill_background), as a map of its
// own. `map` must outlive it.
std::unique_ptr<MapSource> filled(MapSource& map, const SourceOptions& options, const Execution& execution);

}  // namespace tex::inline v1
