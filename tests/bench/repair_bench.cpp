// SPDX-License-Identifier: Apache-2.0
// repair_bench: which damages repair() undoes in 40 clean maps of ../shared/data/wild4, and how exactly.
//
//     repair_bench [MAPS]        the number of maps (40)
//     repair_bench --pairs [MAPS]    two damages at once
//     repair_bench --all         what repairs do to all of wild4, undamaged
//
// Each damage is planted into the middle of a map in double, and the result is stored with 8 and 16 bits, as DXT5nm and
// as BC5. A damage is visible if it turns the normals by a degree or more in the mean. It is undone if the mean angle
// to the undamaged map is at most twice that of a reference, which undoes the same damage in double and stores the
// result once, or 0.2 degrees, which is half a code of 8 bits. Every second map is held out: thresholds may be set on
// the others alone. The direction of green that the undamaged map shows is required; maps that show none are left out
// where a damage is about it.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tex/tex.h>

#include "bench/wild_maps.h"
#include "reference/damage.h"

namespace {

using namespace tex;
using namespace tex::reference;

constexpr double kVisible = 1.0, kFactor = 2.0, kExact = 0.2;  // degrees

// A picture of stored values, 0 to 1: R, G, B (and A).
struct Values {
    Extent extent;
    int channels = 3;
    std::vector<double> of;
};

double curve(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055; }
double curve_back(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

using Change = std::function<void(double* texel, std::size_t place)>;

Values each(Values values, const Change& change) {
    const auto step = static_cast<std::size_t>(values.channels);
    for (std::size_t k = 0; k < values.of.size(); k += step) change(&values.of[k], k / step);
    return values;
}

Change each_channel(double (*by)(double)) {
    return [by](double* t, std::size_t) { std::transform(t, t + 3, t, by); };
}

double without_curve(double c) { return curve_back(std::clamp(c, 0.0, 1.0)); }
double with_curve(double c) { return curve(std::clamp(c, 0.0, 1.0)); }

Change inverted(int channel) {
    return [channel](double* t, std::size_t) { t[channel] = 1.0 - t[channel]; };
}

Change exchanged(int a, int b) {
    return [a, b](double* t, std::size_t) { std::swap(t[a], t[b]); };
}

double rebuilt_z(const double* t) {
    const double x = 2.0 * t[0] - 1.0, y = 2.0 * t[1] - 1.0;
    return 0.5 + 0.5 * std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
}

struct Damage {
    std::string name;
    Change plant, undo;
    bool likely = false;      // undone with RepairOptions::likely
    bool needs_y = false;     // is about the direction of green
    bool needs_blue = false;  // z must be stored
    bool with_alpha = false;
    bool needs_heights = false;
};

const std::vector<Damage>& damages() {
    static const std::vector<Damage> kDamages = {
        {"sRGB encoded", each_channel(with_curve), each_channel(without_curve)},
        {"sRGB decoded", each_channel(without_curve), each_channel(with_curve)},
        {"premultiplied",
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] *= t[3];
         },
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] = t[3] > 0.0 ? std::min(1.0, t[c] / t[3]) : c == 2 ? 1.0 : 0.5;
         },
         false, false, true, true},
        {"BGR", exchanged(0, 2), exchanged(0, 2), false, false, true},
        {"gamma 1.2",
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] = std::pow(t[c], 1.0 / 1.2);
         },
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] = std::pow(std::max(0.0, t[c]), 1.2);
         },
         true, false, true},
        {"levels to 90 %",
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] = std::min(1.0, t[c] / 0.9);
         },
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] *= 0.9;
             t[2] = rebuilt_z(t);
         },
         true, false, true},
        {"levels from 10 %",
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] = std::max(0.0, (t[c] - 0.1) / 0.9);
         },
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] = 0.1 + 0.9 * t[c];
         },
         true, false, true},
        {"darkened to 0.8",
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] *= 0.8;
         },
         [](double* t, std::size_t) {
             for (int c = 0; c < 3; ++c) t[c] = std::min(1.0, t[c] / 0.8);
         },
         false, false, true},
        {"z from 0 to 1", [](double* t, std::size_t) { t[2] = std::max(0.0, 2.0 * t[2] - 1.0); },
         [](double* t, std::size_t) { t[2] = 0.5 + 0.5 * t[2]; }, false, false, true},
        {"blue is 1", [](double* t, std::size_t) { t[2] = 1.0; }, [](double* t, std::size_t) { t[2] = rebuilt_z(t); },
         false, false, true},
        {"blue inverted", inverted(2), inverted(2), true, false, true},
        {"green inverted", inverted(1), inverted(1), true, true},
        {"x and y exchanged", exchanged(0, 1), exchanged(0, 1), true, true},
        {"red, with heights", inverted(0), inverted(0), false, true, false, false, true},
        {"green, with heights", inverted(1), inverted(1), false, true, false, false, true},
    };
    return kDamages;
}

// Pairs that can stand together: the first one happened first.
std::vector<Damage> pairs() {
    const std::vector<std::pair<const char*, const char*>> kPairs = {
        {"sRGB encoded", "premultiplied"},
        {"sRGB decoded", "premultiplied"},
        {"BGR", "premultiplied"},
        {"sRGB encoded", "BGR"},
        {"sRGB decoded", "BGR"},
        {"green inverted", "sRGB encoded"},
        {"green inverted", "sRGB decoded"},
        {"green inverted", "premultiplied"},
        {"green inverted", "BGR"},
        {"green inverted", "blue inverted"},
        {"blue inverted", "sRGB encoded"},
        {"blue inverted", "sRGB decoded"},
        {"blue inverted", "premultiplied"},
        {"green inverted", "z from 0 to 1"},
        {"z from 0 to 1", "premultiplied"},
        {"blue is 1", "green inverted"},
        {"x and y exchanged", "sRGB encoded"},
        {"x and y exchanged", "premultiplied"},
    };
    const auto named = [](const char* name) {
        return *std::find_if(damages().begin(), damages().end(), [&](const Damage& d) { return d.name == name; });
    };
    std::vector<Damage> all;
    for (const auto& [first, second] : kPairs) {
        const Damage a = named(first), b = named(second);
        Damage& both = all.emplace_back();
        both.name = a.name + ", " + b.name;
        both.plant = [a, b](double* t, std::size_t k) { a.plant(t, k), b.plant(t, k); };
        both.undo = [a, b](double* t, std::size_t k) { b.undo(t, k), a.undo(t, k); };
        both.likely = true;  // two damages can hide each other
        both.needs_y = a.needs_y || b.needs_y;
        both.needs_blue = true;
        both.with_alpha = a.with_alpha || b.with_alpha;
    }
    return all;
}

Values values_of(const Codes& codes, bool with_alpha) {
    const Codes from = with_alpha ? reference::with_alpha(codes, false) : codes;
    Values values{from.extent, from.channels, {}};
    for (const unsigned char code : from.values) values.of.push_back(code / 255.0);
    return values;
}

NormalMap map_of(const Values& values) {
    NormalMap map(values.extent);
    for (int j = 0; j < values.extent.height; ++j) {
        for (int i = 0; i < values.extent.width; ++i) {
            const double* t = &values.of[static_cast<std::size_t>((j * values.extent.width + i) * values.channels)];
            map.x.at(i, j) = static_cast<float>(2.0 * t[0] - 1.0);
            map.y.at(i, j) = static_cast<float>(2.0 * t[1] - 1.0);
            map.z.at(i, j) = static_cast<float>(2.0 * t[2] - 1.0);
        }
    }
    return map;
}

enum class Storage { rgb8, rgb16, dxt5nm, bc5 };
constexpr const char* kStorageNames[] = {"8 bits", "16 bits", "DXT5nm", "BC5"};

bool has_blue(Storage storage) { return storage == Storage::rgb8 || storage == Storage::rgb16; }

Texture stored_as(const Values& values, Storage storage) {
    Texture texture;
    if (!has_blue(storage)) {
        MipChain chain;
        chain.levels.push_back(map_of(values));
        const Encoding encoding = storage == Storage::bc5 ? Encoding::bc5 : Encoding::dxt5nm;
        return *pack(chain, {encoding, YAxis::up, Effort::normal, Metric::component, false});
    }
    const int bits = storage == Storage::rgb8 ? 8 : 16;
    texture.format = *format_of(SampleKind::unorm, bits, values.channels);
    Level level{values.extent, {}};
    for (const double c : values.of) {
        const auto code = static_cast<unsigned>(std::lround(std::clamp(c, 0.0, 1.0) * ((1 << bits) - 1)));
        for (int shift = 0; shift < bits; shift += 8)
            level.bytes.push_back(static_cast<std::byte>(code >> shift & 255));
    }
    texture.levels.push_back(std::move(level));
    return texture;
}

// What is stored, as values of R, G, B (and A).
Values values_in(const Texture& texture, Storage storage) {
    const auto image = decode(texture, 0);
    const Extent extent = image->extent();
    Values values{extent, has_blue(storage) ? static_cast<int>(image->planes.size()) : 3, {}};
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            const auto at = [&](int c) {
                return static_cast<double>(image->planes[static_cast<std::size_t>(c)].at(i, j));
            };
            if (has_blue(storage)) {
                for (int c = 0; c < values.channels; ++c) values.of.push_back(at(c));
                continue;
            }
            const double t[3] = {at(storage == Storage::bc5 ? 0 : 3), at(1), 0.0};
            values.of.insert(values.of.end(), {t[0], t[1], rebuilt_z(t)});
        }
    }
    return values;
}

// The mean angle between the undamaged map and what a reader sees in a texture.
double angle_to(const NormalMap& undamaged, const Texture& texture) {
    UnpackOptions as_stored;
    as_stored.y_axis = YAxis::up;
    auto chain = unpack(texture, as_stored);
    if (!chain) return 180.0;
    const auto compared = compare(undamaged, chain->levels.front());
    return compared ? compared->error.mean : 180.0;
}

bool has(const CheckReport& report, std::string_view id) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [id](const Finding& finding) { return finding.rule->id == id; });
}

struct Count {
    int visible = 0, undone = 0;
    double angle = 0.0, reference = 0.0;  // sums over what is undone
};

struct Tally {
    Count of[2][4];  // tune and held out; by storage
};

struct Judged {
    Damage damage;
    Tally tally;
};

void judge(const Codes& codes, const std::string& file, bool held_out, std::vector<Judged>& all) {
    CheckOptions checks;
    const auto plain = check(file, stored_as(values_of(codes, false), Storage::rgb8), checks);
    if (!plain || has(*plain, "N206")) return;  // nothing shows on one colour
    std::optional<HeightField> heights;
    if (plain->y.y) {
        Texture whole = stored_as(values_of(codes, false), Storage::rgb8);
        UnpackOptions measured;
        measured.y_axis = plain->y.y;
        if (auto surface = tex::integrate(unpack(whole, measured)->levels.front())) {
            heights = std::move(surface->field);
        }
    }
    for (Judged& row : all) {
        const Damage& damage = row.damage;
        if (damage.needs_heights && !heights) continue;
        if (damage.needs_y && !plain->y.y) continue;
        const Values intact = values_of(codes, damage.with_alpha);
        const auto undamaged = unpack(stored_as(intact, Storage::rgb16));
        const Values damaged = each(intact, damage.plant);
        for (int s = 0; s < 4; ++s) {
            const auto storage = static_cast<Storage>(s);
            if (damage.needs_blue && !has_blue(storage)) continue;
            const Texture texture = stored_as(damaged, storage);
            Count& count = row.tally.of[held_out ? 1 : 0][s];
            if (angle_to(undamaged->levels.front(), texture) < kVisible) continue;
            RepairOptions options;
            options.likely = damage.likely;
            if (damage.needs_y) {
                options.checks.require.y = plain->y.y;
                if (!damage.needs_heights) options.mirrored = MirroredChannel::green;
            }
            if (damage.needs_heights) options.checks.height = &*heights;
            const auto repaired = repair(file, texture, options);
            if (!repaired) std::exit(1);
            const double reference =
                angle_to(undamaged->levels.front(), stored_as(each(values_in(texture, storage), damage.undo), storage));
            const double angle = angle_to(undamaged->levels.front(), repaired->texture ? *repaired->texture : texture);
            ++count.visible;
            if (angle > std::max(kFactor * reference, kExact)) {
                std::string ids;
                for (const auto& step : repaired->steps) ids += " " + text_of(step);
                ids += ";";
                for (const auto& fault : repaired->left) ids += " " + std::string(fault.finding.rule->id);
                std::fprintf(stderr, "%s, %s, %s: %.2f degrees, reference %.2f:%s\n", file.c_str(), damage.name.c_str(),
                             kStorageNames[s], angle, reference, ids.c_str());
                continue;
            }
            ++count.undone;
            count.angle += angle;
            count.reference += reference;
        }
    }
}

void print(const std::vector<Judged>& all, int half) {
    std::printf("%-34s", half == 0 ? "tune" : "held out");
    for (const char* name : kStorageNames) std::printf(" %22s", name);
    std::printf("\n");
    for (const Judged& row : all) {
        std::printf("%-34s", row.damage.name.c_str());
        for (const Count& count : row.tally.of[half]) {
            if (count.visible == 0) {
                std::printf(" %22s", "");
                continue;
            }
            const double n = std::max(1, count.undone);
            std::printf(" %5d/%-3d %5.2f (%5.2f)", count.undone, count.visible, count.angle / n, count.reference / n);
        }
        std::printf("\n");
    }
}

// Which maps of wild4 a safe repair changes, with the verdicts of labels.tsv, and which other pictures a likely one
// takes for maps.
int list_changed() {
    std::ifstream in(kWildMaps + "labels.tsv");
    int maps = 0, others = 0, changed = 0, taken = 0;
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        std::string file, kind, findings, verdict;
        for (std::string* field : {&file, &kind, &findings, &verdict}) std::getline(fields, *field, '\t');
        const bool is_map = kind == "normal" || kind == "labpbr";
        const auto texture = read_texture(kWildMaps + file);
        if (!texture) continue;
        RepairOptions options;
        options.likely = !is_map;
        const auto repaired = repair(file, *texture, options);
        ++(is_map ? maps : others);
        if (!repaired || repaired->steps.empty() || (!is_map && repaired->has_errors())) continue;
        ++(is_map ? changed : taken);
        std::printf("%s (%s; %s; %s):", file.c_str(), kind.c_str(), findings.c_str(), verdict.c_str());
        for (const RepairStep& step : repaired->steps)
            std::printf(" %s %s, %.2f degrees;", std::string(step.rule->id).c_str(), text_of(step).c_str(),
                        step.degrees);
        std::printf("%s\n", repaired->has_errors() ? " an error is left" : "");
    }
    std::printf("safe repairs change %d of %d maps; likely ones make maps of %d of %d other pictures\n", changed, maps,
                taken, others);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "--all") return list_changed();
    const bool is_of_pairs = argc > 1 && std::string_view(argv[1]) == "--pairs";
    const char* const count = is_of_pairs ? (argc > 2 ? argv[2] : nullptr) : (argc > 1 ? argv[1] : nullptr);
    std::vector<Judged> all;
    for (const Damage& damage : is_of_pairs ? pairs() : damages()) all.push_back({damage, {}});
    const std::vector<std::string> files = clean_maps(static_cast<std::size_t>(count ? std::atoi(count) : 40));
    for (std::size_t k = 0; k < files.size(); ++k) {
        if (const auto codes = middle_of(files[k])) judge(*codes, files[k], k % 2 == 1, all);
    }
    print(all, 0);
    print(all, 1);
    return 0;
}
