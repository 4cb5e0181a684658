// SPDX-License-Identifier: Apache-2.0
// repair_bench: which damages repair() undoes in 40 clean maps of ../shared/data/wild4, and how exactly.
//
//     repair_bench [MAPS [FIRST]] [likely]
//                                    the number of maps (40) and of storages (all 5), or "jpeg" for JPEG alone; with
//                                    likely repairs for every damage
//     repair_bench --pairs [MAPS]    two damages at once, in 8 bits
//     repair_bench --all             what repairs do to all of wild4, undamaged
//
// Each damage is planted into the middle of a map in double, and the result is stored with 8 and 16 bits, as a JPEG of
// quality 75, as DXT5nm and as BC5. A damage is visible if it turns the normals by a degree or more in the mean. It is
// undone if the mean angle to the undamaged map is at most twice that of a reference, which undoes the same damage in
// double and stores the result once, or 0.2 degrees, which is half a code of 8 bits. Half of the maps, by a hash of
// their names, are held out: thresholds may be set on the others alone. The direction of green that the undamaged map
// shows is required; maps that show none are left out where a damage is about it.

#include <algorithm>
#include <cmath>
#include <cstdint>
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

#include "bench/repair_damages.h"
#include "bench/wild_maps.h"
#include "reference/damage.h"

namespace {

using namespace tex;
using namespace tex::reference;

constexpr double kVisible = 1.0, kFactor = 2.0, kExact = 0.2;  // degrees

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

enum class Storage { rgb8, rgb16, jpeg, dxt5nm, bc5 };
constexpr int kStorages = 5, kJpegQuality = 75;
constexpr const char* kStorageNames[] = {"8 bits", "16 bits", "JPEG 75", "DXT5nm", "BC5"};

bool has_blue(Storage storage) { return storage != Storage::dxt5nm && storage != Storage::bc5; }

Texture stored_as(const Values& values, Storage storage) {
    Texture texture;
    if (!has_blue(storage)) {
        MipChain chain;
        chain.levels.push_back(map_of(values));
        const Encoding encoding = storage == Storage::bc5 ? Encoding::bc5 : Encoding::dxt5nm;
        return *pack(chain, {encoding, YAxis::up, Effort::normal, Metric::component, false});
    }
    if (storage == Storage::jpeg) {
        Codes codes{values.extent, values.channels, {}};
        for (const double c : values.of)
            codes.values.push_back(static_cast<unsigned char>(std::lround(255.0 * std::clamp(c, 0.0, 1.0))));
        return texture_of(reference::jpeg(codes, kJpegQuality));
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
    Count of[2][kStorages];  // tune and held out; by storage
};

struct Judged {
    Damage damage;
    Tally tally;
};

// How many damages that turn the normals by so many degrees or more are undone.
struct Curve {
    static constexpr double kFrom[] = {1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
    Count of[std::size(kFrom)][kStorages];
    void add(double degrees, int storage, bool is_undone) {
        for (std::size_t k = 0; k < std::size(kFrom); ++k) {
            if (degrees < kFrom[k]) continue;
            ++of[k][storage].visible;
            of[k][storage].undone += is_undone ? 1 : 0;
        }
    }
    void print() const {
        for (std::size_t k = 0; k < std::size(kFrom); ++k) {
            std::printf("from %2.0f degrees on                  ", kFrom[k]);
            for (const Count& count : of[k])
                std::printf(" %5d/%-4d %5.1f %%     ", count.undone, count.visible,
                            100.0 * count.undone / std::max(1, count.visible));
            std::printf("\n");
        }
    }
};

// FNV-1a of the name without its folder.
bool is_held_out(const std::string& file) {
    std::uint32_t hash = 2166136261u;
    for (const char c : file.substr(file.rfind('/') + 1)) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    return (hash >> 16) % 2 == 1;
}

// From the first storage to the one before `end`.
struct Storages {
    int first = 0, end = kStorages;
};

void judge(const Codes& codes, const std::string& file, const Storages& storages, bool likely, std::vector<Judged>& all,
           Curve& curve) {
    const bool held_out = is_held_out(file);
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
        for (int s = storages.first; s < storages.end; ++s) {
            const auto storage = static_cast<Storage>(s);
            if (damage.needs_blue && !has_blue(storage)) continue;
            if (damage.with_alpha && storage == Storage::jpeg) continue;
            const Texture texture = stored_as(damaged, storage);
            Count& count = row.tally.of[held_out ? 1 : 0][s];
            const double turned = angle_to(undamaged->levels.front(), texture);
            if (turned < kVisible) continue;
            RepairOptions options;
            options.likely = damage.likely || likely;
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
            const bool is_undone = angle <= std::max(kFactor * reference, kExact);
            curve.add(turned, s, is_undone);
            if (!is_undone) {
                std::string ids;
                for (const auto& step : repaired->steps) ids += " " + text_of(step);
                ids += ";";
                for (const auto& fault : repaired->left) ids += " " + std::string(fault.finding.rule->id);
                std::fprintf(stderr, "%s: %s, %s, %s: %.2f degrees, reference %.2f:%s\n",
                             held_out ? "held out" : "tune", file.c_str(), damage.name.c_str(), kStorageNames[s], angle,
                             reference, ids.c_str());
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
    Storages storages{0, is_of_pairs ? 1 : kStorages};
    if (!is_of_pairs && argc > 2) {
        constexpr int kJpeg = static_cast<int>(Storage::jpeg);
        const bool is_jpeg = std::string_view(argv[2]) == "jpeg";
        storages = is_jpeg ? Storages{kJpeg, kJpeg + 1} : Storages{0, std::clamp(std::atoi(argv[2]), 1, kStorages)};
    }
    std::vector<Judged> all;
    for (const Damage& damage : is_of_pairs ? damage_pairs() : damages()) all.push_back({damage, {}});
    const std::vector<std::string> files = clean_maps(static_cast<std::size_t>(count ? std::atoi(count) : 40));
    const bool likely = std::string_view(argv[argc - 1]) == "likely";
    Curve curve;
    for (const std::string& file : files) {
        if (const auto codes = middle_of(file)) judge(*codes, file, storages, likely, all, curve);
    }
    print(all, 0);
    print(all, 1);
    curve.print();
    return 0;
}
