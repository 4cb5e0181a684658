// SPDX-License-Identifier: Apache-2.0
// Embree 3 as a judge of rays: what it hits in robust mode, beside what trace_rays() hits, and how long both take on
// one thread. Its library is loaded at run time, by its C interface of version 3.13; without it, the program says so.
//
//     embree_bench [TRIANGLES [SIZE]]        default 998,000 triangles, 2048x2048 rays

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <vector>

#include "bench/wavy_sphere.h"
#include "rays/box_tree.h"

namespace {

// rtcore.h of 3.13.
struct alignas(16) RayHit {
    float org[3], near, direction[3], time, far;
    unsigned mask, id, flags;
    float normal[3], u, v;
    unsigned triangle, geometry, instance;
};
struct Context {
    int flags = 0;
    void* filter = nullptr;
    unsigned instance = 0xffffffff;
    float reserved[8] = {};
};
constexpr int kTriangles = 0, kIndex = 0, kVertex = 1, kUint3 = 0x5003, kFloat3 = 0x9003, kRobust = 4;
constexpr unsigned kNothing = 0xffffffff;

class Embree {
public:
    explicit Embree(void* library) : library_(library) {}

    template <class F>
    F* find(const char* name) const {
        void* const address = dlsym(library_, name);
        if (address == nullptr) std::exit(1);
        F* function = nullptr;
        std::memcpy(&function, &address, sizeof function);
        return function;
    }

private:
    void* library_;
};

void* scene_of(const Embree& embree, const tex::MeshPart& part) {
    void* const device = embree.find<void*(const char*)>("rtcNewDevice")("threads=1");
    void* const scene = embree.find<void*(void*)>("rtcNewScene")(device);
    embree.find<void(void*, int)>("rtcSetSceneFlags")(scene, kRobust);
    void* const geometry = embree.find<void*(void*, int)>("rtcNewGeometry")(device, kTriangles);
    auto* const new_buffer =
        embree.find<void*(void*, int, unsigned, int, std::size_t, std::size_t)>("rtcSetNewGeometryBuffer");
    std::memcpy(new_buffer(geometry, kVertex, 0, kFloat3, 12, part.positions.size()), part.positions.data(),
                12 * part.positions.size());
    std::memcpy(new_buffer(geometry, kIndex, 0, kUint3, 12, part.triangles()), part.indices.data(),
                4 * part.indices.size());
    embree.find<void(void*)>("rtcCommitGeometry")(geometry);
    embree.find<unsigned(void*, void*)>("rtcAttachGeometry")(scene, geometry);
    embree.find<void(void*)>("rtcCommitScene")(scene);
    return scene;
}

double seconds_since(std::clock_t start) { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

void compare(const std::vector<tex::RayHit>& ours, const std::vector<RayHit>& theirs) {
    std::int64_t only_ours = 0, only_theirs = 0, other_triangles = 0;
    double farthest = 0.0;
    for (std::size_t k = 0; k < ours.size(); ++k) {
        const bool hit = ours[k].triangle != tex::kNoHit, their_hit = theirs[k].geometry != kNothing;
        only_ours += hit && !their_hit ? 1 : 0;
        only_theirs += !hit && their_hit ? 1 : 0;
        if (!hit || !their_hit) continue;
        other_triangles += ours[k].triangle != theirs[k].triangle ? 1 : 0;
        farthest = std::max(farthest, std::abs(ours[k].t - static_cast<double>(theirs[k].far)));
    }
    std::printf("%lld rays: %lld hit here alone, %lld in Embree alone, %lld other triangles; largest difference %.2g\n",
                static_cast<long long>(ours.size()), static_cast<long long>(only_ours),
                static_cast<long long>(only_theirs), static_cast<long long>(other_triangles), farthest);
}

}  // namespace

int main(int argc, char** argv) {
    void* const library = dlopen("libembree3.so.3", RTLD_NOW);
    if (library == nullptr) {
        std::puts("libembree3.so.3 is not installed");
        return 0;
    }
    const Embree embree(library);
    const double triangles = argc > 1 ? std::atof(argv[1]) : 998000.0;
    const int size = argc > 2 ? std::atoi(argv[2]) : 2048, rows = static_cast<int>(std::sqrt(triangles / 4.0));
    const tex::MeshPart part = tex::bench::wavy_sphere(2 * rows, rows, 0.01f);
    const std::vector<tex::Ray> rays = tex::bench::rays_at(size, 0.02);
    auto start = std::clock();
    void* const scene = scene_of(embree, part);
    const double their_tree = seconds_since(start);
    auto* const intersect = embree.find<void(void*, Context*, RayHit*)>("rtcIntersect1");
    std::vector<RayHit> theirs(rays.size());
    for (std::size_t k = 0; k < rays.size(); ++k) {
        theirs[k] = {};
        for (std::size_t c = 0; c < 3; ++c) {
            theirs[k].org[c] = static_cast<float>(rays[k].origin[c]);
            theirs[k].direction[c] = static_cast<float>(rays[k].direction[c]);
        }
        theirs[k].far = static_cast<float>(rays[k].length);
        theirs[k].mask = kNothing;
        theirs[k].geometry = kNothing;
    }
    Context context;
    start = std::clock();
    for (RayHit& ray : theirs) intersect(scene, &context, &ray);
    const double their_rays = seconds_since(start);
    start = std::clock();
    const auto tree = tex::BoxTree::build(tex::Triangles({&part}), {1, {}});
    const double our_tree = seconds_since(start);
    if (!tree) return 1;
    std::vector<tex::RayHit> ours(rays.size());
    start = std::clock();
    tex::trace_rays(tree->view(), rays.data(), rays.size(), ours.data());
    const double our_rays = seconds_since(start);
    std::printf("tree: %.2f s here, %.2f s Embree; million rays a second: %.2f here, %.2f Embree\n", our_tree,
                their_tree, static_cast<double>(rays.size()) / our_rays / 1e6,
                static_cast<double>(rays.size()) / their_rays / 1e6);
    compare(ours, theirs);
    return 0;
}
