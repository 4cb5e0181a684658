// SPDX-License-Identifier: Apache-2.0
// tone.h: finds changes of levels (gamma, brightness, contrast), because z follows from x and y once they are undone.

#pragma once

#include <optional>

#include <tex/check.h>

#include "checks/background.h"
#include "checks/centre.h"
#include "checks/stored.h"
#include "checks/tone_texels.h"

namespace tex::inline v1 {

// A curve that explains the stored values. Errors are the mean distance of z as it is stored from the z that x and y
// imply, in codes of 8 bits.
struct ToneFit {
    ToneCurve curve;
    double as_stored = 0.0, error = 0.0;  // without the curve, and with it
    double other = 0.0;                   // with the best curve of another family: levels, gamma, or lightness
    bool is_in_codes = false;             // the histogram of 8 bits shows this curve and no other
    bool is_cut = false;  // z is cut off nearly everywhere: the middle alone shows that there was a curve
};

// The change of levels of all channels that moved x and y off the middle. Nothing if they are there, or if the lengths
// of vectors do not prove it. Precondition: x, y and z are stored, unsigned.
std::optional<ToneFit> find_tone(const Stored& stored, const Centre& centre, const Background* background);

// The error of the curve, of any family, that explains z best.
double least_tone_error(const Centre& centre, const ToneTexels& texels);

// The contrast that made vectors longer and left the middle where it is: white - black is below 1.
std::optional<ToneFit> find_contrast(const Stored& stored, const Centre& centre, const Background* background);

// A change of levels that the histogram of 8 bits shows, in a map that leans, so that the middle shows nothing.
std::optional<ToneFit> find_tone_in_codes(const Stored& stored, const Centre& centre, const Background* background);

// A curve of x or y alone, where it moved one of them off the middle and z fits once it is undone. Levels are shifted,
// or stay at black or at white.
struct ChannelTone {
    Component component;
    ToneCurve curve;
    double as_stored = 0.0, error = 0.0;  // as in ToneFit
};
std::optional<ChannelTone> find_channel_tone(const Stored& stored, const Centre& centre, const Background* background);

}  // namespace tex::inline v1
