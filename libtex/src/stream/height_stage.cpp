// SPDX-License-Identifier: Apache-2.0

#include "stream/height_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/bake.h"
#include "kernels/height_field.h"
#include "rows/blur.h"
#include "rows/border.h"

namespace tex {
namespace {

Keep rows_to_keep(int height, int start, int radius, Wrap wrap) {
    Keep keep;
    keep.head = wrap == Wrap::repeat ? 2 * radius : 0;
    keep.tail = wrap == Wrap::repeat ? 0 : radius + 2;
    keep.all = height <= 4 * radius + 2 * start + 8;
    return keep;
}

// The first row to make, if the first rows wait for the last ones. (If all rows are kept, each row waits for the rows
// that it needs.)
int first_row(int height, int start, int radius, Wrap wrap) {
    return wrap != Wrap::repeat || rows_to_keep(height, start, radius, wrap).all ? 0 : start + radius;
}

}  // namespace

HeightWindow::HeightWindow(Extent extent, int start, int radius, Wrap wrap, std::optional<int> first)
    : shelf(extent.height, start, rows_to_keep(extent.height, start, radius, wrap)), extent_(extent), wrap_(wrap),
      start_(first.value_or(first_row(extent.height, start, radius, wrap))), next_(start_) {}

bool HeightWindow::has(int first, int end) const {
    for (int j = end - 1; j >= first; --j) {
        const HeightIndex at = height_index(wrap_, j, extent_.height);
        if (!shelf.has(at.index)) return false;
        if (!at.plain() && (!shelf.has(at.edge) || !shelf.has(at.other))) return false;
    }
    return true;
}

// Blurs along each row as it arrives, and down the columns when the window is complete.
struct HeightStage::Blur {
    Blur(Extent its_extent, const HeightOptions& options, std::optional<int> first)
        : extent(its_extent), wrap_y(options.wrap_y),
          weights(gaussian_weights(static_cast<double>(options.blur_sigma))),
          radius(static_cast<int>(weights.size()) - 1), window(extent, 0, radius, wrap_y, first),
          across(extent.width, 1), extended(
                                       extent, [this](int) { return row; }, options.wrap_x, options.wrap_y, radius, 1),
          beyond(Extent{extent.width, wrap_y == Wrap::clamp ? 2 * radius + 1 : 1}),
          beyond_from(window.start() - radius), pointers(static_cast<std::size_t>(2 * radius + 1)) {}

    // Row j, which may lie beyond the border.
    const float* row_at(int j) {
        float* out = beyond.row(wrap_around(j, beyond.extent().height));
        const bool plain = height_index(wrap_y, j, extent.height).plain();
        if (!plain && j < beyond_from) return out;
        if (!plain) beyond_from = j + 1;
        return height_row([this](int k) { return window.shelf.at(k).planes[0]; }, extent, wrap_y, j, out);
    }

    const Extent extent;
    const Wrap wrap_y;
    const std::vector<float> weights;
    const int radius;
    HeightWindow window;
    RowMaker across;
    const float* row = nullptr;  // the row that is being blurred
    HeightRows extended;         // the same row, extended beyond its ends
    Plane<float> beyond;         // the rows beyond the border, at indices below beyond_from
    int beyond_from;
    std::vector<const float*> pointers;
};

int HeightStage::reach(const HeightOptions& options, const Gradient& gradient) {
    const bool blurs = options.blur_sigma > 0.0f;
    return gradient.radius +
           (blurs ? static_cast<int>(gaussian_weights(static_cast<double>(options.blur_sigma)).size()) - 1 : 0);
}

HeightStage::HeightStage(Extent extent, const HeightSource& source, const HeightOptions& options,
                         const Gradient& gradient, const HeightFieldHead& head, NormalSink sink,
                         std::optional<Image> last)
    : extent_(extent), source_(source), options_(options), gradient_(gradient), sink_(std::move(sink)),
      last_(std::move(last)), known_(last_ ? std::min(reach(options, gradient), extent.height) : 0),
      heights_(extent.width, 1) {
    // The gradient needs its last rows first as well, so as many rows are blurred before row 0.
    const std::optional<int> before =
        known_ > 0 ? std::optional(-std::min(gradient.radius, extent.height)) : std::nullopt;
    const std::optional<int> top = known_ > 0 ? std::optional(0) : std::nullopt;
    if (options.blur_sigma > 0.0f) blur_ = std::make_unique<Blur>(extent, options, before);
    const int from = blur_ && known_ == 0 ? blur_->window.start() : 0;
    window_ = std::make_unique<HeightWindow>(extent, from, gradient.radius, options.wrap_y, top);
    const auto height = [this](int j) { return window_->shelf.at(j).planes[0]; };
    bake_ = std::make_unique<BakeRows>(extent, height, gradient_, head, window_->start());
}

HeightStage::~HeightStage() = default;

int HeightStage::start() const { return window_->start(); }

void HeightStage::put(const Image& rows, int count) {
    if (last_) begin_with(*std::exchange(last_, std::nullopt));
    for (int k = 0; k < count; ++k) put_row(rows, k);
}

// These rows are counted later, when they arrive in their turn.
void HeightStage::begin_with(const Image& last) {
    std::vector<std::shared_ptr<Plane<float>>> rows;
    for (int k = 0; k < known_ && !only_counts_; ++k) {
        rows.push_back(heights_.make());
        only_counts_ = take_heights(last, source_, options_, k, rows.back()->row(0)).invalid > 0;
    }
    for (int k = 0; k < known_ && !only_counts_; ++k)
        take_row(extent_.height - known_ + k, rows[static_cast<std::size_t>(k)]);
}

void HeightStage::put_row(const Image& rows, int k) {
    const std::shared_ptr<Plane<float>> row = heights_.make();
    const HeightCounts counts = take_heights(rows, source_, options_, k, row->row(0));
    if (counts.invalid > 0 && counts_.invalid == 0) take_invalid(row->row(0));
    counts_ += counts;
    only_counts_ = only_counts_ || counts_.invalid > 0;
    const int j = row_++;
    if (!only_counts_ && j < extent_.height - known_) take_row(j, row);
}

void HeightStage::take_row(int j, std::shared_ptr<Plane<float>> row) {
    const float* const heights = row->row(0);
    blur_ ? blur_row(j, heights) : put_height(j, {{heights}, std::move(row)});
}

void HeightStage::take_invalid(const float* row) {
    const float* found = std::find_if(row, row + extent_.width, [](float h) { return std::isnan(h); });
    first_invalid_[0] = static_cast<int>(found - row);
    first_invalid_[1] = row_;
}

Result<void> HeightStage::check() const {
    if (counts_.invalid == 0) return {};
    return invalid_heights(counts_.invalid, first_invalid_[0], first_invalid_[1], extent_, options_);
}

void HeightStage::blur_row(int j, const float* row) {
    Blur& blur = *blur_;
    const std::shared_ptr<Plane<float>> across = blur.across.make();
    blur.row = row;
    smooth_row(blur.extended.fetch(j), blur.weights.data(), blur.radius, extent_.width, across->row(0));
    blur.window.shelf.put(j, {{across->row(0)}, across});
    while (!blur.window.done()) {
        const int at = blur.window.next();
        if (!blur.window.has(at - blur.radius, at + blur.radius + 1)) break;
        blur_column(at);
    }
}

void HeightStage::blur_column(int at) {
    Blur& blur = *blur_;
    const std::shared_ptr<Plane<float>> blurred = heights_.make();
    for (int k = 0; k <= 2 * blur.radius; ++k) {
        blur.pointers[static_cast<std::size_t>(k)] = blur.row_at(at - blur.radius + k);
    }
    smooth_column(blur.pointers.data(), blur.weights.data(), blur.radius, extent_.width, blurred->row(0));
    blur.window.advance();
    blur.window.shelf.release_before(blur.window.next() - blur.radius);
    put_height(wrap_around(at, extent_.height), {{blurred->row(0)}, blurred});
}

void HeightStage::put_height(int j, ShelfRow row) {
    HeightWindow& window = *window_;
    window.shelf.put(j, std::move(row));
    while (!window.done()) {
        const int at = window.next();
        if (!window.has(bake_->next_height(), at + gradient_.radius + 1)) break;
        const int out = at % extent_.height;
        bake_->bake(at, sink_.place(out));
        sink_.finish(out);
        window.advance();
        window.shelf.release_before(bake_->next_height());
    }
}

}  // namespace tex
