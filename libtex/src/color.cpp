// SPDX-License-Identifier: Apache-2.0

#include <tex/color.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <string_view>
#include <vector>

#include <OpenColorIO/OpenColorIO.h>

#include "files/input_file.h"
#include "rows/math.h"
#include "threads/guard.h"

namespace tex {
namespace {

namespace OCIO = OCIO_NAMESPACE;

// The planes that hold colour: R, G and B, or the one that is not alpha. Empty where there is neither.
std::vector<Plane<float>*> colour_planes(Image& image) {
    std::vector<Plane<float>*> planes;
    for (const char* name : {"R", "G", "B"}) {
        if (const int k = image.find(name); k >= 0) planes.push_back(&image.planes[static_cast<std::size_t>(k)]);
    }
    if (planes.size() == 3) return planes;
    planes.clear();
    for (std::size_t k = 0; k < image.planes.size(); ++k) {
        if (image.names[k] != "A") planes.push_back(&image.planes[k]);
    }
    if (planes.size() > 1) planes.clear();
    return planes;
}

// -- without a configuration -----------------------------------------------------------------------------------

// IEC 61966-2-1:1999, continued beyond [0, 1] by its own formula and below 0 by symmetry.
float srgb_to_linear(float encoded) {
    const double c = std::abs(static_cast<double>(encoded));
    const double linear = c <= 0.04045 ? c / 12.92 : math::pow((c + 0.055) / 1.055, 2.4);
    return static_cast<float>(encoded < 0.0f ? -linear : linear);
}

// Pictures of few bits hold few values: a table of all codes is quicker than the power of each texel.
void srgb_by_table(Plane<float>& plane, int bits) {
    const int top = (1 << bits) - 1;
    std::vector<float> table;
    table.reserve(static_cast<std::size_t>(top) + 1);
    for (int code = 0; code <= top; ++code) {
        table.push_back(srgb_to_linear(static_cast<float>(code) / static_cast<float>(top)));
    }
    for (int j = 0; j < plane.extent().height; ++j) {
        float* row = plane.row(j);
        for (int i = 0; i < plane.extent().width; ++i) {
            row[i] = table[static_cast<std::size_t>(std::clamp(row[i], 0.0f, 1.0f) * static_cast<float>(top) + 0.5f)];
        }
    }
}

void srgb_by_formula(Plane<float>& plane) {
    for (int j = 0; j < plane.extent().height; ++j) {
        std::transform(plane.row(j), plane.row(j) + plane.extent().width, plane.row(j), srgb_to_linear);
    }
}

bool is_word(std::string_view text, std::string_view lower) {
    return std::equal(text.begin(), text.end(), lower.begin(), lower.end(), [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
}

Result<void> convert_built_in(const std::vector<Plane<float>*>& planes, const Image& image, const std::string& space) {
    if (is_word(space, "linear")) return {};
    if (!is_word(space, "srgb")) {
        return Error{ErrorCode::bad_option,
                     {},
                     "no colour space \"" + space + "\": without a configuration there are sRGB and linear"};
    }
    constexpr int kMostBitsOfTable = 16;
    const bool table = image.sample == SampleKind::unorm && image.bits <= kMostBitsOfTable;
    for (Plane<float>* plane : planes) table ? srgb_by_table(*plane, image.bits) : srgb_by_formula(*plane);
    return {};
}

// -- with a configuration --------------------------------------------------------------------------------------

// One line of what OpenColorIO threw.
std::string reason_of(const std::exception& thrown) {
    std::string reason = thrown.what();
    if (const std::size_t line = reason.find('\n'); line != std::string::npos) reason.erase(line);
    while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ' || reason.back() == ':')) reason.pop_back();
    return reason;
}

std::string some_spaces(const OCIO::ConstConfigRcPtr& config) {
    constexpr int kMost = 8;
    std::string names;
    const int count = config->getNumColorSpaces();
    for (int k = 0; k < std::min(count, kMost); ++k) {
        if (k > 0) names += ", ";
        names += config->getColorSpaceNameByIndex(k);
    }
    return count > kMost ? names + " ..." : names;
}

Result<OCIO::ConstConfigRcPtr> load(const std::string& path) {
    if (!path.starts_with("ocio://")) {  // OpenColorIO does not say why a file cannot be read
        const Result<InputFile> file = InputFile::open(path);
        if (!file) return file.error();
    }
    try {
        return OCIO::Config::CreateFromFile(path.c_str());
    } catch (const OCIO::Exception& thrown) {
        return Error{ErrorCode::bad_data, path, "not a sound OpenColorIO configuration: " + reason_of(thrown)};
    }
}

// Rows of R, G and B, or three times the one row of a grey picture.
void convert_rows(const OCIO::ConstCPUProcessorRcPtr& processor, const std::vector<Plane<float>*>& planes) {
    const Extent extent = planes.front()->extent();
    const bool grey = planes.size() == 1;
    std::vector<float> green(grey ? static_cast<std::size_t>(extent.width) : 0);
    std::vector<float> blue(green.size());
    for (int j = 0; j < extent.height; ++j) {
        float* r = planes[0]->row(j);
        float* g = grey ? green.data() : planes[1]->row(j);
        float* b = grey ? blue.data() : planes[2]->row(j);
        if (grey) {
            std::copy_n(r, extent.width, g);
            std::copy_n(r, extent.width, b);
        }
        OCIO::PlanarImageDesc row(r, g, b, nullptr, extent.width, 1);
        processor->apply(row);
    }
}

Result<void> convert_by_config(const std::vector<Plane<float>*>& planes, const ColorOptions& options) {
    OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);  // libtex is silent
    const Result<OCIO::ConstConfigRcPtr> loaded = load(options.config);
    if (!loaded) return loaded.error();
    const OCIO::ConstConfigRcPtr& config = loaded.value();
    if (!config->getColorSpace(options.space.c_str())) {
        return Error{ErrorCode::bad_option, options.config,
                     "no colour space \"" + options.space + "\"; there are " + some_spaces(config)};
    }
    if (!config->getColorSpace(OCIO::ROLE_SCENE_LINEAR)) {
        return Error{ErrorCode::bad_option, options.config, "the configuration has no role scene_linear"};
    }
    try {
        const auto processor = config->getProcessor(options.space.c_str(), OCIO::ROLE_SCENE_LINEAR);
        convert_rows(processor->getDefaultCPUProcessor(), planes);
        return {};
    } catch (const OCIO::Exception& thrown) {
        return Error{ErrorCode::bad_data, options.config, "the conversion fails: " + reason_of(thrown)};
    }
}

}  // namespace

const char* opencolorio_version() { return OCIO::GetVersion(); }

Result<void> to_linear(Image& image, const ColorOptions& options) {
    return guarded([&]() -> Result<void> {
        const std::vector<Plane<float>*> planes = colour_planes(image);
        if (planes.empty()) {
            return Error{ErrorCode::bad_option, {}, "a colour space needs the channels R, G and B, or a single one"};
        }
        return options.config.empty() ? convert_built_in(planes, image, options.space)
                                      : convert_by_config(planes, options);
    });
}

}  // namespace tex
