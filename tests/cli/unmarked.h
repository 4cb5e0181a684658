// SPDX-License-Identifier: Apache-2.0
// unmarked.h: files that state nothing about their normals, as other programs write them.

#pragma once

#include <string>

#include <gtest/gtest.h>
#include <tex/tex.h>

#include "cli/program.h"

namespace tex::cli {

// Removes what a file of ours states about its layout and y.
inline void remove_marks(const Scratch& scratch, const std::string& name) {
    auto texture = read_texture(scratch.path(name));
    ASSERT_TRUE(texture);
    texture->swizzle_known = texture->y_known = false;
    ASSERT_TRUE(write_texture(scratch.path(name), *texture));
}

}  // namespace tex::cli
