// SPDX-License-Identifier: Apache-2.0

#include "stream/given_others.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "rows/usable.h"

namespace tex {
namespace {

// Joins normals and planes of other data.
class JoinStage final : public Stage {
public:
    JoinStage(const Stage& normals, OtherPlanes others, const Plane<float>& blue, const Plane<float>& alpha)
        : Stage(normals.extent(), others), normals_(normals), blue_(blue), alpha_(alpha) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override { return {{&normals_, first, end}}; }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k) {
            const int j = strip.first + k;
            for (const int plane : {0, 1, 2}) copy(normals_.row(plane, j), strip.row(plane, k));
            if (others().alpha)
                copy(alpha_.empty() ? normals_.row(kAlphaPlane, j) : alpha_.row(j), strip.row(kAlphaPlane, k));
            if (others().blue)
                copy(blue_.empty() ? normals_.row(kBluePlane, j) : blue_.row(j), strip.row(kBluePlane, k));
        }
        return {};
    }

private:
    void copy(const float* from, float* to) const { std::copy_n(from, extent().width, to); }

    const Stage& normals_;
    const Plane<float>&blue_, &alpha_;
};

Error cannot_hold(const char* channel, Encoding encoding) {
    std::string able;
    for (const auto& row : kEncodingNames) {
        if (channel[0] == 'b' ? can_hold(row.value).blue : can_hold(row.value).alpha)
            able.append(able.empty() ? "" : ", ").append(row.name);
    }
    return Error{ErrorCode::bad_option,
                 {},
                 std::string(name_of(kEncodingNames, encoding)) + " has no " + channel +
                     " for data beside the normals; these formats have: " + able};
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

}  // namespace

OtherPlanes planes_given(const OtherInputs& inputs) { return {inputs.blue.has_value(), inputs.alpha.has_value()}; }

Result<GivenOthers> GivenOthers::read(const OtherInputs& inputs, Extent base, const std::vector<FileTarget>& files) {
    GivenOthers given;
    given.planes_ = planes_given(inputs);
    for (const FileTarget& file : files) {
        const OtherPlanes held = can_hold(file.pack.encoding);
        if (inputs.alpha && !held.alpha) return cannot_hold("alpha", file.pack.encoding);
        if (inputs.blue && !held.blue) return cannot_hold("blue", file.pack.encoding);
    }
    for (const auto& [data, plane, name] :
         {std::tuple(&inputs.blue, &given.blue_, "blue"), std::tuple(&inputs.alpha, &given.alpha_, "alpha")}) {
        if (!*data || (*data)->heights) continue;
        Result<Plane<float>> read = plane_of(**data, base, name);
        if (!read) return read.error();
        *plane = std::move(*read);
    }
    return given;
}

const Stage& GivenOthers::add_to(Flow& flow, const Stage& normals) const {
    if (blue_.empty() && alpha_.empty()) return normals;
    const OtherPlanes own = normals.others();
    const OtherPlanes all{own.blue || planes_.blue, own.alpha || planes_.alpha};
    return flow.add<JoinStage>(normals, all, blue_, alpha_);
}

}  // namespace tex
