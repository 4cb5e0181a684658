// SPDX-License-Identifier: Apache-2.0

#include "mesh/gltf_writer.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <tex/file.h>

#include "mesh/glb.h"
#include "mesh/gltf.h"
#include "mesh/gltf_images.h"
#include "mesh/gltf_materials.h"
#include "mesh/gltf_views.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {
namespace {

constexpr int kNobody = -1, kUnused = -2;  // instead of the number of a picture

Error bad_picture(std::string reason) { return {ErrorCode::bad_option, {}, std::move(reason)}; }

std::string_view media_type_of(Container container) {
    return container == Container::jpeg ? "image/jpeg" : "image/png";
}

// The media type of a data URI, with its parameters.
std::string media_type_of_uri(std::string_view uri) {
    std::string_view type = uri.substr(5, uri.find(',') == std::string_view::npos ? 0 : uri.find(',') - 5);
    if (type.ends_with(";base64")) type.remove_suffix(7);
    return std::string(type);
}

// What several users make of one thing: the picture that all of them get, or nobody.
void join(int& owner, int picture) { owner = owner == kUnused || owner == picture ? picture : kNobody; }

class GltfWriter {
public:
    GltfWriter(JsonValue root, JsonText& text, std::span<const std::byte> binary, const LoadBeside& load,
               const ModelPlace& place, const std::vector<ModelPicture>& pictures)
        : root_(root), text_(text.root()), binary_(binary), load_(load), place_(place), pictures_(pictures),
          names_(root, place), views_(root), own_(pictures.size()) {}

    Result<void> change();
    [[nodiscard]] const std::optional<std::vector<std::byte>>& binary() const { return changed_binary_; }
    std::vector<BesideModel> take_beside() { return std::move(beside_); }
    [[nodiscard]] const std::vector<std::string>& outside() const { return names_.outside(); }

private:
    struct Slot {
        std::size_t material = 0;
        GltfSlot slot;
        int picture = kNobody;
    };
    // Where a picture is from now on.
    struct Home {
        std::optional<std::int64_t> view;
        std::string uri;   // of data or, if it is in a file, empty until files have names
        std::string file;  // that it was in
        std::vector<std::int64_t> images;
    };

    Result<void> find_slots();
    void find_owners();
    Result<void> house_pictures();
    Result<void> change_buffers();
    void name_files();
    void name_picture(std::size_t picture);
    void change_images(std::size_t picture);
    void change_textures();
    void change_texture(std::int64_t texture, std::int64_t image);
    std::int64_t add_texture(std::int64_t like, std::int64_t image);
    void forget_extensions();
    Result<std::vector<std::byte>> load_buffer(std::size_t buffer) const;
    [[nodiscard]] JsonValue image(std::int64_t index) const { return root_["images"][static_cast<std::size_t>(index)]; }
    [[nodiscard]] std::int64_t image_of(const Slot& slot) const { return image_of_texture(root_, slot.slot.texture); }

    JsonValue root_;
    JsonNode& text_;
    std::span<const std::byte> binary_;
    const LoadBeside& load_;
    const ModelPlace& place_;
    const std::vector<ModelPicture>& pictures_;
    GltfNames names_;
    GltfViews views_;
    std::vector<Slot> slots_;
    std::vector<int> texture_owners_;
    std::vector<std::vector<std::int64_t>> own_;  // for each picture, the images that it replaces everywhere
    std::vector<Home> homes_;
    std::vector<ChangedBuffer> buffers_;
    std::optional<std::vector<std::byte>> changed_binary_;
    std::vector<BesideModel> beside_;
};

// Finds all slots, and which of them get a picture.
Result<void> GltfWriter::find_slots() {
    struct Want {
        int picture, image;
        bool is_found = false;
    };
    std::map<std::pair<int, NormalSlot>, Want> wanted;
    for (std::size_t p = 0; p < pictures_.size(); ++p) {
        if (pictures_[p].maps.empty()) return bad_picture("a picture is for no map");
        if (pictures_[p].container != Container::png && pictures_[p].container != Container::jpeg)
            return bad_picture("a picture of a model is PNG or JPEG");
        for (const ModelMap& map : pictures_[p].maps) {
            if (!wanted.emplace(std::pair(map.material, map.slot), Want{static_cast<int>(p), map.image}).second)
                return bad_picture("two pictures are for one map of material " + std::to_string(map.material));
            if (map.image < 0)
                return bad_picture("the map of material " + std::to_string(map.material) + " has no image");
        }
    }
    const JsonValue materials = root_["materials"];
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const auto slots = slots_of(materials[m]);
        if (!slots) return bad_gltf("material " + std::to_string(m) + ": " + slots.error().reason);
        for (const GltfSlot& found : *slots) {
            slots_.push_back({m, found, kNobody});
            const auto kind = normal_slot(found);
            const auto want = kind ? wanted.find({static_cast<int>(m), *kind}) : wanted.end();
            if (want == wanted.end() || image_of(slots_.back()) != want->second.image) continue;
            slots_.back().picture = want->second.picture;
            want->second.is_found = true;
        }
    }
    for (const auto& [map, want] : wanted) {
        if (!want.is_found) return bad_picture("material " + std::to_string(map.first) + " has no such map");
    }
    return {};
}

// Finds out which textures and images belong to one picture in all of their uses.
void GltfWriter::find_owners() {
    const JsonValue textures = root_["textures"];
    texture_owners_.assign(textures.size(), kUnused);
    for (const Slot& slot : slots_) {
        const auto texture = static_cast<std::size_t>(slot.slot.texture);
        if (texture < texture_owners_.size()) join(texture_owners_[texture], slot.picture);
    }
    std::vector<int> owners(root_["images"].size(), kUnused);
    for (std::size_t t = 0; t < textures.size(); ++t) {
        const auto use = [&](JsonValue source) {
            const auto index = source.count();
            if (!index || static_cast<std::size_t>(*index) >= owners.size()) return;
            join(owners[static_cast<std::size_t>(*index)],
                 texture_owners_[t] == kUnused ? kNobody : texture_owners_[t]);
        };
        use(textures[t]["source"]);
        for (const std::string& name : textures[t]["extensions"].keys()) use(textures[t]["extensions"][name]["source"]);
    }
    for (const Slot& slot : slots_) {
        if (slot.picture == kNobody) continue;
        const std::int64_t index = image_of(slot);
        auto& own = own_[static_cast<std::size_t>(slot.picture)];
        if (owners[static_cast<std::size_t>(index)] == slot.picture &&
            std::find(own.begin(), own.end(), index) == own.end())
            own.push_back(index);
    }
}

// Puts each picture where the image was: into a buffer, into the text, or into a file, which gets its name later.
Result<void> GltfWriter::house_pictures() {
    for (std::size_t p = 0; p < pictures_.size(); ++p) {
        Home home;
        home.images = own_[p];
        const auto slot = std::find_if(slots_.begin(), slots_.end(),
                                       [&](const Slot& each) { return each.picture == static_cast<int>(p); });
        const std::int64_t like = home.images.empty() ? image_of(*slot) : home.images.front();
        if (const auto view = image(like)["bufferView"].count()) {
            const auto uses = std::count_if(home.images.begin(), home.images.end(), [&](std::int64_t other) {
                return image(other)["bufferView"].count() == view;
            });
            if (static_cast<std::size_t>(*view) >= root_["bufferViews"].size())
                return bad_gltf("image " + std::to_string(like) + " is in a view that does not exist");
            home.view = view;
            if (uses > 0 && views_.is_own(*view, static_cast<std::size_t>(uses)))
                views_.replace(*view, pictures_[p].bytes);
            else
                home.view = views_.add(views_.buffer_of(*view), pictures_[p].bytes);
        } else if (const std::string uri = image(like)["uri"].text().value_or(""); is_data_uri(uri)) {
            home.uri = encode_data_uri(media_type_of(pictures_[p].container), pictures_[p].bytes);
        } else if (home.images.empty() && !binary_.empty() && root_["buffers"][0]["uri"].is_null()) {
            home.view = views_.add(0, pictures_[p].bytes);  // of a GLB file, which need name no further file
        } else {
            auto path = path_of_uri(uri);
            if (!path) return path.error();
            home.file = std::move(*path);
        }
        for (const std::int64_t own : home.images) {
            const auto path = path_of_uri(image(own)["uri"].text().value_or(""));
            if (path) names_.forget(*path);
        }
        homes_.push_back(std::move(home));
    }
    return {};
}

Result<std::vector<std::byte>> GltfWriter::load_buffer(std::size_t buffer) const {
    const auto uri = root_["buffers"][buffer]["uri"].text();
    if (!uri && buffer != 0) return bad_gltf("buffer " + std::to_string(buffer) + " has no bytes");
    if (!uri) return std::vector<std::byte>(binary_.begin(), binary_.end());
    if (is_data_uri(*uri)) return decode_data_uri(*uri);
    auto path = path_of_uri(*uri);
    if (!path) return path.error();
    return load_(*path);
}

Result<void> GltfWriter::change_buffers() {
    auto changed = views_.finish(text_, [this](std::size_t buffer) { return load_buffer(buffer); });
    if (!changed) return changed.error();
    for (ChangedBuffer& buffer : *changed) {
        const auto uri = root_["buffers"][buffer.index]["uri"].text();
        if (!uri) {
            changed_binary_ = std::move(buffer.bytes);
        } else if (is_data_uri(*uri)) {
            text_.member("buffers")
                ->element(buffer.index)
                ->set("uri", '"' + encode_data_uri(media_type_of_uri(*uri), buffer.bytes) + '"');
        } else {
            names_.forget(*path_of_uri(*uri));
            buffers_.push_back(std::move(buffer));
        }
    }
    return {};
}

// Names files once it is known which of those in the model are no longer used.
void GltfWriter::name_files() {
    for (ChangedBuffer& buffer : buffers_) {
        const std::string path = *path_of_uri(*root_["buffers"][buffer.index]["uri"].text());
        const std::size_t dot = path.rfind('.');
        const std::string name = names_.name_for(path, dot == std::string::npos ? "" : path.substr(dot));
        if (name != path) text_.member("buffers")->element(buffer.index)->set("uri", json_string(uri_of_path(name)));
        beside_.push_back({name, path, true, std::move(buffer.bytes)});
    }
    for (std::size_t p = 0; p < homes_.size(); ++p) {
        if (!homes_[p].file.empty()) name_picture(p);
    }
    if (place_.is_same_folder) return;
    std::vector<BesideModel> all;
    for (const std::string& path : names_.kept()) all.push_back({path, path});
    for (BesideModel& changed : beside_) all.push_back(std::move(changed));
    beside_ = std::move(all);
}

void GltfWriter::name_picture(std::size_t picture) {
    Home& home = homes_[picture];
    const Container container = pictures_[picture].container;
    const std::size_t dot = home.file.rfind('.');
    const bool has_extension = container_of(home.file) == container;  // .jpeg stays .jpeg
    const std::string extension = has_extension                  ? home.file.substr(dot)
                                  : container == Container::jpeg ? std::string(".jpg")
                                                                 : std::string(".png");
    const std::string name = names_.name_for(home.file, extension);
    home.uri = uri_of_path(name);
    beside_.push_back({name, home.file, true, pictures_[picture].bytes});
}

// Describes the picture in its images, or in one more.
void GltfWriter::change_images(std::size_t picture) {
    Home& home = homes_[picture];
    JsonNode& list = *text_.member("images");
    const std::string type = json_string(media_type_of(pictures_[picture].container));
    for (const std::int64_t own : home.images) {
        JsonNode& node = *list.element(static_cast<std::size_t>(own));
        if (home.view) {
            node.remove("uri");
            if (image(own)["bufferView"].count() != home.view) node.set("bufferView", std::to_string(*home.view));
            node.set("mimeType", type);
            continue;
        }
        node.remove("bufferView");
        const auto path = path_of_uri(image(own)["uri"].text().value_or(""));
        if (home.file.empty() || !path || uri_of_path(*path) != home.uri) node.set("uri", '"' + home.uri + '"');
        if (node.member("mimeType") != nullptr) node.set("mimeType", type);
    }
    if (!home.images.empty()) return;
    const auto slot = std::find_if(slots_.begin(), slots_.end(),
                                   [&](const Slot& each) { return each.picture == static_cast<int>(picture); });
    const auto name = image(image_of(*slot))["name"].text();
    std::string text = name ? "{\"name\":" + json_string(*name) + "," : "{";
    text += home.view ? "\"bufferView\":" + std::to_string(*home.view) + ",\"mimeType\":" + type
                      : "\"uri\":\"" + home.uri + '"';
    home.images.push_back(static_cast<std::int64_t>(list.size()));
    list.append(text + "}");
}

void GltfWriter::change_texture(std::int64_t texture, std::int64_t image) {
    JsonNode& node = *text_.member("textures")->element(static_cast<std::size_t>(texture));
    const JsonValue description = root_["textures"][static_cast<std::size_t>(texture)];
    if (description["source"].count() != image) node.set("source", std::to_string(image));
    JsonNode* const extensions = node.member("extensions");
    if (extensions == nullptr) return;
    for (const char* const name : kTextureExtensions) extensions->remove(name);
    if (extensions->size() == 0) node.remove("extensions");
}

std::int64_t GltfWriter::add_texture(std::int64_t like, std::int64_t image) {
    const auto sampler = root_["textures"][static_cast<std::size_t>(like)]["sampler"].count();
    JsonNode& list = *text_.member("textures");
    list.append((sampler ? "{\"sampler\":" + std::to_string(*sampler) + "," : "{") +
                "\"source\":" + std::to_string(image) + "}");
    return static_cast<std::int64_t>(list.size()) - 1;
}

// Makes the textures of slots show their pictures. A texture that other slots use, too, is left to them.
void GltfWriter::change_textures() {
    std::map<std::pair<int, std::int64_t>, std::int64_t> added;
    for (const Slot& slot : slots_) {
        if (slot.picture == kNobody) continue;
        const std::int64_t texture = slot.slot.texture;
        const std::vector<std::int64_t>& images = homes_[static_cast<std::size_t>(slot.picture)].images;
        const bool stays = std::find(images.begin(), images.end(), image_of(slot)) != images.end();
        const std::int64_t image = stays ? image_of(slot) : images.front();
        if (texture_owners_[static_cast<std::size_t>(texture)] == slot.picture) {
            change_texture(texture, image);
            continue;
        }
        const auto [found, is_new] = added.emplace(std::pair(slot.picture, texture), 0);
        if (is_new) found->second = add_texture(texture, image);
        JsonNode* node = text_.member("materials")->element(slot.material);
        if (!slot.slot.extension.empty()) node = node->member("extensions")->member(slot.slot.extension);
        JsonNode* info = node->member(slot.slot.name);
        if (info == nullptr) info = node->member("pbrMetallicRoughness")->member(slot.slot.name);
        info->set("index", std::to_string(found->second));
    }
}

// An extension that no texture uses any more is neither used nor required.
void GltfWriter::forget_extensions() {
    JsonNode* const textures = text_.member("textures");
    for (const char* const name : kTextureExtensions) {
        bool was_used = false, is_used = false;
        for (std::size_t t = 0; t < root_["textures"].size(); ++t) {
            if (root_["textures"][t]["extensions"][name].is_null()) continue;
            was_used = true;
            JsonNode* const extensions = textures->element(t)->member("extensions");
            is_used = is_used || (extensions != nullptr && extensions->member(name) != nullptr);
        }
        if (!was_used || is_used) continue;
        for (const char* const list : {"extensionsUsed", "extensionsRequired"}) {
            JsonNode* const node = text_.member(list);
            if (node == nullptr) continue;
            for (std::size_t k = node->size(); k-- > 0;) {
                std::string word;
                node->element(k)->write(word);
                if (word == json_string(name)) node->remove_element(k);
            }
            if (node->size() == 0) text_.remove(list);
        }
    }
}

Result<void> GltfWriter::change() {
    if (auto found = find_slots(); !found) return found;
    find_owners();
    if (auto housed = house_pictures(); !housed) return housed;
    if (auto changed = change_buffers(); !changed) return changed;
    name_files();
    for (std::size_t p = 0; p < homes_.size(); ++p) change_images(p);
    change_textures();
    forget_extensions();
    return {};
}

}  // namespace

Result<WrittenGltf> write_gltf(std::span<const std::byte> file, const LoadBeside& load, const ModelPlace& place,
                               const ModelChanges& changes) {
    const auto chunks = gltf_chunks(file);
    if (!chunks) return chunks.error();
    const auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    if (auto known = check_asset(document->root()); !known) return known.error();
    JsonText text(chunks->json);
    GltfWriter writer(document->root(), text, chunks->binary, load, place, changes.pictures);
    if (auto changed = writer.change(); !changed) return changed.error();
    auto bytes = with_chunks(file, *chunks, text.text(), writer.binary());
    if (!bytes) return bytes.error();
    return WrittenGltf{std::move(*bytes), writer.take_beside(), writer.outside()};
}

}  // namespace tex::inline v1
