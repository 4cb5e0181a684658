// SPDX-License-Identifier: Apache-2.0

#include "tiff_mask.h"

#include <algorithm>
#include <utility>

#include "open_input.h"

namespace tex::reader {
namespace {

// A file of many pages is searched no further: masks come right behind their picture, or behind its overviews.
constexpr int kMostPictures = 64;

bool is_mask_of(const TiffLayout& layout, TIFF* tiff) {
    std::uint32_t kind = 0;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SUBFILETYPE, &kind);
    const TiffLayout its = tiff_layout(tiff);
    return kind == FILETYPE_MASK && its.width == layout.width && its.height == layout.height && its.channels == 1 &&
           (its.bits == 1 || its.bits == 8) && its.chunk_width > 0 && its.chunk_height > 0 &&
           TIFFIsCODECConfigured(its.compression) != 0;
}

}  // namespace

TiffMask::TiffMask(TiffFile file)
    : file_(std::move(file)),
      layout_(tiff_layout(file_.get())), samples_{layout_.bits, SAMPLEFORMAT_UINT, false, ReaderType::u8},
      chunks_(file_.get(), layout_, samples_), rows_(std::size_t{layout_.width} * layout_.chunk_height) {}

bool TiffMask::read_row(std::uint32_t y, const std::byte*& mask) {
    if (y >= end_) {
        first_ = end_;
        end_ = std::min(first_ + layout_.chunk_height, layout_.height);
        if (!chunks_.read(first_, end_ - first_, rows_.data())) return false;
    }
    mask = &rows_[std::size_t{layout_.width} * (y - first_)];
    return true;
}

std::unique_ptr<TiffMask> open_mask(TIFF* tiff, const TiffLayout& layout) {
    if (TIFFLastDirectory(tiff) != 0) return nullptr;
    TiffFile file(open_tiff_input());
    std::unique_ptr<TiffMask> mask;
    for (int k = 1; file && k < kMostPictures && mask == nullptr && TIFFReadDirectory(file.get()) != 0; ++k) {
        if (is_mask_of(layout, file.get())) mask = std::make_unique<TiffMask>(std::move(file));
    }
    // A picture that is not read may be damaged.
    if (mask == nullptr) tiff_error().clear();
    return mask;
}

}  // namespace tex::reader
