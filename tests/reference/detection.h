// SPDX-License-Identifier: Apache-2.0
// detection.h: counts what the rules of check.h find and miss in the real maps with planted damages, separately for the
// half that set the thresholds and for the held-out half.

#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <tex/types.h>

namespace tex::reference {

struct Score {
    int planted = 0, detected = 0;  // visible damages
    int hidden = 0;                 // damages that the map hides, see Planted::visible
    int intact = 0, alarms = 0;     // the same textures without the damage

    void add(const Score& other);
};

struct Detection {
    std::map<std::string, std::array<Score, 2>> by_damage;  // [the half that sets thresholds, the held-out half]
    std::array<Score, 2> total;
    std::vector<std::string> missed, alarmed;  // "JPEG, quality 50: normal/brick_512.jpg"

    // A table, the missed damages, and the sums.
    [[nodiscard]] std::string text() const;
};

// Plants every damage into every intact map. `data` is the folder of the files, with a slash. Errors: those of reading
// and checking.
Result<Detection> detect_planted(const std::string& data);

}  // namespace tex::reference
