// SPDX-License-Identifier: Apache-2.0
// kernels/fourier.h: the steps of Fourier, Hartley and cosine transforms, of sixteen rows or columns side by side.
//
// A group is kGroup floats that belong to one index: eight real parts, then the eight imaginary parts of the same
// eight complex sequences. Sixteen real sequences also make a group: the first eight are the real parts. A buffer holds
// one group for each index, aligned to 64 bytes. Every sequence is computed with the same operations in the same order,
// whatever the width of vectors.

#pragma once

namespace tex::inline v1 {

inline constexpr int kGroup = 16;

// One stage of a Stockham transform (Swarztrauber 1984: FFT algorithms for vector computers), which combines `radix` =
// 2, 3, 4 or 5 groups. With m = length / radix, p < m, q < stride, k and l < radix:
//
//     out[q + stride (radix p + l)] = twiddle(p, l) sum over k of in[q + stride (p + m k)] exp(-2 pi i k l / radix)
//
// `twiddles` holds the real and imaginary parts of exp(-2 pi i p l / length) for l = 1 to radix - 1, for each p.
struct FourierStage {
    int radix;
    int length;
    int stride;
    const float* twiddles;
};
void fourier_stage(const FourierStage& stage, const float* in, float* out);

// Multiplies `count` groups by complex factors, whose real and imaginary parts are in turn in `factors`:
//
//     plain          data[k] = data[k] factors[k]
//     conjugate      data[k] = conj(data[k] factors[k])
//     of_conjugate   data[k] = conj(data[k]) factors[k]
enum class Product { plain, conjugate, of_conjugate };
void multiply_groups(Product product, const float* factors, int count, float* data);

// From the Fourier transform of pairs of real sequences (one in the real, one in the imaginary part) to the discrete
// Hartley transform of each, Re F[k] - Im F[k].
void hartley_of_fourier(const float* in, int count, float* out);

// To the cosine transform of each, c[k] Re F[k] + s[k] Im F[k], where `turns` holds c[k] = cos(pi k / (2 count)) and
// s[k] = sin(pi k / (2 count)) in turn (Makhoul 1980: A fast cosine transform in one and two dimensions).
void cosine_of_fourier(const float* in, const float* turns, int count, float* out);

// The inverse step, with the real and imaginary parts of the result exchanged: a Fourier transform of that is the
// inverse Fourier transform, times `count`, exchanged again.
void fourier_of_cosine(const float* in, const float* turns, int count, float* out);

// Divides the coefficients of one row of frequencies by the eigenvalues of a sum of squared derivatives:
//
//     eigenvalue = x_slope[i] y_smooth + x_smooth[i] y_slope
//     data[i] = eigenvalue > least (x_ideal[i] + y_ideal) ? data[i] scale / eigenvalue : 0
struct SpectrumRow {
    const float *x_slope, *x_smooth, *x_ideal;
    float y_slope, y_smooth, y_ideal;
    float least, scale;
};
void divide_spectrum(const SpectrumRow& row, int count, float* data);

}  // namespace tex::inline v1
