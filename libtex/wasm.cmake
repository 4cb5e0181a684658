# SPDX-License-Identifier: Apache-2.0
# wasm.cmake: how sources of libtex are compiled for WebAssembly: all are in ${sources}, and ${kernels} are among them.

# Highway 1.0.3 has no vectors of double for WebAssembly. Its plain C++ of the same lanes gives the same bytes.
foreach(kernel bilinear corner_vectors stored trace)
  set_source_files_properties(libtex/src/kernels/${kernel}.cpp PROPERTIES COMPILE_DEFINITIONS HWY_COMPILE_ONLY_EMU128)
endforeach()
# It is downloaded. Kernels take most of the time, but not because LLVM repeats the bodies of loops whose length it
# does not know. -O3 inlines more than -O2, from which only the kernels of BC5, EAC and 8 bits gain.
set_source_files_properties(${kernels} PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS
                            "-O2;-mllvm=-unroll-runtime=false;-mllvm=-unroll-allow-partial=false")
set(inlined ${kernels})
list(FILTER inlined INCLUDE REGEX "/(fit|pack|encode_eac|eac_[a-z]+)[.]cpp$")
set_source_files_properties(${inlined} PROPERTIES COMPILE_OPTIONS -O3)
# Elsewhere, too, a few sources have loops over texels that -Oz makes slower.
set(loops ${sources})
list(FILTER loops INCLUDE REGEX "src/[a-z0-9_]+[.]cpp$|/rays/|/checks/(chroma|curl|kind|stored|texel_counts)[.]cpp$")
set_source_files_properties(${loops} PROPERTIES COMPILE_OPTIONS -Os)
target_compile_options(tex_objects PRIVATE -Oz)
