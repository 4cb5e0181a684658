// SPDX-License-Identifier: Apache-2.0
// The errors that the headers of the verbs promise: `cancelled` and `out_of_memory` of each verb, and `bad_data`.
// (usable_test.cpp has bad_option.) Memory runs out because the thread has been lent little: planes come from that.

#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "fields.h"
#include "memory/lent_memory.h"
#include "normal_maps.h"

namespace {

using tex::ErrorCode;
using tex::Execution;
using tex::Extent;

constexpr Extent kExtent{200, 120};

// What went wrong; nothing if nothing did.
template <class T>
std::optional<ErrorCode> error_of(const tex::Result<T>& result) {
    if (result) return std::nullopt;
    return result.error().code;
}

tex::HeightField stepped_heights() {
    tex::HeightField field;
    field.height = tex::fields::plane_of(
        kExtent, [](int i, int j) { return std::round(127.0 + 60.0 * std::sin(0.03 * i + 0.02 * j)) / 255.0; });
    return field;
}

tex::Image picture() {
    tex::Image image;
    for (const char* name : {"R", "G", "B"}) {
        image.names.emplace_back(name);
        image.planes.push_back(tex::fields::plane_of(kExtent, [](int i, int) { return i % 7 / 10.0; }));
    }
    return image;
}

tex::Texture texture() { return *tex::pack(tex::chain_from(tex::wavy_map(kExtent)), {tex::Encoding::bc5}); }

tex::MeshPart quad() {
    tex::MeshPart part;
    part.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    part.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    part.uvs = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    part.indices = {0, 1, 2, 0, 2, 3};
    return part;
}

// A verb whose inputs exist already.
struct Verb {
    const char* name;
    std::function<std::optional<ErrorCode>(const Execution& execution)> run;
    bool makes_planes = true;  // its memory is that of planes
};

std::vector<Verb> verbs() {
    static const tex::HeightField field = stepped_heights();
    static const tex::NormalMap map = tex::wavy_map(kExtent), other = tex::wavy_map(kExtent, 1.0);
    static const tex::MipChain chain = tex::chain_from(tex::wavy_map(kExtent));
    static const tex::Image image = picture();
    static const tex::Texture packed = texture();
    static const tex::MeshPart part = quad();
    static const tex::Plane<float> rough(kExtent, 0.5f);
    // Functions that take their input do not return it, so each run gets a new map from the heap.
    static std::vector<tex::NormalMap> given;
    static std::vector<tex::HeightField> fields;
    static std::vector<std::vector<tex::Layer>> layers;
    for (int k = 0; k < 16; ++k) {
        given.push_back(tex::wavy_map(kExtent));
        fields.push_back(stepped_heights());
        tex::Layer layer;
        layer.detail = tex::chain_from(tex::wavy_map({50, 60}));
        layer.rotation = 30.0f;
        layers.emplace_back();
        layers.back().push_back(std::move(layer));
    }
    const auto take = [](auto& from) {
        auto one = std::move(from.back());
        from.pop_back();
        return one;
    };
    return {
        {"bake", [](const Execution& e) { return error_of(tex::bake(field, {}, e)); }},
        {"deband",
         [=](const Execution& e) {
             tex::HeightField own = take(fields);
             return error_of(tex::deband(std::move(own), tex::Deband::on, e));
         }},
        {"height_field",
         [](const Execution& e) {
             tex::HeightOptions options;
             options.blur_sigma = 2.0f;
             return error_of(tex::height_field(image, options, e));
         }},
        {"build_mip_chain", [=](const Execution& e) { return error_of(tex::build_mip_chain(take(given), {}, e)); }},
        {"build_roughness_chain",
         [](const Execution& e) {
             return error_of(tex::build_roughness_chain(map, rough, tex::RoughnessModel::toksvig, {}, e));
         }},
        {"scale", [=](const Execution& e) { return error_of(tex::scale(take(given), 2.0f, tex::ScaleMode::slope, e)); },
         false},
        {"blend",
         [=](const Execution& e) { return error_of(tex::blend(tex::chain_from(take(given)), take(layers), {}, e)); }},
        {"pack", [](const Execution& e) { return error_of(tex::pack(chain, {}, e)); }, false},
        {"decode", [](const Execution& e) { return error_of(tex::decode(packed, 0, e)); }},
        {"unpack a texture", [](const Execution& e) { return error_of(tex::unpack(packed, {}, e)); }},
        {"unpack a picture", [](const Execution& e) { return error_of(tex::unpack(image, {}, e)); }},
        {"integrate", [](const Execution& e) { return error_of(tex::integrate(map, {}, e)); }},
        {"curvature", [](const Execution& e) { return error_of(tex::curvature(map, {}, e)); }},
        {"occlusion",
         [](const Execution& e) {
             return error_of(tex::occlusion(field, {4, 0.0f, true, true, true, 4}, {}, e));
         }},
        {"compare", [](const Execution& e) { return error_of(tex::compare(map, other, e)); }},
        {"make_tangents",
         [](const Execution& e) { return error_of(tex::make_tangents(part, tex::TangentMethod::mikktspace, 0, e)); },
         false},
    };
}

TEST(DocumentedErrors, EveryVerbSucceedsWithMemoryAndTime) {
    for (const Verb& verb : verbs()) EXPECT_EQ(verb.run({1, {}}), std::nullopt) << verb.name;
}

TEST(DocumentedErrors, EveryVerbCanBeCancelled) {
    for (const Verb& verb : verbs())
        EXPECT_EQ(verb.run({1, [](double) { return false; }}), ErrorCode::cancelled) << verb.name;
}

// However far a verb gets before memory runs out, that is its only error.
TEST(DocumentedErrors, EveryVerbSaysThatMemoryRanOut) {
    std::vector<unsigned char> memory(std::size_t{4} << 20);
    for (const Verb& verb : verbs()) {
        int failed = 0;
        for (const std::size_t size : {std::size_t{64}, std::size_t{2000}, std::size_t{100000}, std::size_t{400000}}) {
            tex::LentMemory little(memory.data(), size);
            const tex::Lend lend(little);
            const auto error = verb.run({1, {}});
            EXPECT_TRUE(!error || *error == ErrorCode::out_of_memory) << verb.name << " with " << size;
            failed += error ? 1 : 0;
        }
        EXPECT_GE(failed, verb.makes_planes ? 1 : 0) << verb.name;
    }
}

TEST(DocumentedErrors, DataThatCannotBeUsedAreBadData) {
    tex::HeightField field = stepped_heights();
    field.height.at(3, 4) = std::numeric_limits<float>::infinity();
    EXPECT_EQ(error_of(tex::bake(field)), ErrorCode::bad_data);
    tex::Image image = picture();
    for (auto& plane : image.planes) plane.at(5, 6) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(error_of(tex::height_field(image, {})), ErrorCode::bad_data) << "an invalid texel";
    for (auto& plane : image.planes) plane = tex::Plane<float>(kExtent, std::numeric_limits<float>::quiet_NaN());
    tex::HeightOptions fill;
    fill.fill_invalid = true;
    EXPECT_EQ(error_of(tex::height_field(image, fill)), ErrorCode::bad_data) << "no valid texel";
    EXPECT_EQ(error_of(tex::integrate(tex::uniform_map(kExtent, 0.6f, 0.0f, -0.8f))), ErrorCode::bad_data);
    EXPECT_EQ(error_of(tex::integrate(tex::uniform_map(kExtent, 1.0f, 0.0f, 0.0f))), ErrorCode::bad_data);
    tex::MeshPart part = quad();
    part.indices[4] = 9;
    EXPECT_EQ(error_of(tex::make_tangents(part)), ErrorCode::bad_data);
}

}  // namespace
