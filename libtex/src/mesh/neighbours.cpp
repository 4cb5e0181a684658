// SPDX-License-Identifier: Apache-2.0

#include "mesh/neighbours.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <utility>

#include "threads/parallel.h"

namespace tex::inline v1 {
namespace {

// An edge, and the one of its vertices that it is sorted by.
struct SortedEdge {
    std::uint32_t vertex;
    std::uint32_t edge;
};

// What is left of the reference's quicksort if only the place of the greatest keys matters: it divides as the
// reference does, and continues where the greatest key may be.
class LastEdges {
public:
    LastEdges(std::vector<SortedEdge>& edges, std::uint32_t greatest) : edges_(edges), greatest_(greatest) {}

    // Moves the edges with the greatest key to the end, in the reference's order, and returns them.
    std::span<const SortedEdge> sort() {
        sort(0, static_cast<std::ptrdiff_t>(edges_.size()) - 1, 39871946u);
        std::size_t first = edges_.size();
        while (first > 0 && edges_[first - 1].vertex == greatest_) --first;
        return {edges_.data() + first, edges_.size() - first};
    }

private:
    SortedEdge& at(std::ptrdiff_t k) { return edges_[static_cast<std::size_t>(k)]; }

    // Sorts [left, right]. The part with the smaller keys is skipped unless the greatest key divided it from the other.
    // A mesh may be made so that quicksort takes quadratic time. Then its order is given up.
    void sort(std::ptrdiff_t left, std::ptrdiff_t right, std::uint32_t seed) {
        struct Range {
            std::ptrdiff_t left, right;
            std::uint32_t seed;
        };
        std::vector<Range> ranges = {{left, right, seed}};
        std::size_t work = 0;
        while (!ranges.empty()) {
            const Range range = ranges.back();
            ranges.pop_back();
            const std::ptrdiff_t count = range.right - range.left + 1;
            work += static_cast<std::size_t>(count);
            if (count < 2) continue;
            if (work > 256 * edges_.size() + 4096) return give_up();
            if (count == 2) {
                if (at(range.left).vertex > at(range.right).vertex) std::swap(at(range.left), at(range.right));
                continue;
            }
            const std::uint32_t turn = range.seed & 31u;
            const std::uint32_t next_seed = range.seed + std::rotl(range.seed, static_cast<int>(turn)) + 3u;
            const std::uint32_t middle =
                at(range.left + static_cast<std::ptrdiff_t>(next_seed % static_cast<std::uint32_t>(count))).vertex;
            std::ptrdiff_t l = range.left, r = range.right;
            do {
                while (at(l).vertex < middle) ++l;
                while (at(r).vertex > middle) --r;
                if (l <= r) std::swap(at(l++), at(r--));
            } while (l <= r);
            if (middle == greatest_) ranges.push_back({range.left, r, next_seed});
            ranges.push_back({l, range.right, next_seed});
        }
    }

    void give_up() {
        std::sort(edges_.begin(), edges_.end(), [](const SortedEdge& a, const SortedEdge& b) {
            return a.vertex != b.vertex ? a.vertex < b.vertex : a.edge < b.edge;
        });
    }

    std::vector<SortedEdge>& edges_;
    const std::uint32_t greatest_;
};

class Finder {
public:
    explicit Finder(const std::vector<std::uint32_t>& corners)
        : corners_(corners), neighbours_(corners.size(), kNoNeighbour) {}

    Result<std::vector<std::int32_t>> run(const Execution& execution);

private:
    [[nodiscard]] std::uint32_t from(std::size_t edge) const { return corners_[edge]; }
    [[nodiscard]] std::uint32_t to(std::size_t edge) const { return corners_[edge % 3 == 2 ? edge - 2 : edge + 1]; }
    [[nodiscard]] std::uint32_t lesser(std::size_t edge) const { return std::min(from(edge), to(edge)); }
    [[nodiscard]] std::uint32_t greater(std::size_t edge) const { return std::max(from(edge), to(edge)); }

    void pair_all_of(std::span<SortedEdge> edges);
    void pair_runs(std::span<const SortedEdge> edges);
    void pair_equal(std::span<const SortedEdge> edges);
    void pair_last(std::uint32_t greatest);

    const std::vector<std::uint32_t>& corners_;
    std::vector<std::int32_t> neighbours_;
};

// Pairs edges between the same two vertices, in their order. An edge takes the first later one of the other direction
// that is free; as edges are taken in order, one place for each direction is enough to find it.
void Finder::pair_equal(std::span<const SortedEdge> edges) {
    std::size_t next[2] = {0, 0};
    const auto direction = [&](std::size_t k) { return from(edges[k].edge) < to(edges[k].edge) ? 0 : 1; };
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const std::uint32_t edge = edges[k].edge;
        if (neighbours_[edge] != kNoNeighbour) continue;
        const int other = 1 - direction(k);
        std::size_t& j = next[other];
        j = std::max(j, k + 1);
        while (j < edges.size() && (direction(j) != other || neighbours_[edges[j].edge] != kNoNeighbour)) ++j;
        if (j == edges.size()) continue;
        neighbours_[edge] = static_cast<std::int32_t>(edges[j].edge / 3);
        neighbours_[edges[j].edge] = static_cast<std::int32_t>(edge / 3);
    }
}

// Pairs edges that stand side by side and run between the same vertices.
void Finder::pair_runs(std::span<const SortedEdge> edges) {
    for (std::size_t begin = 0; begin < edges.size();) {
        std::size_t end = begin + 1;
        while (end < edges.size() && edges[end].vertex == edges[begin].vertex) ++end;
        if (end - begin > 1) pair_equal(edges.subspan(begin, end - begin));
        begin = end;
    }
}

// Pairs the edges of one vertex, which come in the order of triangles.
void Finder::pair_all_of(std::span<SortedEdge> edges) {
    std::sort(edges.begin(), edges.end(), [](const SortedEdge& a, const SortedEdge& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.edge < b.edge;
    });
    pair_runs(edges);
}

// Pairs the edges whose lesser vertex is the greatest of all.
void Finder::pair_last(std::uint32_t greatest) {
    std::vector<SortedEdge> edges(corners_.size());
    for (std::size_t e = 0; e < edges.size(); ++e) edges[e] = {lesser(e), static_cast<std::uint32_t>(e)};
    std::vector<SortedEdge> last;
    for (const SortedEdge& e : LastEdges(edges, greatest).sort()) last.push_back({greater(e.edge), e.edge});
    // The reference then sorts each run by triangle, but the last one.
    for (std::size_t begin = 0; begin < last.size();) {
        std::size_t end = begin + 1;
        while (end < last.size() && last[end].vertex == last[begin].vertex) ++end;
        if (end < last.size()) {
            std::sort(last.begin() + static_cast<std::ptrdiff_t>(begin),
                      last.begin() + static_cast<std::ptrdiff_t>(end),
                      [](const SortedEdge& a, const SortedEdge& b) { return a.edge < b.edge; });
        }
        begin = end;
    }
    pair_runs(last);
}

Result<std::vector<std::int32_t>> Finder::run(const Execution& execution) {
    const std::size_t count = corners_.size();
    if (count == 0) return std::move(neighbours_);
    // A counting sort by the lesser vertex.
    std::uint32_t greatest = 0;
    for (std::size_t e = 0; e < count; ++e) greatest = std::max(greatest, lesser(e));
    std::vector<std::uint32_t> ends(std::size_t{greatest} + 2, 0);
    for (std::size_t e = 0; e < count; ++e) ++ends[lesser(e) + 1];
    for (std::size_t v = 1; v < ends.size(); ++v) ends[v] += ends[v - 1];
    std::vector<SortedEdge> edges(count);
    for (std::size_t e = 0; e < count; ++e) edges[ends[lesser(e)]++] = {greater(e), static_cast<std::uint32_t>(e)};
    // Now ends[v] is the end of vertex v.
    const auto paired = parallel_for(execution, static_cast<int>(greatest), 1 << 14, [&](int begin, int end) {
        for (int v = begin; v < end; ++v) {
            const std::uint32_t first = v == 0 ? 0 : ends[static_cast<std::size_t>(v) - 1];
            const std::uint32_t last = ends[static_cast<std::size_t>(v)];
            if (last - first > 1) pair_all_of({edges.data() + first, last - first});
        }
    });
    if (!paired) return paired.error();
    edges = {};
    pair_last(greatest);
    return std::move(neighbours_);
}

}  // namespace

Result<std::vector<std::int32_t>> find_neighbours(const std::vector<std::uint32_t>& corners,
                                                  const Execution& execution) {
    return Finder(corners).run(execution);
}

}  // namespace tex::inline v1
