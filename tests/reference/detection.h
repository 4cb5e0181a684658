// SPDX-License-Identifier: Apache-2.0
// detection.h: what the rules of check.h find and miss in the real maps with planted damages, on the half that set the
// thresholds and on the one held out.

#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <tex/result.h>

namespace tex::reference {

struct Score {
    int planted = 0, detected = 0;  // damages that show
    int hidden = 0;                 // that the map hides, see Planted::visible
    int intact = 0, alarms = 0;     // the same textures without the damage

    void add(const Score& other);
};

struct Detection {
    std::map<std::string, std::array<Score, 2>> by_damage;  // of the half that sets, of the half held out
    std::array<Score, 2> total;
    std::vector<std::string> missed, alarmed;  // "JPEG, quality 50: normal/brick_512.jpg"

    // A table, what was missed, and the sums.
    [[nodiscard]] std::string text() const;
};

// Plants every damage into every intact map. `data` is the folder of the files, with a slash. Errors: those of reading
// and checking.
Result<Detection> detect_planted(const std::string& data);

}  // namespace tex::reference
