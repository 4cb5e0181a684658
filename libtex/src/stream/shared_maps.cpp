// SPDX-License-Identifier: Apache-2.0

#include "stream/shared_maps.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include <tex/mip.h>

#include "stream/map_source.h"
#include "stream/normal_source.h"
#include "stream/placed_map.h"

namespace tex::inline v1 {
namespace {

std::int64_t bytes_of(Extent extent) { return extent.texels() * 3 * static_cast<std::int64_t>(sizeof(float)); }

std::int64_t bytes_of(const MipChain& chain) {
    std::int64_t bytes = 0;
    for (const NormalMap& level : chain.levels) bytes += bytes_of(level.extent());
    return bytes;
}

}  // namespace

std::shared_ptr<SharedMaps> share_maps(std::int64_t most_bytes) { return std::make_shared<SharedMaps>(most_bytes); }

// The entry of a file as it is now. Entries of what it was before are forgotten.
std::shared_ptr<SharedMaps::Entry> SharedMaps::entry_of(const std::string& path, const SourceOptions& options,
                                                        const FileVersion& version) {
    const std::lock_guard lock(mutex_);
    for (auto each = entries_.begin(); each != entries_.end();) {
        const std::shared_ptr<Entry> entry = *each;
        if (entry->path == path && entry->version != version) {
            used_ -= std::exchange(entry->bytes, 0);
            each = entries_.erase(each);
            continue;
        }
        if (entry->path == path && entry->options == options) {
            entries_.splice(entries_.begin(), entries_, each);
            return entry;
        }
        ++each;
    }
    auto entry = std::make_shared<Entry>();
    entry->path = path;
    entry->options = options;
    entry->version = version;
    entries_.push_front(entry);
    return entry;
}

// If necessary, forgets maps that are not in use, those not used for the longest time first.
bool SharedMaps::make_room(std::int64_t bytes) {
    const auto is_unused = [](const std::shared_ptr<Entry>& entry) {
        return entry.use_count() == 1 && entry->plain.use_count() == 1 &&
               std::all_of(entry->built.begin(), entry->built.end(),
                           [](const Leveled& built) { return built.map.use_count() == 1; });
    };
    for (auto each = entries_.end(); used_ + bytes > most_ && each != entries_.begin();) {
        if (!is_unused(*--each)) continue;
        used_ -= (*each)->bytes;
        each = entries_.erase(each);
    }
    return used_ + bytes <= most_;
}

// Calls `put`, which lets the entry hold so many bytes more, if there is room for them.
bool SharedMaps::keep(Entry& entry, std::int64_t bytes, const std::function<void()>& put) {
    const std::lock_guard lock(mutex_);
    const bool is_known = std::any_of(entries_.begin(), entries_.end(),
                                      [&](const std::shared_ptr<Entry>& known) { return known.get() == &entry; });
    if (!is_known || !make_room(bytes)) return false;
    put();
    used_ += bytes;
    entry.bytes += bytes;
    return true;
}

// Reads the map of an entry. Returns null if it is too large.
Result<SharedMaps::Map> SharedMaps::read(Entry& entry, const Execution& execution) {
    FileMap file(entry.path, entry.options.read);
    if (!entry.options.measure_y) {
        if (const Result<void> opened = file.open(); !opened) return opened.error();
        entry.is_refused = bytes_of(file.extent(0)) > most_;
        if (entry.is_refused) return Map();
    }
    Result<Source> source = read_normals(file, entry.options, false, execution);
    if (!source) return source.error();
    const Map map = std::make_shared<const HeldMap>(HeldMap{std::move(source->chain), std::move(source->info)});
    entry.is_refused =
        FileVersion::of(entry.path) != entry.version || !keep(entry, bytes_of(map->chain), [&] { entry.plain = map; });
    return map;
}

Result<SharedMaps::Map> SharedMaps::with_levels(Entry& entry, const Map& plain, const MapTransform& place,
                                                const Execution& execution) {
    for (const Leveled& built : entry.built) {
        if (built.wrap_x == place.wrap_x && built.wrap_y == place.wrap_y) return built.map;
    }
    // Both maps own the base level, which build_mip_chain() only reads.
    const auto plane_of = [&plain](const Plane<float>& plane) {
        return Plane<float>(
            plane.extent(), plane.stride(),
            std::shared_ptr<float>(std::const_pointer_cast<HeldMap>(plain), const_cast<float*>(plane.row(0))));
    };
    const NormalMap& read = plain->chain.levels.front();
    NormalMap base;
    base.x = plane_of(read.x);
    base.y = plane_of(read.y);
    base.z = plane_of(read.z);
    MipOptions options;
    options.wrap_x = place.wrap_x;
    options.wrap_y = place.wrap_y;
    Result<MipChain> chain = build_mip_chain(std::move(base), options, execution);
    if (!chain) return chain.error();
    const Map map = std::make_shared<const HeldMap>(HeldMap{std::move(*chain), plain->info});
    if (!entry.is_refused) {
        std::ignore = keep(entry, bytes_of(map->chain) - bytes_of(read.extent()), [&] {
            entry.built.push_back({place.wrap_x, place.wrap_y, map});
        });
    }
    return map;
}

Result<std::shared_ptr<const HeldMap>> SharedMaps::get(const std::string& path, const SourceOptions& options,
                                                       const MapTransform& place, const Execution& execution) {
    const std::optional<FileVersion> version = path == "-" ? std::nullopt : FileVersion::of(path);
    if (!version) return Map();
    const std::shared_ptr<Entry> entry = entry_of(path, options, *version);
    const std::lock_guard lock(entry->reading);
    if (entry->is_refused) return Map();
    Map map = entry->plain;
    if (!map) {
        Result<Map> read_now = read(*entry, execution);
        if (!read_now || !*read_now) return read_now;
        map = std::move(*read_now);
    }
    if (levels_needed(map->chain, place.map) == 1) return map;
    return with_levels(*entry, map, place, execution);
}

}  // namespace tex::inline v1
