// SPDX-License-Identifier: Apache-2.0

#include "stream/given_others.h"

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

// Where a place's rows come from: a plane, another stage, or, if both are null, the stage of normals.
struct PlaceRows {
    const Plane<float>* plane = nullptr;
    const Stage* picture = nullptr;
};

// Joins normals and other data.
class JoinStage final : public Stage {
public:
    // `rows`: in the order of kOtherPlaces.
    JoinStage(const Stage& normals, OtherPlanes others, std::vector<PlaceRows> rows)
        : Stage(normals.extent(), others), normals_(normals), rows_(std::move(rows)) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override {
        std::vector<Need> needs = {{&normals_, first, end}};
        for (const PlaceRows& rows : rows_) {
            if (rows.picture != nullptr) needs.push_back({rows.picture, first, end});
        }
        return needs;
    }
    Result<void> make(Strip& strip) override {
        for (int k = 0; k < strip.height; ++k) {
            const int j = strip.first + k;
            for (const int plane : {0, 1, 2}) copy(normals_.row(plane, j), strip.row(plane, k));
            int plane = kFirstOtherPlane;
            for (const OtherPlace& place : kOtherPlaces) {
                if (others().*place.has) copy(row_of(plane, j), strip.row(plane, k));
                ++plane;
            }
        }
        return {};
    }

private:
    [[nodiscard]] const float* row_of(int plane, int j) const {
        const PlaceRows& rows = rows_[static_cast<std::size_t>(plane - kFirstOtherPlane)];
        if (rows.plane != nullptr) return rows.plane->row(j);
        return rows.picture != nullptr ? rows.picture->row(0, j) : normals_.row(plane, j);
    }
    void copy(const float* from, float* to) const { std::copy_n(from, extent().width, to); }

    const Stage& normals_;
    const std::vector<PlaceRows> rows_;
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

Result<void> check_extent(Extent own, Extent base, const char* name) {
    if (own == base) return {};
    const auto text = [](Extent e) { return std::to_string(e.width) + "x" + std::to_string(e.height); };
    return bad_option(std::string(name) + ": the map has " + text(own) + " texels, the normals have " + text(base));
}

// How the rows of a picture are opened.
BakeFileOptions heights_of(const OtherPicture& picture) {
    BakeFileOptions options;
    options.read = picture.read;
    options.read.values = FileValues::unit;
    options.heights.channel = picture.channel;
    options.heights.no_data = std::numeric_limits<float>::quiet_NaN();
    return options;
}

Result<Plane<float>> plane_of(const OtherPicture& picture) {
    const BakeFileOptions options = heights_of(picture);
    Result<Image> image = read_image(picture.file, options.read);
    if (!image) return image.error();
    Result<PictureHeights> values = height_field(*image, options.heights);
    if (!values) return values.error().of(picture.file);
    return std::move(values->height);
}

Result<Plane<float>> plane_of(const OtherData& given, Extent base, const char* name) {
    if (!given.map && !given.picture) {
        if (!(given.value >= 0.0f && given.value <= 1.0f))
            return bad_option(std::string(name) + ": must be from 0 to 1");
        return Plane<float>(base, given.value);
    }
    Result<Plane<float>> plane = given.picture ? plane_of(*given.picture) : given.map();
    if (!plane) return plane;
    if (auto fits = check_extent(plane->extent(), base, name); !fits) return fits.error();
    return plane;
}

// Reads a place's data into the plane of `map`.
Result<void> read_plane(const GivenPlace& given, const OtherData& data, Extent base, NormalMap& map) {
    Result<Plane<float>> read = plane_of(data, base, given.place.name);
    if (!read) return read.error();
    map.*given.place.plane = std::move(*read);
    return {};
}

Result<std::unique_ptr<GivenOthers::Picture>> open_picture(const GivenPlace& given, const OtherPicture& picture,
                                                           Extent base) {
    const BakeFileOptions options = heights_of(picture);
    Result<InputFile> file = open_input(picture.file, options.read);
    if (!file) return file.error();
    auto opened = std::make_unique<GivenOthers::Picture>(GivenOthers::Picture{&given.place, std::move(*file), {}});
    Result<Heights> heights = open_height_rows(opened->file, options);
    if (!heights) return heights.error().of(picture.file);
    opened->heights = std::move(*heights);
    RowSource& rows = *opened->heights.rows;
    if (auto fits = check_extent(rows.extent(), base, given.place.name); !fits)
        return after_all_rows(rows, picture.file, fits.error());
    return opened;
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
    for (const GivenPlace& place : kGivenPlaces) {
        const std::optional<OtherData>& data = inputs.*place.data;
        if (!data || data->heights) continue;
        if (data->picture) {
            auto opened = open_picture(place, *data->picture, base);
            if (!opened) return opened.error();
            given.pictures_.push_back(std::move(*opened));
        } else if (auto read = read_plane(place, *data, base, given.map_); !read) {
            return read.error();
        }
    }
    return given;
}

const Stage& GivenOthers::add_to(Flow& flow, const Stage& normals) const {
    if (others_of(map_) == OtherPlanes() && pictures_.empty()) return normals;
    std::vector<PlaceRows> rows;
    for (const OtherPlace& place : kOtherPlaces) {
        PlaceRows& own = rows.emplace_back();
        if (!(map_.*place.plane).empty()) own.plane = &(map_.*place.plane);
        for (const std::unique_ptr<Picture>& picture : pictures_) {
            if (picture->place->plane == place.plane)
                own.picture = &add_heights(flow, picture->heights, picture->file.path());
        }
    }
    return flow.add<JoinStage>(normals, normals.others() | planes_, std::move(rows));
}

Result<void> put_others(NormalMap& map, const OtherInputs& inputs, Encoding encoding) {
    return no_throw([&]() -> Result<void> {
        if (auto usable = check_usable(map); !usable) return usable;
        for (const auto& [place, data] : kGivenPlaces) {
            if (inputs.*data && (inputs.*data)->heights)
                return bad_option("others: there are no heights, only normals");
        }
        if (auto fits = check_together(others_of(map) | planes_given(inputs)); !fits) return fits;
        if (auto fits = check_room(planes_given(inputs), encoding); !fits) return fits;
        for (const GivenPlace& place : kGivenPlaces) {
            const std::optional<OtherData>& data = inputs.*place.data;
            if (!data) continue;
            if (auto read = read_plane(place, *data, map.extent(), map); !read) return read;
        }
        return {};
    });
}

}  // namespace tex::inline v1
