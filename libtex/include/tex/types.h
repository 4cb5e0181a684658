// SPDX-License-Identifier: Apache-2.0
// types.h: the values that everything else is made of: names, results, images, maps, mip chains.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

// What a shared library shows of itself.
#if defined(__GNUC__) && !defined(_WIN32)
#define TEX_API __attribute__((visibility("default")))
#else
#define TEX_API
#endif

namespace tex::inline v1 {

// -- names ---------------------------------------------------------------------------------------------------------
//
// The names of enumerators.
//
// Every enum that a user can choose from has one table of names beside its definition, called k<Enum>Names. The command
// line, the help, the reports and the error messages all read that table, so a value has the same name everywhere.
// Tables are in the order in which help lists them.

// One row of a name table: the enumerator, its name as a user types it (lower case, words joined by "-"), and one
// clause that explains it in the help.
template <class E>
struct Named {
    E value;
    std::string_view name;
    std::string_view meaning;
};

// The name of `value` in `table`; an empty view if the table does not list it.
template <class E, std::size_t N>
constexpr std::string_view name_of(const Named<E> (&table)[N], E value) {
    for (const Named<E>& row : table) {
        if (row.value == value) return row.name;
    }
    return {};
}

// The enumerator called `name` (exact, case-sensitive); nullopt if the table does not list it.
template <class E, std::size_t N>
constexpr std::optional<E> find_by_name(const Named<E> (&table)[N], std::string_view name) {
    for (const Named<E>& row : table) {
        if (row.name == name) return row.value;
    }
    return std::nullopt;
}

// -- result --------------------------------------------------------------------------------------------------------
//
// How libtex reports failure.
//
// Functions that can fail return Result<T>: the value, or an Error that says which file is concerned and why, in one
// sentence that a technical artist understands. libtex throws no exception across its interface, prints nothing and
// never ends the process. (The constructors of Plane and the standard containers in its structs may throw
// std::bad_alloc in the caller's own code.)

// What kind of failure it was. The commands map it to their exit codes (see normal-maps(7)).
enum class ErrorCode {
    io,             // a file cannot be opened, read, written or renamed; the disk is full
    bad_data,       // a file is damaged, truncated, or holds values that cannot be used (NaN heights)
    unsupported,    // a file is sound but of a type that libtex does not handle
    bad_option,     // the options contradict each other or the data (a channel that the file does not have)
    out_of_memory,  // memory, threads or another resource of the system ran out
    cancelled,      // the progress callback asked to stop, or a signal arrived while a FIFO waited for its reader
};

inline constexpr Named<ErrorCode> kErrorCodeNames[] = {
    {ErrorCode::io, "io", "a file cannot be read or written"},
    {ErrorCode::bad_data, "bad-data", "a file is damaged"},
    {ErrorCode::unsupported, "unsupported", "a file is of an unsupported kind"},
    {ErrorCode::bad_option, "bad-option", "the options do not fit"},
    {ErrorCode::out_of_memory, "out-of-memory", "memory or threads ran out"},
    {ErrorCode::cancelled, "cancelled", "cancelled"},
};

// What a program may act on, beyond the kind of failure.
enum class ErrorDetail {
    none,
    no_space,             // io: the disk, or the quota that the file counts towards, is full
    missing_heights,      // bad_data: some heights are missing, but not all (HeightOptions::fill_invalid fills them)
    uastc_without_alpha,  // a texture of Basis Universal (UASTC or ETC1S) of one channel, which is not y
    several_materials,    // bad_option: MeshSelection::material must choose one
    no_tangents,          // bad_option: the mesh has no tangents of its own (TangentSource)
    no_uvs,               // what was selected of the mesh has no UVs
};

// A failure. `file` is the path concerned, as the caller gave it, or empty if no file is involved; `reason` is one
// clause without a final full stop ("truncated: level 3 wants 64 bytes, 12 are left").
struct Error {
    ErrorCode code = ErrorCode::io;
    std::string file;
    std::string reason;
    ErrorDetail detail = ErrorDetail::none;

    // "FILE: reason", or just the reason if no file is named.
    [[nodiscard]] std::string message() const { return file.empty() ? reason : file + ": " + reason; }

    // This error for the file `path`, unless it already names a file.
    [[nodiscard]] Error of(const std::string& path) const { return {code, file.empty() ? path : file, reason, detail}; }
};

// A value or an Error. Test it, then use value() or error(). Asking for the one that is absent is a programming error
// (std::bad_variant_access, as std::variant defines it).
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return state_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }

    [[nodiscard]] T& value() & { return std::get<0>(state_); }
    [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
    [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
    [[nodiscard]] const Error& error() const& { return std::get<1>(state_); }
    [[nodiscard]] Error&& error() && { return std::get<1>(std::move(state_)); }

    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

private:
    std::variant<T, Error> state_;
};

// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : failed_(true), error_(std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return !failed_; }
    explicit operator bool() const noexcept { return has_value(); }
    [[nodiscard]] const Error& error() const& { return error_; }
    [[nodiscard]] Error&& error() && { return std::move(error_); }

private:
    bool failed_ = false;
    Error error_;
};

// -- execution -----------------------------------------------------------------------------------------------------
//
// Threads, progress and cancellation: the last argument of every verb on whole images.

// How a verb runs. The result never depends on it: the bytes are the same for every number of threads.
struct Execution {
    // The largest number of threads, 1 or more; 0 means one for each processor that this process may use. If the system
    // refuses threads, the verb uses fewer, down to the caller's thread alone.
    int threads = 0;

    // Called from time to time, never from two threads at once, with the fraction done (0 to 1, not decreasing within
    // one call of a verb). If it returns false, the verb stops soon and returns ErrorCode::cancelled. May be empty.
    // Must not throw.
    std::function<bool(double fraction)> progress;

    // Runs loops on the caller's job system, in place of oneTBB's threads: calls body(k) for each k from 0 to count -
    // 1, in any order, on any threads, and returns when all calls have returned. A body never waits for another one, so
    // they may also run one after the other. The verb calls it only if `threads` is not 1. May be empty. Neither it nor
    // a body throws.
    std::function<void(int count, const std::function<void(int k)>& body)> parallel = {};

    // Returns memory for the planes that a verb works on and returns: at least `bytes`, starting at a multiple of
    // kRowAlignment; or null, if there is none: the verb then fails with out_of_memory. Called from any of the verb's
    // threads, also at once. The planes that a verb returns hold it. Functions that read or write files, and everything
    // that is not a plane (bytes of textures, lists), use the heap. May be empty. Must not throw.
    std::function<std::shared_ptr<void>(std::size_t bytes)> allocate = {};

    // This execution without progress.
    [[nodiscard]] Execution quiet() const { return {threads, {}, parallel, allocate}; }
};

// -- image ---------------------------------------------------------------------------------------------------------
//
// Extents, planes of values, and images made of named planes.
//
// Memory layout. The value of texel (i, j), i to the right, j down from the top row, is at
//
//     data[j * stride + i]          0 <= i < extent.width,  0 <= j < extent.height
//
// with the stride in elements, not bytes. Rows of a Plane start on kRowAlignment bytes and are padded to a multiple of
// it, so that a kernel may load and store whole vectors past the last texel of a row; the values in the padding have no
// meaning. Rows of a PlaneView that a caller makes need no padding: verbs on whole images accept any stride >= width.

// Width and height in texels; a valid extent has both at least 1.
struct Extent {
    int width = 0;
    int height = 0;

    [[nodiscard]] constexpr std::int64_t texels() const { return static_cast<std::int64_t>(width) * height; }
    friend constexpr bool operator==(Extent a, Extent b) { return a.width == b.width && a.height == b.height; }
    friend constexpr bool operator!=(Extent a, Extent b) { return !(a == b); }
};

// The largest width or height that libtex handles, in texels.
inline constexpr int kMaxExtent = 1 << 20;

// Rows of a Plane start at multiples of this many bytes: the widest vector of any kernel.
inline constexpr std::size_t kRowAlignment = 64;

// A view of a plane that another object owns. `stride` is in elements, at least extent.width.
template <class T>
struct PlaneView {
    T* data = nullptr;
    Extent extent;
    std::ptrdiff_t stride = 0;

    [[nodiscard]] T* row(int j) const { return data + j * stride; }
    [[nodiscard]] T& at(int i, int j) const { return data[j * stride + i]; }
    operator PlaneView<const T>() const { return {data, extent, stride}; }
};

// allocate_rows() returns the memory of a Plane: `bytes` bytes that start at a multiple of kRowAlignment. It is
// released with the last pointer to it. Compiled in libtex, so that programs compiled with -fno-exceptions can use
// planes. If memory runs out, std::bad_alloc is thrown, and such a program ends.
[[nodiscard]] TEX_API std::shared_ptr<void> allocate_rows(std::size_t bytes);

// The stride of a Plane of this width: rows are padded to whole multiples of kRowAlignment.
template <class T>
[[nodiscard]] constexpr std::ptrdiff_t padded_stride(int width) {
    constexpr std::ptrdiff_t kStep = static_cast<std::ptrdiff_t>(kRowAlignment / sizeof(T));
    return (width + kStep - 1) / kStep * kStep;
}

// Owns one plane, or shares its memory with others. Movable, not copyable by accident: clone() copies. The constructor
// leaves the texels unset and the padding zero, and throws std::bad_alloc like any container of the standard library.
template <class T>
class Plane {
public:
    Plane() = default;
    explicit Plane(Extent extent)
        : Plane(extent, padded_stride<T>(extent.width), allocate(extent, padded_stride<T>(extent.width))) {
        clear_padding();
    }
    Plane(Extent extent, T value) : Plane(extent) {
        for (int j = 0; j < extent.height; ++j) {
            for (int i = 0; i < extent.width; ++i) row(j)[i] = value;
        }
    }
    // A plane in memory that exists already. `rows` points to the first texel and keeps the memory; `stride` is in
    // elements, at least extent.width, or 0 if all rows are the same row, which must not be written to. Every row, also
    // the last one, must be followed by readable memory up to a multiple of kRowAlignment bytes after its start, but
    // need not be aligned: a verb that takes the plane as const only reads it, and all give the same bytes.
    Plane(Extent extent, std::ptrdiff_t stride, std::shared_ptr<T> rows)
        : extent_(extent), stride_(stride), rows_(std::move(rows)) {}

    Plane(Plane&&) noexcept = default;
    Plane& operator=(Plane&&) noexcept = default;
    Plane(const Plane&) = delete;
    Plane& operator=(const Plane&) = delete;
    ~Plane() = default;

    [[nodiscard]] Extent extent() const { return extent_; }
    [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }  // in elements
    [[nodiscard]] bool empty() const { return rows_ == nullptr; }
    [[nodiscard]] T* row(int j) { return rows_.get() + j * stride_; }
    [[nodiscard]] const T* row(int j) const { return rows_.get() + j * stride_; }
    [[nodiscard]] T& at(int i, int j) { return row(j)[i]; }
    [[nodiscard]] const T& at(int i, int j) const { return row(j)[i]; }
    [[nodiscard]] PlaneView<T> view() { return {rows_.get(), extent_, stride_}; }
    [[nodiscard]] PlaneView<const T> view() const { return {rows_.get(), extent_, stride_}; }

    [[nodiscard]] Plane clone() const {
        if (empty()) return {};
        Plane copy(extent_);
        for (int j = 0; j < extent_.height; ++j)
            std::memcpy(copy.row(j), row(j), static_cast<std::size_t>(extent_.width) * sizeof(T));
        return copy;
    }

    // The padding becomes zero.
    void clear_padding() {
        for (int j = 0; j < extent_.height; ++j) {
            std::memset(row(j) + extent_.width, 0, static_cast<std::size_t>(stride_ - extent_.width) * sizeof(T));
        }
    }

private:
    static std::shared_ptr<T> allocate(Extent extent, std::ptrdiff_t stride) {
        const std::size_t count = static_cast<std::size_t>(stride) * static_cast<std::size_t>(extent.height);
        std::shared_ptr<void> memory = allocate_rows(count * sizeof(T));
        T* const rows = static_cast<T*>(memory.get());
        return {std::move(memory), rows};
    }

    Extent extent_;
    std::ptrdiff_t stride_ = 0;
    std::shared_ptr<T> rows_;
};

// What the size of a texel on the ground is measured in.
enum class GroundUnit {
    metre,
    degree,    // of longitude and latitude
    mercator,  // metres of Web Mercator (EPSG:3857), which are longer than those of the ground away from the equator
};

inline constexpr Named<GroundUnit> kGroundUnitNames[] = {
    {GroundUnit::metre, "metre", "metres"},
    {GroundUnit::degree, "degree", "degrees of longitude and latitude"},
    {GroundUnit::mercator, "mercator", "metres of Web Mercator"},
};

// Where the texels of an elevation model lie, as far as slopes depend on it. texel_size() turns it into metres.
struct Ground {
    GroundUnit unit = GroundUnit::metre;
    double width = 1.0;  // of a texel, above 0
    double height = 1.0;
    // The middle of row 0: the latitude in degrees, or the northing in metres of Mercator. Not used with metres.
    double north = 0.0;
    bool north_up = true;  // row 0 is the northernmost one
    // The ellipsoid: WGS 84, unless the file has another one, such as that of the Moon. Metres.
    double equator_radius = 6378137.0;
    double pole_radius = 6356752.314245;
    double height_metres = 1.0;    // of the height 1: 0.3048 if heights are in feet
    bool has_height_unit = false;  // the file states it; else heights are taken as metres

    friend bool operator==(const Ground&, const Ground&) = default;
};

// How a file stored the values before they were converted to float.
enum class SampleKind { unorm, snorm, floating };

// A picture as read from a file: planes of one extent, in the order of the file, each with its channel's
// name ("R", "G", "B", "A" for colour and alpha, "Y" for grey; EXR channels keep theirs). The values are the raw
// data of the file: no colour conversion, no multiplication by alpha. Unsigned integers of n bits are
// divided by 2^n - 1 and so lie in [0, 1], signed ones by 2^(n-1) - 1 and lie in [-1, 1], floats are as stored and may
// be infinite or NaN. The values may also be the numbers themselves: see `stored`.
struct Image {
    std::vector<Plane<float>> planes;
    std::vector<std::string> names;

    SampleKind sample = SampleKind::unorm;
    int bits = 8;  // significant bits of a sample in the file: 1 to 16, or 32; 16 or 32 for half and float

    // The EXR attribute normalEncoding, or empty: "signed" if the values are the components of normals themselves.
    std::string normal_encoding;

    // What a picture that libtex wrote states about its channels, for example "rgb +y" (see encode_file()), or empty.
    // read_texture() applies it.
    std::string normal_mark;
    // The value of texels without data, if the file names one (GDAL_NODATA in TIFF).
    std::optional<float> no_data;

    // Whether the values are the numbers that the file stores (ReadOptions::values), as scale * number + offset.
    // `sample` is then floating.
    bool stored = false;
    double scale = 1.0;  // of GDAL, if the file states them
    double offset = 0.0;

    std::string remark;  // what the reader had to find out, such as the extent of a file without a header, or empty

    // The size of a texel on the ground, if the file states it: GeoTIFF, HGT, ESRI grids, world files, map tiles.
    std::optional<Ground> ground;
    std::string ground_remark;  // what was assumed about it, or why it could not be used, or empty

    [[nodiscard]] Extent extent() const { return planes.empty() ? Extent{} : planes.front().extent(); }
    // The index of the plane called `name` (exact), or -1.
    [[nodiscard]] int find(const std::string& name) const {
        for (std::size_t k = 0; k < names.size(); ++k) {
            if (names[k] == name) return static_cast<int>(k);
        }
        return -1;
    }
};

// -- borders --------------------------------------------------------------------------------------------------------

// What lies beyond the border of an axis of n texels.
//
//             heights                                        vectors and colours (mip filters)
//   repeat    h[i + n] = h[i]                                the same
//   clamp     h[-k] = 2 h[0] - h[k]: a ramp keeps its slope  the border texel again
//   mirror    h[-1 - k] = h[k] (GL_MIRRORED_REPEAT)          the same; vectors are not flipped
//
// If a filter is wider than the axis, the rules apply repeatedly. An axis of one texel has slope 0.
enum class Wrap { repeat, clamp, mirror };

inline constexpr Named<Wrap> kWrapNames[] = {
    {Wrap::repeat, "repeat", "the texture tiles"},
    {Wrap::clamp, "clamp", "heights continue their slope, filters repeat the border texel"},
    {Wrap::mirror, "mirror", "the texture is mirrored at its border"},
};

// -- normal map ----------------------------------------------------------------------------------------------------
//
// Tangent-space normals in memory.
//
// x points right, y points *up* (towards the top row: OpenGL and Unity; "+Y"), z points out of the surface. Components
// are in [-1, 1], vectors have unit length, z >= 0. In files y may point down (DirectX, "-Y"): only pack() and unpack()
// flip it.

// The direction of green in a file.
enum class YAxis { up, down };

inline constexpr Named<YAxis> kYAxisNames[] = {
    {YAxis::up, "up", "+Y: OpenGL, Unity, Blender, glTF"},
    {YAxis::down, "down", "-Y: DirectX, Unreal"},
};

// The data that a texture can hold beside the normals, in extra channels.
enum class Extra { alpha, blue, length };

inline constexpr Named<Extra> kExtraNames[] = {
    {Extra::alpha, "alpha", "heights, occlusion, roughness or a mask in A"},
    {Extra::blue, "blue", "the same in B, instead of z"},
    {Extra::length, "length", "occlusion, in the lengths of vectors"},
};
inline constexpr Extra kExtras[] = {Extra::alpha, Extra::blue, Extra::length};

// One thing for each of them.
template <class T>
struct Extras {
    T blue = {}, alpha = {}, length = {};

    [[nodiscard]] constexpr T& operator[](Extra extra) {
        return extra == Extra::alpha ? alpha : extra == Extra::blue ? blue : length;
    }
    [[nodiscard]] constexpr const T& operator[](Extra extra) const {
        return extra == Extra::alpha ? alpha : extra == Extra::blue ? blue : length;
    }
    friend bool operator==(const Extras&, const Extras&) = default;
};

// Which of them there are.
using ExtraSet = Extras<bool>;

// Three planes of one extent. The constructor takes them from one piece of memory, equally far apart, so that all three
// can be seen as one array of rows, columns and components. Memory is released with the last plane.
//
// `blue`, `alpha` and `length` are other data that a texture holds beside the normals: heights, occlusion, roughness, a
// mask. They are empty, or have the extent of the normals and values from 0 to 1. pack() stores `alpha` in A and `blue`
// in B instead of z, so that whoever reads the texture must reconstruct z. `length` is occlusion c (1 where nothing
// occludes), stored as the length of the vector:
//
//     length = 0.5 + 0.5 sqrt(c), c = clamp(2 length - 1, 0, 1)^2     (Terrain3D for Godot, pull request 868, 2025)
//
// unpack() finds all of them again; build_mip_chain() averages them (ExtraKind; `length` as occlusion). scale() and the
// conversions of mesh.h leave them as they are. blend() keeps those of the base, sampled as its normals are. Other
// verbs ignore them.
struct NormalMap : Extras<Plane<float>> {
    Plane<float> x;
    Plane<float> y;
    Plane<float> z;

    NormalMap() = default;
    explicit NormalMap(Extent extent) {
        // Between two planes are a few lines of the cache. Otherwise the same texel of all three would often compete
        // for the same lines.
        constexpr std::ptrdiff_t kGap = 4 * static_cast<std::ptrdiff_t>(kRowAlignment / sizeof(float));
        const std::ptrdiff_t stride = padded_stride<float>(extent.width);
        const std::ptrdiff_t step = stride * extent.height + kGap;
        const std::shared_ptr<void> memory = allocate_rows(static_cast<std::size_t>(3 * step - kGap) * sizeof(float));
        float* rows = static_cast<float*>(memory.get());
        for (Plane<float>* plane : {&x, &y, &z}) {
            *plane = Plane<float>(extent, stride, std::shared_ptr<float>(memory, rows));
            plane->clear_padding();
            rows += step;
        }
    }
    [[nodiscard]] Extent extent() const { return x.extent(); }
};

// The effect of a bump scale s on a normal.
//
//   slope    normalize(s x, s y, z), as scaling the height by s does; glTF, Unity's SRP
//   xy       (s x, s y, reconstruct_z(s x, s y)): Catlike Coding, Rendering 6, 2.3 (UnpackScaleNormal); if s x and s y
//            leave the unit circle, they are divided by their length and z is 0
//
// For a normal tilted by 32 degrees, the results differ by 2 degrees at s = 0.5 and by 39 degrees at s = 2.
enum class ScaleMode { slope, xy };

inline constexpr Named<ScaleMode> kScaleModeNames[] = {
    {ScaleMode::slope, "slope", "multiply the slopes, as scaling the height does"},
    {ScaleMode::xy, "xy", "multiply x and y, then reconstruct z, as UnpackScaleNormal does"},
};

// z of the unit vector with the given x and y: sqrt(1 - saturate(x^2 + y^2)). Because of the clamp, the result is 0 and
// not NaN if quantisation made x^2 + y^2 greater than 1. (Catlike Coding, Rendering 6, 2.2.)
[[nodiscard]] inline float reconstruct_z(float x, float y) {
    return std::sqrt(1.0f - std::min(std::max(x * x + y * y, 0.0f), 1.0f));
}

// The cheap approximation 1 - (x^2 + y^2) / 2 (GLSL/Cg Programming in Unity, Lighting of Bumpy Surfaces), for
// comparison: it is 0.5 where the true z is 0.
[[nodiscard]] inline float reconstruct_z_approximate(float x, float y) { return 1.0f - (x * x + y * y) / 2.0f; }

// -- mip chain -----------------------------------------------------------------------------------------------------
//
// A normal map and its smaller levels.

// levels[0] is the base level. Level k + 1 has max(1, floor(w / 2)) by max(1, floor(h / 2)) texels, as OpenGL, Vulkan
// and Direct3D require. A chain is complete if its last level is 1x1; it need not be complete.
struct MipChain {
    std::vector<NormalMap> levels;
};

// The extent of level `level` (0 is the base level) of a texture of extent `base`.
[[nodiscard]] constexpr Extent level_extent(Extent base, int level) {
    for (int k = 0; k < level && (base.width > 1 || base.height > 1); ++k) {
        base = {std::max(1, base.width / 2), std::max(1, base.height / 2)};
    }
    return base;
}

// The number of levels of a complete chain: 1 + floor(log2(max(w, h))); 1 for 1x1, 13 for 4096x4096.
[[nodiscard]] constexpr int level_count(Extent base) {
    int count = 1;
    for (int n = std::max(base.width, base.height); n > 1; n /= 2) ++count;
    return count;
}

// -- angular error -------------------------------------------------------------------------------------------------
//
// The distribution of the angles between two normal maps.

// The distribution of the angle between the normals of two maps, in degrees (0 to 180).
//
// Percentiles are exact, by nearest rank: p99 is the smallest angle that at least 99 % of the texels do not exceed.
struct AngularError {
    std::int64_t texels = 0;
    double mean = 0.0;
    double rms = 0.0;  // square root of the mean square
    double p50 = 0.0;  // the median
    double p99 = 0.0;
    double p999 = 0.0;  // 99.9 %
    double max = 0.0;
    int max_column = 0;  // the first texel, in rows from the top, that has the largest angle
    int max_row = 0;
};

// -- materials -----------------------------------------------------------------------------------------------------
//
// Coordinates of meshes, and what a material says about its textures.

struct Float2 {
    float x = 0.0f, y = 0.0f;
};
struct Float3 {
    float x = 0.0f, y = 0.0f, z = 0.0f;
};
struct Float4 {
    float x = 0.0f, y = 0.0f, z = 0.0f, w = 0.0f;
};

// How a material moves UVs before it looks up a texture (glTF's KHR_texture_transform). With c and s the cosine and the
// sine of `rotation`, and v pointing down,
//
//     u' =  c scale_x u + s scale_y v + offset_x
//     v' = -s scale_x u + c scale_y v + offset_y
//
// A mesh keeps the UVs that its file stores; select_part() moves them.
struct UvTransform {
    double offset_x = 0.0, offset_y = 0.0;
    double rotation = 0.0;  // radians
    double scale_x = 1.0, scale_y = 1.0;

    friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

// What alpha of a material's base colour means (glTF 2.0, 3.9.4).
enum class AlphaMode { opaque, mask, blend };

inline constexpr Named<AlphaMode> kAlphaModeNames[] = {
    {AlphaMode::opaque, "opaque", "nothing"},
    {AlphaMode::mask, "mask", "what is below the cutoff is not there"},
    {AlphaMode::blend, "blend", "how much covers what is behind"},
};

}  // namespace tex::inline v1
