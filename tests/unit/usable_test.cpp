// SPDX-License-Identifier: Apache-2.0
// What a caller gets wrong is an error in every build, never a crash.

#include "rows/usable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <tex/tex.h>

namespace tex {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

NormalMap flat(Extent extent) {
    NormalMap map(extent);
    for (int j = 0; j < extent.height; ++j) {
        for (int i = 0; i < extent.width; ++i) {
            map.x.at(i, j) = map.y.at(i, j) = 0.0f;
            map.z.at(i, j) = 1.0f;
        }
    }
    return map;
}

MipChain chain(std::vector<Extent> extents) {
    MipChain chain;
    for (const Extent extent : extents) chain.levels.push_back(flat(extent));
    return chain;
}

std::vector<Layer> one(Layer layer) {
    std::vector<Layer> layers;
    layers.push_back(std::move(layer));
    return layers;
}

// The reason of a bad_option; another text if there is none.
template <class T>
std::string refusal(const Result<T>& result) {
    if (result) return "no error";
    return result.error().code == ErrorCode::bad_option ? result.error().reason : "another error";
}

TEST(Usable, MapsWithoutTexelsAreRefused) {
    const std::string empty = "the map has no texels";
    EXPECT_EQ(refusal(bake({})), "the height field has no texels");
    EXPECT_EQ(refusal(deband({})), "the height field has no texels");
    EXPECT_EQ(refusal(build_mip_chain({})), empty);
    EXPECT_EQ(refusal(scale(NormalMap(), 2.0f)), empty);
    EXPECT_EQ(refusal(integrate({})), empty);
    EXPECT_EQ(refusal(curvature({})), empty);
    EXPECT_EQ(refusal(occlusion({})), "the height field has no texels");
    EXPECT_EQ(refusal(compare({}, {})), empty);
    EXPECT_EQ(refusal(compare(flat({2, 2}), flat({2, 1}))), "the maps have different extents");
    EXPECT_EQ(refusal(heat_map({}, 1.0)), empty);
    EXPECT_EQ(refusal(build_roughness_chain(flat({2, 2}), {})), "the roughness map has no texels");
    const MeshPart part;
    const std::vector<Float4> tangents;
    EXPECT_EQ(refusal(to_object_space(NormalMap(), {part, tangents})), empty);
    EXPECT_EQ(refusal(height_field(Image(), {})), "the picture does not have a name for each of its planes");
    EXPECT_EQ(refusal(unpack(Image())), "the picture does not have a name for each of its planes");
    NormalMap odd = flat({2, 2});
    odd.z = Plane<float>({2, 1});
    EXPECT_EQ(refusal(integrate(odd)), "the planes of the map have different extents");
}

TEST(Usable, ChainsAndTexturesHaveTheLevelsThatFollowFromTheBase) {
    const std::string none = "the chain has no level";
    const std::string wrong = "level 1 does not have the extent that follows from the base level";
    EXPECT_EQ(refusal(pack({})), none);
    EXPECT_EQ(refusal(scale(MipChain(), 2.0f)), none);
    EXPECT_EQ(refusal(blend({}, {})), none);
    EXPECT_EQ(refusal(blend(chain({{4, 4}}), one(Layer()))), none);
    EXPECT_EQ(refusal(pack_roughness({})), none);
    EXPECT_EQ(refusal(pack(chain({{4, 4}, {3, 3}}))), wrong);
    EXPECT_EQ(refusal(preview({})), "there is no map to show");

    EXPECT_EQ(refusal(unpack(Texture())), "the texture has no level");
    EXPECT_EQ(refusal(check("a", Texture())), "the texture has no level");
    EXPECT_EQ(refusal(guess_swizzle(Texture())), "level: the texture has no level 0");
    Texture texture = *pack(chain({{8, 8}, {4, 4}}));
    EXPECT_EQ(refusal(decode(texture, 2)), "level: the texture has no level 2");
    EXPECT_EQ(refusal(decode(texture, -1)), "level: the texture has no level -1");
    texture.levels[1].bytes.pop_back();
    EXPECT_EQ(refusal(unpack(texture)), "level 1 does not have the bytes of its format and extent");
    EXPECT_EQ(refusal(decode(texture, 1)), "the level does not have the bytes of its format and extent");
    texture.levels[1].extent = {4, 2};
    EXPECT_EQ(refusal(unpack(texture)), wrong);
}

template <class Options, class Change>
std::string of(Change change) {
    Options options;
    change(options);
    return refusal(validate(options));
}

TEST(Usable, OptionsOutOfRangeAreNamed) {
    EXPECT_EQ(of<BakeOptions>([](auto& o) {
                  o.kernel = GradientKernel::gaussian;
                  o.gaussian_sigma = kNan;
              }),
              "gaussian_sigma: must be above 0 and at most 64");
    EXPECT_EQ(of<BakeOptions>([](auto& o) { o.gaussian_sigma = 0.0f; }), "no error") << "only gaussian reads it";
    EXPECT_EQ(of<MipOptions>([](auto& o) { o.levels = -1; }), "levels: must be 0, for all, or more");
    EXPECT_EQ(of<MipOptions>([](auto& o) { o.max_side = -1; }), "max_side: must be 0, for no limit, or more");
    EXPECT_EQ(of<MipOptions>([](auto& o) {
                  o.fade = Fade{3, 3};
              }),
              "fade: first must be 0 or more, and less than last");
    EXPECT_EQ(of<MipOptions>([](auto& o) {
                  o.any_z = true;
                  o.domain = MipDomain::slope;
              }),
              "any_z: needs the domain vector and no fade");
    EXPECT_EQ(of<BlendOptions>([](auto& o) { o.base_scale = kNan; }), "base_scale: must be at most 1e6 in magnitude");
    EXPECT_EQ(of<BlendOptions>([](auto& o) { o.extent = {4, 0}; }), "extent has no texels");
    EXPECT_EQ(of<Layer>([](auto& o) { o.tiling_y = 0.0f; }), "tiling: must be above 0 and at most 4096");
    EXPECT_EQ(of<Layer>([](auto& o) { o.offset_x = 5000.0f; }), "offset: must be at most 4096 in magnitude");
    EXPECT_EQ(of<Layer>([](auto& o) { o.rotation = kNan; }), "rotation: must be finite");
    EXPECT_EQ(of<Layer>([](auto& o) { o.strength = 1.5f; }), "strength: must be from 0 to 1");
    EXPECT_EQ(of<PackOptions>([](auto& o) { o.rdo.mean = -1.0f; }), "rdo.mean: must be from 0 to 180");
    EXPECT_EQ(of<PackOptions>([](auto& o) { o.rdo.max = kNan; }), "rdo.max: must be from 0 to 180");
    EXPECT_EQ(of<PackOptions>([](auto& o) { o.rdo.window = 1; }), "rdo.window: must be from 64 to 1048576");
    EXPECT_EQ(of<IntegrateOptions>([](auto& o) { o.bumpiness_y = 0.0f; }),
              "bumpiness: must be from 1e-20 to 1e20 in magnitude");
    EXPECT_EQ(of<IntegrateOptions>([](auto& o) { o.least_z = 0.0f; }), "least_z: must be above 0 and at most 1");
    EXPECT_EQ(of<IntegrateOptions>([](auto& o) { o.least_response = 1e-7f; }),
              "least_response: must be from 1e-6 to 1, or 0");
    EXPECT_EQ(of<ConvertOptions>([](auto& o) { o.padding = -1; }), "padding: must be 0 or more");
    EXPECT_EQ(of<ConvertOptions>([](auto& o) { o.subsamples = 9; }), "subsamples: must be from 1 to 8");
    EXPECT_EQ(of<TransferOptions>([](auto& o) { o.front = {Reach::Unit::percent, -1.0}; }), "front: must be 0 or more");
    EXPECT_EQ(of<TransferOptions>([](auto& o) { o.straight_angle = 181.0; }), "straight_angle: must be from 0 to 180");
    EXPECT_EQ(of<TransferOptions>([](auto& o) { o.rays_per_hit = 0; }), "rays_per_hit: must be from 1 to 4096");
    EXPECT_EQ(of<TransferOptions>([](auto& o) {
                  o.occlusion_distance = {Reach::Unit::absolute, -1.0};
              }),
              "occlusion_distance: must be 0 or more");
    EXPECT_EQ(of<TransferOptions>([](auto& o) { o.subsamples = 0; }), "subsamples: must be from 1 to 8");
    EXPECT_EQ(of<PackFileOptions>([](auto& o) { o.level = -1; }), "level: must be 0 or more");
    EXPECT_EQ(of<PackFileOptions>([](auto& o) { o.roughness.emplace(); }), "roughness: needs mip");
    EXPECT_EQ(of<BlendFileOptions>([](auto& o) { o.layers.emplace_back().scale = 1e9f; }),
              "scale: must be at most 1e6 in magnitude");
    EXPECT_EQ(of<HeightOptions>([](auto& o) { o.blur_sigma = kNan; }), "blur_sigma: must be from 0 to 256");
    EXPECT_EQ(of<PreviewOptions>([](auto& o) { o.tiles_x = 257; }), "tiles: must be from 1 to 256");
    EXPECT_EQ(of<PreviewOptions>([](auto& o) { o.material.shininess = 0.0f; }), "material.shininess: must be above 0");
    EXPECT_EQ(of<WriteOptions>([](auto& o) { o.zstd = 23; }), "zstd: must be from 0 to 22");
    EXPECT_EQ(of<WriteOptions>([](auto& o) { o.jpeg_quality = 0; }), "jpeg_quality: must be from 1 to 100");
    EXPECT_EQ(refusal(validate(std::vector<Step>())), "steps: there must be at least one");
    EXPECT_EQ(refusal(validate({Step(PackFileOptions()), Step(BakeFileOptions())})),
              "steps: only the first one can bake");
    EXPECT_EQ(refusal(apply_steps("none.png", {}, "none.dds", Container::dds)), "steps: there must be at least one");
}

// Bindings and newer callers can hand over numbers that no enumerator has.
TEST(Usable, UnknownEnumeratorsAreNamed) {
    constexpr int kUnknown[] = {99, -2, 1 << 20};
    for (const int number : kUnknown) {
        const auto set = [number](auto member) {
            return [number, member](auto& o) {
                auto& value = member(o);
                value = static_cast<std::remove_reference_t<decltype(value)>>(number);
            };
        };
#define EXPECT_NAMED(Options, name) \
    EXPECT_EQ(of<Options>(set([](auto& o) -> auto& { return o.name; })), #name ": unknown value")
        EXPECT_NAMED(BakeOptions, kernel);
        EXPECT_NAMED(MipOptions, filter);
        EXPECT_NAMED(MipOptions, domain);
        EXPECT_NAMED(MipOptions, wrap_x);
        EXPECT_NAMED(MipOptions, wrap_y);
        EXPECT_NAMED(MipOptions, blue);
        EXPECT_NAMED(MipOptions, alpha);
        EXPECT_NAMED(MipOptions, roughness);
        EXPECT_NAMED(PackOptions, encoding);
        EXPECT_NAMED(PackOptions, y_axis);
        EXPECT_NAMED(PackOptions, effort);
        EXPECT_NAMED(PackOptions, metric);
        EXPECT_NAMED(BlendOptions, mode);
        EXPECT_NAMED(BlendOptions, scale_mode);
        EXPECT_NAMED(BlendOptions, wrap_x);
        EXPECT_NAMED(BlendOptions, wrap_y);
        EXPECT_NAMED(Layer, wrap_x);
        EXPECT_NAMED(Layer, wrap_y);
        EXPECT_NAMED(IntegrateOptions, wrap_x);
        EXPECT_NAMED(IntegrateOptions, wrap_y);
        EXPECT_NAMED(TransferOptions, rays);
        EXPECT_NAMED(TransferOptions, hit);
        EXPECT_NAMED(HeightOptions, channel);
        EXPECT_NAMED(HeightOptions, deband);
        EXPECT_NAMED(HeightOptions, wrap_x);
        EXPECT_NAMED(HeightOptions, wrap_y);
        EXPECT_NAMED(PreviewOptions, show);
        EXPECT_NAMED(PreviewOptions, shape);
        EXPECT_NAMED(PreviewOptions, scale_mode);
        EXPECT_NAMED(PreviewOptions, wrap_x);
        EXPECT_NAMED(PreviewOptions, wrap_y);
        EXPECT_NAMED(PreviewOptions, light.kind);
        EXPECT_NAMED(PreviewOptions, material.model);
        EXPECT_NAMED(WriteOptions, dds_header);
#undef EXPECT_NAMED
        EXPECT_EQ(of<CheckOptions>([&](auto& o) { o.require.encoding = static_cast<Encoding>(number); }),
                  "require.encoding: unknown value");
        EXPECT_EQ(of<CheckOptions>([&](auto& o) { o.require.format = static_cast<Format>(number); }),
                  "require.format: unknown value");
        EXPECT_EQ(of<CheckOptions>([&](auto& o) { o.require.y = static_cast<YAxis>(number); }),
                  "require.y: unknown value");

        Texture texture = *pack(chain({{8, 8}}));
        texture.format = static_cast<Format>(number);
        EXPECT_EQ(refusal(unpack(texture)), "format: unknown value");
        EXPECT_EQ(refusal(decode(texture, 0)), "format: unknown value");
        EXPECT_EQ(level_bytes(texture.format, {4, 4}), 0u);
        EXPECT_EQ(refusal(scale(flat({4, 4}), 2.0f, static_cast<ScaleMode>(number))), "mode: unknown value");
        EXPECT_EQ(refusal(curvature(flat({4, 4}), {static_cast<CurvatureKind>(number)})), "kind: unknown value");
    }
}

TEST(Usable, PicturesWithoutLevelsAreRefused) {
    EXPECT_EQ(refusal(encode_picture({})), "the picture has no level");
    EXPECT_EQ(refusal(split_view({{}, "a"}, {{}, "b"})), "a split view needs two pictures");
    EXPECT_EQ(slope_range({}).max_x, 0.0f);
}

TEST(Usable, VerbsAskBeforeTheyWork) {
    HeightField field;
    field.height = Plane<float>({4, 4}, 0.0f);
    EXPECT_EQ(refusal(bake(field, {GradientKernel::gaussian, 100.0f})),
              "gaussian_sigma: must be above 0 and at most 64");
    field.bumpiness_x = kNan;
    EXPECT_EQ(refusal(bake(field)), "bumpiness: must be finite");
    MipOptions mip;
    mip.levels = -2;
    EXPECT_EQ(refusal(build_mip_chain(flat({4, 4}), mip)), "levels: must be 0, for all, or more");
    EXPECT_EQ(refusal(build_roughness_chain(flat({4, 4}), Plane<float>({1, 1}, 0.5f), {}, mip)),
              "levels: must be 0, for all, or more");
    PackOptions pack_options;
    pack_options.rdo.window = 0;
    EXPECT_EQ(refusal(pack(chain({{4, 4}}), pack_options)), "rdo.window: must be from 64 to 1048576");
    EXPECT_EQ(refusal(scale(flat({4, 4}), kNan)), "scale: must be at most 1e6 in magnitude");
    Layer layer;
    layer.detail = chain({{4, 4}});
    layer.strength = -1.0f;
    EXPECT_EQ(refusal(blend(chain({{4, 4}}), one(std::move(layer)))), "strength: must be from 0 to 1");
    EXPECT_EQ(refusal(heat_map(Plane<float>({2, 2}, 0.0f), 0.0)), "full_scale: must be above 0 and at most 180");
}

}  // namespace
}  // namespace tex
