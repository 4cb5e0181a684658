// SPDX-License-Identifier: Apache-2.0

#include <array>
#include <cstdint>
#include <optional>

#include "mesh/meshopt_buffers.h"

namespace tex::inline v1 {
namespace {

// Numbers of one to five bytes, seven bits each, the lowest first.
class NumberReader {
public:
    explicit NumberReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::uint32_t byte() {
        if (at_ == bytes_.size()) {
            failed_ = true;
            return 0;
        }
        return std::to_integer<std::uint32_t>(bytes_[at_++]);
    }
    std::uint32_t number() {
        std::uint32_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const std::uint32_t group = byte();
            value |= (group & 127) << shift;
            if (group < 128) break;
        }
        return value;
    }
    // A number with its sign in the lowest bit.
    std::uint32_t difference() {
        const std::uint32_t value = number();
        return (value >> 1) ^ (0u - (value & 1));
    }
    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
    bool failed_ = false;
};

void store(std::uint32_t value, std::size_t size, std::byte* to) {
    for (std::size_t b = 0; b < size; ++b) to[b] = static_cast<std::byte>(value >> (8 * b) & 0xff);
}

// The version of a buffer that begins with `kind`, or nothing.
std::optional<int> version_of(std::span<const std::byte> bytes, int kind) {
    if (bytes.empty() || (std::to_integer<int>(bytes[0]) & 0xf0) != kind) return std::nullopt;
    const int version = std::to_integer<int>(bytes[0]) & 0xf;
    return version > 1 ? std::nullopt : std::optional<int>(version);
}

// The state of a decoder of triangles: the last 16 edges and vertices, the next new vertex, and the last that was
// written as a number.
class TriangleDecoder {
public:
    using Triangle = std::array<std::uint32_t, 3>;

    TriangleDecoder(std::span<const std::byte> data, std::span<const std::byte> table, int version)
        : data_(data), table_(table), numbered_from_(version >= 1 ? 13 : 15) {
        edges_.fill({UINT32_MAX, UINT32_MAX});
        vertices_.fill(UINT32_MAX);
    }

    Triangle next(std::uint32_t code) {
        if (code < 0xf0) return on_edge(code >> 4, code & 15);
        const Triangle t = code < 0xfe ? from_table(std::to_integer<std::uint32_t>(table_[code & 15]))
                                       : from_data(code == 0xfe ? 0 : 15);
        push_edge(t[1], t[0]);
        push_edge(t[2], t[1]);
        push_edge(t[0], t[2]);
        return t;
    }
    [[nodiscard]] bool failed() const { return data_.failed(); }
    [[nodiscard]] bool at_end() const { return data_.at_end(); }

private:
    // A triangle on one of the last edges.
    Triangle on_edge(std::uint32_t edge, std::uint32_t corner) {
        const auto [a, b] = edges_[(next_edge_ - 1 - edge) & 15];
        std::uint32_t c = 0;
        if (corner < numbered_from_) {
            c = corner == 0 ? next_++ : vertices_[(next_vertex_ - 1 - corner) & 15];
            if (corner == 0) push_vertex(c);
        } else {
            c = corner == 15 ? last_ + data_.difference() : last_ + (corner == 13 ? UINT32_MAX : 1u);
            last_ = c;
            push_vertex(c);
        }
        push_edge(c, b);
        push_edge(a, c);
        return {a, b, c};
    }

    Triangle from_table(std::uint32_t corners) {
        const std::uint32_t feb = corners >> 4, fec = corners & 15;
        Triangle t{};
        t[0] = next_++;
        t[1] = feb == 0 ? next_++ : vertices_[(next_vertex_ - feb) & 15];
        t[2] = fec == 0 ? next_++ : vertices_[(next_vertex_ - fec) & 15];
        push_vertex(t[0]);
        if (feb == 0) push_vertex(t[1]);
        if (fec == 0) push_vertex(t[2]);
        return t;
    }

    Triangle from_data(std::uint32_t fea) {
        const std::uint32_t corners = data_.byte(), feb = corners >> 4, fec = corners & 15;
        if (corners == 0) next_ = 0;
        Triangle t{};
        t[0] = fea == 0 ? next_++ : 0;
        t[1] = feb == 0 ? next_++ : vertices_[(next_vertex_ - feb) & 15];
        t[2] = fec == 0 ? next_++ : vertices_[(next_vertex_ - fec) & 15];
        const std::array<std::uint32_t, 3> from = {fea, feb, fec};
        for (std::size_t k = 0; k < 3; ++k) {
            if (from[k] == 15) t[k] = last_ += data_.difference();
        }
        for (std::size_t k = 0; k < 3; ++k) {
            if (k == 0 || from[k] == 0 || from[k] == 15) push_vertex(t[k]);
        }
        return t;
    }

    void push_edge(std::uint32_t a, std::uint32_t b) {
        edges_[next_edge_] = {a, b};
        next_edge_ = (next_edge_ + 1) & 15;
    }
    void push_vertex(std::uint32_t v) {
        vertices_[next_vertex_] = v;
        next_vertex_ = (next_vertex_ + 1) & 15;
    }

    NumberReader data_;
    std::span<const std::byte> table_;
    std::uint32_t numbered_from_;
    std::array<std::array<std::uint32_t, 2>, 16> edges_{};
    std::array<std::uint32_t, 16> vertices_{};
    std::uint32_t next_edge_ = 0, next_vertex_ = 0, next_ = 0, last_ = 0;
};

}  // namespace

bool decode_meshopt_triangles(std::span<const std::byte> bytes, std::size_t size, std::vector<std::byte>& to) {
    constexpr std::size_t kTable = 16;
    const std::optional<int> version = version_of(bytes, 0xe0);
    const std::size_t triangles = to.size() / size / 3;
    if (!version || bytes.size() < 1 + kTable || bytes.size() - 1 - kTable < triangles) return false;
    const auto codes = bytes.subspan(1, triangles);
    const auto data = bytes.subspan(1 + triangles, bytes.size() - 1 - triangles - kTable);
    TriangleDecoder decoder(data, bytes.last(kTable), *version);
    std::byte* at = to.data();
    for (const std::byte code : codes) {
        for (const std::uint32_t corner : decoder.next(std::to_integer<std::uint32_t>(code))) {
            store(corner, size, at);
            at += size;
        }
        if (decoder.failed()) return false;
    }
    return decoder.at_end();
}

bool decode_meshopt_indices(std::span<const std::byte> bytes, std::size_t size, std::vector<std::byte>& to) {
    constexpr std::size_t kTail = 4;
    const std::size_t count = to.size() / size;
    if (!version_of(bytes, 0xd0) || bytes.size() < 1 + kTail || bytes.size() - 1 - kTail < count) return false;
    NumberReader data(bytes.subspan(1, bytes.size() - 1 - kTail));
    std::array<std::uint32_t, 2> last{};
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t value = data.number(), baseline = value & 1, step = value >> 1;
        last[baseline] += (step >> 1) ^ (0u - (step & 1));
        store(last[baseline], size, to.data() + k * size);
        if (data.failed()) return false;
    }
    return data.at_end();
}

}  // namespace tex::inline v1
