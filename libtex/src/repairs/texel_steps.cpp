// SPDX-License-Identifier: Apache-2.0

#include "repairs/texel_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <tex/bake.h>
#include <tex/format.h>
#include <tex/height.h>
#include <tex/mip.h>

#include "checks/centre.h"
#include "checks/texel_counts.h"
#include "checks/tone_texels.h"
#include "repairs/smooth_heights.h"
#include "repairs/smooth_steps.h"
#include "rows/math.h"
#include "rows/unpack_rows.h"
#include "stream/filled_map.h"
#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// Codes of 16 bits, among which those of 8 bits are.
constexpr int kCurveTop = 65535;

// A curve of stored values. Where a value is a code of 8 or 16 bits it was computed before; the result is the same.
class Curve {
public:
    explicit Curve(double (*of)(double)) : of_(of), at_(kCurveTop + 1) {
        for (int k = 0; k <= kCurveTop; ++k) at_[static_cast<std::size_t>(k)] = exact(input(k));
    }
    [[nodiscard]] float operator()(float c) const {
        c = std::clamp(c, 0.0f, 1.0f);
        const int k = static_cast<int>(c * static_cast<float>(kCurveTop) + 0.5f);
        return input(k) == c ? at_[static_cast<std::size_t>(k)] : exact(c);
    }

private:
    [[nodiscard]] static float input(int k) { return static_cast<float>(k) / static_cast<float>(kCurveTop); }
    [[nodiscard]] float exact(float c) const { return static_cast<float>(of_(static_cast<double>(c))); }

    double (*of_)(double);
    std::vector<float> at_;
};

// A level whose vectors change, and where they are.
struct LevelTexels {
    Image& image;
    int x, y, z;  // channels; z may be -1
    bool is_signed;

    [[nodiscard]] float* row(int channel, int j) const {
        return image.planes[static_cast<std::size_t>(channel)].row(j);
    }
    [[nodiscard]] float component(float c) const { return is_signed ? c : 2.0f * c - 1.0f; }
    [[nodiscard]] float code(float n) const { return is_signed ? n : 0.5f * n + 0.5f; }
};

using RowChange = std::function<void(const LevelTexels& texels, int row)>;

Result<void> each_row(StoredLevels& levels, const Execution& execution, const RowChange& change) {
    for (int k = 0; k < static_cast<int>(levels.levels.size()); ++k) {
        const Stored stored = levels.stored(k);
        const LevelTexels texels{levels.levels[static_cast<std::size_t>(k)], stored.channel(Component::x),
                                 stored.channel(Component::y), stored.channel(Component::z), levels.is_signed};
        const auto rows = [&](int begin, int end) {
            for (int j = begin; j < end; ++j) change(texels, j);
        };
        const Extent extent = stored.extent();
        if (auto done = parallel_for(execution, extent.height, rows_per_piece(extent), rows); !done) return done;
    }
    return {};
}

Result<void> apply_curve(double (*of)(double), StoredLevels& levels, const Execution& execution) {
    const Curve curve(of);
    return each_row(levels, execution, [&](const LevelTexels& t, int j) {
        for (const int channel : {t.x, t.y, t.z}) {
            if (channel < 0) continue;
            float* const row = t.row(channel, j);
            std::transform(row, row + t.image.extent().width, row, curve);
        }
    });
}

void divide_row(const LevelTexels& t, int j) {
    const float* const alpha = t.row(3, j);
    for (const int channel : {t.x, t.y, t.z}) {
        if (channel < 0) continue;
        float* const row = t.row(channel, j);
        const float flat = t.code(channel == t.z ? 1.0f : 0.0f);
        for (int i = 0; i < t.image.extent().width; ++i)
            row[i] = alpha[i] > 0.0f ? std::min(row[i] / alpha[i], 1.0f) : flat;
    }
}

// Takes a curve of all three channels back, or of one. Where z was cut off, it follows from x and y. One that was
// stored in another form was cut off at black, too.
void undo_tone_row(const LevelTexels& t, const ToneCurve& tone, ZForm form, int of_channel, int j) {
    constexpr float kCutOff = 254.5f / 255.0f;
    const auto black = static_cast<float>(tone.black), span = static_cast<float>(tone.white - tone.black);
    const bool is_cut = tone.white < 1.0;
    const bool is_cut_below = tone.black > 0.0 && form != ZForm::whole;
    const float* const zs = t.z < 0 ? nullptr : t.row(t.z, j);
    for (int i = 0; i < t.image.extent().width; ++i) {
        const bool is_lost = zs != nullptr && of_channel < 0 &&
                             ((is_cut && zs[i] >= kCutOff) || (is_cut_below && zs[i] <= 1.0f - kCutOff));
        for (const int channel : {t.x, t.y, t.z}) {
            if (channel < 0 || (of_channel >= 0 && channel != of_channel)) continue;
            float& c = t.row(channel, j)[i];
            const float old = std::clamp(c, 0.0f, 1.0f);
            const float power =
                tone.gamma == 1.0 ? old : static_cast<float>(math::pow(static_cast<double>(old), tone.gamma));
            c = std::clamp(black + span * power, 0.0f, 1.0f);
        }
        if (!is_lost) continue;
        const float a = t.component(t.row(t.x, j)[i]), b = t.component(t.row(t.y, j)[i]);
        const float root = std::sqrt(std::max(0.0f, 1.0f - a * a - b * b));
        t.row(t.z, j)[i] = static_cast<float>(stored_z(form, static_cast<double>(root)));
    }
}

// Lightness takes all three channels of colours.
void undo_lightness_row(const LevelTexels& t, const ToneCurve& tone, int j) {
    float *const x = t.row(t.x, j), *const y = t.row(t.y, j), *const z = t.row(t.z, j);
    for (int i = 0; i < t.image.extent().width; ++i) {
        const ToneTexel before = undone(tone, ToneTexel{x[i], y[i], z[i]});
        x[i] = static_cast<float>(before[0]);
        y[i] = static_cast<float>(before[1]);
        z[i] = static_cast<float>(before[2]);
    }
}

Result<void> undo_tone_of(const ToneCurve& tone, int channel, StoredLevels& levels, const Execution& execution) {
    if (tone.lightness != 1.0) {
        return each_row(levels, execution, [&](const LevelTexels& t, int j) { undo_lightness_row(t, tone, j); });
    }
    const Stored base = levels.stored(0);
    const ZForm form =
        base.has_z() && !levels.is_signed ? likeliest_form(tone, tone_texels(base, nullptr)) : ZForm::whole;
    return each_row(levels, execution, [&](const LevelTexels& t, int j) { undo_tone_row(t, tone, form, channel, j); });
}

Result<void> undo_tones(const ChannelTones& tones, StoredLevels& levels, const Execution& execution) {
    return each_row(levels, execution, [&](const LevelTexels& t, int j) {
        undo_tone_row(t, tones[0], ZForm::whole, t.x, j);
        undo_tone_row(t, tones[1], ZForm::whole, t.y, j);
        undo_tone_row(t, tones[2], ZForm::whole, t.z, j);
    });
}

void normalize_row(const LevelTexels& t, int j) {
    for (int i = 0; i < t.image.extent().width; ++i) {
        float &x = t.row(t.x, j)[i], &y = t.row(t.y, j)[i], &z = t.row(t.z, j)[i];
        const float a = t.component(x), b = t.component(y), c = t.component(z);
        const float length = std::sqrt(a * a + b * b + c * c);
        const bool is_null = !(length >= kNullLength);
        x = t.code(is_null ? 0.0f : a / length);
        y = t.code(is_null ? 0.0f : b / length);
        z = t.code(is_null ? 1.0f : c / length);
    }
}

void rebuild_z_row(const LevelTexels& t, int j) {
    for (int i = 0; i < t.image.extent().width; ++i) {
        const float a = t.component(t.row(t.x, j)[i]), b = t.component(t.row(t.y, j)[i]);
        t.row(2, j)[i] = t.code(std::sqrt(std::max(0.0f, 1.0f - a * a - b * b)));
    }
}

void invert_row(const LevelTexels& t, int channel, int j, int begin, int end) {
    float* const row = t.row(channel, j);
    std::transform(row + begin, row + end, row + begin, [&](float c) { return t.is_signed ? -c : 1.0f - c; });
}

// The base level as unit vectors, with the data beside them.
NormalMap base_of(const StoredLevels& levels) {
    const Stored stored = levels.stored(0);
    const Extent extent = stored.extent();
    NormalMap map(extent);
    const int x = stored.channel(Component::x), y = stored.channel(Component::y), z = stored.channel(Component::z);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const float a = stored.component(x, i, j), b = stored.component(y, i, j);
            const float c = z < 0 ? std::sqrt(std::max(0.0f, 1.0f - a * a - b * b)) : stored.component(z, i, j);
            const float length = std::sqrt(a * a + b * b + c * c);
            const bool is_null = !(length >= kNullLength);
            map.x.at(i, j) = is_null ? 0.0f : a / length;
            map.y.at(i, j) = is_null ? 0.0f : b / length;
            map.z.at(i, j) = is_null ? 1.0f : c / length;
        }
    }
    const auto& planes = levels.levels.front().planes;
    const ExtraSet beside = extras_beside({x, y, z}, static_cast<int>(planes.size()));
    if (beside.blue) map.blue = planes[2].clone();
    if (beside.alpha) map.alpha = planes[3].clone();
    return map;
}

Result<void> build_levels(const MipOptions& mip, bool all, StoredLevels& levels, const Execution& execution) {
    const Stored stored = levels.stored(0);
    const int x = stored.channel(Component::x), y = stored.channel(Component::y), z = stored.channel(Component::z);
    if ((x > 0 && y > 0 && z != 0) && levels.levels.front().planes.size() == 4 && !levels.keeps_blocks)
        return Error{ErrorCode::unsupported, {}, "R holds other data, which levels are not built of"};
    MipOptions options = mip;
    options.levels = all ? 0 : static_cast<int>(levels.levels.size());
    options.fade.reset();
    auto chain = build_mip_chain(base_of(levels), options, execution);
    if (!chain) return chain.error();
    const std::vector<std::string> names = levels.levels.front().names;
    const std::size_t channels = names.size();
    levels.levels.resize(1);
    for (std::size_t k = 1; k < chain->levels.size(); ++k) {
        NormalMap& map = chain->levels[k];
        Image image;
        image.names = names;
        image.sample = levels.levels.front().sample;
        image.bits = levels.levels.front().bits;
        for (std::size_t c = 0; c < channels; ++c) {
            const int at = static_cast<int>(c);
            const bool is_component = at == x || at == y || at == z;
            Plane<float>& from = at == x ? map.x : at == y ? map.y : at == z ? map.z : c == 2 ? map.blue : map.alpha;
            Plane<float> plane = from.empty() ? Plane<float>(map.extent(), 1.0f) : from.clone();
            for (int j = 0; is_component && !levels.is_signed && j < map.extent().height; ++j) {
                float* const row = plane.row(j);
                std::transform(row, row + map.extent().width, row, [](float n) { return 0.5f * n + 0.5f; });
            }
            image.planes.push_back(std::move(plane));
        }
        levels.levels.push_back(std::move(image));
    }
    return {};
}

Result<void> fill_base(const MipOptions& mip, const Texture& current, StoredLevels& levels,
                       const Execution& execution) {
    Texture base = levels.head;
    base.format = current.format;
    base.levels = {current.levels.front()};
    auto filled = decode_filled(base, levels.head.swizzle, {}, execution);
    if (!filled) return filled.error();
    levels.levels.front() = std::move(*filled);
    return levels.levels.size() > 1 ? build_levels(mip, false, levels, execution) : Result<void>();
}

// Turns all vectors about the axis that is at right angles to their mean and to z, so that the mean becomes z.
Result<void> turn_mean_out(StoredLevels& levels, const Execution& execution) {
    const NormalMap base = base_of(levels);
    double sum[3] = {};
    for (int j = 0; j < base.extent().height; ++j) {
        for (int i = 0; i < base.extent().width; ++i) {
            sum[0] += static_cast<double>(base.x.at(i, j));
            sum[1] += static_cast<double>(base.y.at(i, j));
            sum[2] += static_cast<double>(base.z.at(i, j));
        }
    }
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    if (!(length > 0.0) || sum[2] <= 0.0) return Error{ErrorCode::unsupported, {}, "the mean points into the surface"};
    const auto a = static_cast<float>(sum[0] / length), b = static_cast<float>(sum[1] / length),
               c = static_cast<float>(sum[2] / length);
    const float k = 1.0f / (1.0f + c);
    return each_row(levels, execution, [=](const LevelTexels& t, int j) {
        for (int i = 0; i < t.image.extent().width; ++i) {
            float &xs = t.row(t.x, j)[i], &ys = t.row(t.y, j)[i];
            const float x = t.component(xs), y = t.component(ys);
            const float z = t.z < 0 ? std::sqrt(std::max(0.0f, 1.0f - x * x - y * y)) : t.component(t.row(t.z, j)[i]);
            const float across = a * x + b * y;
            xs = t.code(x - a * (z + k * across));
            ys = t.code(y - b * (z + k * across));
            if (t.z >= 0) t.row(t.z, j)[i] = t.code(across + c * z);
        }
    });
}

// The picture becomes the normals of the heights that it holds, in 8 bits or in 16.
Result<void> bake_picture(const RepairOptions& options, const Texture& current, StoredLevels& levels,
                          const Execution& execution) {
    auto field = height_field(levels.levels.front(), {}, execution);
    if (!field) return field.error();
    field->bumpiness_x = field->bumpiness_y = *options.bumpiness;
    auto map = bake(*field, {}, execution);
    if (!map) return map.error();
    const FormatInfo info = format_info(current.format);
    const YAxis y = options.checks.require.y.value_or(YAxis::up);
    const bool has_more = levels.levels.size() > 1;
    Image image;
    image.names = {"R", "G", "B"};
    for (Plane<float>* plane : {&map->x, &map->y, &map->z}) {
        const float sign = plane == &map->y && y == YAxis::down ? -1.0f : 1.0f;
        for (int j = 0; j < map->extent().height; ++j) {
            float* const row = plane->row(j);
            std::transform(row, row + map->extent().width, row, [sign](float n) { return 0.5f * sign * n + 0.5f; });
        }
        image.planes.push_back(std::move(*plane));
    }
    const bool is_coarse = info.has_blocks() || (info.sample == SampleKind::unorm && info.bits == 8);
    levels.head.format = *format_of(SampleKind::unorm, is_coarse ? 8 : 16, 3);
    levels.head.swizzle = kSwizzleXyz;
    levels.head.swizzle_known = true;
    levels.head.y_axis = y;
    levels.head.y_known = true;
    levels.head.x_in_grey = false;
    levels.head.normal_encoding.clear();
    levels.is_signed = levels.keeps_blocks = false;
    levels.levels.clear();
    levels.levels.push_back(std::move(image));
    return has_more ? build_levels(options.mip, true, levels, execution) : Result<void>();
}

}  // namespace

Result<void> apply_step(const RepairStep& step, double figure, const RepairOptions& options, const Texture& current,
                        StoredLevels& levels, const Execution& execution) {
    const MipOptions& mip = options.mip;
    const auto row_change = [&](const RowChange& change) { return each_row(levels, execution, change); };
    switch (step.kind) {
        case RepairKind::encode_srgb: return apply_curve(srgb_encoded, levels, execution);
        case RepairKind::decode_srgb: return apply_curve(srgb_decoded, levels, execution);
        case RepairKind::divide_by_alpha: return row_change(divide_row);
        case RepairKind::normalize: return row_change(normalize_row);
        case RepairKind::exchange:
            for (Image& image : levels.levels)
                std::swap(image.planes[static_cast<std::size_t>(step.channel)],
                          image.planes[static_cast<std::size_t>(step.other)]);
            return {};
        case RepairKind::invert:
            return row_change(
                [&](const LevelTexels& t, int j) { invert_row(t, step.channel, j, 0, t.image.extent().width); });
        case RepairKind::stretch_z:
            return row_change([](const LevelTexels& t, int j) {
                float* const row = t.row(t.z, j);
                std::transform(row, row + t.image.extent().width, row, [](float c) { return 0.5f * c + 0.5f; });
            });
        case RepairKind::rebuild_z:
            if (auto done = row_change(rebuild_z_row); !done) return done;
            levels.head.swizzle[2] = Component::z;
            return {};
        case RepairKind::invert_part:
            return row_change([&](const LevelTexels& t, int j) {
                // Smaller levels have the same share of the part.
                const Extent own = t.image.extent(), base = levels.levels.front().extent();
                const auto scaled = [](int at, int size, int whole) {
                    return static_cast<int>((static_cast<std::int64_t>(at) * size + whole / 2) / whole);
                };
                const Region& part = *step.part;
                if (j < scaled(part.y, own.height, base.height) ||
                    j >= scaled(part.y + part.height, own.height, base.height))
                    return;
                invert_row(t, t.y, j, scaled(part.x, own.width, base.width),
                           scaled(part.x + part.width, own.width, base.width));
            });
        case RepairKind::fill_background: return fill_base(mip, current, levels, execution);
        case RepairKind::rebuild_levels: return build_levels(mip, step.rule->id == "N103", levels, execution);
        case RepairKind::undo_tone:
            if (step.tones) return undo_tones(*step.tones, levels, execution);
            return undo_tone_of(*step.tone, step.channel, levels, execution);
        case RepairKind::straighten: return turn_mean_out(levels, execution);
        case RepairKind::turn_left:
        case RepairKind::turn_right: {
            const YAxis y = step.y.value_or(options.checks.require.y.value_or(current.y_axis));
            const bool is_down = y == YAxis::down;
            const bool inverts_x = (step.kind == RepairKind::turn_left) != is_down;
            return row_change([inverts_x](const LevelTexels& t, int j) {
                std::swap_ranges(t.row(t.x, j), t.row(t.x, j) + t.image.extent().width, t.row(t.y, j));
                invert_row(t, inverts_x ? t.x : t.y, j, 0, t.image.extent().width);
            });
        }
        case RepairKind::smooth_steps:
            if (auto done = step.rule->id == "N305" ? smooth_heights(levels, figure, execution)
                                                    : smooth_base(levels, execution);
                !done)
                return done;
            return levels.levels.size() > 1 ? build_levels(mip, false, levels, execution) : Result<void>();
        case RepairKind::bake_heights: return bake_picture(options, current, levels, execution);
        case RepairKind::change_sign:
        case RepairKind::drop_srgb:
        case RepairKind::state_y: break;  // these change no texel
    }
    return {};
}

}  // namespace tex::inline v1
