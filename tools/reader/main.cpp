// SPDX-License-Identifier: Apache-2.0
// tex-reader: loads tex-pictures.so, which is all the rest (program.cpp), from its own folder.
//
// OpenImageIO links 260 libraries, and most of the time of a start goes into those that tex-reader never calls. The
// folder stand-ins, if there is one, has small libraries of the same names (stand_ins.cmake). A library of a name that
// is loaded already is not loaded again, so they come first. If OpenImageIO needs more of a library than its stand-in
// has, which is possible after an update, all of them go, and the real ones are loaded.

#include <dlfcn.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace {

std::string own_folder() {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error).parent_path().string();
}

std::vector<void*> load_stand_ins(const std::string& folder) {
    std::vector<void*> loaded;
    std::error_code error;
    for (const auto& file : std::filesystem::directory_iterator(folder + "/stand-ins", error)) {
        if (file.path().extension() != ".so") continue;
        if (void* const library = dlopen(file.path().c_str(), RTLD_NOW | RTLD_LOCAL)) loaded.push_back(library);
    }
    return loaded;
}

void* load_pictures(const std::string& folder) {
    const std::string library = folder + "/tex-pictures.so";
    const std::vector<void*> stand_ins = load_stand_ins(folder);
    if (void* const pictures = dlopen(library.c_str(), RTLD_NOW | RTLD_GLOBAL)) return pictures;
    for (void* const stand_in : stand_ins) dlclose(stand_in);
    return dlopen(library.c_str(), RTLD_NOW | RTLD_GLOBAL);
}

}  // namespace

int main(int argc, char** argv) {
    constexpr int kNotLoaded = 127;  // as the dynamic loader
    using Program = int(int, char**);
    void* const pictures = load_pictures(own_folder());
    void* const program = pictures == nullptr ? nullptr : dlsym(pictures, "tex_read_pictures");
    if (program == nullptr) {
        static_cast<void>(std::fprintf(stderr, "tex-reader: %s\n", dlerror()));
        return kNotLoaded;
    }
    return reinterpret_cast<Program*>(program)(argc, argv);
}
