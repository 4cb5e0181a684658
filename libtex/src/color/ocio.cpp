// SPDX-License-Identifier: Apache-2.0

#include "color/ocio.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <OpenColorIO/OpenColorIO.h>

#include "files/input_file.h"

namespace tex::inline v1 {
namespace {

namespace OCIO = OCIO_NAMESPACE;

// The reason that OpenColorIO threw, as one line.
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

Error conversion_fails(const std::string& config, const std::exception& thrown) {
    return {ErrorCode::bad_data, config, "the conversion fails: " + reason_of(thrown)};
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

Result<OCIO::ConstProcessorRcPtr> processor_of(const OCIO::ConstConfigRcPtr& config, const std::string& file,
                                               const std::string& space) {
    if (!config->getColorSpace(space.c_str())) {
        return Error{ErrorCode::bad_option, file,
                     "no colour space \"" + space + "\"; there are " + some_spaces(config)};
    }
    if (!config->getColorSpace(OCIO::ROLE_SCENE_LINEAR)) {
        return Error{ErrorCode::bad_option, file, "the configuration has no role scene_linear"};
    }
    try {
        return config->getProcessor(space.c_str(), OCIO::ROLE_SCENE_LINEAR);
    } catch (const OCIO::Exception& thrown) {
        return conversion_fails(file, thrown);
    }
}

}  // namespace

const char* ocio_version() { return OCIO::GetVersion(); }

Result<ConvertRow> by_config(const std::string& file, const std::string& space) {
    OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);  // libtex prints nothing
    const Result<OCIO::ConstConfigRcPtr> config = load(file);
    if (!config) return config.error();
    const Result<OCIO::ConstProcessorRcPtr> processor = processor_of(*config, file, space);
    if (!processor) return processor.error();
    try {
        return ConvertRow(
            [on_cpu = (*processor)->getDefaultCPUProcessor(), file](const ColorRows& rows, int width) -> Result<void> {
                try {
                    OCIO::PlanarImageDesc row(rows.row[0], rows.row[1], rows.row[2], nullptr, width, 1);
                    on_cpu->apply(row);
                    return {};
                } catch (const OCIO::Exception& thrown) {
                    return conversion_fails(file, thrown);
                }
            });
    } catch (const OCIO::Exception& thrown) {
        return conversion_fails(file, thrown);
    }
}

Result<std::vector<std::string>> files_of_config(const std::string& file, const std::string& space) {
    std::vector<std::string> files;
    OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
    // OpenColorIO keeps every table that it has read, by its name. Who asks for the names in a program that runs for
    // long wants to know what they are now.
    OCIO::ClearAllCaches();
    const Result<OCIO::ConstConfigRcPtr> config = load(file);
    if (!config) return config.error();
    const Result<OCIO::ConstProcessorRcPtr> processor = processor_of(*config, file, space);
    if (!processor) return processor.error();
    if (!file.starts_with("ocio://")) files.push_back(file);
    try {
        const OCIO::ConstProcessorMetadataRcPtr metadata = (*processor)->getProcessorMetadata();
        const OCIO::ConstContextRcPtr context = (*config)->getCurrentContext();
        for (int k = 0; k < metadata->getNumFiles(); ++k)
            files.emplace_back(context->resolveFileLocation(metadata->getFile(k)));
    } catch (const OCIO::Exception& thrown) {
        return conversion_fails(file, thrown);
    }
    return files;
}

}  // namespace tex::inline v1
