// SPDX-License-Identifier: Apache-2.0
// map_source.h: where a normal map comes from: a file, or steps that make it (made_map.h).

#pragma once

#include <string>

#include <tex/result.h>

#include "files/input_file.h"
#include "formats/texture_rows.h"

namespace tex {

class MapSource {
public:
    MapSource() = default;
    MapSource(const MapSource&) = delete;
    MapSource& operator=(const MapSource&) = delete;
    virtual ~MapSource() = default;

    [[nodiscard]] virtual const std::string& path() const = 0;  // for messages
    // The map from its first row, however often this is called. The rows of earlier calls must not be used any more.
    // May throw std::bad_alloc.
    virtual Result<TextureRows> open() = 0;
};

// A map in an open file.
class OpenFileMap final : public MapSource {
public:
    OpenFileMap(InputFile& file, const ReadOptions& options) : file_(file), options_(options) {}

    [[nodiscard]] const std::string& path() const override { return file_.path(); }
    Result<TextureRows> open() override {
        if (was_opened_) {
            if (const Result<void> again = file_.rewind(); !again) return again.error();
        }
        was_opened_ = true;
        return open_texture_rows(file_, options_);
    }

private:
    InputFile& file_;
    const ReadOptions& options_;
    bool was_opened_ = false;
};

}  // namespace tex
