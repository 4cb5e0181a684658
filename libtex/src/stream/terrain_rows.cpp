// SPDX-License-Identifier: Apache-2.0

#include "stream/terrain_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "rows/border.h"
#include "rows/height_bytes.h"

namespace tex::inline v1 {
namespace {

// The height at any index of a row of n heights.
float height_beyond(const float* row, Wrap wrap, int index, int n) {
    const HeightIndex at = height_index(wrap, index, n);
    const float inner = at.reflected ? 2.0f * row[at.edge] - row[at.index] : row[at.index];
    return at.plain() ? inner : inner + static_cast<float>(at.drift) * (row[at.edge] - row[at.other]);
}

bool are_alike(const std::optional<Ground>& a, const std::optional<Ground>& b) {
    constexpr double kTolerance = 1e-3;
    if (!a || !b) return a.has_value() == b.has_value();
    const auto near = [](double x, double y) { return std::abs(x - y) <= kTolerance * std::max(x, y); };
    return a->unit == b->unit && near(a->width, b->width) && near(a->height, b->height) &&
           near(a->height_metres, b->height_metres) && near(a->equator_radius, b->equator_radius);
}

bool usually_shares_border(Extent extent) {
    const auto is_one = [](int side) {
        const int texels = side - 1;
        return texels == 1200 || texels == 3600 || (texels >= 2 && (texels & (texels - 1)) == 0);
    };
    return is_one(extent.width) && is_one(extent.height);
}

}  // namespace

Result<std::unique_ptr<TerrainRows>> TerrainRows::open(InputFile& file, const BakeFileOptions& options, int reach,
                                                       TerrainMargin margin) {
    std::unique_ptr<TerrainRows> rows(new TerrainRows(file, options));
    rows->takes_ = margin;
    Result<std::unique_ptr<TileReader>> center = TileReader::open(file, options);
    if (!center) return center.error();
    rows->center_ = std::move(*center);
    if (const Result<void> measured = rows->measure(reach); !measured) return measured.error();
    rows->center_remark_ = rows->center_->heights().remark;
    rows->center_source_ = rows->center_->heights().source;
    rows->center_options_ = rows->center_->heights().options;
    const TerrainWindow& window = rows->window_;
    rows->describe(window.extent, {"Y"}, static_cast<std::size_t>(window.extent.width) * sizeof(float),
                   SampleKind::floating, 32);
    rows->row_.resize(static_cast<std::size_t>(window.extent.width));
    return rows;
}

std::string TerrainRows::path_of(int right, int down) const {
    if (right == 0 && down == 0) return file_.path();
    std::string path = options_.tile->neighbour(right, down);
    if (!path.empty()) return path;
    if (right != 0 && options_.heights.wrap_x == Wrap::repeat) return path_of(0, down);
    if (down != 0 && options_.heights.wrap_y == Wrap::repeat) return path_of(right, 0);
    return {};
}

Result<int> TerrainRows::margin(int right, int down, int reach) {
    const std::string path = path_of(right, down);
    if (path.empty()) return 0;
    const Result<std::unique_ptr<TileReader>> tile = TileReader::open(path, options_);
    if (!tile) return tile.error();
    const Extent its = (*tile)->extent(), own = window_.tile;
    const bool is_beside = right != 0;
    if (is_beside ? its.height != own.height : its.width != own.width)
        return Error{ErrorCode::bad_data, path,
                     "has " + std::to_string(its.width) + "x" + std::to_string(its.height) +
                         " texels, which do not fit beside " + file_.path() + " with " + std::to_string(own.width) +
                         "x" + std::to_string(own.height)};
    const int least = is_beside ? std::min(its.width, own.width) : std::min(its.height, own.height);
    if (takes_ == TerrainMargin::where_there) reach = std::min(reach, std::max(0, least - shared_));
    if (least < reach + shared_)
        return Error{ErrorCode::bad_data, path,
                     "is too small for its terrain: a normal depends on " + std::to_string(reach) +
                         " texels to each side, and this tile or the one beside it has fewer"};
    compare_ground(**tile);
    return reach;
}

void TerrainRows::compare_ground(const TileReader& tile) {
    if (options_.strength || !ground_remark_.empty() || are_alike(center_->heights().ground, tile.heights().ground))
        return;
    ground_remark_ = tile.path() +
                     ", the tile beside it, states another size of its texels or another unit of its "
                     "heights: the slopes at the border fit neither";
}

Result<void> TerrainRows::measure(int reach) {
    window_.tile = center_->extent();
    shared_ = options_.tile->shared_border.value_or(usually_shares_border(window_.tile)) ? 1 : 0;
    const Result<int> left = margin(-1, 0, reach), right = margin(1, 0, reach), top = margin(0, -1, reach),
                      bottom = margin(0, 1, reach);
    for (const Result<int>* side : {&left, &right, &top, &bottom}) {
        if (!*side) return side->error();
    }
    window_.left = *left;
    window_.top = *top;
    window_.extent = {*left + window_.tile.width + *right, *top + window_.tile.height + *bottom};
    const HeightOptions& heights = options_.heights;
    if (heights.wrap_x != Wrap::repeat) window_.wrap_x = heights.wrap_x;
    if (heights.wrap_y != Wrap::repeat) window_.wrap_y = heights.wrap_y;
    return {};
}

// Opens the tiles of the band above the tile (-1), of the tile's own (0) or below it (1).
Result<void> TerrainRows::enter_band(int down) {
    band_ = {};
    down_ = down;
    const int right_margin = window_.extent.width - window_.left - window_.tile.width;
    for (const int right : {0, -1, 1}) {
        const auto k = static_cast<std::size_t>(right + 1);
        if (right == 0 && down == 0) {
            band_[k] = std::move(center_);
            continue;
        }
        const std::string path = path_of(right, down);
        const int margin = right < 0 ? window_.left : right > 0 ? right_margin : 0;
        if (path.empty() || (right != 0 && margin == 0)) continue;
        Result<std::unique_ptr<TileReader>> tile = TileReader::open(path, options_);
        if (!tile) return tile.error();
        const Extent its = (*tile)->extent();
        const bool fits = right == 0 || (its.height == band_[1]->extent().height && its.width >= margin + shared_);
        if (!fits)
            return Error{ErrorCode::bad_data, path,
                         "has " + std::to_string(its.width) + "x" + std::to_string(its.height) +
                             " texels, which do not fit beside " + band_[1]->path()};
        band_[k] = std::move(*tile);
    }
    return {};
}

Result<void> TerrainRows::read_center(int down, int row, float* out) {
    const Result<HeightCounts> found = band_[1]->read(row, out);
    if (!found) return found.error();
    if (down != 0) {
        if (found->invalid > 0 && invalid_neighbour_.empty()) invalid_neighbour_ = band_[1]->path();
        return {};
    }
    if (found->invalid > 0 && counts_.invalid == 0) {
        first_invalid_[0] =
            static_cast<int>(std::find_if(out, out + window_.tile.width, [](float h) { return std::isnan(h); }) - out);
        first_invalid_[1] = row;
    }
    counts_ += *found;
    return {};
}

// Reads the heights of the margin beside `center`, those of a row in the middle of the band.
Result<void> TerrainRows::read_side(int right, int row, const float* center, int center_width, float* out) {
    const int count = right < 0 ? window_.left : window_.extent.width - window_.left - window_.tile.width;
    const std::unique_ptr<TileReader>& tile = band_[static_cast<std::size_t>(right + 1)];
    if (count == 0) return {};
    if (tile == nullptr) {
        for (int i = 0; i < count; ++i)
            out[i] =
                height_beyond(center, options_.heights.wrap_x, right < 0 ? i - count : center_width + i, center_width);
        return {};
    }
    const int width = tile->extent().width;
    side_.resize(std::max(side_.size(), static_cast<std::size_t>(width)));
    const Result<HeightCounts> found = tile->read(row, side_.data());
    if (!found) return found.error();
    const float own = center[right < 0 ? 0 : center_width - 1],
                theirs = side_[static_cast<std::size_t>(right < 0 ? width - 1 : 0)];
    if (shared_ != 0 && down_ == 0 && own != theirs && !std::isnan(own) && !std::isnan(theirs)) ++disagreeing_;
    std::copy_n(side_.data() + (right < 0 ? width - shared_ - count : shared_), count, out);
    if (invalid_neighbour_.empty() && std::any_of(out, out + count, [](float h) { return std::isnan(h); }))
        invalid_neighbour_ = tile->path();
    return {};
}

Result<void> TerrainRows::make_row(int j, float* out) {
    const int k = j - window_.top, height = window_.tile.height;
    const int down = k < 0 ? -1 : k < height ? 0 : 1;
    if (down != down_) {
        if (Result<void> entered = enter_band(down); !entered) return entered;
    }
    const int row = down < 0 ? band_[1]->extent().height - shared_ + k : down == 0 ? k : k - height + shared_;
    float* const center = out + window_.left;
    if (Result<void> read = read_center(down, row, center); !read) return read;
    if (Result<void> read = read_side(-1, row, center, window_.tile.width, out); !read) return read;
    return read_side(1, row, center, window_.tile.width, center + window_.tile.width);
}

Result<void> TerrainRows::decode(int first, int count, std::byte* rows) {
    for (int j = first; j < first + count; ++j, rows += row_bytes()) {
        if (Result<void> made = make_row(j, row_.data()); !made) return made;
        std::memcpy(rows, row_.data(), row_bytes());
        // A damaged end of the tile is an error of the tile, whatever comes below it.
        if (j - window_.top == window_.tile.height - 1) {
            if (Result<void> ended = band_[1]->finish(); !ended) return ended;
        }
    }
    return {};
}

std::string TerrainRows::remark() const {
    std::string remark = center_remark_;
    if (disagreeing_ != 0) {
        remark = std::to_string(disagreeing_) +
                 " heights of the border are not those of the tile beside it, although the tiles share their borders";
    }
    return remark + (remark.empty() || ground_remark_.empty() ? "" : "; ") + ground_remark_;
}

Result<void> TerrainRows::finish() {
    if (auto exchanged = exchanged_bytes(counts_, center_source_.mixture)) return exchanged->of(file_.path());
    if (options_.heights.fill_invalid) return {};
    if (counts_.invalid > 0)
        return invalid_heights(counts_.invalid, first_invalid_[0], first_invalid_[1], window_.tile, center_options_)
            .of(file_.path());
    if (invalid_neighbour_.empty()) return {};
    return Error{ErrorCode::bad_data, invalid_neighbour_,
                 "heights near the border to " + file_.path() + " are NaN, infinite or no-data"};
}

void TerrainRows::store(const std::byte* rows, int first, int end, Image& image) const {
    for (int j = first; j < end; ++j, rows += row_bytes()) std::memcpy(image.planes.front().row(j), rows, row_bytes());
}

}  // namespace tex::inline v1
