// SPDX-License-Identifier: Apache-2.0

#include "stream/given_others.h"

#include <algorithm>
#include <string>
#include <utility>

#include "rows/usable.h"
#include "threads/guard.h"

namespace tex::inline v1 {
namespace {

// Where a place's data come from.
struct GivenPlace {
    const OtherPlace& place;
    std::optional<OtherData> OtherInputs::*data;
};
constexpr GivenPlace kGivenPlaces[] = {
    {kOtherPlaces[0], &OtherInputs::alpha},
    {kOtherPlaces[1], &OtherInputs::blue},
    {kOtherPlaces[2], &OtherInputs::length},
};

// Joins normals and planes of other data. Planes that are empty come with the normals.
class JoinStage final : public Stage {
public:
    JoinStage(const Stage& normals, OtherPlanes others, const NormalMap& given)
        : Stage(normals.extent(), others), normals_(normals), given_(given) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&normals_, first, end}}; }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k) {
            const int j = strip.first + k;
            for (const int plane : {0, 1, 2}) copy(normals_.row(plane, j), strip.row(plane, k));
            int plane = kFirstOtherPlane;
            for (const OtherPlace& place : kOtherPlaces) {
                const Plane<float>& given = given_.*place.plane;
                if (others().*place.has)
                    copy(given.empty() ? normals_.row(plane, j) : given.row(j), strip.row(plane, k));
                ++plane;
            }
        }
        return {};
    }

private:
    void copy(const float* from, float* to) const { std::copy_n(from, extent().width, to); }

    const Stage& normals_;
    const NormalMap& given_;
};

Result<void> check_room(OtherPlanes given, Encoding encoding) {
    for (const OtherPlace& place : kOtherPlaces) {
        if (!(given.*place.has) || can_hold(encoding).*place.has) continue;
        std::string able;
        for (const auto& row : kEncodingNames) {
            if (can_hold(row.value).*place.has) able.append(able.empty() ? "" : ", ").append(row.name);
        }
        return bad_option(std::string(name_of(kEncodingNames, encoding)) + " has no " + place.name +
                          " for data beside the normals; these formats have: " + able);
    }
    return {};
}

Result<Plane<float>> plane_of(const OtherData& given, Extent base, const std::string& name) {
    if (!given.map) {
        if (!(given.value >= 0.0f && given.value <= 1.0f)) return bad_option(name + ": must be from 0 to 1");
        return Plane<float>(base, given.value);
    }
    Result<Plane<float>> plane = given.map();
    if (!plane) return plane;
    if (plane->extent() != base) {
        const auto text = [](Extent e) { return std::to_string(e.width) + "x" + std::to_string(e.height); };
        return bad_option(name + ": the map has " + text(plane->extent()) + " texels, the normals have " + text(base));
    }
    return plane;
}

// Reads what is given, apart from heights that are baked, into the planes of `map`.
Result<void> read_given(const OtherInputs& inputs, Extent base, NormalMap& map) {
    for (const auto& [place, data] : kGivenPlaces) {
        const std::optional<OtherData>& given = inputs.*data;
        if (!given || given->heights) continue;
        Result<Plane<float>> read = plane_of(*given, base, place.name);
        if (!read) return read.error();
        map.*place.plane = std::move(*read);
    }
    return {};
}

}  // namespace

OtherPlanes planes_given(const OtherInputs& inputs) {
    OtherPlanes planes;
    for (const auto& [place, data] : kGivenPlaces) planes.*place.has = (inputs.*data).has_value();
    return planes;
}

Result<void> check_together(OtherPlanes beside) {
    if (!beside.blue || !beside.length) return {};
    return bad_option("blue and length exclude each other: without z, a vector has no length");
}

bool may_change_ones(const MipOptions& mip, const std::vector<FileTarget>& files) {
    return follows_normals(mip.alpha) || std::any_of(files.begin(), files.end(), [](const FileTarget& file) {
               const Format format = encoding_info(file.pack.encoding).format;
               return can_hold(file.pack.encoding).alpha && format_info(format).sample == SampleKind::floating;
           });
}

Result<GivenOthers> GivenOthers::read(const OtherInputs& inputs, Extent base, const std::vector<FileTarget>& files) {
    GivenOthers given;
    given.planes_ = planes_given(inputs);
    if (auto fits = check_together(given.planes_); !fits) return fits.error();
    for (const FileTarget& file : files) {
        if (auto fits = check_room(given.planes_, file.pack.encoding); !fits) return fits.error();
    }
    if (auto read = read_given(inputs, base, given.map_); !read) return read.error();
    return given;
}

const Stage& GivenOthers::add_to(Flow& flow, const Stage& normals) const {
    if (others_of(map_) == OtherPlanes()) return normals;
    return flow.add<JoinStage>(normals, normals.others() | planes_, map_);
}

Result<void> put_others(NormalMap& map, const OtherInputs& inputs, Encoding encoding) {
    return guarded([&]() -> Result<void> {
        if (auto usable = check_usable(map); !usable) return usable;
        for (const auto& [place, data] : kGivenPlaces) {
            if (inputs.*data && (inputs.*data)->heights)
                return bad_option("others: there are no heights, only normals");
        }
        if (auto fits = check_together(others_of(map) | planes_given(inputs)); !fits) return fits;
        if (auto fits = check_room(planes_given(inputs), encoding); !fits) return fits;
        return read_given(inputs, map.extent(), map);
    });
}

}  // namespace tex::inline v1
