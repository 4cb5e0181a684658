// SPDX-License-Identifier: Apache-2.0

#include "stream/measured_y.h"

#include "stream/map_file.h"
#include "stream/map_inspector.h"
#include "stream/unpack_stage.h"

namespace tex {

Result<SourceOptions> with_measured_y(MapSource& map, const SourceOptions& options) {
    SourceOptions as_up = options;
    as_up.measure_y = false;
    as_up.file_y_first = false;
    as_up.unpack.y_axis = YAxis::up;
    MapFile file(map, as_up);
    if (Result<void> opened = file.open(); !opened) return opened.error();
    if (Result<void> settled = file.settle_layout(); !settled) return settled.error();
    RowSource& rows = *file.rows();
    const Extent extent = rows.extent();
    NormalMap row(Extent{extent.width, 1});
    const NormalSink sink{[&row](int) { return NormalRow{row.x.row(0), row.y.row(0), row.z.row(0)}; }, [](int) {}};
    MapInspector inspector(extent);
    UnpackStage stage(file.texture(), extent, file.sources(), file.rule(), std::nullopt, nullptr, &inspector, sink);
    const Result<void> seen = rows.visit(map.path(), [&stage](const Image& image, int, int count) {
        stage.put(image, count);
        return Result<void>();
    });
    if (!seen) return seen.error();
    const std::optional<YAxis> shown = inspector.y();
    if (!shown) return undecided_y(map.path());
    as_up.unpack.y_axis = *shown;
    return as_up;
}

Error undecided_y(const std::string& path) {
    return {ErrorCode::bad_data, path, "which way green points does not show clearly in the texels"};
}

}  // namespace tex
