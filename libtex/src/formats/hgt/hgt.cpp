// SPDX-License-Identifier: Apache-2.0

#include "formats/hgt/hgt.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "formats/raw/raw_rows.h"
#include "formats/size_limits.h"
#include "formats/words.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

constexpr Extent kHgtExtents[] = {{3601, 3601}, {1801, 3601}, {1201, 1201}};
constexpr float kHgtVoid = -32768.0f;

}  // namespace

bool is_hgt(const InputFile& file, const ReadOptions&) { return has_extension(file.path(), ".hgt"); }

Result<std::unique_ptr<RowSource>> open_hgt(InputFile& file, const ReadOptions& options) {
    return no_throw([&]() -> Result<std::unique_ptr<RowSource>> {
        if (const Result<void> settled = file.settle(largest_file(options)); !settled) return settled.error();
        RawTexels place{.samples = {SampleKind::snorm, 16, true}, .has_place = true, .no_data = kHgtVoid};
        const auto* const found = std::find_if(std::begin(kHgtExtents), std::end(kHgtExtents),
                                               [&](Extent extent) { return extent.texels() * 2 == *file.size(); });
        if (found == std::end(kHgtExtents)) {
            return Error{ErrorCode::bad_data, file.path(),
                         std::to_string(*file.size()) +
                             " bytes are not an HGT file, which has 3601x3601, 1801x3601 or 1201x1201 heights; name "
                             "another extent in a raw layout, such as 7201x3601,s16be"};
        }
        const Result<Extent> extent = claimed_extent(file.path(), found->width, found->height, options);
        if (!extent) return extent.error();
        place.extent = *extent;
        return open_raw_rows(file, std::move(place));
    });
}

}  // namespace tex::inline v1
