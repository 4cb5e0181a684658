// SPDX-License-Identifier: Apache-2.0
// conveyor.h: items that pass through four stations, which run in parallel.

#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

#include "threads/fork_join.h"

namespace tex {

// Passes items, one after the other until first() returns null, through
//
//     Item* first()          one at a time
//     second(item)           several at once
//     third(item)            one at a time, in the order of first()
//     fourth(item)           several at once
//
// A free thread does the work that is nearest to the beginning of this list. So first(), where the work comes in, gets
// a free thread before any other station. If first() costs nothing (`first_waits`), a free thread instead does the work
// that is nearest to the end; most items then stay with one thread, and in its processor's cache. At most `items` items
// are in the conveyor. No function may throw. Uses up to `threads` threads.
//
// Preconditions: items >= 1; 1 <= threads <= what tbb::global_control allows. With one thread, everything runs in the
// caller's thread.
template <class Item, class First, class Second, class Third, class Fourth>
class Conveyor {
public:
    Conveyor(int threads, int items, bool first_waits, const First& first, const Second& second, const Third& third,
             const Fourth& fourth)
        : threads_(threads), first_waits_(first_waits), first_(first), second_(second), third_(third), fourth_(fourth),
          places_(static_cast<std::size_t>(items)) {}

    void run() {
        if (threads_ > 1) {
            fork_join(threads_, threads_, [this](int) { work(); });
            return;
        }
        while (Item* item = first_()) {
            second_(item);
            third_(item);
            fourth_(item);
        }
    }

private:
    enum class At { nowhere, second, third, fourth, station };  // where an item waits; station: it is at a station

    struct Place {
        Item* item = nullptr;
        At at = At::nowhere;
    };

    // Works until nothing is left. Waits while the remaining work depends on another thread.
    void work() {
        std::unique_lock lock(mutex_);
        while (true) {
            if (step(lock)) {
                changed_.notify_all();
            } else if (busy_ == 0) {
                return;  // the other threads will find the same
            } else {
                changed_.wait(lock);
            }
        }
    }

    // Does one piece of work at one station, without holding the lock. False if there is none to do.
    bool step(std::unique_lock<std::mutex>& lock) {
        if (first_waits_) return at_fourth(lock) || at_third(lock) || at_second(lock) || at_first(lock);
        return at_first(lock) || at_second(lock) || at_third(lock) || at_fourth(lock);
    }

    bool at_first(std::unique_lock<std::mutex>& lock) {
        Place& next = place(begun_);
        if (first_busy_ || ended_ || next.at != At::nowhere) return false;
        first_busy_ = true;
        next.item = unlocked(lock, [this] { return first_(); });
        first_busy_ = false;
        ended_ = next.item == nullptr;
        if (ended_) return true;
        next.at = At::second;
        ++begun_;
        return true;
    }

    bool at_second(std::unique_lock<std::mutex>& lock) {
        for (std::size_t k = ordered_; k < begun_; ++k) {
            if (place(k).at == At::second) return visit(lock, place(k), second_, At::third);
        }
        return false;
    }

    bool at_third(std::unique_lock<std::mutex>& lock) {
        if (third_busy_ || ordered_ == begun_ || place(ordered_).at != At::third) return false;
        third_busy_ = true;
        Place& here = place(ordered_++);
        visit(lock, here, third_, At::fourth);
        third_busy_ = false;
        return true;
    }

    bool at_fourth(std::unique_lock<std::mutex>& lock) {
        for (Place& here : places_) {
            if (here.at == At::fourth) return visit(lock, here, fourth_, At::nowhere);
        }
        return false;
    }

    template <class Station>
    bool visit(std::unique_lock<std::mutex>& lock, Place& here, const Station& station, At then) {
        here.at = At::station;
        unlocked(lock, [&] { return station(here.item), nullptr; });
        here.at = then;
        return true;
    }

    Place& place(std::size_t k) { return places_[k % places_.size()]; }

    template <class Body>
    auto unlocked(std::unique_lock<std::mutex>& lock, const Body& body) {
        ++busy_;
        lock.unlock();
        auto result = body();
        lock.lock();
        --busy_;
        return result;
    }

    const int threads_;
    const bool first_waits_;
    const First& first_;
    const Second& second_;
    const Third& third_;
    const Fourth& fourth_;

    std::mutex mutex_;  // guards all members below
    std::condition_variable changed_;
    std::vector<Place> places_;  // item k is at index k modulo the size
    std::size_t begun_ = 0;      // items that first() has returned
    std::size_t ordered_ = 0;    // items that have entered third()
    int busy_ = 0;               // threads that are at a station
    bool first_busy_ = false;
    bool third_busy_ = false;
    bool ended_ = false;
};

template <class Item, class First, class Second, class Third, class Fourth>
void convey(int threads, int items, bool first_waits, const First& first, const Second& second, const Third& third,
            const Fourth& fourth) {
    Conveyor<Item, First, Second, Third, Fourth>(threads, items, first_waits, first, second, third, fourth).run();
}

}  // namespace tex
