// SPDX-License-Identifier: Apache-2.0
// Normals to the bytes of textures, and back.

#include <fmt/format.h>

#include "modules.h"
#include "running.h"
#include "values.h"

namespace tex::python {
namespace {

// PackOptions without the encoding, which is a positional argument.
struct PackKeywords : PackOptions {};

template <class F>
void each_field(PackKeywords& o, F& f) {
    f("y_axis", o.y_axis);
    f("effort", o.effort);
    f("metric", o.metric);
    f("y_known", o.y_known);
    each_rdo_field(o.rdo, f);
}

// The fields that blocks depend on.
struct BlockKeywords : PackOptions {};

template <class F>
void each_field(BlockKeywords& o, F& f) {
    f("y_axis", o.y_axis);
    f("effort", o.effort);
    f("metric", o.metric);
}

// Raises ValueError if an array has data beside the normals for which the encoding has no room. Files that hold such
// data can be packed, as the commands do.
void need_room(const MipChain& chain, py::handle from, const char* name, Encoding encoding) {
    if (is_path(from) || py::isinstance<Image>(from) || py::isinstance<Texture>(from)) return;
    for (const NormalMap& level : chain.levels) {
        for (const Extra extra : {Extra::blue, Extra::alpha, Extra::length}) {
            if (level[extra].empty() || can_hold(encoding)[extra]) continue;
            throw py::value_error(fmt::format("{}: {} has no room for {}; NormalMap(n, {}=None) leaves it out", name,
                                              name_of(kEncodingNames, encoding), name_of(kExtraNames, extra),
                                              name_of(kExtraNames, extra)));
        }
    }
}

// pack() makes the same bytes as encode_blocks(), on all threads, and can be stopped.
py::object encoded(Call& call, PackOptions& options, Running& running) {
    if (call.has("encoding")) options.encoding = Convert<Encoding>::from(call["encoding"], "encoding");
    need(format_info(encoding_info(options.encoding).format).has_blocks(), "encoding",
         "must be one of 'dxt5nm', 'bc5', 'bc5-snorm', 'eac-rg11', 'eac-rg11-snorm'");
    MipChain chain;
    chain.levels.push_back(map_from(call["n"], "n"));
    need_room(chain, call["n"], "n", options.encoding);
    const Texture texture = running.run([&](const Execution& e) { return pack(chain, options, e); });
    return bytes_of(texture.levels.front().bytes);
}

py::object unpacked(Call& call, UnpackOptions& options, Running& running) {
    const py::object from = call["source"];
    if (py::isinstance<Texture>(from)) {
        const Texture& texture = texture_from(from, "source");
        return arrays_of(running.run([&](const Execution& e) { return unpack(texture, options, e); }));
    }
    const Picture image(from, "source");
    return array_of(running.run([&](const Execution& e) { return unpack(*image, options, e); }));
}

}  // namespace

void add_packing(Module& module) {
    module.verb<PackKeywords, Running>(
        "pack", {{"chain", kChainSource}, {"encoding", "str", "'dxt5nm'"}}, "Texture",
        "`chain` is a list of levels, as build_mip_chain() returns it, or one array (height, width, 3). A path, an "
        "Image or a Texture stands for its normals. A NormalMap with data for which the encoding has no room raises "
        "ValueError; of files, such data are left out.",
        [](Call& call, PackKeywords& options, Running& running) -> py::object {
            if (call.has("encoding")) options.encoding = Convert<Encoding>::from(call["encoding"], "encoding");
            const MipChain chain = chain_from(call["chain"], "chain");
            need_room(chain, call["chain"], "chain", options.encoding);
            return object_of(running.run([&](const Execution& e) { return pack(chain, options, e); }));
        });
    module.verb<BlockKeywords, Running>(
        "encode_blocks", {{"n", kMapSource}, {"encoding", "str", "'dxt5nm'"}}, "bytes",
        "The blocks of one level, row by row from the top, as bytes for an engine's own container. `encoding` is "
        "'dxt5nm', 'bc5', 'bc5-snorm', 'eac-rg11' or 'eac-rg11-snorm'. Here the verb takes all threads, and memory for "
        "the result.",
        [](Call& call, BlockKeywords& options, Running& running) -> py::object {
            return encoded(call, options, running);
        });
    module.overload({{"Texture", "list[NDArray[np.float32]]"}, {kPicture, "NDArray[np.float32]"}});
    module.verb<UnpackOptions, Running>(
        "unpack", {{"source", "Texture | ArrayLike | Image | str | PathLike[str]"}}, "Any",
        "Of a Texture: a list of arrays (height, width, 3), one for each level. Of an Image, or of an array (height, "
        "width, channels) of stored colours: one array.",
        unpacked);
    module.verb<Running>(
        "decode", {{"texture", "Texture"}, {"level", "int", "0"}}, "Image",
        "The channels of one level as they are stored.", [](Call& call, Running& running) -> py::object {
            const Texture& texture = texture_from(call["texture"], "texture");
            const int level = call.has("level") ? Convert<int>::from(call["level"], "level") : 0;
            const auto count = static_cast<int>(texture.levels.size());
            need(level >= 0 && level < count, "level", fmt::format("must be from 0 to {}", count - 1));
            return object_of(running.run([&](const Execution& e) { return decode(texture, level, e); }));
        });
    module.verb<Running>(
        "guess_swizzle", {{"texture", "Texture"}}, "str", "The layout's name ('dxt5nm'), or its letters.",
        [](Call& call, Running& running) -> py::object {
            const Texture& texture = texture_from(call["texture"], "texture");
            const Swizzle swizzle = running.run([&](const Execution& e) { return guess_swizzle(texture, e); });
            return py::str(layout_name(swizzle));
        });
    module.verb<Running>(
        "transcode", {{"texture", "Texture"}, {"format", "str"}}, "Texture",
        "`format` is 'astc', 'bc7', 'etc1' or 'bc1'.", [](Call& call, Running& running) -> py::object {
            const Texture& texture = texture_from(call["texture"], "texture");
            const auto format = Convert<GpuFormat>::from(call["format"], "format");
            return object_of(running.run([&](const Execution& e) { return transcode(texture, format, e); }));
        });
}

}  // namespace tex::python
