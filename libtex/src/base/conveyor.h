// SPDX-License-Identifier: Apache-2.0
// conveyor.h: items that go through three stations, each beside the others, on TBB's threads.
//
// fork_join.h says why the thread sanitizer has to be told what happens before what.

#pragma once

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "base/fork_join.h"

namespace tex {

// Calls first() for one item after the other until it returns null, second(item) for each in the same order, and third(item) for each in any order, several at
// once; at most `items` items are on their way. No function may throw. Uses up to `threads` threads.
//
// Preconditions: items >= 1; 1 <= threads <= what tbb::global_control allows. With one thread everything runs in the caller's.
template <class Item, class First, class Second, class Third>
void convey(int threads, int items, const First& first, const Second& second, const Third& third) {
    if (threads <= 1) {
        while (Item* item = first()) {
            second(item);
            third(item);
        }
        return;
    }
    happens_before(fork_moment);
    const auto station = [](const auto& work) {
        happens_after(fork_moment);
        happens_after(join_moment);
        auto result = work();
        happens_before(join_moment);
        return result;
    };
    tbb::task_arena(threads).execute([&] {
        tbb::parallel_pipeline(
            static_cast<std::size_t>(items),
            tbb::make_filter<void, Item*>(tbb::filter_mode::serial_in_order,
                                          [&](tbb::flow_control& flow) {
                                              Item* item = station([&] { return first(); });
                                              if (item == nullptr) flow.stop();
                                              return item;
                                          }) &
                tbb::make_filter<Item*, Item*>(tbb::filter_mode::serial_in_order,
                                               [&](Item* item) {
                                                   return station([&] {
                                                       second(item);
                                                       return item;
                                                   });
                                               }) &
                tbb::make_filter<Item*, void>(tbb::filter_mode::parallel, [&](Item* item) {
                    station([&] {
                        third(item);
                        return 0;
                    });
                }));
    });
    happens_after(join_moment);
}

}  // namespace tex
