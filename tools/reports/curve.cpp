// SPDX-License-Identifier: Apache-2.0

#include "reports/curve.h"

#include <fmt/format.h>
#include <tex/file.h>
#include <tex/pack.h>

#include "cli/json.h"

namespace tex::cli {

Result<CurvePoint> measure_point(const MipChain& map, const PackOptions& options, const Execution& execution) {
    const auto texture = pack(map, options, execution);
    if (!texture) return texture.error();
    const Execution silent{execution.threads, [&](double) { return !execution.progress || execution.progress(1.0); }};
    WriteOptions write;
    write.zstd = 19;
    const auto file = encode_file(*texture, Container::ktx2, write, silent);
    if (!file) return file.error();
    const auto decoded = unpack(*texture, {}, silent);
    if (!decoded) return decoded.error();
    const auto comparison = compare(map.levels[0], decoded->levels[0], silent);
    if (!comparison) return comparison.error();
    return CurvePoint{options.rdo.mean, static_cast<std::int64_t>(file->size()), comparison->error};
}

ExitCode print_point(Console& console, const ComparisonRun& run, const std::vector<CurvePoint>& points,
                     const PackOptions& options, bool as_json) {
    const CurvePoint& point = points.back();
    const AngularError& e = point.error;
    const double change = static_cast<double>(point.bytes) / static_cast<double>(points.front().bytes) - 1.0;
    if (as_json) {
        const auto degrees = [](double angle) { return static_cast<float>(angle); };
        Json line;
        line["a"] = run.inputs[0];
        line["format"] = name_of(kEncodingNames, options.encoding);
        line["rdo_mean"] = point.rdo_mean;
        line["bytes"] = point.bytes;
        line["change"] = degrees(change);
        line["degrees"] = {{"mean", degrees(e.mean)}, {"p99.9", degrees(e.p999)}, {"max", degrees(e.max)}};
        line["warnings"] = warnings_json(run.warnings);
        line["seconds"] = seconds_since(run.start);
        return console.print(to_report_line(line));
    }
    std::string text;
    if (points.size() == 1) {
        text = fmt::format("{:>9} {:>11} {:>8} {:>9} {:>9} {:>9}  in degrees\n", "rdo-mean", "bytes", "change", "mean",
                           "p99.9", "max");
    }
    text += fmt::format("{:>9} {:>11} {:>6.1f} % {:>9.4f} {:>9.4f} {:>9.4f}\n", point.rdo_mean, point.bytes,
                        100.0 * change, e.mean, e.p999, e.max);
    return console.print(text);
}

}  // namespace tex::cli
