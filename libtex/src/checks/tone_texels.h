// SPDX-License-Identifier: Apache-2.0
// tone_texels.h: stored x, y and z, and how well z follows from x and y once a change of levels is undone.

#pragma once

#include <array>
#include <vector>

#include <tex/check.h>

#include "checks/background.h"
#include "checks/stored.h"

namespace tex::inline v1 {

// What a value was before levels were changed, and what it becomes. Not for lightness, which takes all channels.
double undone(const ToneCurve& curve, double c);
double redone(const ToneCurve& curve, double c);

using ToneTexel = std::array<double, 3>;  // stored x, y and z
using ToneTexels = std::vector<ToneTexel>;
ToneTexel undone(const ToneCurve& curve, const ToneTexel& texel);
ToneTexel redone(const ToneCurve& curve, const ToneTexel& texel);

// The values of up to about 2^14 texels. Precondition: x and y are stored, and z or blue.
ToneTexels tone_texels(const Stored& stored, const Background* background);

// How z was stored before levels were changed: as (z + 1) / 2, as (1 - z) / 2, or from 0 to 1.
enum class ZForm { whole, inverted, from_zero };

// `root` is z from x and y; what is stored for it.
double stored_z(ZForm form, double root);

// The mean distance, in codes, of z as it is stored from what the curve makes of the z of x and y. Where x and y leave
// the unit circle, they add how far.
double error_of(const ToneCurve& curve, const ToneTexels& texels, ZForm form = ZForm::whole);

// This error of the curve of sRGB, encoding or decoding.
double error_of_srgb(bool is_encoded, const ToneTexels& texels, ZForm form = ZForm::whole);

// The share of texels whose z the curve does not cut off at 0 or 1. Where it cuts nearly all, any contrast fits.
double share_uncut(const ToneCurve& curve, const ToneTexels& texels, ZForm form = ZForm::whole);

// The share of the texels whose x or y the curve may have cut off.
double share_cut(const ToneCurve& curve, const ToneTexels& texels);

// Whether so few codes are used near the middle of x and y that it is known to six codes at best: a posterised map.
bool has_coarse_middle(const ToneTexels& texels, double middle);

// The forms that may have been stored, the usual one first. No curve changes whether z grows where x and y say so.
std::vector<ZForm> possible_forms(const ToneTexels& texels);

// The form that fits best after a curve. It must fit much better than the usual one.
ZForm likeliest_form(const ToneCurve& curve, const ToneTexels& texels);

}  // namespace tex::inline v1
