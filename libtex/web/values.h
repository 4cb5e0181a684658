// SPDX-License-Identifier: Apache-2.0
// values.h: maps, textures and bytes as JavaScript passes them: JSON, in which {"at": A, "count": N, "type": T} stands
// for a typed array that was copied to this memory.

#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "reader.h"

namespace tex::web {

// What a call answers. Arrays that it refers to live until the next call.
struct Answer {
    std::vector<std::shared_ptr<void>> arrays;

    Json array(const char* type, std::shared_ptr<void> memory, std::size_t count);
    Json of(const NormalMap& map);
    Json of(const MipChain& chain);
    Json of(const Plane<float>& plane);
    Json of(Texture texture);
    Json of(std::vector<std::byte> bytes);
};

// Throw Failure.
const Json& member(const Json& of, const char* name);
Json value_or_null(const Json& of, const char* name);
std::span<const std::byte> bytes_from(const Json& given, const std::string& name);
Plane<float> plane_from(const Json& given, const std::string& name);
NormalMap map_from(const Json& given, const std::string& name);
MipChain chain_from(const Json& given, const std::string& name);
Texture texture_from(const Json& given);
template <class T>
T sound(Result<T> result) {
    if (!result) throw Failure{result.error()};
    return std::move(*result);
}

inline void sound_or_throw(const Result<void>& result) {
    if (!result) throw Failure{result.error()};
}

}  // namespace tex::web
