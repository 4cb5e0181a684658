// SPDX-License-Identifier: Apache-2.0
// encode_bench: speed and quality of the DXT5nm encoders, our own and others, for each map.
//
//     encode_bench [MAP ... | DIRECTORY ... | ENCODER.so ...]
//
// Without maps: ../shared/data/normal and pairs beside the source tree or, if they are missing, bakes of the samples.
// An ENCODER.so has the function
//
//     extern "C" void encode(const uint8_t* rgba, int width, int height, size_t pitch, uint8_t* blocks)
//
// and gets R = 255, G = y, B = 0, A = x in 8 bits. libsquish is always compared with our encoders. Times are processor
// time on one thread, the median of several runs. Our encoders read strips of float rows that stay in the second-level
// cache. Errors are those of our decoder, divided by those of `best`, which is the optimum of the squared error in both
// channels. Maps are cut to whole blocks. "pooled" is the sum over the maps divided by the sum over the optima.

// Then it prints the errors under the rules by which processors return 8 bits (decode_rules.h), on a sample of blocks,
// divided by the least error that any blocks of DXT5nm have under the same rule. It also prints how two threads scale,
// compared with a loop that only counts, and the pooled figures in the form of RESULTS.md.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <dlfcn.h>
#include <hwy/highway.h>
#include <squish.h>

#include <tex/tex.h>

#include "bench/decode_rules.h"
#include "bench/encode_maps.h"
#include "blocks/bc1.h"
#include "blocks/bc4.h"
#include "kernels/encode.h"
#include "rows/codecs.h"

namespace {

using namespace bench;
namespace fs = std::filesystem;

struct Quality {
    double green = 0, alpha = 0;                 // mean squared errors, in codes squared
    double mean = 0, most_999 = 0, largest = 0;  // angles in degrees
};

// The sums of squared errors under each rule.
struct RuleErrors {
    double green[4] = {}, alpha[4] = {};
};

struct Encoder {
    std::string name;
    std::function<double(const Map&, std::vector<std::byte>&)> run;  // returns seconds
    Quality sum;
    double seconds = 0;
    RuleErrors under_rules;
};

Quality measure(const Map& map, const std::vector<std::byte>& blocks) {
    Quality q;
    std::vector<float> angles;
    angles.reserve(static_cast<std::size_t>(map.blocks()) * 16);
    for (int block = 0; block < map.blocks(); ++block) {
        const std::byte* bytes = blocks.data() + 16 * block;
        float x[16], y[16], r[16], b[16], a[16];
        tex::decode_bc4_unorm(bytes, x);
        tex::decode_bc1(bytes + 8, tex::Bc1Mode::four_colors, r, y, b, a);
        for (int k = 0; k < 16; ++k) {
            const int i = block % (map.width / 4) * 4 + k % 4;
            const int j = block / (map.width / 4) * 4 + k / 4;
            const double p[2] = {map.normals.x.at(i, j), map.normals.y.at(i, j)};
            const double e[2] = {2.0 * x[k] - 1.0, 2.0 * y[k] - 1.0};
            q.alpha += (p[0] - e[0]) * (p[0] - e[0]) * 127.5 * 127.5;
            q.green += (p[1] - e[1]) * (p[1] - e[1]) * 127.5 * 127.5;
            const double pz = std::sqrt(1.0 - std::min(1.0, p[0] * p[0] + p[1] * p[1]));
            const double ez = std::sqrt(1.0 - std::min(1.0, e[0] * e[0] + e[1] * e[1]));
            const double cross = std::hypot(p[1] * ez - pz * e[1], pz * e[0] - p[0] * ez, p[0] * e[1] - p[1] * e[0]);
            angles.push_back(
                static_cast<float>(std::atan2(cross, p[0] * e[0] + p[1] * e[1] + pz * ez) * 57.29577951308232));
            q.mean += angles.back();
        }
    }
    const auto count = static_cast<double>(angles.size());
    q.green /= count, q.alpha /= count, q.mean /= count;
    const auto at = static_cast<std::ptrdiff_t>(0.999 * (count - 1));
    std::nth_element(angles.begin(), angles.begin() + at, angles.end());
    q.most_999 = angles[static_cast<std::size_t>(at)];
    q.largest = *std::max_element(angles.begin(), angles.end());
    return q;
}

// Takes a sample of about kSampled blocks of the map: calls visit(block, y, x) with the texels in codes.
constexpr int kSampled = 24;
template <class Visit>
void for_sampled_blocks(const Map& map, Visit visit) {
    const int across = map.width / 4;
    const int step = std::max(1, map.blocks() / kSampled) | 1;  // odd, so that blocks come from several columns
    for (int block = step / 2; block < map.blocks(); block += step) {
        float x[16], y[16];
        for (int k = 0; k < 16; ++k) {
            x[k] = map.normals.x.at(block % across * 4 + k % 4, block / across * 4 + k / 4) * 127.5f + 127.5f;
            y[k] = map.normals.y.at(block % across * 4 + k % 4, block / across * 4 + k / 4) * 127.5f + 127.5f;
        }
        visit(block, y, x);
    }
}

void add_rule_errors(const Map& map, const std::vector<std::byte>& blocks, RuleErrors& sum) {
    for_sampled_blocks(map, [&](int block, const float* y, const float* x) {
        for (int r = 0; r < 4; ++r) {
            const std::byte* bytes = blocks.data() + 16 * static_cast<std::ptrdiff_t>(block);
            sum.green[r] += rules::green_error(static_cast<rules::Rule>(r), bytes, y);
            sum.alpha[r] += rules::alpha_error(static_cast<rules::Rule>(r), bytes, x);
        }
    });
}

void add_least_errors(const Map& map, RuleErrors& sum) {
    for_sampled_blocks(map, [&](int, const float* y, const float* x) {
        for (int r = 0; r < 4; ++r) {
            sum.green[r] += static_cast<double>(rules::least_green_error(static_cast<rules::Rule>(r), y));
            sum.alpha[r] += static_cast<double>(rules::least_alpha_error(static_cast<rules::Rule>(r), x));
        }
    });
}

// Our encoders: rows of blocks, each several times in a row, so that its texels are in the cache.
double encode_ours(const Map& map, tex::Effort effort, std::vector<std::byte>& blocks,
                   tex::Metric metric = tex::Metric::component) {
    const int repeats = effort == tex::Effort::best ? 1 : effort == tex::Effort::normal ? 2 : 8;
    std::vector<double> seconds;
    for (int run = 0; run < (effort == tex::Effort::best ? 1 : 3); ++run) {
        const double start = processor_seconds();
        for (int j = 0; j < map.height; j += 4) {
            tex::BlockRow row;
            for (int k = 0; k < 4; ++k) {
                row.x[k] = map.normals.x.row(j + k);
                row.y[k] = map.normals.y.row(j + k);
            }
            row.width = map.width;
            std::byte* out = blocks.data() + 16 * static_cast<std::ptrdiff_t>(j / 4) * (map.width / 4);
            for (int repeat = 0; repeat < repeats; ++repeat) {
                tex::encode_blocks(row, {tex::Encoding::dxt5nm, tex::YAxis::up, effort, metric}, out);
            }
        }
        seconds.push_back((processor_seconds() - start) / repeats);
    }
    return median(seconds);
}

double encode_others(const Map& map, std::vector<std::byte>& blocks,
                     const std::function<void(const Map&, std::uint8_t*)>& encode, int runs) {
    std::vector<double> seconds;
    for (int run = 0; run < runs; ++run) {
        const double start = processor_seconds();
        encode(map, reinterpret_cast<std::uint8_t*>(blocks.data()));
        seconds.push_back(processor_seconds() - start);
    }
    return median(seconds);
}

void print(const std::string& map, const Encoder& encoder, double speed, const Quality& q, const Quality& best) {
    const auto ratio = [](double value, double least) {
        return least > 0 ? value / least : value > 0 ? HUGE_VAL : 1.0;
    };
    std::printf("%-28s %-22s %9.2f %8.3f %8.3f %8.3f %8.3f %8.3f\n", map.c_str(), encoder.name.c_str(), speed,
                ratio(q.mean, best.mean), ratio(q.green, best.green), ratio(q.alpha, best.alpha),
                ratio(q.most_999, best.most_999), ratio(q.largest, best.largest));
    std::fflush(stdout);
}

std::vector<Encoder> our_encoders() {
    std::vector<Encoder> encoders;
    encoders.push_back(
        {"best", [](const Map& map, auto& blocks) { return encode_ours(map, tex::Effort::best, blocks); }, {}, 0, {}});
    encoders.push_back(
        {"best, angle",
         [](const Map& map, auto& blocks) { return encode_ours(map, tex::Effort::best, blocks, tex::Metric::angle); },
         {},
         0,
         {}});
    for (const tex::Effort effort : {tex::Effort::normal, tex::Effort::fast}) {
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            const std::string name =
                std::string(tex::name_of(tex::kEffortNames, effort)) + " " + hwy::TargetName(target);
            encoders.push_back({name,
                                [effort, target](const Map& map, auto& blocks) {
                                    hwy::SetSupportedTargetsForTest(target);
                                    const double seconds = encode_ours(map, effort, blocks);
                                    hwy::SetSupportedTargetsForTest(0);
                                    return seconds;
                                },
                                {},
                                0,
                                {}});
        }
    }
    for (const int flag : {squish::kColourRangeFit, squish::kColourClusterFit}) {
        encoders.push_back({flag == squish::kColourRangeFit ? "libsquish range" : "libsquish cluster",
                            [flag](const Map& map, auto& blocks) {
                                return encode_others(
                                    map, blocks,
                                    [flag](const Map& m, std::uint8_t* out) {
                                        squish::CompressImage(m.rgba8.data(), m.width, m.height, out,
                                                              squish::kDxt5 | flag);
                                    },
                                    1);
                            },
                            {},
                            0,
                            {}});
    }
    return encoders;
}

// Wall-clock seconds for `work` on each of `threads` threads at once: the minimum of several runs.
template <class Work>
double wall_seconds(int threads, Work work) {
    double least = HUGE_VAL;
    for (int run = 0; run < 5; ++run) {
        const auto start = std::chrono::steady_clock::now();
        std::vector<std::jthread> running;
        for (int k = 0; k < threads; ++k) running.emplace_back(work);
        running.clear();
        least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return least;
}

// How much more two threads do than one, for encoding and for a loop that only counts.
void print_threads(const Map& map) {
    const auto count = [] {
        for (std::uint64_t k = 0; k < 200'000'000; ++k) asm volatile("" : "+r"(k));
    };
    const double counting = 2 * wall_seconds(1, count) / wall_seconds(2, count);
    for (const tex::Effort effort : {tex::Effort::fast, tex::Effort::normal}) {
        const auto encode = [&map, effort] {
            std::vector<std::byte> blocks(static_cast<std::size_t>(map.blocks()) * 16);
            encode_ours(map, effort, blocks);
        };
        const double encoding = 2 * wall_seconds(1, encode) / wall_seconds(2, encode);
        std::printf("two threads, %s: %.2f of one (counting alone: %.2f, ratio %.2f)\n",
                    std::string(tex::name_of(tex::kEffortNames, effort)).c_str(), encoding, counting,
                    encoding / counting);
    }
}

void print_rules(const std::vector<Encoder>& encoders, const RuleErrors& least) {
    std::printf("\n%-22s", "green, alpha");
    for (const char* name : rules::kNames) std::printf(" %16s", name);
    for (const Encoder& encoder : encoders) {
        std::printf("\n%-22s", encoder.name.c_str());
        for (int r = 0; r < 4; ++r) {
            std::printf("   %6.3f %6.3f", encoder.under_rules.green[r] / least.green[r],
                        encoder.under_rules.alpha[r] / least.alpha[r]);
        }
    }
    std::printf("\n\n");
}

void print_markdown(const std::vector<Encoder>& encoders, double texels) {
    std::printf(
        "\n| encoder | Mtexel/s | mean angle | p99.9 angle | green MSE | alpha MSE |\n|---|---|---|---|---|---|\n");
    const Quality& best = encoders.front().sum;
    for (const Encoder& encoder : encoders) {
        const double speed = texels / encoder.seconds * 1e-6;
        std::printf("| %s | %.*f | %.3f | %.3f | %.3f | %.3f |\n", encoder.name.c_str(), speed < 20 ? 1 : 0, speed,
                    encoder.sum.mean / best.mean, encoder.sum.most_999 / best.most_999, encoder.sum.green / best.green,
                    encoder.sum.alpha / best.alpha);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<Map> maps;
    std::vector<Encoder> encoders = our_encoders();
    for (int k = 1; k < argc; ++k) {
        const fs::path path = argv[k];
        if (path.extension() == ".so") {
            void* library = dlopen(argv[k], RTLD_NOW);
            using Encode = void (*)(const std::uint8_t*, int, int, std::size_t, std::uint8_t*);
            const auto encode = library == nullptr ? nullptr : reinterpret_cast<Encode>(dlsym(library, "encode"));
            if (encode == nullptr) {
                std::fprintf(stderr, "encode_bench: %s\n", dlerror());
                return 3;
            }
            encoders.push_back({path.stem().string(),
                                [encode](const Map& map, auto& blocks) {
                                    return encode_others(
                                        map, blocks,
                                        [encode](const Map& m, std::uint8_t* out) {
                                            encode(m.rgba8.data(), m.width, m.height,
                                                   static_cast<std::size_t>(4 * m.width), out);
                                        },
                                        3);
                                },
                                {},
                                0,
                                {}});
        } else if (fs::is_directory(path)) {
            add_directory(path, maps);
        } else {
            add_map(path, maps);
        }
    }
    if (maps.empty()) add_usual_maps(maps);
    if (maps.empty()) return 3;
    std::printf("%-28s %-22s %9s %8s %8s %8s %8s %8s\n", "map", "encoder", "Mtexel/s", "mean", "green", "alpha",
                "p99.9", "largest");
    double texels = 0;
    RuleErrors least;
    for (const Map& map : maps) {
        add_least_errors(map, least);
        std::vector<std::byte> blocks(static_cast<std::size_t>(map.blocks()) * 16);
        texels += 16.0 * map.blocks();
        Quality best;
        for (Encoder& encoder : encoders) {
            const double seconds = encoder.run(map, blocks);
            const Quality q = measure(map, blocks);
            if (&encoder == encoders.data()) best = q;
            add_rule_errors(map, blocks, encoder.under_rules);
            print(map.name, encoder, 16.0 * map.blocks() / seconds * 1e-6, q, best);
            encoder.seconds += seconds;
            for (double Quality::*field :
                 {&Quality::green, &Quality::alpha, &Quality::mean, &Quality::most_999, &Quality::largest}) {
                encoder.sum.*field += q.*field;
            }
        }
    }
    for (const Encoder& encoder : encoders)
        print("pooled", encoder, texels / encoder.seconds * 1e-6, encoder.sum, encoders.front().sum);
    print_rules(encoders, least);
    if (!maps.empty()) print_threads(maps.front());
    print_markdown(encoders, texels);
    return 0;
}
