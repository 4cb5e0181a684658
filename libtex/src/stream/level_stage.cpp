// SPDX-License-Identifier: Apache-2.0

#include "stream/level_stage.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <tex/types.h>

#include "kernels/mip.h"
#include "kernels/roughness.h"
#include "rows/border.h"
#include "rows/extra_rows.h"
#include "rows/mip_rows.h"

namespace tex::inline v1 {
namespace {

// A plane of another stage.
struct StagePlane {
    const Stage* stage;
    int plane;
};

std::vector<StagePlane> planes_of(const Stage& stage, int count) {
    std::vector<StagePlane> planes;
    for (int plane = 0; plane < count; ++plane) planes.push_back({&stage, plane});
    return planes;
}

// Makes the averages of a level from those of the larger one, or from its vectors.
class MipStage final : public Stage {
public:
    // `level` is that of the result.
    MipStage(std::vector<StagePlane> from, int level, const MipOptions& options)
        : Stage(level_extent(from.front().stage->extent(), 1), static_cast<int>(from.size()), level),
          from_(std::move(from)), filter_(from_.front().stage->extent(), options) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override {
        std::vector<Need> needs;
        const int height = filter_.from.height;
        const int top = 2 * first + filter_.y.first, bottom = 2 * (end - 1) + filter_.y.first + filter_.y.taps;
        for (const StagePlane& from : from_) {
            if (!needs.empty() && needs.back().stage == from.stage) continue;
            for (int j = top; j < bottom; ++j) {
                if (j >= 0 && j < height) continue;
                const int row = border_index(filter_.wrap_y, j, height);
                needs.push_back({from.stage, row, row + 1});
            }
            const int inner = std::max(top, 0), outer = std::min(bottom, height);
            if (inner < outer) needs.push_back({from.stage, inner, outer});
        }
        return needs;
    }
    Result<void> make(Strip& strip) override {
        const std::shared_ptr<MipRows> maker = makers_.take([this] { return std::make_unique<MipRows>(filter_); });
        std::vector<const float*> window(static_cast<std::size_t>(filter_.y.taps));
        for (int k = 0; k < strip.height; ++k) {
            const int j = strip.first + k;
            for (std::size_t plane = 0; plane < from_.size(); ++plane) {
                for (std::size_t tap = 0; tap < window.size(); ++tap)
                    window[tap] = from_[plane].stage->row(from_[plane].plane, filter_.source(j, static_cast<int>(tap)));
                maker->make(window.data(), j, strip.row(static_cast<int>(plane), k));
            }
        }
        return {};
    }

private:
    const std::vector<StagePlane> from_;
    const LevelFilter filter_;
    Pool<MipRows> makers_;
};

// Makes x/z and y/z of vectors.
class SlopeStage final : public Stage {
public:
    explicit SlopeStage(const Stage& normals) : Stage(normals.extent(), 2), normals_(normals) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&normals_, first, end}}; }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k) {
            const VectorRow from = normals_.normals(strip.first + k);
            slopes_of_vectors(from.x, from.y, from.z, extent().width, strip.row(0, k), strip.row(1, k));
        }
        return {};
    }

private:
    const Stage& normals_;
};

// Makes the material's own roughness at the base level, and its alpha^2, in step with the normals.
class MaterialRoughnessStage final : public Stage {
public:
    MaterialRoughnessStage(const Stage& normals, const MaterialRoughness& own)
        : Stage(normals.extent(), 2), normals_(normals), own_(own) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&normals_, first, end}}; }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k) own_.row(strip.first + k, strip.row(0, k), strip.row(1, k));
        return {};
    }

private:
    const Stage& normals_;
    const MaterialRoughness& own_;
};

// Writes a level. Its rows are those of another stage, or made from them by `finish`, which takes row j to row k of the
// strip.
class TargetStage final : public Stage {
public:
    using Finish = std::function<void(int j, Strip& strip, int k)>;

    // Targets of normals, or of their roughness.
    TargetStage(const Stage& from, ExtraSet extras, int level_in_file, Finish finish, Targets& targets, WatchRows seen)
        : Stage(from.extent(), extras, from.level()), from_(from), content_(Content::normals),
          level_in_file_(level_in_file), finish_(std::move(finish)), targets_(targets), seen_(std::move(seen)) {}
    TargetStage(const Stage& from, Content content, int level_in_file, int planes, Finish finish, Targets& targets,
                WatchRows seen)
        : Stage(from.extent(), planes, from.level()), from_(from), content_(content), level_in_file_(level_in_file),
          finish_(std::move(finish)), targets_(targets), seen_(std::move(seen)) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&from_, first, end}}; }
    [[nodiscard]] bool in_order() const override { return targets_.is_in_order(content_, level_in_file_); }
    Result<void> make(Strip& strip) override {
        for (int k = 0; finish_ && k < strip.height; ++k) finish_(strip.first + k, strip, k);
        const Strip& made = finish_ ? strip : from_.strip_of(strip.first);
        const LevelRows rows{content_, level_in_file_, strip.first, strip.height, made.map, strip.bytes};
        if (Result<void> written = targets_.write(rows); !written) return written;
        if (seen_) seen_(rows);
        return {};
    }

private:
    const Stage& from_;
    const Content content_;
    const int level_in_file_;
    const Finish finish_;
    Targets& targets_;
    const WatchRows seen_;
};

// Makes what is averaged from an extra channel of the normals.
class ExtraStage final : public Stage {
public:
    ExtraStage(const Stage& normals, int plane, ExtraKind kind)
        : Stage(normals.extent(), 1), normals_(normals), plane_(plane), kind_(kind) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&normals_, first, end}}; }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k)
            values_to_average(kind_, normals_.row(plane_, strip.first + k), extent().width, strip.row(0, k));
        return {};
    }

private:
    const Stage& normals_;
    const int plane_;
    const ExtraKind kind_;
};

// The planes of extra channels, in the order of their averages.
struct ExtraPlane {
    int plane;
    ExtraKind kind;
};
std::vector<ExtraPlane> extra_planes(const MadeLevels& levels) {
    std::vector<ExtraPlane> planes;
    for (const Extra extra : kExtras) {
        if (levels.extras[extra]) planes.push_back({plane_of(extra), kind_of(extra, levels.options)});
    }
    return planes;
}

// Turns averages of a level into normals and, after them, extra channels.
TargetStage::Finish finish_averages(const Stage& averages, int level, const MadeLevels& levels) {
    const int width = averages.extent().width, planes = levels.options.domain == MipDomain::vector ? 3 : 2;
    return [&averages, level, options = levels.options, extras = extra_planes(levels), width, planes](
               int j, Strip& strip, int k) {
        for (int plane = 0; plane < planes; ++plane) std::copy_n(averages.row(plane, j), width, strip.row(plane, k));
        const VectorRow mean{averages.row(0, j), averages.row(1, j), planes == 3 ? averages.row(2, j) : nullptr};
        for (std::size_t n = 0; n < extras.size(); ++n) {
            values_of_averages(extras[n].kind, options.roughness, mean, averages.row(planes + static_cast<int>(n), j),
                               width, strip.row(extras[n].plane, k));
        }
        finish_row(strip.normals(k), width, options, level);
    };
}

}  // namespace

void add_levels(Flow& flow, const Stage& normals, const MadeLevels& levels, Targets& targets, const WatchRows& seen) {
    if (levels.first >= 0)
        flow.add<TargetStage>(normals, Content::normals, levels.first, 0, TargetStage::Finish(), targets, seen);
    if (levels.count < 2) return;
    const bool averages_vectors = levels.options.domain == MipDomain::vector;
    std::vector<StagePlane> larger =
        averages_vectors ? planes_of(normals, 3) : planes_of(flow.add<SlopeStage>(normals), 2);
    for (const auto& [plane, kind] : extra_planes(levels)) {
        if (follows_normals(kind)) {
            larger.push_back({&flow.add<ExtraStage>(normals, plane, kind), 0});
        } else {
            larger.push_back({&normals, plane});
        }
    }
    for (int k = 1; k < levels.count; ++k) {
        const Stage& averages = flow.add<MipStage>(larger, k, levels.options);
        larger = planes_of(averages, static_cast<int>(larger.size()));
        if (levels.first + k < 0) continue;
        flow.add<TargetStage>(averages, levels.extras, levels.first + k, finish_averages(averages, k, levels), targets,
                              seen);
    }
}

void add_roughness(Flow& flow, const Stage& normals, const MadeLevels& levels, RoughnessModel model,
                   const MaterialRoughness& own, Targets& targets) {
    constexpr int kOfAverages = 4, kAlpha2 = 3;
    const Stage& base = flow.add<MaterialRoughnessStage>(normals, own);
    if (levels.first >= 0)
        flow.add<TargetStage>(base, Content::roughness, levels.first, 0, TargetStage::Finish(), targets, WatchRows());
    std::vector<StagePlane> larger = planes_of(normals, kAlpha2);
    larger.push_back({&base, 1});
    for (int k = 1; k < levels.count; ++k) {
        const Stage& averages = flow.add<MipStage>(larger, k, levels.options);
        larger = planes_of(averages, kOfAverages);
        if (levels.first + k < 0) continue;
        const auto finish = [&averages, model](int j, Strip& strip, int row) {
            const VectorRow mean = averages.normals(j);
            roughness_of_averages(model, mean.x, mean.y, mean.z, averages.row(kAlpha2, j), averages.extent().width,
                                  strip.row(0, row));
        };
        flow.add<TargetStage>(averages, Content::roughness, levels.first + k, 1, finish, targets, WatchRows());
    }
}

}  // namespace tex::inline v1
