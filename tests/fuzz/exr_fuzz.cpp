// SPDX-License-Identifier: Apache-2.0
// An EXR of any bytes is read or refused, as a picture and as a texture; rows from anywhere in it are those of the
// whole; a texture that is read can be written and read again.
//
// Mutations of bytes seldom leave a header: half of them add, remove, rename, retype and change attributes, or change
// the version, the table of chunks and the numbers at the beginning of a chunk.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/exr/exr.h"
#include "formats/exr/exr_chunk.h"
#include "formats/exr/exr_part.h"
#include "formats/exr/exr_rows.h"
#include "formats/size_limits.h"
#include "reference/exr_file.h"

// A function of libFuzzer; programs that replay the corpus do not have it, and do not mutate.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using tex::reference::ExrAttribute;
using tex::reference::ExrFile;
using tex::reference::little;
using Random = std::minstd_rand;

std::size_t below(std::size_t count, Random& random) { return random() % count; }

template <class T, std::size_t N>
T one_of(const T (&values)[N], Random& random) {
    return values[below(N, random)];
}

std::uint32_t some_integer(Random& random) {
    constexpr std::uint32_t kEdges[] = {0,          1,          0xff,       0x7fff,     0xffff,    0x10000,
                                        0x7ffffffe, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
    return below(2, random) == 0 ? one_of(kEdges, random) : static_cast<std::uint32_t>(below(70, random));
}

constexpr const char* kTypes[] = {"box2i",    "chlist", "compression", "float",   "int",          "lineOrder", "string",
                                  "tiledesc", "v2f",    "v2i",         "preview", "stringvector", "unknown"};

// A value that fits a type, with edges in its fields.
std::string some_value(std::string_view type, Random& random) {
    if (type == "tiledesc")
        return tex::reference::exr_tiles(some_integer(random), some_integer(random),
                                         static_cast<char>(below(20, random)));
    if (type == "compression" || type == "lineOrder") return std::string(1, static_cast<char>(below(12, random)));
    if (type == "string") {
        constexpr const char* kKinds[] = {"scanlineimage", "tiledimage", "deepscanline", "deeptile", "", "+y", "xy01"};
        return one_of(kKinds, random);
    }
    if (type == "chlist") {
        std::vector<tex::reference::ExrChannel> channels;
        for (std::size_t k = below(5, random) + 1; k-- > 0;) {
            constexpr const char* kNames[] = {"R", "G", "B", "A", "X", "Y", "Z", "RY", "layer.R"};
            const std::uint32_t sampling = below(6, random) == 0 ? some_integer(random) : 1;
            channels.push_back(
                {one_of(kNames, random), static_cast<std::uint32_t>(below(4, random)), sampling, sampling, 0});
        }
        return tex::reference::exr_channels(channels);
    }
    std::string value;
    for (std::size_t k = type == "box2i" ? 4 : type == "v2f" || type == "v2i" ? 2 : 1; k-- > 0;)
        value += little({some_integer(random)}, 4);
    return value;
}

ExrAttribute some_attribute(Random& random) {
    constexpr std::pair<const char*, const char*> kKnown[] = {{"tiles", "tiledesc"},
                                                              {"type", "string"},
                                                              {"name", "string"},
                                                              {"chunkCount", "int"},
                                                              {"version", "int"},
                                                              {"dataWindow", "box2i"},
                                                              {"displayWindow", "box2i"},
                                                              {"channels", "chlist"},
                                                              {"compression", "compression"},
                                                              {"lineOrder", "lineOrder"},
                                                              {"dwaCompressionLevel", "float"},
                                                              {"maxSamplesPerPixel", "int"},
                                                              {"pixelAspectRatio", "float"},
                                                              {"screenWindowCenter", "v2f"},
                                                              {"screenWindowWidth", "float"},
                                                              {"preview", "preview"},
                                                              {"envmap", "envmap"},
                                                              {"wrapmodes", "string"}};
    const auto& [name, type] = one_of(kKnown, random);
    return {name, type, some_value(type, random)};
}

void change_attribute(ExrAttribute& attribute, Random& random) {
    switch (below(5, random)) {
        case 0: attribute.type = one_of(kTypes, random); break;
        case 1: attribute.name = some_attribute(random).name; break;
        case 2: attribute.size = some_integer(random); break;
        case 3:
            if (const std::size_t fields = attribute.value.size() / 4; fields > 0)
                attribute.value.replace(below(fields, random) * 4, 4, little({some_integer(random)}, 4));
            break;
        default: attribute.value = some_value(attribute.type, random);
    }
}

void change_header(std::vector<ExrAttribute>& header, Random& random) {
    const std::size_t k = below(header.size() + 1, random);
    const auto at = header.begin() + static_cast<std::ptrdiff_t>(k);
    if (at == header.end() || below(3, random) == 0) {
        header.insert(at, some_attribute(random));
    } else if (below(4, random) == 0) {
        header.erase(at);
    } else {
        change_attribute(*at, random);
    }
}

void change(ExrFile& file, Random& random) {
    switch (below(10, random)) {
        case 0: file.version ^= ExrFile::kTiled << below(4, random); return;
        case 1:
            if (!file.table.empty()) file.table[below(file.table.size(), random)] = some_integer(random);
            return;
        case 2:
            if (file.parts.size() < 4) file.parts.push_back(file.parts.front());
            return;
        case 3: {  // the numbers before the bytes of a chunk
            const std::size_t chunk = file.table.empty() ? 0 : file.table[below(file.table.size(), random)];
            const std::size_t at = chunk + below(6, random) * 4;
            if (at < file.chunks.size() && file.chunks.size() - at >= 4)
                file.chunks.replace(at, 4, little({some_integer(random)}, 4));
            return;
        }
        case 4: file.chunks.resize(below(file.chunks.size() + 64, random), static_cast<char>(random())); return;
        default: change_header(file.parts[below(file.parts.size(), random)], random);
    }
}

// tex-reader decodes the others, in a process for each.
bool is_decoded_here(const tex::InputFile& file) {
    const auto headers = tex::ExrHeaders::read(file);
    return !headers || tex::is_decoded_here((*headers)[0].compression());
}

// Some rows of a picture or level by themselves, which may begin and end in the middle of chunks and tiles. `choice`
// tells which.
void compare_some_rows(tex::RowSource& source, unsigned choice) {
    const auto whole = source.read_all();
    if (!whole) std::abort();
    const auto [width, height] = source.extent();
    const int first = static_cast<int>(choice % static_cast<unsigned>(height));
    const int count = 1 + static_cast<int>(choice / 251 % static_cast<unsigned>(height - first));
    std::vector<std::byte> rows(source.row_bytes() * static_cast<std::size_t>((count + 3) / 4 * 4));
    if (!source.decode(first, count, rows.data())) std::abort();
    tex::Image some = tex::make_image(source.extent(), source.names());
    source.store(rows.data(), first, first + count, some);
    for (std::size_t k = 0; k < some.planes.size(); ++k) {
        for (int j = first; j < first + count; ++j) {
            if (std::memcmp(some.planes[k].row(j), whole->planes[k].row(j),
                            sizeof(float) * static_cast<std::size_t>(width)) != 0)
                std::abort();
        }
    }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    Random random(seed);
    auto file = tex::reference::parse_exr({reinterpret_cast<const char*>(data), size});
    if (!file || file->parts.empty() || below(2, random) == 0) return LLVMFuzzerMutate(data, size, most);
    for (std::size_t changes = 1 + below(3, random); changes-- > 0;) change(*file, random);
    const std::string bytes = tex::reference::write_exr(*file);
    if (bytes.size() > most) return LLVMFuzzerMutate(data, size, most);
    std::memcpy(data, bytes.data(), bytes.size());
    return bytes.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    auto file = tex::InputFile::from_memory("fuzz.exr", {bytes, bytes + size});
    if (!file || !is_decoded_here(*file)) return 0;
    tex::ReadOptions options;
    options.max_texels = 1 << 16;
    const auto image = tex::read_all(tex::open_exr_rows(*file, options));
    if (!image && image.error().reason.empty()) std::abort();
    if (image && (image->extent().texels() > options.max_texels || image->names.size() != image->planes.size()))
        std::abort();
    const unsigned choice = size == 0 ? 0 : 251U * data[size / 2] + data[size - 1];
    if (image) {
        const auto rows = tex::open_exr_rows(*file, options);
        if (!rows) std::abort();
        compare_some_rows(**rows, choice);
    }
    const auto texture = tex::read_all(tex::open_exr_texture_rows(*file, options));
    if (!texture) return 0;
    if (!image) std::abort();
    const auto levels = tex::open_exr_texture_rows(*file, options);
    if (!levels) std::abort();
    for (std::size_t k = 1; k < levels->levels.size(); ++k) compare_some_rows(*levels->levels[k], choice);
    const auto again = tex::encode_exr(*texture);
    if (!again) std::abort();
    auto copy = tex::InputFile::from_memory("again.exr", *again);
    const auto same = tex::read_all(tex::open_exr_texture_rows(*copy, options));
    if (!same || same->levels.size() != texture->levels.size()) std::abort();
    for (std::size_t k = 0; k < same->levels.size(); ++k) {
        if (same->levels[k].bytes.size() != texture->levels[k].bytes.size()) std::abort();
    }
    return 0;
}
