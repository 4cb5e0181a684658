// SPDX-License-Identifier: Apache-2.0
// modules.h: the groups of functions and classes that make up the module.

#pragma once

namespace tex::python {

class Module;

void add_values(Module& module);
void add_images(Module& module);
void add_formats(Module& module);
void add_heights(Module& module);
void add_normals(Module& module);
void add_surfaces(Module& module);
void add_packing(Module& module);
void add_files(Module& module);
void add_pipeline(Module& module);
void add_meshes(Module& module);
void add_spaces(Module& module);
void add_transfers(Module& module);
void add_checks(Module& module);
void add_repairs(Module& module);
void add_pictures(Module& module);
void add_programs(Module& module);

}  // namespace tex::python
