// SPDX-License-Identifier: Apache-2.0
// failures.h: rows of failures that the headers promise, and a mesh that causes them.

#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <tex/mesh.h>
#include <tex/types.h>

namespace tex::failures {

struct Failure {
    const char* words;  // of the header
    std::optional<ErrorCode> promised, got;
};

inline void expect_all(const std::vector<Failure>& failures) {
    for (const Failure& row : failures) {
        EXPECT_TRUE(row.got == row.promised) << row.words << ": " << (row.got ? static_cast<int>(*row.got) : -1);
    }
}

// Nothing if nothing failed.
template <class T>
std::optional<ErrorCode> failure_of(const Result<T>& result) {
    return result ? std::nullopt : std::optional(result.error().code);
}

inline const Execution kStopped = {1, [](double) { return false; }};

// A quad over the whole map, and what a change makes of it.
template <class Change>
MeshPart sheet(Change change) {
    MeshPart part;
    part.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    part.normals = std::vector<Float3>(4, {0, 0, 1});
    part.uvs = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    part.indices = {0, 1, 2, 0, 2, 3};
    change(part);
    return part;
}
inline const auto kUnchanged = [](MeshPart&) {};
inline const auto kBroken = [](MeshPart& part) { part.indices[0] = 4; };
inline const auto kFar = [](MeshPart& part) { part.uvs[0][0].x = 2e6f; };
inline const auto kWithoutArea = [](MeshPart& part) { part.uvs[0] = std::vector<Float2>(4, {0.5f, 0.5f}); };
inline const auto kWithoutNormals = [](MeshPart& part) { part.normals.clear(); };

inline const std::vector<Float4> kTangents(6, {1, 0, 0, 1});
inline const std::vector<Float4> kFewTangents(5, {1, 0, 0, 1});

}  // namespace tex::failures
