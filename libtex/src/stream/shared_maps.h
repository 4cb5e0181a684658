// SPDX-License-Identifier: Apache-2.0
// shared_maps.h: maps that many blends hold together: see share_maps().

#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <tex/pipeline.h>

#include "files/input_file.h"
#include "rows/sampler.h"

namespace tex::inline v1 {

// A whole map. Nobody changes it.
struct HeldMap {
    MipChain chain;
    SourceInfo info;
};

// Where a map lies on a result.
struct MapTransform {
    UvMap map;
    Wrap wrap_x = Wrap::repeat;
    Wrap wrap_y = Wrap::repeat;
};

class SharedMaps {
public:
    explicit SharedMaps(std::int64_t most_bytes) : most_(most_bytes) {}

    // The map of a file, with the levels that the place requires. Null if it is too large to be kept, or if the file
    // is a stream: then the caller reads it. Waits while another thread reads the same map. May throw std::bad_alloc.
    // Errors: as read_normals().
    Result<std::shared_ptr<const HeldMap>> get(const std::string& path, const SourceOptions& options,
                                               const MapTransform& place, const Execution& execution);

private:
    using Map = std::shared_ptr<const HeldMap>;
    // The map with the levels that these borders give it.
    struct Leveled {
        Wrap wrap_x, wrap_y;
        Map map;
    };
    struct Entry {
        std::string path;
        SourceOptions options;
        FileVersion version;
        std::mutex reading;          // held while the map is read, or its levels are built
        bool is_refused = false;     // too large, or the file has changed
        Map plain;                   // as it was read
        std::vector<Leveled> built;  // if it has one level; the base level is that of `plain`
        std::int64_t bytes = 0;      // of all that
    };
    std::shared_ptr<Entry> entry_of(const std::string& path, const SourceOptions& options, const FileVersion& version);
    bool make_room(std::int64_t bytes);
    bool keep(Entry& entry, std::int64_t bytes, const std::function<void()>& put);
    Result<Map> read(Entry& entry, const Execution& execution);
    Result<Map> with_levels(Entry& entry, const Map& plain, const MapTransform& place, const Execution& execution);

    const std::int64_t most_;
    std::mutex mutex_;  // guards all below, and what entries hold; whoever changes that also holds Entry::reading
    std::list<std::shared_ptr<Entry>> entries_;  // those used last come first
    std::int64_t used_ = 0;
};

}  // namespace tex::inline v1
