// SPDX-License-Identifier: Apache-2.0

#include "stream/height_stage.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "kernels/bake.h"
#include "kernels/height_field.h"
#include "rows/blur.h"
#include "rows/border.h"
#include "rows/height_bytes.h"
#include "stream/given_extras.h"
#include "stream/source_stage.h"
#include "stream/terrain_rows.h"

namespace tex::inline v1 {
namespace {

// Rows of heights. If the last rows had to be read before all others, they are a stage of their own.
struct HeightInput {
    const Stage* rows = nullptr;
    const Stage* last = nullptr;  // null, or what makes the rows from last->begin() on
    Wrap wrap = Wrap::repeat;

    [[nodiscard]] const float* row(int j) const {
        return (last != nullptr && j >= last->begin() ? last : rows)->row(0, j);
    }
    // What rows [first, end), which may lie beyond the border, are made from.
    [[nodiscard]] std::vector<Need> needs(int first, int end) const {
        std::vector<Need> needs;
        const int height = rows->extent().height, split = last == nullptr ? height : last->begin();
        const auto add = [&](int from, int to) {
            if (from < std::min(to, split)) needs.push_back({rows, from, std::min(to, split)});
            if (std::max(from, split) < to) needs.push_back({last, std::max(from, split), to});
        };
        add(std::max(first, 0), std::min(end, height));
        for (int j = first; j < end; ++j) {
            if (j >= 0 && j < height) continue;
            const HeightIndex at = height_index(wrap, j, height);
            add(at.index, at.index + 1);
            if (at.plain()) continue;
            add(at.edge, at.edge + 1);
            add(at.other, at.other + 1);
        }
        return needs;
    }
};

// A blur along each row, as the first half of the blur; no weights, no blur.
struct AcrossBlur {
    WorkingVector<float> weights;
    Wrap wrap_x = Wrap::repeat;

    [[nodiscard]] int radius() const { return static_cast<int>(weights.size()) - 1; }
};

// Takes heights from rows of a picture, and blurs them along the row.
class TakeStage : public Stage {
public:
    TakeStage(Extent extent, int begin, const Heights& heights, const AcrossBlur& blur)
        : Stage(extent, 1, 0, begin), heights_(heights), blur_(blur) {}

protected:
    // Row j of `image` becomes row k of the strip.
    HeightCounts take(const Image& image, int j, Strip& strip, int k) const {
        return take_heights(image, heights_.source, heights_.options, j, strip.map.x.row(k));
    }
    void blur_across(Strip& strip) const {
        if (blur_.weights.empty()) return;
        const Extent extent{Stage::extent().width, 1};
        Plane<float> blurred(extent);
        const float* row = nullptr;
        HeightRows extended(
            extent, [&row](int) { return row; }, blur_.wrap_x, Wrap::repeat, blur_.radius(), 1);
        for (int k = 0; k < strip.height; ++k) {
            row = strip.map.x.row(k);
            smooth_row(extended.fetch(k), blur_.weights.data(), blur_.radius(), extent.width, blurred.row(0));
            std::copy_n(blurred.row(0), extent.width, strip.map.x.row(k));
        }
    }

private:
    const Heights& heights_;
    const AcrossBlur blur_;
};

class HeightStage final : public TakeStage {
public:
    HeightStage(Flow& flow, const Stage& picture, Heights& heights, const std::string& input, const AcrossBlur& blur)
        : TakeStage(picture.extent(), 0, heights, blur), flow_(flow), picture_(picture), heights_(heights),
          input_(input) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&picture_, first, end}}; }
    [[nodiscard]] bool counts() const override { return true; }
    Result<void> make(Strip& strip) override {
        HeightCounts counts;
        for (int k = 0; k < strip.height; ++k) {
            const int j = strip.first + k;
            const Strip& from = picture_.strip_of(j);
            const HeightCounts found = take(from.image, j - from.first, strip, k);
            if (found.invalid > 0) note_invalid(strip.map.x.row(k), j);
            counts += found;
        }
        if (counts.invalid == 0) blur_across(strip);
        const std::lock_guard lock(mutex_);
        heights_.counts += counts;
        return {};
    }
    [[nodiscard]] Result<void> check() const override {
        if (auto exchanged = exchanged_bytes(heights_.counts, heights_.source.mixture)) return exchanged->of(input_);
        if (first_row_ < 0) return {};
        return invalid_heights(heights_.counts.invalid, first_column_, first_row_, extent(), heights_.options)
            .of(input_);
    }

private:
    void note_invalid(const float* row, int j) {
        flow_.only_count();
        const std::lock_guard lock(mutex_);
        if (first_row_ >= 0 && first_row_ <= j) return;
        first_row_ = j;
        first_column_ =
            static_cast<int>(std::find_if(row, row + extent().width, [](float h) { return std::isnan(h); }) - row);
    }

    Flow& flow_;
    const Stage& picture_;
    Heights& heights_;
    const std::string& input_;
    std::mutex mutex_;  // guards heights_.counts and the next two
    int first_row_ = -1, first_column_ = 0;
};

// The last rows, which were read before all others. They are counted when they come in their turn.
class LastHeightStage final : public TakeStage {
public:
    LastHeightStage(Flow& flow, Extent extent, int begin, const Heights& heights, const AcrossBlur& blur)
        : TakeStage(extent, begin, heights, blur), flow_(flow), last_(*heights.last) {}

    [[nodiscard]] std::vector<Need> needs(int, int) const override { return {}; }
    Result<void> make(Strip& strip) override {
        HeightCounts counts;
        for (int k = 0; k < strip.height; ++k) counts += take(last_, strip.first - begin() + k, strip, k);
        if (counts.invalid > 0) flow_.only_count();
        if (counts.invalid == 0) blur_across(strip);
        return {};
    }

private:
    Flow& flow_;
    const Image& last_;
};

// Blurs down the columns what was blurred along the rows.
class BlurStage final : public Stage {
public:
    BlurStage(const HeightInput& input, int begin, const WorkingVector<float>& weights)
        : Stage(input.rows->extent(), 1, 0, begin), input_(input), weights_(weights),
          radius_(static_cast<int>(weights.size()) - 1) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override {
        return input_.needs(first - radius_, end + radius_);
    }
    Result<void> make(Strip& strip) override {
        std::vector<Plane<float>> beyond;  // rows that are computed
        std::vector<const float*> rows;
        for (int j = strip.first - radius_; j < strip.first + strip.height + radius_; ++j)
            rows.push_back(row_at(j, beyond));
        for (int k = 0; k < strip.height; ++k)
            smooth_column(rows.data() + k, weights_.data(), radius_, extent().width, strip.map.x.row(k));
        return {};
    }

private:
    const float* row_at(int j, std::vector<Plane<float>>& beyond) const {
        const HeightIndex at = height_index(input_.wrap, j, extent().height);
        if (at.plain()) return input_.row(at.index);
        beyond.emplace_back(Extent{extent().width, 1});
        return height_row([this](int k) { return input_.row(k); }, extent(), input_.wrap, j, beyond.back().row(0));
    }

    const HeightInput input_;
    const WorkingVector<float> weights_;
    const int radius_;
};

// Bakes heights. The normals of a window become those of the tile in it.
class BakeStage final : public Stage {
public:
    // `beside`: where the heights themselves go.
    BakeStage(const HeightInput& input, const Gradient& gradient, const HeightFieldHead& head,
              const std::optional<TerrainWindow>& window, ExtraSet beside)
        : Stage(window ? window->tile : input.rows->extent(), beside), input_(input), gradient_(gradient), head_(head),
          left_(window ? window->left : 0), top_(window ? window->top : 0) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override {
        return input_.needs(first + top_ - gradient_.radius, end + top_ + gradient_.radius);
    }
    Result<void> make(Strip& strip) override {
        std::unique_ptr<Baker> baker = take_baker(strip.first + top_);
        for (int k = 0; k < strip.height; ++k) {
            const int j = strip.first + top_ + k;
            bake_row(*baker, j, strip.normals(k));
            const float* const heights = input_.row(j) + left_;
            for (const Extra extra : kExtras) {
                if (extras()[extra]) std::copy_n(heights, extent().width, strip.map[extra].row(k));
            }
        }
        baker->next = strip.first + top_ + strip.height;
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(baker));
        return {};
    }

private:
    // Filters rows from top to bottom. One that goes on where it was filters no row twice.
    struct Baker {
        Baker(const BakeStage& stage, int first)
            : rows(
                  stage.input_.rows->extent(), [&stage](int j) { return stage.input_.row(j); }, stage.gradient_,
                  stage.head_, first),
              next(first) {}

        BakeRows rows;
        int next;
        NormalMap wide;  // a row of the window
    };

    std::unique_ptr<Baker> take_baker(int first) {
        {
            const std::lock_guard lock(mutex_);
            const auto same =
                std::find_if(idle_.begin(), idle_.end(), [first](const auto& baker) { return baker->next == first; });
            const auto taken = same != idle_.end() || idle_.empty() ? same : idle_.begin();
            if (taken != idle_.end()) {
                std::unique_ptr<Baker> baker = std::move(*taken);
                idle_.erase(taken);
                if (baker->next != first) baker->rows.go_to(first);
                return baker;
            }
        }
        return std::make_unique<Baker>(*this, first);
    }
    void bake_row(Baker& baker, int j, const NormalRow& out) const {
        if (extent() == input_.rows->extent()) return baker.rows.bake(j, out);
        if (baker.wide.x.empty()) baker.wide = NormalMap(Extent{input_.rows->extent().width, 1});
        const NormalRow wide{baker.wide.x.row(0), baker.wide.y.row(0), baker.wide.z.row(0)};
        baker.rows.bake(j, wide);
        std::copy_n(wide.x + left_, extent().width, out.x);
        std::copy_n(wide.y + left_, extent().width, out.y);
        std::copy_n(wide.z + left_, extent().width, out.z);
    }

    const HeightInput input_;
    const Gradient& gradient_;
    const HeightFieldHead head_;
    const int left_, top_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Baker>> idle_;
};

WorkingVector<float> weights_of(const HeightOptions& options) {
    if (!(options.blur_sigma > 0.0f)) return {};
    return gaussian_weights(static_cast<double>(options.blur_sigma));
}

}  // namespace

int height_reach(const HeightOptions& options, const Gradient& gradient) {
    return gradient.radius + std::max(0, static_cast<int>(weights_of(options).size()) - 1);
}

namespace {

const Stage& add_picture(Flow& flow, Heights& heights, const std::string& input) {
    ConvertRows convert;
    if (heights.linear) convert = [&heights](Image& rows, int count) { return heights.linear->convert(rows, count); };
    return add_source(flow, *heights.rows, input, std::move(convert));
}

}  // namespace

const Stage& add_heights(Flow& flow, Heights& heights, const std::string& input) {
    const Stage* const picture = &add_picture(flow, heights, input);
    return flow.add<HeightStage>(flow, *picture, heights, input, AcrossBlur());
}

BakedRows add_bake(Flow& flow, Heights& heights, const std::string& input, const BakeFileOptions& options,
                   const Gradient& gradient) {
    const Extent extent = heights.rows->extent();
    // A pointer: GCC 14 takes a reference for one to the temporary argument.
    const Stage* const picture = &add_picture(flow, heights, input);
    const WorkingVector<float> weights = weights_of(heights.options);
    const AcrossBlur blur{weights, heights.options.wrap_x};
    HeightInput rows{&flow.add<HeightStage>(flow, *picture, heights, input, blur), nullptr, heights.options.wrap_y};
    if (heights.last) {
        const int begin = std::max(0, extent.height - height_reach(heights.options, gradient));
        rows.last = &flow.add<LastHeightStage>(flow, extent, begin, heights, blur);
    }
    if (!weights.empty()) {
        const HeightInput across = rows;
        rows.rows = &flow.add<BlurStage>(across, 0, weights);
        if (heights.last)
            rows.last = &flow.add<BlurStage>(across, std::max(0, extent.height - gradient.radius), weights);
    }
    const HeightFieldHead head = head_of(heights, options);
    return {&flow.add<BakeStage>(rows, gradient, head, heights.window, heights_given(options.others)), head};
}

}  // namespace tex::inline v1
