// SPDX-License-Identifier: Apache-2.0

#include "stream/last_rows.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "blocks/extent.h"
#include "formats/size_limits.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Opens the picture again. Errors: those of opening; io if the picture has changed.
Result<void> reopen(InputFile& file, std::unique_ptr<RowSource>& rows, const ReadOptions& options) {
    const Extent extent = rows->extent();
    const std::vector<std::string> names = rows->names();
    rows.reset();
    if (Result<void> again = file.rewind(); !again) return again;
    Result<std::unique_ptr<RowSource>> opened = open_rows(file, options);
    if (!opened) return opened.error();
    rows = std::move(*opened);
    if (rows->extent() == extent && rows->names() == names) return {};
    return Error{ErrorCode::io, file.path(), "changed while it was read"};
}

}  // namespace

Result<Image> last_rows(InputFile& file, std::unique_ptr<RowSource>& rows, const ReadOptions& options, int count,
                        const Execution& execution) {
    const Extent extent = rows->extent();
    const int first = extent.height - count, together = rows->rows_together();
    Image image = make_image({extent.width, rows->held_rows(count)}, rows->names());
    const int held = rows->held_rows(together);
    std::vector<std::byte> decoded(rows->row_bytes() * static_cast<std::size_t>(held));
    for (int j = rows->can_peek() ? first / together * together : 0; j < extent.height; j += together) {
        if (execution.progress && !execution.progress(0.0)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        const int end = std::min(j + together, extent.height);
        const Result<void> done = no_throw([&] {
            return rows->can_peek() ? rows->peek(j, end - j, decoded.data()) : rows->decode(j, end - j, decoded.data());
        });
        if (!done) return done.error().of(file.path());
        if (end <= first) continue;
        Image some = make_image({extent.width, held}, rows->names());
        rows->store(decoded.data(), 0, end - j, some);
        for (std::size_t plane = 0; plane < image.planes.size(); ++plane) {
            for (int k = std::max(j, first); k < end; ++k) {
                std::copy_n(some.planes[plane].row(k - j), extent.width, image.planes[plane].row(k - first));
            }
        }
    }
    if (!rows->can_peek()) {
        if (const Result<void> again = reopen(file, rows, options); !again) return again.error();
    }
    return image;
}

}  // namespace tex::inline v1
