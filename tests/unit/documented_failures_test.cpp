// SPDX-License-Identifier: Apache-2.0
// The failures that the headers promise in their paragraphs "Errors", as rows: what a header says, and a call that does
// it. (documented_errors_test.cpp has `cancelled` and `out_of_memory` of the verbs, usable_test.cpp options out of
// range, documented_mesh_failures_test.cpp what mesh.h says.)

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "scratch.h"
#include "unit/failures.h"
#include "unit/normal_maps.h"

namespace tex {
namespace {

using namespace failures;

TEST(DocumentedFailures, OfCheck) {
    const NormalMap map = flat_map({8, 8}), other = flat_map({8, 4});
    const auto compared = [&](auto change, int set) { return failure_of(compare(map, map, sheet(change), set)); };
    Requirements requirements;
    const Texture texture = *pack(chain_from(flat_map({8, 8})), {Encoding::rgba8});
    Texture unknown = texture;
    unknown.swizzle_known = false;
    const auto checked = [&](auto change) {
        CheckOptions options;
        change(options);
        return failure_of(check("a", texture, options));
    };
    CheckOptions wrong;
    wrong.enable = {"N999"};
    const std::string crate = TEX_SOURCE_DIR "/samples/crate_low.glb";
    ModelCheckOptions elsewhere;
    elsewhere.material = "glass";
    expect_all({
        {"compare: check_part(part) fails", ErrorCode::bad_data, compared(kBroken, 0)},
        {"compare: no such set of UVs", ErrorCode::bad_option, compared(kUnchanged, 1)},
        {"compare: no triangle covers a texel", ErrorCode::bad_option, compared(kWithoutArea, 0)},
        {"compare: UVs", ErrorCode::unsupported, compared(kFar, 0)},
        {"compare: different extents", ErrorCode::bad_option, failure_of(compare(map, other, sheet(kUnchanged)))},
        {"heat_map: full_scale above 180", ErrorCode::bad_option, failure_of(heat_map(Plane<float>({2, 2}, 0), 181))},
        {"heat_map", ErrorCode::cancelled, failure_of(heat_map(Plane<float>({2, 2}, 0.0f), 1.0, kStopped))},
        {"largest_of_cells: no texels", ErrorCode::bad_option, failure_of(largest_of_cells({}, 4))},
        {"largest_of_cells: any side", std::nullopt, failure_of(largest_of_cells(Plane<float>({2, 2}, 0), 2147483647))},
        {"largest_of_cells: side", ErrorCode::bad_option, failure_of(largest_of_cells(Plane<float>({2, 2}, 0.0f), 0))},
        {"compare a mesh", ErrorCode::cancelled, failure_of(compare(map, map, sheet(kUnchanged), 0, kStopped))},
        {"guess_swizzle", ErrorCode::cancelled, failure_of(guess_swizzle(unknown, kStopped))},
        {"add_requirement: key", ErrorCode::bad_option, failure_of(add_requirement(requirements, "colour=red"))},
        {"add_requirement: value", ErrorCode::bad_option, failure_of(add_requirement(requirements, "mips=some"))},
        {"check: enable", ErrorCode::bad_option, checked([](auto& o) { o.enable = {"N999"}; })},
        {"check: disable", ErrorCode::bad_option, checked([](auto& o) { o.disable = {"not-a-rule"}; })},
        {"check: severity", ErrorCode::bad_option, checked([](auto& o) {
             o.severity = {{"N999", Severity::note}};
         })},
        {"check_file: bad_option", ErrorCode::bad_option, failure_of(check_file("none.png", wrong))},
        {"check_model: those of read_model()", ErrorCode::io, failure_of(check_model("none.gltf"))},
        {"check_model: bad_option", ErrorCode::bad_option, failure_of(check_model(crate, {wrong}))},
        {"check_model: there is no such material", ErrorCode::bad_option, failure_of(check_model(crate, elsewhere))},
    });
}

TEST(DocumentedFailures, OfSurfacesAndPictures) {
    const NormalMap map = flat_map({8, 8});
    NormalMap wide;
    for (Plane<float>* plane : {&wide.x, &wide.y, &wide.z}) *plane = Plane<float>({kMaxExtent + 1, 1}, 0.5f);
    const MipChain chain = chain_from(flat_map({8, 8}));
    const auto shown = [&](Show show, auto change, const auto& tangents, int set = 0, int side = 16) {
        const MeshPart part = sheet(change);
        const TangentSpace space = {part, tangents, set};
        PreviewScene scene;
        scene.map = &chain;
        scene.mesh = &space;
        PreviewOptions options;
        options.show = show;
        options.size = {side, side};
        return failure_of(preview(scene, options));
    };
    const auto stack = [](MeshPart& part) {
        for (int k = 0; k < 3000; ++k) part.indices.insert(part.indices.end(), {0, 1, 2, 0, 2, 3});
    };
    const std::vector<Float4> many(6 + 6 * 3000, {1, 0, 0, 1});
    PreviewOptions tangents;
    tangents.show = Show::tangents;
    Image two;
    two.names = {"R", "G"};
    for (int k = 0; k < 2; ++k) two.planes.emplace_back(Extent{4, 4}, 0.5f);
    PreviewScene painted;
    painted.map = &chain;
    painted.albedo = &two;
    const Texture small = *pack(chain_from(flat_map({4, 4})), {Encoding::rgb8});
    const Texture large = *pack(chain_from(flat_map({8, 8})), {Encoding::rgb8});
    expect_all({
        {"integrate: kMaxExtent", ErrorCode::bad_option, failure_of(integrate(wide))},
        {"curvature: kMaxExtent", ErrorCode::bad_option, failure_of(curvature(wide))},
        {"tangents without a mesh", ErrorCode::bad_option, failure_of(preview({.map = &chain}, tangents))},
        {"the albedo", ErrorCode::bad_option, failure_of(preview(painted))},
        {"no normals", ErrorCode::bad_option, shown(Show::lit, kWithoutNormals, kTangents)},
        {"no such set of UVs", ErrorCode::bad_option, shown(Show::lit, kUnchanged, kTangents, 1)},
        {"not as many tangents", ErrorCode::bad_option, shown(Show::lit, kUnchanged, kFewTangents)},
        {"UVs beyond a million", ErrorCode::unsupported, shown(Show::uv, kFar, kTangents)},
        {"more than 1024 deep", ErrorCode::unsupported, shown(Show::lit, stack, many, 0, 1024)},
        {"picture_of: a plane is missing", ErrorCode::bad_option, failure_of(picture_of(two))},
        {"contact_sheet: empty", ErrorCode::bad_option, failure_of(contact_sheet({}))},
        {"split_view: extents", ErrorCode::bad_option, failure_of(split_view({small, ""}, {large, ""}))},
        {"encode_animation: no picture", ErrorCode::bad_option, failure_of(encode_animation({}))},
        {"encode_animation: size", ErrorCode::bad_option, failure_of(encode_animation({small, large}))},
    });
}

TEST(DocumentedFailures, OfFiles) {
    const std::string name = "documented_failures.dds", absent = "/nowhere/tex-reader";
    const Texture texture = *pack(chain_from(flat_map({8, 8})), {Encoding::rgb8});
    const Texture astc = *pack(chain_from(flat_map({8, 8})), {Encoding::astc_4x4});
    const std::vector<std::byte> dds = *encode_file(texture, Container::dds);
    const auto written = [&](Container container, auto change) {
        WriteOptions options;
        change(options);
        return failure_of(encode_file(texture, container, options));
    };
    Texture cut = *pack(chain_from(flat_map({8, 8})), {Encoding::rgb8});
    cut.levels[0].bytes.pop_back();
    const Texture tall = *pack(chain_from(flat_map({8, 300})), {Encoding::rgb8});
    const Execution in_between = {1, [](double fraction) { return fraction == 0.0; }};
    const auto read = [&](auto change) {
        ReadOptions options;
        change(options);
        return failure_of(read_texture(dds, name, options));
    };
    expect_all({
        {"check_raw", ErrorCode::bad_option, failure_of(check_raw("u9"))},
        {"more texels than max_texels", ErrorCode::unsupported, read([](auto& o) { o.max_texels = 63; })},
        {"no such layer", ErrorCode::bad_option, read([](auto& o) { o.layer = "3"; })},
        {"is a directory", ErrorCode::io, failure_of(read_image("/tmp"))},
        {"empty", ErrorCode::bad_data, failure_of(read_image(std::span<const std::byte>(), name))},
        {"truncated", ErrorCode::bad_data, failure_of(read_texture(std::span(dds).first(dds.size() - 1), name))},
        {"the container cannot hold the format", ErrorCode::unsupported, failure_of(encode_file(astc, Container::dds))},
        {"or zstd", ErrorCode::unsupported, written(Container::dds, [](auto& o) { o.zstd = 1; })},
        {"zstd above 22", ErrorCode::bad_option, written(Container::ktx2, [](auto& o) { o.zstd = 23; })},
        {"zstd below 0", ErrorCode::bad_option, written(Container::ktx2, [](auto& o) { o.zstd = -1; })},
        {"jpeg_quality", ErrorCode::bad_option, written(Container::jpeg, [](auto& o) { o.jpeg_quality = 0; })},
        {"jpeg_quality", ErrorCode::bad_option, written(Container::jpeg, [](auto& o) { o.jpeg_quality = 101; })},
        {"the reader", ErrorCode::io, written(Container::tiff, [&](auto& o) { o.reader.reader = absent; })},
        {"the reader", ErrorCode::bad_data, written(Container::tiff, [](auto& o) { o.reader.reader = "/bin/false"; })},
        {"no level", ErrorCode::bad_option, failure_of(encode_file(Texture(), Container::dds))},
        {"not level_bytes() bytes", ErrorCode::bad_option, failure_of(encode_file(cut, Container::png))},
        {"cancelled", ErrorCode::cancelled, failure_of(encode_file(texture, Container::dds, {}, kStopped))},
        {"cancelled", ErrorCode::cancelled, failure_of(encode_file(tall, Container::png, {}, in_between))},
        {"no such extension", ErrorCode::bad_option, failure_of(write_texture("a.gif", texture))},
        {"no such directory", ErrorCode::io, failure_of(write_texture("/nowhere/a.dds", texture))},
    });
}

// Failures that the function reports in its result instead of an error.
TEST(DocumentedFailures, OfFilesThatAreChecked) {
    const auto missing = check_file("none.png");
    ASSERT_TRUE(missing);
    EXPECT_TRUE(missing->findings.empty());
    ASSERT_TRUE(missing->error);
    EXPECT_EQ(missing->error->code, ErrorCode::io);
    const std::string path = TEX_SOURCE_DIR "/samples/bricks.png";
    const auto stopped = check_file(path, {}, {}, kStopped);
    ASSERT_TRUE(stopped);
    EXPECT_TRUE(stopped->findings.empty());
    ASSERT_TRUE(stopped->error);
    EXPECT_EQ(stopped->error->code, ErrorCode::cancelled);
}

TEST(DocumentedFailures, OfPipelines) {
    NormalMap map = flat_map({8, 8});
    const auto put = [&](Encoding encoding, auto change) {
        ExtraInputs inputs;
        change(inputs);
        return failure_of(put_others(map, inputs, encoding));
    };
    const auto gives = [](Extent extent) { return [=] { return Result<Plane<float>>(Plane<float>(extent, 0.5f)); }; };
    const auto fails = [] { return Result<Plane<float>>(Error{ErrorCode::io, "mask", "is not there"}); };
    PackFileOptions levels, roughness;
    levels.mip.emplace();
    roughness.mip.emplace();
    roughness.roughness.emplace();
    SourceOptions measured;
    measured.measure_y = true;
    const Scratch scratch;
    const std::string file = scratch.path("flat.dds"), out = scratch.path("out.dds");
    PackOptions bc5;
    bc5.encoding = Encoding::bc5;
    ASSERT_TRUE(write_texture(file, *pack(*build_mip_chain(flat_map({8, 8})), bc5)));
    PackFileOptions deep, rough_alpha;
    deep.level = 9;
    rough_alpha.others.alpha = ExtraData{0.5f};
    rough_alpha.pack = [](const SourceInfo&) { return PackOptions{Encoding::rgba8}; };
    const Result<Source> y = read_normals(file, measured);
    expect_all({
        {"put_others: cannot hold", ErrorCode::bad_option, put(Encoding::bc5, [](auto& o) { o.alpha = ExtraData{}; })},
        {"put_others: value", ErrorCode::bad_option, put(Encoding::rgba8, [](auto& o) { o.alpha = ExtraData{1.5f}; })},
        {"put_others: value", ErrorCode::bad_option, put(Encoding::rgba8, [](auto& o) { o.alpha = ExtraData{NAN}; })},
        {"put_others: another extent", ErrorCode::bad_option,
         put(Encoding::rgba8,
             [&](auto& o) {
                 o.alpha = ExtraData{1.0f, gives({8, 4})};
             })},
        {"put_others: heights", ErrorCode::bad_option,
         put(Encoding::rgba8,
             [](auto& o) {
                 o.alpha = ExtraData{1.0f, {}, true};
             })},
        {"put_others: blue with length", ErrorCode::bad_option,
         put(Encoding::rgba8, [](auto& o) { o.blue = o.length = ExtraData{}; })},
        {"put_others: those of map", ErrorCode::io,
         put(Encoding::rgba8,
             [&](auto& o) {
                 o.alpha = ExtraData{1.0f, fails};
             })},
        {"read_normals: y is not clear", ErrorCode::bad_data, failure_of(y)},
        {"pack_file: lacks the level", ErrorCode::bad_option, failure_of(pack_file(file, out, Container::dds, deep))},
        {"pack_file: others with smaller levels", ErrorCode::bad_option,
         failure_of(pack_file(file, out, Container::dds, rough_alpha))},
        {"steps: levels before the last", ErrorCode::bad_option,
         failure_of(validate(std::vector<Step>{levels, PackFileOptions()}))},
        {"steps: roughness before the last", ErrorCode::bad_option,
         failure_of(validate(std::vector<Step>{roughness, PackFileOptions()}))},
    });
    EXPECT_EQ(y.error().file, file) << "all of which name the file";
    EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace tex
