// SPDX-License-Identifier: Apache-2.0
// fourier.h: Fourier transforms of any length, of groups of sequences (kernels/fourier.h).
//
// The folder surface/ holds what finds a surface from its slopes: transforms and solvers on whole planes. It opens no
// file and knows no verb; its loops over texels are in kernels/.
//
// Lengths of the form 2^a 3^b 5^c take a stage for each factor. Any other length n becomes a convolution with a chirp
// (Bluestein 1970: A linear filtering approach to the computation of the discrete Fourier transform), by transforms of
// the next such length from 2 n - 1 on: four times the time. Twiddles come from rows/math.h, so results have the same
// bytes on every machine.

#pragma once

#include <tex/types.h>

#include "kernels/fourier.h"
#include "memory/lent_memory.h"

namespace tex::inline v1 {

// Buffers of groups, one group in each row.
using Groups = Plane<float>;
inline Groups groups_of(int count) { return Groups(Extent{kGroup, count}); }

// A transform of a length of the form 2^a 3^b 5^c.
class SmoothFourier {
public:
    explicit SmoothFourier(int length);

    [[nodiscard]] int length() const { return length_; }

    // Transforms the groups in `data`. `scratch` has as many groups.
    void run(Groups& data, Groups& scratch) const;

private:
    struct Stage {
        int radix, length, stride;
        WorkingVector<float> twiddles;
    };
    int length_;
    WorkingVector<Stage> stages_;
};

// The least length of that form that is at least `length`.
int smooth_length(int length);

class Fourier {
public:
    explicit Fourier(int length);

    // The number of groups in each of the two buffers that run() needs: at least the length.
    [[nodiscard]] int buffer_length() const { return fourier_.length(); }

    // X[k] = sum over i of x[i] exp(-2 pi i k / length), in place, for the first `length` groups of `data`.
    void run(Groups& data, Groups& scratch) const;

private:
    int length_;
    SmoothFourier fourier_;
    // Bluestein's; empty if the length needs none.
    WorkingVector<float> chirp_;
    WorkingVector<float> kernel_;
};

}  // namespace tex::inline v1
