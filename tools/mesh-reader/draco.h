// SPDX-License-Identifier: Apache-2.0
// draco.h: decodes buffers that Draco compressed, as gltf_draco.h of libtex asks for them.

#pragma once

#include "glb.h"
#include "reader/reader.h"

namespace tex::reader {

// The buffers of a request become the primitives of one mesh. Attributes of more than four components are left out.
// Returns false after a refusal.
bool decode_draco(const void* request, std::size_t bytes, Glb& glb, ReaderHeader& header);

}  // namespace tex::reader
