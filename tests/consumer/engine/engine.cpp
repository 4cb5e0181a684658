// SPDX-License-Identifier: Apache-2.0
// engine.cpp: what engine.c does, with the C++ interface, without exceptions and RTTI: the verbs run on threads of this
// program and take their planes from memory of this program. Prints the same. Fails if a plane comes from the heap.
#include <tex/tex.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>

extern "C" std::size_t largest_allocation(void);  // allocations.c
extern "C" long allocations_here(void);

namespace {

constexpr tex::Extent kExtent = {160, 96};
constexpr int kThreads = 3;

[[noreturn]] void fail(const std::string& reason) {
    std::fprintf(stderr, "%s\n", reason.c_str());
    std::exit(1);
}

template <class T>
T take(tex::Result<T> result) {
    if (!result) fail(result.error().message());
    return *std::move(result);
}

std::uint64_t hash(const void* data, std::size_t size, std::uint64_t sum = 14695981039346656037u) {  // FNV-1a
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t k = 0; k < size; ++k) sum = (sum ^ bytes[k]) * 1099511628211u;
    return sum;
}

// Calls body(k) for each k below count, on threads of this program.
template <class Body>
void on_threads(int count, const Body& body) {
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int k = next++; k < count; k = next++) body(k);
    };
    std::array<std::thread, kThreads> threads;
    for (std::thread& thread : threads) thread = std::thread(work);
    for (std::thread& thread : threads) thread.join();
}

// Memory that was there before, handed out from its beginning to its end. Planes give it back with the last pointer.
class Arena {
public:
    std::shared_ptr<void> take(std::size_t bytes) {
        const std::size_t size = (bytes + tex::kRowAlignment - 1) / tex::kRowAlignment * tex::kRowAlignment;
        const std::size_t at = used_.fetch_add(size);
        if (at + size > sizeof(memory_)) return nullptr;
        ++held_;
        return {static_cast<void*>(memory_ + at), [this](void*) { --held_; }};
    }
    std::size_t used() const { return used_; }
    int held() const { return held_; }

private:
    alignas(tex::kRowAlignment) std::byte memory_[4 << 20];
    std::atomic<std::size_t> used_{0};
    std::atomic<int> held_{0};
};
Arena g_arena;

tex::Execution on_own_resources() {
    tex::Execution execution;
    execution.parallel = [](int count, const std::function<void(int)>& body) { on_threads(count, body); };
    execution.allocate = [](std::size_t bytes) { return g_arena.take(bytes); };
    return execution;
}

tex::Texture bake(float* heights) {
    const tex::Execution execution = on_own_resources();
    tex::HeightField field;
    // A pointer that keeps nothing: the heights live longer.
    field.height = tex::Plane<float>(kExtent, kExtent.width, std::shared_ptr<float>(std::shared_ptr<void>(), heights));
    field.bumpiness_x = field.bumpiness_y = 6.0f;
    tex::BakeOptions options;
    options.kernel = tex::GradientKernel::sobel;

    largest_allocation();
    tex::NormalMap normals = take(tex::bake(field, options, execution));
    const tex::MipChain chain = take(tex::build_mip_chain(std::move(normals), {}, execution));
    const std::size_t largest = largest_allocation();
    const std::size_t row = static_cast<std::size_t>(kExtent.width) * sizeof(float);
    if (largest >= 4 * row) fail("the verbs took " + std::to_string(largest) + " bytes from the heap at once");
    if (g_arena.used() < 3 * row * static_cast<std::size_t>(kExtent.height)) fail("planes are not in the arena");

    tex::Texture texture;
    texture.format = tex::Format::bc5_unorm;
    texture.swizzle = tex::kSwizzleXy;
    texture.swizzle_known = true;
    tex::PackOptions pack;
    pack.encoding = tex::Encoding::bc5;
    for (const tex::NormalMap& map : chain.levels) {
        const tex::Extent extent = map.extent();
        tex::Level level = {extent, std::vector<std::byte>(tex::level_bytes(texture.format, extent))};
        const std::size_t pitch = tex::level_bytes(texture.format, {extent.width, 1});
        on_threads((extent.height + 3) / 4, [&](int r) {
            const int rows = std::min(4, extent.height - 4 * r);
            const tex::PlaneView<const float> x = {map.x.row(4 * r), {extent.width, rows}, map.x.stride()};
            const tex::PlaneView<const float> y = {map.y.row(4 * r), {extent.width, rows}, map.y.stride()};
            std::byte* const blocks = level.bytes.data() + static_cast<std::size_t>(r) * pitch;
            const long before = allocations_here();
            const tex::Result<void> done = tex::encode_blocks(x, y, pack, blocks, pitch);
            if (!done || allocations_here() != before) fail("encode_blocks() failed or allocated");
        });
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

// Prints the hashes of red and green of all texels; as a check, decode() must agree with decode_blocks().
void decode(const tex::Texture& texture) {
    std::uint64_t sums[2] = {hash(nullptr, 0), hash(nullptr, 0)};
    for (int k = 0; k < static_cast<int>(texture.levels.size()); ++k) {
        const tex::Level& level = texture.levels[static_cast<std::size_t>(k)];
        const std::size_t texels = static_cast<std::size_t>(level.extent.texels());
        std::vector<float> memory(2 * texels);
        std::array<tex::PlaneView<float>, 4> channels = {};
        channels[0] = {memory.data(), level.extent, level.extent.width};
        channels[1] = {memory.data() + texels, level.extent, level.extent.width};
        const long before = allocations_here();
        const tex::Result<void> done = tex::decode_blocks(
            texture.format, level.bytes.data(), tex::level_bytes(texture.format, {level.extent.width, 1}), channels);
        if (!done || allocations_here() != before) fail("decode_blocks() failed or allocated");
        const tex::Image image = take(tex::decode(texture, k, on_own_resources()));
        for (std::size_t c = 0; c < 2; ++c) {
            sums[c] = hash(channels[c].data, texels * sizeof(float), sums[c]);
            for (int j = 0; j < level.extent.height; ++j) {
                if (!std::equal(channels[c].row(j), channels[c].row(j) + level.extent.width, image.planes[c].row(j)))
                    fail("decode() and decode_blocks() differ");
            }
        }
    }
    std::printf("decoded %016llx %016llx\n", static_cast<unsigned long long>(sums[0]),
                static_cast<unsigned long long>(sums[1]));
}

void check(const tex::Texture& texture, std::optional<tex::YAxis> y) {
    tex::CheckOptions options;
    options.require.y = y;
    options.require.tiles = true;
    const tex::CheckReport report = take(tex::check("memory", texture, options));
    std::printf("%zu findings\n", report.findings.size());
    for (const tex::Finding& finding : report.findings) {
        const std::string id(finding.rule->id);
        const std::string severity(tex::name_of(tex::kSeverityNames, finding.severity));
        std::printf("%s %s, level %d: %s\n", id.c_str(), severity.c_str(),
                    finding.regions.empty() ? 0 : finding.regions.front().level, finding.message.c_str());
    }
}

}  // namespace

int main() {
    static float heights[160 * 96];
    for (int j = 0; j < kExtent.height; ++j) {
        for (int i = 0; i < kExtent.width; ++i) {
            const float u = static_cast<float>(i % 32) / 32.0f, v = static_cast<float>(j % 32) / 32.0f;
            heights[j * kExtent.width + i] = 16.0f * u * (1.0f - u) * v * (1.0f - v);
        }
    }
    const tex::Texture texture = bake(heights);
    if (g_arena.held() != 0) fail("memory is held after its planes");
    std::uint64_t sum = hash(nullptr, 0);
    for (const tex::Level& level : texture.levels) sum = hash(level.bytes.data(), level.bytes.size(), sum);
    std::printf("baked %016llx\n", static_cast<unsigned long long>(sum));

    const std::vector<std::byte> file = take(tex::encode_file(texture, tex::Container::dds));
    const tex::Texture read = take(tex::read_texture(file, "memory.dds"));
    if (largest_allocation() < file.size()) fail("nothing is counted");
    decode(read);
    check(read, std::nullopt);
    check(read, tex::YAxis::down);
    return 0;
}
