// SPDX-License-Identifier: Apache-2.0
// settled_map.h: a map, and how its normals are read: its layout, the range of its values, and where y points. All of
// that is settled before the first row of normals is made. If only the texels can tell, they are looked at first.

#pragma once

#include <memory>
#include <optional>

#include <tex/blend.h>
#include <tex/file.h>

#include "rows/unpack_rows.h"
#include "stream/map_source.h"

namespace tex::inline v1 {

class SettledMap {
public:
    // The map must outlive this object.
    SettledMap(MapSource& map, const SourceOptions& options) : map_(&map), options_(options) {}
    SettledMap(const SettledMap&) = delete;
    SettledMap& operator=(const SettledMap&) = delete;

    // Opens the map and settles how it is read. Its rows can then be read once. May throw std::bad_alloc. Errors: those
    // of read_normals().
    Result<void> open(const Execution& execution);

    [[nodiscard]] MapSource& map() const { return *map_; }
    [[nodiscard]] const SourceOptions& options() const { return options_; }
    [[nodiscard]] const Sources& sources() const { return sources_; }
    [[nodiscard]] const SourceInfo& info() const { return info_; }
    // Vectors stay as they are stored.
    void keep_length() { rule_.keep_length = true; }
    [[nodiscard]] const UnpackRule& rule() const { return rule_; }

    // Where other data may be beside the normals.
    [[nodiscard]] ExtraSet extras() const;
    // Whether alpha is 1 in every texel of the base level, which then holds no data. If rows cannot be looked at, it is
    // not. Rows can be read once more afterwards.
    Result<bool> alpha_is_one();
    // The channels that go along, as the options say.
    [[nodiscard]] ExtraSet extras_taken() const;

    // Adds stages that make the normals of a level. What the plan names must outlive the flow, as the map must.
    Stage& add_to(Flow& flow, int level, const UnpackPlan& plan = {}) const;

private:
    Result<void> settle();
    Result<Swizzle> find_layout();
    Result<Swizzle> find_order();
    Result<void> look_at_blue();
    Result<bool> find_range();
    Result<void> measure_y(const Execution& execution);

    MapSource* map_;
    SourceOptions options_;  // y is no longer to be measured after open()
    std::unique_ptr<MapSource> filled_;
    std::optional<Swizzle> swizzle_;
    bool order_assumed_ = false;
    bool is_blue_seen_ = false, is_z01_ = false;
    std::optional<bool> is_unsigned_;
    Sources sources_;
    UnpackRule rule_;
    SourceInfo info_;
};

}  // namespace tex::inline v1
