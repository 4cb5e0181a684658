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
#include "mesh/gltf_mirrors.h"
#include "mesh/gltf_picture_slots.h"
#include "mesh/gltf_slots.h"
#include "mesh/gltf_tangents.h"
#include "mesh/gltf_views.h"
#include "mesh/json_text.h"

namespace tex::inline v1 {
namespace {

std::string_view media_type_of(Container container) {
    if (container == Container::webp) return "image/webp";
    if (container == Container::ktx2) return "image/ktx2";
    return container == Container::jpeg ? "image/jpeg" : "image/png";
}

// What several users make of one thing: it belongs to the first picture, or to nobody if a user gets none.
void join(int& owner, int picture) {
    if (owner == kUnused || picture == kNobody) owner = picture;
}

// Buffers that were changed before, by their paths.
using ChangedFiles = std::map<std::string, std::vector<std::byte>>;

class GltfWriter {
public:
    GltfWriter(JsonValue root, JsonText& text, std::span<const std::byte> binary, const LoadBeside& load,
               const ModelPlace& place, const ModelChanges& changes, GltfBuffers& buffers, const ChangedFiles& changed)
        : root_(root), text_(text.root()), binary_(binary), load_(load), place_(place), changes_(changes),
          changed_(changed), pictures_(changes.pictures), names_(root, place), views_(root),
          tangents_(root, text_, buffers, views_, !binary.empty()), own_(changes.pictures.size()) {}

    Result<void> change();
    [[nodiscard]] const std::optional<std::vector<std::byte>>& binary() const { return changed_binary_; }
    std::vector<BesideModel> take_beside() { return std::move(beside_); }
    [[nodiscard]] int compressed() const { return tangents_.compressed(); }
    [[nodiscard]] const std::vector<std::string>& outside() const { return names_.outside(); }

private:
    // Where a picture is from now on.
    struct Home {
        std::optional<std::int64_t> view;
        std::string uri;   // of data or, if it is in a file, empty until files have names
        std::string file;  // that it was in
        std::vector<std::int64_t> images;
    };

    void set_map(JsonNode& node, const PictureSlot& slot);
    void find_owners();
    Result<void> house(std::size_t picture);
    Result<void> house_pictures();
    Result<void> change_buffers();
    void name_files();
    void name_picture(std::size_t picture);
    void change_images(std::size_t picture);
    void change_textures();
    [[nodiscard]] JsonValue image(std::int64_t index) const { return root_["images"][static_cast<std::size_t>(index)]; }
    [[nodiscard]] std::int64_t image_of(const PictureSlot& slot) const {
        return image_of_texture(root_, slot.slot.texture);
    }

    JsonValue root_;
    JsonNode& text_;
    std::span<const std::byte> binary_;
    const LoadBeside& load_;
    const ModelPlace& place_;
    const ModelChanges& changes_;
    const ChangedFiles& changed_;
    const std::vector<ModelPicture>& pictures_;
    GltfNames names_;
    GltfViews views_;
    GltfTangents tangents_;
    std::vector<PictureSlot> slots_;
    std::vector<int> texture_owners_;
    std::vector<std::vector<std::int64_t>> own_;  // for each picture, the images that it replaces everywhere
    std::vector<Home> homes_;
    std::vector<ChangedBuffer> buffers_;
    std::optional<std::vector<std::byte>> changed_binary_;
    std::vector<BesideModel> beside_;
};

// Finds out which textures and images belong to one picture in all of their uses.
void GltfWriter::find_owners() {
    const JsonValue textures = root_["textures"];
    texture_owners_.assign(textures.size(), kUnused);
    for (const PictureSlot& slot : slots_) {
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
    for (const PictureSlot& slot : slots_) {
        if (slot.picture == kNobody) continue;
        const std::int64_t index = image_of(slot);
        if (index < 0) continue;
        auto& own = own_[static_cast<std::size_t>(slot.picture)];
        if (owners[static_cast<std::size_t>(index)] == slot.picture &&
            std::find(own.begin(), own.end(), index) == own.end())
            own.push_back(index);
    }
}

Result<void> GltfWriter::house_pictures() {
    for (std::size_t p = 0; p < pictures_.size(); ++p) {
        if (auto housed = house(p); !housed) return housed;
    }
    return {};
}

// Puts a picture where the image was: into a buffer, into the text, or into a file, which gets its name later.
Result<void> GltfWriter::house(std::size_t picture) {
    Home home;
    home.images = own_[picture];
    const std::vector<std::byte>& bytes = pictures_[picture].bytes;
    const auto slot = std::find_if(slots_.begin(), slots_.end(),
                                   [&](const PictureSlot& each) { return each.picture == static_cast<int>(picture); });
    const std::int64_t like = home.images.empty() ? image_of(*slot) : home.images.front();
    const std::string uri = like < 0 ? "" : image(like)["uri"].text().value_or("");
    const bool takes_binary = !binary_.empty() && root_["buffers"][0]["uri"].is_null();  // and needs no further file
    const std::string first_buffer = root_["buffers"][0]["uri"].text().value_or("");
    if (const auto view = like < 0 ? std::nullopt : image(like)["bufferView"].count()) {
        const auto uses = std::count_if(home.images.begin(), home.images.end(),
                                        [&](std::int64_t other) { return image(other)["bufferView"].count() == view; });
        if (static_cast<std::size_t>(*view) >= root_["bufferViews"].size())
            return bad_gltf("image " + std::to_string(like) + " is in a view that does not exist");
        home.view = view;
        if (uses > 0 && views_.is_own(*view, static_cast<std::size_t>(uses)))
            views_.replace(*view, bytes);
        else
            home.view = views_.add(views_.buffer_of(*view), bytes);
    } else if (is_data_uri(uri) || (like < 0 && !takes_binary && is_data_uri(first_buffer))) {
        home.uri = encode_data_uri(media_type_of(pictures_[picture].container), bytes);
    } else if (home.images.empty() && takes_binary) {
        home.view = views_.add(0, bytes);
    } else if (like < 0) {
        const std::string what = slot->kind == SlotKind::normal ? "normal_" : "occlusion_";
        home.file = what + std::to_string(slot->material) + ".png";
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
    return {};
}

// Files that changed before stay changed.
Result<void> GltfWriter::change_buffers() {
    auto finished = finish_buffers(root_, text_, views_, binary_, load_);
    if (!finished) return finished.error();
    changed_binary_ = std::move(finished->binary);
    buffers_ = std::move(finished->files);
    for (std::size_t b = 0; b < root_["buffers"].size(); ++b) {
        const auto path = path_of_uri(root_["buffers"][b]["uri"].text().value_or("data:"));
        const auto before = path ? changed_.find(*path) : changed_.end();
        const auto is_this = [b](const ChangedBuffer& buffer) { return buffer.index == b; };
        if (before != changed_.end() && std::none_of(buffers_.begin(), buffers_.end(), is_this))
            buffers_.push_back({b, before->second});
    }
    for (const ChangedBuffer& buffer : buffers_)
        names_.forget(*path_of_uri(*root_["buffers"][buffer.index]["uri"].text()));
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
                                  : container == Container::webp ? std::string(".webp")
                                  : container == Container::ktx2 ? std::string(".ktx2")
                                                                 : std::string(".png");
    const std::string name = names_.name_for(home.file, extension);
    home.uri = uri_of_path(name);
    const bool is_new = home.images.empty() && std::none_of(slots_.begin(), slots_.end(), [&](const PictureSlot& slot) {
                            return slot.picture == static_cast<int>(picture) && image_of(slot) >= 0;
                        });
    beside_.push_back({name, is_new ? std::string() : home.file, true, pictures_[picture].bytes});
}

// Describes the picture in its images, or in one more.
void GltfWriter::change_images(std::size_t picture) {
    Home& home = homes_[picture];
    if (text_.member("images") == nullptr) text_.set("images", "[]");
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
                                   [&](const PictureSlot& each) { return each.picture == static_cast<int>(picture); });
    const std::int64_t like = image_of(*slot);
    const auto name = like < 0 ? std::nullopt : image(like)["name"].text();
    std::string text = name ? "{\"name\":" + json_string(*name) + "," : "{";
    text += home.view ? "\"bufferView\":" + std::to_string(*home.view) + ",\"mimeType\":" + type
                      : "\"uri\":\"" + home.uri + '"';
    home.images.push_back(static_cast<std::int64_t>(list.size()));
    list.append(text + "}");
}

// Makes the textures of slots show their pictures. A texture that other slots use, too, is left to them.
void GltfWriter::change_textures() {
    std::map<std::pair<int, std::int64_t>, std::int64_t> added;
    std::map<int, std::int64_t> shown;  // a texture of each picture, for slots that had none
    for (const PictureSlot& slot : slots_) {
        if (slot.picture == kNobody) continue;
        const std::int64_t texture = slot.slot.texture;
        const auto number = static_cast<std::size_t>(texture);
        const ModelPicture& picture = pictures_[static_cast<std::size_t>(slot.picture)];
        const std::vector<std::int64_t>& images = homes_[static_cast<std::size_t>(slot.picture)].images;
        const bool stays = std::find(images.begin(), images.end(), image_of(slot)) != images.end();
        const std::int64_t image = stays ? image_of(slot) : images.front();
        const bool is_own = number < texture_owners_.size() && texture_owners_[number] == slot.picture;
        JsonNode& material = *text_.member("materials")->element(slot.material);
        JsonNode* node = texture < 0 ? nullptr : slot_node(material, slot.slot);
        if (is_own) {
            show_image(text_, *text_.member("textures")->element(number), image, picture.container);
            shown.emplace(slot.picture, texture);
        } else if (const auto known = shown.find(slot.picture); texture < 0 && known != shown.end()) {
            node = add_slot(material, slot.slot.name, known->second);
        } else {
            const auto [found, is_new] = added.emplace(std::pair(slot.picture, texture), 0);
            const auto sampler = texture < 0 ? std::nullopt : root_["textures"][number]["sampler"].count();
            if (is_new) found->second = add_texture(text_, sampler, image, picture.container);
            shown.emplace(slot.picture, found->second);
            if (node == nullptr)
                node = add_slot(material, slot.slot.name, found->second);
            else
                node->set("index", std::to_string(found->second));
        }
        set_map(*node, slot);
    }
}

// Gives a slot what its map says, if that is wanted. Occlusion from 0 to 1 needs no strength.
void GltfWriter::set_map(JsonNode& node, const PictureSlot& slot) {
    if (slot.kind == SlotKind::roughness) return;
    if (slot.kind != SlotKind::occlusion) {
        if (pictures_[static_cast<std::size_t>(slot.picture)].sets_slots) set_slot(text_, node, slot.slot, *slot.map);
        return;
    }
    ModelMap map = *slot.map;
    map.scale = slot.slot.scale;
    set_slot(text_, node, slot.slot, map);
    node.remove("strength");
}

Result<void> GltfWriter::change() {
    auto slots = picture_slots(root_, pictures_);
    if (!slots) return slots.error();
    slots_ = std::move(*slots);
    find_owners();
    if (auto housed = house_pictures(); !housed) return housed;
    if (auto changed = tangents_.change(changes_.tangents); !changed) return changed;
    if (auto changed = change_buffers(); !changed) return changed;
    name_files();
    for (std::size_t p = 0; p < homes_.size(); ++p) change_images(p);
    change_textures();
    forget_extensions(root_, text_);
    return {};
}

Result<WrittenGltf> write_changes(std::span<const std::byte> file, const GltfChunks& chunks, JsonValue root,
                                  const LoadBeside& load, const ModelPlace& place, const ModelChanges& changes,
                                  const ChangedFiles& changed) {
    JsonText text(chunks.json);
    GltfBuffers buffers(root, chunks.json.size(), chunks.binary, load);
    GltfWriter writer(root, text, chunks.binary, load, place, changes, buffers, changed);
    if (auto made = writer.change(); !made) return made.error();
    auto bytes = with_chunks(file, chunks, text.text(), writer.binary());
    if (!bytes) return bytes.error();
    return WrittenGltf{std::move(*bytes), writer.take_beside(), writer.outside(), {}, writer.compressed()};
}

}  // namespace

Result<WrittenGltf> write_same_form(std::span<const std::byte> file, const LoadBeside& load, const ModelPlace& place,
                                    const ModelChanges& changes) {
    auto chunks = gltf_chunks(file);
    if (!chunks) return chunks.error();
    auto document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    if (auto known = check_asset(document->root()); !known) return known.error();
    auto unmirrored = apply_mirrors(file, *chunks, document->root(), load, changes.tangents);
    if (!unmirrored) return unmirrored.error();
    if (!*unmirrored) return write_changes(file, *chunks, document->root(), load, place, changes, {});
    chunks = gltf_chunks((*unmirrored)->bytes);
    if (!chunks) return chunks.error();
    document = JsonDocument::parse(chunks->json);
    if (!document) return document.error();
    const ChangedFiles& changed = (*unmirrored)->files;
    const LoadBeside load_now = [&](const std::string& path) -> Result<std::vector<std::byte>> {
        const auto found = changed.find(path);
        return found == changed.end() ? load(path) : found->second;
    };
    const ModelChanges now{changes.pictures, std::move((*unmirrored)->tangents)};
    auto written = write_changes((*unmirrored)->bytes, *chunks, document->root(), load_now, place, now, changed);
    if (!written) return written.error();
    written->mirrors = (*unmirrored)->applied;
    written->left_mirrors = (*unmirrored)->left;
    return written;
}

}  // namespace tex::inline v1
