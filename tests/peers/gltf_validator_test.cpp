// SPDX-License-Identifier: Apache-2.0
// Khronos' gltf-validator beside the reader of glTF: what it finds valid is read, and what it calls an error in
// geometry is refused, apart from the exceptions that are named here.
//
// The models are those of ../shared/data and of the samples, and some thousand that are made from small ones by
// changing one number, or leaving out one member. The validator comes from npm, into a folder of the build; the test is
// skipped where npm or its registry is missing.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <tex/tex.h>
#include <nlohmann/json.hpp>

#include "npm.h"
#include "scratch.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kSource = TEX_SOURCE_DIR;
const fs::path kData = kSource / "../shared/data";

bool shell(const std::string& command) { return std::system((command + " </dev/null").c_str()) == 0; }

// The folder in which npm has installed the validator; empty if it cannot.
std::string modules() {
    static const std::string folder = tex::npm_folder("gltf-validator", "gltf-validator@2.0.0-dev.3.10");
    return folder;
}

std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// A GLB file of its two chunks.
struct Glb {
    json document;
    std::string binary;

    explicit Glb(const std::string& bytes) {
        std::uint32_t size = 0;
        std::memcpy(&size, bytes.data() + 12, 4);
        document = json::parse(bytes.substr(20, size));
        const std::size_t next = 20 + size;
        if (next + 8 <= bytes.size()) binary = bytes.substr(next + 8);
    }
    [[nodiscard]] std::string bytes() const {
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string file;
        const auto put = [&](std::size_t value) {
            const auto word = static_cast<std::uint32_t>(value);
            file.append(reinterpret_cast<const char*>(&word), 4);
        };
        put(0x46546C67);
        put(2);
        put(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
        put(text.size());
        put(0x4E4F534A);
        file += text;
        if (binary.empty()) return file;
        put(binary.size());
        put(0x004E4942);
        return file + binary;
    }
};

// Every change of one value below `at`: other numbers, and its absence.
void change_each(const json& whole, const json::json_pointer& at, std::vector<json>& changed) {
    const json& value = whole.at(at);
    if (value.is_object() || value.is_array()) {
        for (const auto& [key, part] : value.items()) {
            const json::json_pointer below = value.is_array() ? at / std::stoul(key) : at / key;
            change_each(whole, below, changed);
            if (!value.is_object()) continue;
            json without = whole;
            without[at].erase(key);
            changed.push_back(std::move(without));
        }
        return;
    }
    if (!value.is_number()) return;
    for (const json& other :
         {json(0), json(-1), json(value.get<double>() + 1.0), json(1000000000), json(5121), json(5125), json("x")}) {
        json with = whole;
        with[at] = other.is_number_float() ? json(static_cast<std::int64_t>(other.get<double>())) : other;
        if (with != whole) changed.push_back(std::move(with));
    }
}

// Errors of the validator on which both need not agree, with the reason.
struct Exception {
    std::string_view code;   // the whole code, or its beginning before '*'
    std::string_view where;  // the beginning of the pointer
};

// No damage to geometry: such files are read.
constexpr Exception kHarmless[] = {
    // Images are judged when a map is read, and by rules of check-normals.
    {"*", "/images"},
    {"*", "/textures"},
    {"*", "/samplers"},
    {"MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", ""},  // N803
    {"ACCESSOR_INVALID_SIGN", ""},             // N703
    {"ACCESSOR_VECTOR3_NON_UNIT", ""},         // N702
    // Bounds are for culling. What is read are the vertices.
    {"MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", ""},
    {"ACCESSOR_MIN_MISMATCH", ""},
    {"ACCESSOR_MAX_MISMATCH", ""},
    {"ACCESSOR_ELEMENT_OUT_OF_*", ""},
    // Values are copied byte by byte, so that no processor minds where they are.
    {"ACCESSOR_TOTAL_OFFSET_ALIGNMENT", ""},
    {"ACCESSOR_OFFSET_ALIGNMENT", ""},
    {"MESH_PRIMITIVE_ACCESSOR_UNALIGNED", ""},
    // What GPUs want of a buffer.
    {"BUFFER_VIEW_TARGET_*", ""},
    {"MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE", ""},
    {"MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", ""},
    // Extensions that are known, where the lists of extensions are incomplete.
    {"UNSATISFIED_DEPENDENCY", "/extensionsRequired"},
    {"UNUSED_EXTENSION_REQUIRED", "/extensionsRequired"},
};

// Such files are read or refused.
constexpr Exception kEither[] = {
    {"*", "/materials"},  // a number that is none is refused; an index of a texture is judged with its map
    // A scene that does not exist is refused, but no scenes at all are all nodes.
    {"EMPTY_ENTITY", "/scenes"},
    {"UNRESOLVED_REFERENCE", "/scene"},
    {"VALUE_NOT_IN_LIST", ""},    // a type of numbers that glTF does not have is only a warning
    {"VALUE_*", "/bufferViews"},  // strides that are no multiple of 4 are refused where elements do not fit
    // The formats of KHR_mesh_quantization are read without it; normals without a sign are refused.
    {"MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", ""},
    // TEXCOORD_1 without TEXCOORD_0 is refused, but not COLOR_1 without COLOR_0, which is not read.
    {"MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY", ""},
};

bool matches(const Exception& exception, std::string_view error) {
    const std::size_t at = error.find('@');
    const std::string_view code = error.substr(0, at), where = error.substr(at + 1);
    const std::size_t star = exception.code.find('*');
    const bool named = star == std::string_view::npos ? code == exception.code
                                                      : code.substr(0, star) == exception.code.substr(0, star);
    return named && where.starts_with(exception.where);
}

template <std::size_t N>
bool is_one_of(const Exception (&exceptions)[N], std::string_view error) {
    return std::any_of(std::begin(exceptions), std::end(exceptions),
                       [&](const Exception& exception) { return matches(exception, error); });
}

std::vector<std::string> words(const std::string& line) {
    std::istringstream stream(line);
    return {std::istream_iterator<std::string>(stream), {}};
}

// Adds what the seeds lack.
void make_valid(json& document) {
    if (document.contains("extensionsRequired")) document["extensionsUsed"] = document["extensionsRequired"];
    for (const char* const unused : {"materials", "textures", "images"}) document.erase(unused);
    for (json& mesh : document["meshes"]) {
        for (json& primitive : mesh["primitives"]) primitive.erase("material");
    }
}

class GltfValidator : public testing::Test {
protected:
    void SetUp() override {
        if (modules().empty()) GTEST_SKIP() << "npm cannot install gltf-validator here";
    }

    // Compares both on each of the models.
    void compare(const std::vector<fs::path>& models) {
        std::string list;
        for (const fs::path& model : models) list += model.string() + "\n";
        ASSERT_TRUE(shell("node '" + (kSource / "tests/peers/gltf_validator.mjs").string() + "' '" + modules() + "' '" +
                          scratch_.write("list", list) + "' >'" + scratch_.path("said") + "'"));
        std::istringstream said(scratch_.read("said"));
        std::string line;
        std::map<std::string, std::pair<int, std::string>> accepted;  // how often each error was, and the first model
        for (const fs::path& model : models) {
            ASSERT_TRUE(std::getline(said, line));
            std::vector<std::string> errors = words(line);
            std::erase_if(errors, [](const std::string& error) { return is_one_of(kHarmless, error); });
            const bool is_valid = errors.empty();
            std::erase_if(errors, [](const std::string& error) { return is_one_of(kEither, error); });
            const auto mesh = tex::read_mesh(model.string());
            if (is_valid) {
                EXPECT_TRUE(mesh || is_no_mesh_for_maps(mesh.error())) << model << ": " << mesh.error().message();
                ++valid_;
            } else if (!mesh) {
                ++refused_;
            }
            if (!mesh) continue;
            for (const std::string& error : errors) {
                auto& [count, first] = accepted[error];
                if (count++ == 0) first = model.string();
            }
        }
        for (const auto& [error, what] : accepted)
            ADD_FAILURE() << error << " is accepted " << what.first << " times, first in " << what.second;
    }
    // Models need no triangles, but meshes for normal maps do. And any name of an extension may be required.
    static bool is_no_mesh_for_maps(const tex::Error& error) {
        return error.reason.find("no triangles") != std::string::npos ||
               error.reason.find("requires the extension ACME_nonsense") != std::string::npos;
    }

    // What the validator says about each of the models, of any severity, in the order of its words.
    std::vector<std::vector<std::string>> messages(const std::vector<std::string>& models) {
        std::string list;
        for (const std::string& model : models) list += model + "\n";
        EXPECT_TRUE(shell("node '" + (kSource / "tests/peers/gltf_validator.mjs").string() + "' '" + modules() + "' '" +
                          scratch_.write("list", list) + "' all >'" + scratch_.path("said") + "'"));
        std::istringstream said(scratch_.read("said"));
        std::vector<std::vector<std::string>> all;
        for (std::string line; std::getline(said, line);) all.push_back(words(line));
        return all;
    }

    // Compares what it says about models that were written with what it says about those that they were made of.
    void says_nothing_more(const std::vector<std::string>& before, const std::vector<std::string>& after) {
        const auto was = messages(before), is = messages(after);
        ASSERT_EQ(was.size(), before.size());
        ASSERT_EQ(is.size(), after.size());
        for (std::size_t k = 0; k < after.size(); ++k) {
            std::vector<std::string> more;
            std::set_difference(is[k].begin(), is[k].end(), was[k].begin(), was[k].end(), std::back_inserter(more));
            // Images that are not there stay named, also in GLB.
            std::erase_if(more, [&](const std::string& word) {
                return word == "URI_GLB" && std::count(was[k].begin(), was[k].end(), "IO_ERROR") > 0;
            });
            EXPECT_TRUE(more.empty()) << more.front() << " in " << after[k] << ", made of " << before[k];
        }
        std::printf("%zu models were written\n", after.size());
    }

    const tex::Scratch scratch_;
    int valid_ = 0, refused_ = 0;
};

// A white texel.
std::vector<std::byte> png_of_one_texel() {
    tex::Image white;
    for (const char* const name : {"R", "G", "B"}) {
        white.planes.emplace_back(tex::Extent{1, 1});
        white.planes.back().at(0, 0) = 1.0f;
        white.names.emplace_back(name);
    }
    return *tex::encode_file(*tex::picture_of(white), tex::Container::png);
}

TEST_F(GltfValidator, AgreesOnModelsOfOthers) {
    if (!fs::exists(kData)) GTEST_SKIP() << "no ../shared/data";
    std::vector<fs::path> models;
    for (const fs::path& root : {kData, kSource / "samples", kSource / "tests/fuzz/corpus/gltf"}) {
        for (const auto& entry : fs::recursive_directory_iterator(root)) {
            const auto extension = entry.path().extension();
            if (extension == ".gltf" || extension == ".glb") models.push_back(entry.path());
        }
    }
    std::sort(models.begin(), models.end());
    EXPECT_GT(models.size(), 20u);
    compare(models);
    std::printf("%zu models: %d valid, %d refused by both\n", models.size(), valid_, refused_);
}

// The models of odd_models.py, but for a byte order mark, which glTF forbids and engines read.
TEST_F(GltfValidator, AgreesOnOddModels) {
    ASSERT_TRUE(shell("python3 '" + (kSource / "tests/peers/odd_models.py").string() + "' '" + scratch_.path() + "'"));
    std::vector<fs::path> models;
    for (const auto& entry : fs::directory_iterator(scratch_.path())) {
        const auto extension = entry.path().extension();
        if (entry.path().stem() == "json_with_mark") continue;
        if (extension == ".gltf" || extension == ".glb") models.push_back(entry.path());
    }
    std::sort(models.begin(), models.end());
    EXPECT_GT(models.size(), 100u);
    compare(models);
    std::printf("%zu models: %d valid, %d refused by both\n", models.size(), valid_, refused_);
}

// The maps of a model as PNG, one picture for each image; none if one of them cannot be read.
std::vector<tex::ModelPicture> pictures_of(const tex::Model& model, const std::vector<tex::ModelMap>& maps) {
    std::vector<tex::ModelPicture> pictures;
    for (const tex::ModelMap& map : maps) {
        const auto same = std::find_if(pictures.begin(), pictures.end(), [&](const tex::ModelPicture& picture) {
            return picture.maps.front().image == map.image;
        });
        if (same != pictures.end()) {
            same->maps.push_back(map);
            continue;
        }
        if (map.image < 0) return {};
        const tex::ModelImage& image = model.images[static_cast<std::size_t>(map.image)];
        if (image.error) return {};
        tex::PackFileOptions options;
        options.max_side = 64;
        options.write.into = std::make_shared<std::vector<std::byte>>();
        if (image.file.empty()) options.source.read.bytes = std::make_shared<const std::vector<std::byte>>(image.bytes);
        if (!tex::pack_file(image.file, "picture", tex::Container::png, options)) return {};
        pictures.push_back({{map}, tex::Container::png, *options.write.into});
    }
    return pictures;
}

// All maps of a model get pictures, or one material's, whose textures are split from others; in both forms of glTF.
TEST_F(GltfValidator, HasNothingMoreToSayAboutModelsWithOtherPictures) {
    std::vector<fs::path> models;
    ASSERT_TRUE(shell("python3 '" + (kSource / "tests/peers/odd_models.py").string() + "' '" + scratch_.path() + "'"));
    for (const fs::path& root : {fs::path(scratch_.path()), kData, kSource / "samples"}) {
        if (!fs::exists(root)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root)) {
            const auto extension = entry.path().extension();
            if (extension == ".gltf" || extension == ".glb") models.push_back(entry.path());
        }
    }
    std::sort(models.begin(), models.end());
    std::vector<std::string> before, after;
    tex::WriteOptions writing;
    writing.sync = false;
    for (const fs::path& file : models) {
        const auto model = tex::read_model_maps(file.string());
        if (!model || model->maps.empty()) continue;
        for (const auto& [material, form] : std::vector<std::pair<std::string, std::string>>{
                 {"", ".glb"}, {"", ".gltf"}, {"0", file.extension().string()}}) {
            const auto maps = tex::maps_of(*model, material);
            if (!maps || maps->empty() || (!material.empty() && maps->size() == model->maps.size())) continue;
            const auto pictures = pictures_of(*model, *maps);
            if (pictures.empty()) continue;
            fs::path output = scratch_.path("out/" + std::to_string(after.size())) / file.filename();
            output.replace_extension(form);
            fs::create_directories(output.parent_path());
            const auto written = tex::write_model(file.string(), output.string(), {pictures}, {}, writing);
            const bool is_same_form = form == file.extension();
            if (!written && !is_same_form && written.error().code == tex::ErrorCode::unsupported) continue;
            ASSERT_TRUE(written) << written.error().message();
            const auto again = tex::read_model_maps(output.string());
            ASSERT_TRUE(again) << again.error().message();
            EXPECT_EQ(again->maps.size(), model->maps.size());
            before.push_back(file.string());
            after.push_back(output.string());
        }
    }
    EXPECT_GT(after.size(), 140u);
    says_nothing_more(before, after);
}

// All materials with a normal map get tangents for it, and occlusion in a picture of their own.
TEST_F(GltfValidator, HasNothingMoreToSayAboutModelsWithTangentsAndOcclusion) {
    std::vector<std::string> before, after;
    tex::WriteOptions writing;
    writing.sync = false;
    for (const fs::path& root : {kData, kSource / "samples"}) {
        if (!fs::exists(root)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root)) {
            const auto extension = entry.path().extension();
            if ((extension != ".gltf" && extension != ".glb") || entry.file_size() > (1u << 21)) continue;
            const auto model = tex::read_model(entry.path().string());
            if (!model || model->maps.empty()) continue;
            tex::ModelChanges changes;
            for (const tex::ModelMap& map : model->maps) {
                if (map.slot != tex::NormalSlot::normal) continue;
                const std::size_t parts = changes.tangents.size();
                for (const tex::MeshPart& part : model->mesh.parts) {
                    const auto moved = tex::with_moved_uvs(part, map.uv_set, map.uv_transform);
                    if (part.material != map.material || !moved || part.normals.empty()) continue;
                    auto made = tex::make_tangents(*moved, tex::TangentMethod::mikktspace, map.uv_set);
                    if (made) changes.tangents.push_back({part.mesh, part.primitive, std::move(*made)});
                }
                if (changes.tangents.size() == parts) continue;  // it is on no triangle
                changes.pictures.push_back({{map}, tex::Container::png, png_of_one_texel()});
                changes.pictures.back().use = tex::PictureUse::occlusion;
            }
            const fs::path output = scratch_.path("out/" + std::to_string(after.size())) / entry.path().filename();
            fs::create_directories(output.parent_path());
            const auto written = tex::write_model(entry.path().string(), output.string(), changes, {}, writing);
            ASSERT_TRUE(written) << entry.path() << ": " << written.error().message();
            before.push_back(entry.path().string());
            after.push_back(output.string());
        }
    }
    EXPECT_GT(after.size(), 5u);
    says_nothing_more(before, after);
}

TEST_F(GltfValidator, AgreesOnModelsWithOneChange) {
    std::vector<fs::path> models;
    for (const std::string seed : {"quad", "quantised", "sparse_strip"}) {
        Glb glb(read(kSource / "tests/fuzz/corpus/gltf" / (seed + ".glb")));
        make_valid(glb.document);
        std::vector<json> changed;
        for (const char* const part : {"accessors", "bufferViews", "buffers", "meshes", "nodes"}) {
            const auto at = json::json_pointer() / part;
            if (glb.document.contains(at)) change_each(glb.document, at, changed);
        }
        for (std::size_t k = 0; k < changed.size(); ++k) {
            Glb one = glb;
            one.document = std::move(changed[k]);
            models.push_back(scratch_.path(seed + std::to_string(k) + ".glb"));
            write(models.back(), one.bytes());
        }
    }
    EXPECT_GT(models.size(), 500u);
    compare(models);
    std::printf("%zu models: %d valid, %d refused by both\n", models.size(), valid_, refused_);
}

}  // namespace
