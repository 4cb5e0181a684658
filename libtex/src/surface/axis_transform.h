// SPDX-License-Identifier: Apache-2.0
// axis_transform.h: the transforms along one axis in which differences of heights become products.
//
// An axis that repeats takes the discrete Hartley transform (Bracewell 1983); one that is mirrored takes the cosine
// transform (DCT-II; Strang 1999: The discrete cosine transform), whose even symmetry is that of Wrap::mirror. Both
// turn real values into as many real values, in place, and their squared differences are diagonal: coefficient k of an
// axis of n texels belongs to the frequency 2 pi k / n (repeat) or pi k / n (mirror), in radians a texel.

#pragma once

#include "surface/fourier.h"

namespace tex::inline v1 {

class AxisTransform {
public:
    AxisTransform(int texels, bool is_mirrored);

    // The number of groups in each buffer.
    [[nodiscard]] int buffer_length() const { return fourier_.buffer_length(); }
    [[nodiscard]] double frequency(int k) const;

    // Values go into the buffer in an order that suits the transform: group i takes texel order()[i].
    [[nodiscard]] const WorkingVector<int>& order() const { return order_; }

    // From values to coefficients, which are in the order of k.
    void forward(Groups& data, Groups& scratch) const;
    // Back again, times the number of texels. Afterwards the halves of a group are exchanged if swaps_halves().
    void inverse(Groups& data, Groups& scratch) const;
    [[nodiscard]] bool swaps_halves() const { return is_mirrored_; }

private:
    int texels_;
    bool is_mirrored_;
    Fourier fourier_;
    WorkingVector<int> order_;
    WorkingVector<float> turns_;
};

}  // namespace tex::inline v1
