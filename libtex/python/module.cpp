// SPDX-License-Identifier: Apache-2.0
// The extension tex._tex. The package tex takes everything from it.

#include <pybind11/pybind11.h>

#include "gil.h"
#include "modules.h"
#include "verb.h"

PYBIND11_MODULE(_tex, extension) {
    // Signatures are part of the docstrings, in the form that inspect.signature() reads.
    pybind11::options options;
    options.disable_function_signatures();
    tex::python::Module module(extension);
    tex::python::add_images(module);
    tex::python::add_values(module);
    tex::python::add_formats(module);
    tex::python::add_heights(module);
    tex::python::add_normals(module);
    tex::python::add_surfaces(module);
    tex::python::add_packing(module);
    tex::python::add_files(module);
    tex::python::add_pipeline(module);
    tex::python::add_meshes(module);
    tex::python::add_spaces(module);
    tex::python::add_transfers(module);
    tex::python::add_checks(module);
    tex::python::add_repairs(module);
    tex::python::add_pictures(module);
    tex::python::add_programs(module);
    module.stub("");
    tex::python::stop_work_at_exit();
}
