// SPDX-License-Identifier: Apache-2.0

#include "tasks/model_occlusion.h"

#include <memory>
#include <utility>

#include <tex/file.h>
#include <tex/mesh.h>
#include <tex/mip.h>
#include <tex/preview.h>

namespace tex::cli {

Result<Image> orm_of(const ModelInput& material, const ModelOcclusion& place, const ReadOptions& options) {
    if (place.use != PictureUse::orm) return Image{};
    MeshReadOptions how;
    how.reader = options;
    how.images = true;
    auto model = read_model_maps(material.file, how);
    if (!model) return model.error();
    if (static_cast<std::size_t>(place.image) >= model->images.size())
        return Error{ErrorCode::io, material.file, "changed while it was read"};
    ModelImage& image = model->images[static_cast<std::size_t>(place.image)];
    if (image.error) return image.error->of(material.name());
    ReadOptions reading = options;
    reading.values = FileValues::unit;
    if (image.file.empty()) reading.bytes = std::make_shared<const std::vector<std::byte>>(std::move(image.bytes));
    auto read = read_image(image.file.empty() ? material.name() : image.file, reading);
    if (!read) return read.error();
    Image orm;
    const bool is_grey = read->planes.size() < 3;
    for (const char* const name : {"R", "G", "B"}) {
        orm.planes.push_back(read->planes[is_grey ? 0 : orm.planes.size()].clone());
        orm.names.emplace_back(name);
    }
    return orm;
}

Result<std::vector<std::byte>> occlusion_picture(const Job& job, Plane<float> occlusion, Image orm,
                                                 Container container) {
    const Execution execution{job.threads(), {}};
    if (!orm.planes.empty()) {
        orm.planes.front() = std::move(occlusion);
        const auto texture = picture_of(orm);
        if (!texture) return texture.error();
        return encode_file(*texture, container, job.write_options, execution);
    }
    RoughnessChain chain;
    chain.levels.push_back(std::move(occlusion));
    const auto texture = pack_roughness(chain, Format::r8_unorm, Effort::normal, execution);
    if (!texture) return texture.error();
    return encode_file(*texture, container, job.write_options, execution);
}

}  // namespace tex::cli
