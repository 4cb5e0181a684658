// SPDX-License-Identifier: Apache-2.0

#include "stream/given_extras.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "rows/usable.h"
#include "stream/height_stage.h"
#include "stream/source_stage.h"
#include "threads/no_throw.h"

namespace tex::inline v1 {
namespace {

// Where the rows of an extra come from: a plane, another stage, or, if both are null, the stage of normals.
struct ExtraRows {
    const Plane<float>* plane = nullptr;
    const Stage* picture = nullptr;
};

// Joins normals and other data.
class JoinStage final : public Stage {
public:
    JoinStage(const Stage& normals, ExtraSet extras, const Extras<ExtraRows>& rows)
        : Stage(normals.extent(), extras), normals_(normals), rows_(rows) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override {
        std::vector<Need> needs = {{&normals_, first, end}};
        for (const Extra extra : kExtras) {
            if (rows_[extra].picture != nullptr) needs.push_back({rows_[extra].picture, first, end});
        }
        return needs;
    }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k) {
            const int j = strip.first + k;
            for (const int plane : {0, 1, 2}) copy(normals_.row(plane, j), strip.row(plane, k));
            for (const Extra extra : kExtras) {
                if (extras()[extra]) copy(row_of(extra, j), strip.row(plane_of(extra), k));
            }
        }
        return {};
    }

private:
    [[nodiscard]] const float* row_of(Extra extra, int j) const {
        const ExtraRows& rows = rows_[extra];
        if (rows.plane != nullptr) return rows.plane->row(j);
        return rows.picture != nullptr ? rows.picture->row(0, j) : normals_.row(plane_of(extra), j);
    }
    void copy(const float* from, float* to) const { std::copy_n(from, extent().width, to); }

    const Stage& normals_;
    const Extras<ExtraRows> rows_;
};

Result<void> check_room(ExtraSet given, Encoding encoding) {
    for (const auto& [extra, name, meaning] : kExtraNames) {
        if (!given[extra] || can_hold(encoding)[extra]) continue;
        std::string able;
        for (const auto& row : kEncodingNames) {
            if (can_hold(row.value)[extra]) able.append(able.empty() ? "" : ", ").append(row.name);
        }
        return bad_option(std::string(name_of(kEncodingNames, encoding)) + " has no " + std::string(name) +
                          " for data beside the normals; these formats have: " + able);
    }
    return {};
}

Result<void> check_extent(Extent own, Extent base, Extra extra) {
    if (own == base) return {};
    const auto text = [](Extent e) { return std::to_string(e.width) + "x" + std::to_string(e.height); };
    return bad_option(std::string(name_of(kExtraNames, extra)) + ": the map has " + text(own) +
                      " texels, the normals have " + text(base));
}

// How the rows of a picture are opened.
BakeFileOptions heights_of(const ExtraPicture& picture) {
    BakeFileOptions options;
    options.read = picture.read;
    options.read.values = FileValues::unit;
    options.heights.channel = picture.channel;
    options.heights.no_data = std::numeric_limits<float>::quiet_NaN();
    return options;
}

Result<Plane<float>> plane_of(const ExtraPicture& picture) {
    const BakeFileOptions options = heights_of(picture);
    Result<Image> image = read_image(picture.file, options.read);
    if (!image) return image.error();
    Result<PictureHeights> values = height_field(*image, options.heights);
    if (!values) return values.error().of(picture.file);
    return std::move(values->height);
}

Result<Plane<float>> plane_of(const ExtraData& given, Extent base, Extra extra) {
    if (!given.map && !given.picture) {
        if (!(given.value >= 0.0f && given.value <= 1.0f))
            return bad_option(std::string(name_of(kExtraNames, extra)) + ": must be from 0 to 1");
        return Plane<float>(base, given.value);
    }
    Result<Plane<float>> plane = given.picture ? plane_of(*given.picture) : given.map();
    if (!plane) return plane;
    if (auto fits = check_extent(plane->extent(), base, extra); !fits) return fits.error();
    return plane;
}

Result<void> read_plane(Extra extra, const ExtraData& data, Extent base, NormalMap& map) {
    Result<Plane<float>> read = plane_of(data, base, extra);
    if (!read) return read.error();
    map[extra] = std::move(*read);
    return {};
}

Result<std::unique_ptr<GivenExtras::Picture>> open_picture(Extra extra, const ExtraPicture& picture, Extent base) {
    const BakeFileOptions options = heights_of(picture);
    Result<InputFile> file = open_input(picture.file, options.read);
    if (!file) return file.error();
    auto opened = std::make_unique<GivenExtras::Picture>(GivenExtras::Picture{extra, std::move(*file), {}});
    Result<Heights> heights = open_height_rows(opened->file, options);
    if (!heights) return heights.error().of(picture.file);
    opened->heights = std::move(*heights);
    RowSource& rows = *opened->heights.rows;
    if (auto fits = check_extent(rows.extent(), base, extra); !fits)
        return after_all_rows(rows, picture.file, fits.error());
    return opened;
}

}  // namespace

ExtraSet planes_given(const ExtraInputs& inputs) {
    return extras_with([&](Extra extra) { return inputs[extra].has_value(); });
}

ExtraSet heights_given(const ExtraInputs& inputs) {
    return extras_with([&](Extra extra) { return inputs[extra] && inputs[extra]->heights; });
}

Result<void> check_no_heights(const ExtraInputs& inputs) {
    const auto is_of_heights = [&](Extra extra) {
        return inputs[extra] && (inputs[extra]->heights || inputs[extra]->occlusion);
    };
    if (extras_with(is_of_heights) == ExtraSet()) return {};
    return bad_option("others: there are no heights, only normals");
}

bool may_change_ones(const MipOptions& mip, const std::vector<FileTarget>& files) {
    return follows_normals(mip.alpha) || std::any_of(files.begin(), files.end(), [](const FileTarget& file) {
               const Format format = encoding_info(file.pack.encoding).format;
               return can_hold(file.pack.encoding).alpha && format_info(format).sample == SampleKind::floating;
           });
}

Result<GivenExtras> GivenExtras::read(const ExtraInputs& inputs, Extent base, const std::vector<FileTarget>& files) {
    GivenExtras given;
    given.planes_ = planes_given(inputs);
    if (auto fits = check_together(given.planes_); !fits) return fits.error();
    for (const FileTarget& file : files) {
        if (auto fits = check_room(given.planes_, file.pack.encoding); !fits) return fits.error();
    }
    for (const Extra extra : kExtras) {
        const std::optional<ExtraData>& data = inputs[extra];
        if (!data || data->heights) continue;
        if (data->picture) {
            auto opened = open_picture(extra, *data->picture, base);
            if (!opened) return opened.error();
            given.pictures_.push_back(std::move(*opened));
        } else if (auto read = read_plane(extra, *data, base, given.map_); !read) {
            return read.error();
        }
    }
    return given;
}

const Stage& GivenExtras::add_to(Flow& flow, const Stage& normals) const {
    if (extras_of(map_) == ExtraSet() && pictures_.empty()) return normals;
    Extras<ExtraRows> rows;
    for (const Extra extra : kExtras) {
        if (!map_[extra].empty()) rows[extra].plane = &map_[extra];
    }
    for (const std::unique_ptr<Picture>& picture : pictures_)
        rows[picture->extra].picture = &add_heights(flow, picture->heights, picture->file.path());
    return flow.add<JoinStage>(normals, normals.extras() | planes_, rows);
}

Result<void> put_others(NormalMap& map, const ExtraInputs& inputs, Encoding encoding) {
    return no_throw([&]() -> Result<void> {
        if (auto usable = check_usable(map); !usable) return usable;
        if (auto normals_alone = check_no_heights(inputs); !normals_alone) return normals_alone;
        if (auto fits = check_together(extras_of(map) | planes_given(inputs)); !fits) return fits;
        if (auto fits = check_room(planes_given(inputs), encoding); !fits) return fits;
        for (const Extra extra : kExtras) {
            if (!inputs[extra]) continue;
            if (auto read = read_plane(extra, *inputs[extra], map.extent(), map); !read) return read;
        }
        return {};
    });
}

}  // namespace tex::inline v1
