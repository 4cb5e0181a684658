// SPDX-License-Identifier: Apache-2.0

#include "stream/layout_finder.h"

#include "stream/source_layout.h"

namespace tex {

LayoutFinder::LayoutFinder(const TextureRows& texture, const SourceOptions& options, const KnownLayout& known)
    : options_(options), known_(known), width_(texture.levels.front()->extent().width) {
    const Texture& head = texture.head;
    const FormatInfo info = format_info(head.format);
    if (!known_.swizzle) known_.swizzle = known_swizzle(head, options);
    if (!known_.swizzle) evidence_.emplace(texture.levels.front()->extent(), head.format);
    layout_.swizzle = known_.swizzle.value_or(guessed_swizzle(head.swizzle, options));
    if (!known_.is_unsigned)
        known_.is_unsigned = is_unsigned(info.sample, range_of(head.normal_encoding, options.unpack));
    layout_.is_unsigned = known_.is_unsigned.value_or(false);
    const Result<Sources> sources = sources_of(layout_.swizzle, (1u << info.channels) - 1);
    weighs_ = !known_.is_unsigned && sources;
    if (sources) sources_ = *sources;
}

void LayoutFinder::add_row(const float* const (&channels)[4]) {
    if (evidence_) evidence_->add_row(row_, channels);
    ++row_;
    if (!weighs_ || range_.negative) return;  // one negative value decides
    const float* const z = sources_.z < 0 ? nullptr : channels[sources_.z];
    range_.add(weigh_row(channels[sources_.x], channels[sources_.y], z, width_));
}

std::optional<KnownLayout> LayoutFinder::correction() const {
    KnownLayout right = known_;
    if (evidence_) right.swizzle = guessed_swizzle(evidence_->layout(), options_);
    if (right.swizzle && *right.swizzle != layout_.swizzle) return right;
    if (!weighs_ || range_.says_unsigned() == layout_.is_unsigned) return std::nullopt;
    right.is_unsigned = range_.says_unsigned();
    return right;
}

}  // namespace tex
