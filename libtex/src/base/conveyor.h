// SPDX-License-Identifier: Apache-2.0
// conveyor.h: items that go through four stations, each beside the others, on TBB's threads.
//
// fork_join.h says why the thread sanitizer has to be told what happens before what.

#pragma once

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "base/fork_join.h"

namespace tex {

// Calls, for one item after the other until first() returns null,
//
//     Item* first()          one at a time
//     second(item)           several at once
//     third(item)            one at a time, in the order of first()
//     fourth(item)           several at once
//
// At most `items` items are on their way. No function may throw. Uses up to `threads` threads.
//
// Preconditions: items >= 1; 1 <= threads <= what tbb::global_control allows. With one thread everything runs in the caller's.
template <class Item, class First, class Second, class Third, class Fourth>
void convey(int threads, int items, const First& first, const Second& second, const Third& third, const Fourth& fourth) {
    if (threads <= 1) {
        while (Item* item = first()) {
            second(item);
            third(item);
            fourth(item);
        }
        return;
    }
    happens_before(fork_moment);
    const auto station = [](const auto& work) {
        return [&work](Item* item) {
            happens_after(fork_moment);
            happens_after(join_moment);
            work(item);
            happens_before(join_moment);
            return item;
        };
    };
    const auto source = [&](tbb::flow_control& flow) {
        happens_after(fork_moment);
        happens_after(join_moment);
        Item* item = first();
        happens_before(join_moment);
        if (item == nullptr) flow.stop();
        return item;
    };
    constexpr auto kInOrder = tbb::filter_mode::serial_in_order;
    constexpr auto kParallel = tbb::filter_mode::parallel;
    const auto last = station(fourth);
    tbb::task_arena(threads).execute([&] {
        tbb::parallel_pipeline(static_cast<std::size_t>(items),
                               tbb::make_filter<void, Item*>(kInOrder, source) &
                                   tbb::make_filter<Item*, Item*>(kParallel, station(second)) &
                                   tbb::make_filter<Item*, Item*>(kInOrder, station(third)) &
                                   tbb::make_filter<Item*, void>(kParallel, [&](Item* item) { last(item); }));
    });
    happens_after(join_moment);
}

}  // namespace tex
