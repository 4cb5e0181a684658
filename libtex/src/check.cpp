// SPDX-License-Identifier: Apache-2.0

#include <tex/check.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <tex/format.h>
#include <tex/mesh.h>
#include <tex/pack.h>

#include "checks/context.h"
#include "checks/convention_rules.h"
#include "checks/damage_rules.h"
#include "checks/extra_rules.h"
#include "checks/field_rules.h"
#include "checks/file_rules.h"
#include "checks/findings.h"
#include "checks/kind_rules.h"
#include "checks/marks.h"
#include "checks/mesh_fit.h"
#include "checks/mesh_rules.h"
#include "checks/mip_rules.h"
#include "checks/model_rules.h"
#include "checks/occlusion_rules.h"
#include "checks/pair_rules.h"
#include "checks/picture_kind.h"
#include "checks/rules.h"
#include "checks/sign_rules.h"
#include "checks/value_rules.h"
#include "rows/usable.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Parses `text`, which must be a whole number from 1 to kMaxExtent and nothing else.
std::optional<int> parse_count(std::string_view text) {
    int value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end.ec != std::errc() || end.ptr != text.data() + text.size() || value < 1 || value > kMaxExtent)
        return std::nullopt;
    return value;
}

Result<void> require_format(Requirements& requirements, std::string_view value) {
    requirements.encoding = find_by_name(kEncodingNames, value);
    requirements.format.reset();
    if (!requirements.encoding) requirements.format = find_by_name(kFormatNames, value);
    if (!requirements.encoding && !requirements.format) {
        return bad_option("format=" + std::string(value) + ": no such encoding or format");
    }
    return {};
}

Result<void> require_extent(Requirements& requirements, std::string_view value) {
    const auto cross = value.find('x');
    const auto width = parse_count(value.substr(0, cross));
    const auto height = cross == std::string_view::npos ? std::nullopt : parse_count(value.substr(cross + 1));
    if (!width || !height) return bad_option("extent=" + std::string(value) + ": not WIDTHxHEIGHT");
    requirements.extent = Extent{*width, *height};
    return {};
}

Result<void> require_mips(Requirements& requirements, std::string_view value) {
    const auto count = parse_count(value);
    if (value == "full") {
        requirements.levels = 0;
    } else if (value == "none") {
        requirements.levels = 1;
    } else if (count) {
        requirements.levels = *count;
    } else {
        return bad_option("mips=" + std::string(value) + ": not full, none or a number");
    }
    return {};
}

}  // namespace

Result<void> add_requirement(Requirements& requirements, std::string_view text) {
    const auto equals = text.find('=');
    const std::string_view name = text.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? std::string_view() : text.substr(equals + 1);
    const auto key = find_by_name(kRequirementKeyNames, name);
    if (!key) {
        std::string names;
        for (const auto& row : kRequirementKeyNames) names.append(names.empty() ? "" : ", ").append(row.name);
        return bad_option(std::string("'").append(name).append("' cannot be required; there are ").append(names));
    }
    const bool has_no_value = *key == RequirementKey::pow2 || *key == RequirementKey::tiles;
    if (has_no_value != (equals == std::string_view::npos)) {
        return bad_option(std::string(name) +
                          (has_no_value ? " takes no value" : " needs a value: " + std::string(name) + "=..."));
    }
    switch (*key) {
        case RequirementKey::format: return require_format(requirements, value);
        case RequirementKey::mips: return require_mips(requirements, value);
        case RequirementKey::extent: return require_extent(requirements, value);
        case RequirementKey::max_extent:
            if (const auto side = parse_count(value)) {
                requirements.max_extent = *side;
                return {};
            }
            return bad_option("max-extent=" + std::string(value) + ": not a number of texels");
        case RequirementKey::y:
            requirements.y = find_by_name(kYAxisNames, value);
            if (!requirements.y) return bad_option("y=" + std::string(value) + ": not up or down");
            return {};
        case RequirementKey::pow2: requirements.power_of_two = true; return {};
        case RequirementKey::tiles: requirements.tiles = true; return {};
    }
    return {};
}

Result<void> validate(const CheckOptions& options) {
    const auto known = [](const std::string& name) -> Result<void> {
        if (find_rule(name) != nullptr) return {};
        return bad_option(std::string("there is no rule '").append(name).append("'"));
    };
    for (const auto* names : {&options.enable, &options.disable}) {
        for (const std::string& name : *names) {
            if (auto found = known(name); !found) return found;
        }
    }
    for (const auto& [name, severity] : options.severity) {
        if (auto found = first_error(known(name), check_known("severity", kSeverityNames, severity)); !found)
            return found;
    }
    if (options.marks < 0 || options.marks > kMostMarks)
        return bad_option("marks must be from 0 to " + std::to_string(kMostMarks));
    return first_error(check_known("require.format", kFormatNames, options.require.format),
                       check_known("require.encoding", kEncodingNames, options.require.encoding),
                       check_known("require.y", kYAxisNames, options.require.y));
}

namespace {

// A check runs dozens of loops, and which ones depends on the map. Each reports 0 to 1: it takes half of what is left
// of the progress of the whole.
Execution in_halves(const Execution& execution) {
    if (!execution.progress) return execution;
    Execution halves = execution.quiet();
    halves.progress = [&execution, from = 0.0, last = 0.0](double done) mutable {
        if (done < last) from += 0.5 * (1.0 - from);
        last = done;
        return execution.progress(from + 0.5 * (1.0 - from) * done);
    };
    return halves;
}

}  // namespace

Result<CheckReport> check(const std::string& file, const Texture& texture, const CheckOptions& options,
                          const Execution& whole) {
    return no_throw([&]() -> Result<CheckReport> {
        if (auto usable = check_usable(texture); !usable) return usable.error();
        if (auto valid = validate(options); !valid) return valid.error();
        const Execution execution = in_halves(whole);
        CheckContext context{.texture = texture, .options = options, .execution = execution, .file = file};
        if (auto done = measure(context); !done) return done.error();
        Findings findings(options);
        check_file_rules(context, findings);
        const FoundKind found = check_kind_rules(context, findings);
        if (auto done = check_value_rules(context, findings); !done) return done.error();
        if (auto done = check_extra_rules(context, findings); !done) return done.error();
        if (auto done = check_damage_rules(context, findings); !done) return done.error();
        if (auto done = check_sign_rules(context, findings); !done) return done.error();
        if (auto done = check_field_rules(context, findings); !done) return done.error();
        context.pair = check_pair_rules(context, findings);
        if (context.pair && context.pair->decides()) context.y.y = context.pair->y;
        check_convention_rules(context, findings);
        if (auto done = check_mip_rules(context, findings); !done) return done.error();
        CheckReport report;
        report.pair = context.pair;
        if (auto occlusion = check_occlusion_rules(context, findings)) {
            report.occlusion = *occlusion;
        } else {
            return occlusion.error();
        }
        if (auto seams = check_mesh_rules(context, findings)) {
            report.seams = *seams;
        } else {
            return seams.error();
        }
        check_model_rules(context, findings);
        report.file = file;
        report.findings = findings.take(report.explained);
        if (options.marks > 0) mark_texels(context, report.findings);
        report.format = texture.format;
        report.swizzle = context.stored.swizzle;
        report.extent = texture.extent();
        report.levels = static_cast<int>(texture.levels.size());
        report.more_data = context.has_vectors && has_more_data(context.stored, context.counts);
        report.y = context.y;
        set_kind(context, found.kind, report);
        report.height_bytes = found.height_bytes;
        if (options.mesh != nullptr && context.has_vectors) report.y_on_mesh = y_on_mesh(context);
        if (whole.progress && !whole.progress(1.0)) return Error{ErrorCode::cancelled, {}, "cancelled"};
        return report;
    });
}

namespace {

// The report of a file that could not be read or checked.
CheckReport failed_report(const std::string& file, const CheckOptions& options, const Error& error) {
    CheckReport report;
    report.file = file;
    report.error = error;
    if (error.code != ErrorCode::bad_data && error.code != ErrorCode::unsupported) return report;
    Findings findings(options);
    findings.add("N101", error.reason);
    report.findings = findings.take(report.explained);
    return report;
}

// Adds a finding that the mesh could not be examined. Ids ascend, and this is the last one.
void add_not_examined(const Error& error, const CheckOptions& options, CheckReport& report) {
    const auto explains = [](const Finding& finding) { return has_id(finding.rule->explains, "N807"); };
    if (std::any_of(report.findings.begin(), report.findings.end(), explains)) {
        ++report.explained;
        return;
    }
    Findings findings(options);
    findings.add("N807", error.reason);
    int explained = 0;
    for (Finding& finding : findings.take(explained)) report.findings.push_back(std::move(finding));
}

// CheckReport::material.
std::string material_of_one_map(const Model& model, const ModelMap& map) {
    const auto is_of_same = [&](const ModelMap& other) { return other.material == map.material; };
    if (std::count_if(model.maps.begin(), model.maps.end(), is_of_same) > 1) return {};
    const auto& materials = model.mesh.materials;
    const std::string& name = materials[static_cast<std::size_t>(map.material)].name;
    const auto has_name = [&](const MeshMaterial& other) { return other.name == name; };
    const bool is_unique = std::count_if(materials.begin(), materials.end(), has_name) == 1;
    return !name.empty() && is_unique ? name : selection_of(model, map).material;
}

}  // namespace

Result<CheckReport> check_map(const Model& model, const ModelMap& map, const ModelCheckOptions& options,
                              const ReadOptions& read, const Execution& execution) {
    return no_throw([&]() -> Result<CheckReport> {
        CheckOptions checks = options.checks;
        if (auto valid = validate(checks); !valid) return valid.error();
        if (!checks.require.y) {
            checks.require.y = YAxis::up;
            checks.disable.push_back("N403");  // nobody asked for the direction
            checks.severity.insert(checks.severity.begin(), {"N401", Severity::warning});
        }
        const auto finished = [&](CheckReport report) {
            report.map = map_name(model, map);
            report.material = material_of_one_map(model, map);
            return report;
        };
        const auto texture = read_map(model, map, read);
        if (!texture) return finished(failed_report(model.file, checks, texture.error()));
        MeshSelection selection = selection_of(model, map);
        selection.tangents = options.tangents;
        const auto selected = select_part(model.mesh, selection, execution);
        const MapInModel in{model, map};
        checks.model = &in;
        std::optional<MeshToCheck> mesh;
        if (selected) mesh.emplace(MeshToCheck{*selected, options.decoder, model.file, map.scale});
        checks.mesh = mesh ? &*mesh : nullptr;
        auto report = check(model.file, *texture, checks, execution);
        if (!report && mesh && report.error().code != ErrorCode::cancelled &&
            report.error().code != ErrorCode::out_of_memory) {
            const Error why = report.error();
            checks.mesh = nullptr;
            report = check(model.file, *texture, checks, execution);
            if (report) add_not_examined(why, checks, *report);
        } else if (report && !selected) {
            add_not_examined(selected.error(), checks, *report);
        }
        return finished(report ? std::move(*report) : failed_report(model.file, checks, report.error()));
    });
}

Result<std::vector<CheckReport>> check_model(const std::string& path, const ModelCheckOptions& options,
                                             const ReadOptions& read, const Execution& execution) {
    return no_throw([&]() -> Result<std::vector<CheckReport>> {
        if (auto valid = validate(options.checks); !valid) return valid.error();
        MeshReadOptions how;
        how.reader = read;
        const auto model = read_model(path, how);
        if (!model) return model.error();
        const auto maps = maps_of(*model, options.material);
        if (!maps) return maps.error();
        std::vector<CheckReport> reports;
        for (const ModelMap& map : *maps) {
            auto report = check_map(*model, map, options, read, execution);
            if (!report) return report.error();
            const auto& error = report->error;
            if (error && (error->code == ErrorCode::cancelled || error->code == ErrorCode::out_of_memory))
                return *error;
            reports.push_back(std::move(*report));
        }
        return reports;
    });
}

Result<CheckReport> check_file(const std::string& path, const CheckOptions& options, const ReadOptions& read,
                               const Execution& execution) {
    return no_throw([&]() -> Result<CheckReport> {
        if (auto valid = validate(options); !valid) return valid.error();
        const auto texture = read_texture(path, read);
        if (!texture) return failed_report(path, options, texture.error());
        auto checked = check(path, *texture, options, execution);
        if (checked) return checked;
        CheckReport report;
        report.file = path;
        report.error = checked.error();
        return report;
    });
}

}  // namespace tex::inline v1
