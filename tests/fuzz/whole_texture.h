// SPDX-License-Identifier: Apache-2.0
// whole_texture.h: what must be true of every texture that a reader of containers accepted.

#pragma once

#include <cstdlib>

#include <tex/file.h>
#include <tex/pack.h>

// Small enough for a fuzzer's memory and time.
inline tex::ReadOptions fuzz_options() {
    tex::ReadOptions options;
    options.max_texels = 1 << 20;
    return options;
}

// Levels have their bytes, level 0 decodes, and the texture can be written again.
inline void expect_whole(const tex::Texture& texture) {
    for (const tex::Level& level : texture.levels) {
        if (level.bytes.size() != tex::level_bytes(texture.format, level.extent)) std::abort();
    }
    tex::Execution one;
    one.threads = 1;
    if (!tex::decode(texture, 0, one)) std::abort();
    static_cast<void>(tex::unpack(texture, {}, one));  // may refuse: a height map has no x
    for (const tex::Container container : {tex::Container::dds, tex::Container::ktx2, tex::Container::astc}) {
        if (tex::can_hold(container, texture.format) && !tex::encode_file(texture, container)) std::abort();
    }
}
