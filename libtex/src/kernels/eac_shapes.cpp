// SPDX-License-Identifier: Apache-2.0

#include "kernels/eac_shapes.h"

#include <algorithm>

namespace tex::inline v1 {
namespace {

struct Windows {
    EacWindow at[kEacTables][8][kLongestWindow + 1];
};

EacWindow window_of(const EacShape& shape, int count, int length) {
    EacWindow window{1000, -1000};
    for (int k = 0; k + count <= 7; ++k) {
        const int first = shape.sums[k];
        const int last = shape.sums[k + count - 1];
        const int needed = count == 1 ? static_cast<int>(shape.gaps[k]) : last - first;
        if (needed > length) continue;
        window.last = std::min(window.last, last);
        window.first = std::max(window.first, first);
    }
    return window;
}

Windows make_windows() {
    Windows windows{};
    for (int table = 0; table < kEacTables; ++table) {
        for (int count = 1; count < 8; ++count) {
            for (int length = 0; length <= kLongestWindow; ++length) {
                windows.at[table][count][length] =
                    window_of(kEacShapes[static_cast<std::size_t>(table)], count, length);
            }
        }
    }
    return windows;
}

}  // namespace

const EacWindow& eac_window(int table, int count, int length) {
    static const Windows windows = make_windows();
    return windows.at[table][count][std::min(length, kLongestWindow)];
}

}  // namespace tex::inline v1
