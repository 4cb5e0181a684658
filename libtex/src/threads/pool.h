// SPDX-License-Identifier: Apache-2.0
// pool.h: objects that are needed repeatedly and are expensive to make.

#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tex::inline v1 {

// Lends objects. An object that nobody holds any more waits for the next taker, in the state in which it was left. Any
// thread may take and return objects. An object may outlive the pool. Copies of a pool share the waiting objects.
template <class T>
class Pool {
public:
    // Returns a waiting object, or, if there is none, what make() returns (a std::unique_ptr<T>).
    template <class Make>
    std::shared_ptr<T> take(const Make& make) {
        std::unique_ptr<T> thing;
        {
            const std::lock_guard lock(shelf_->mutex);
            if (!shelf_->things.empty()) {
                thing = std::move(shelf_->things.back());
                shelf_->things.pop_back();
            }
        }
        if (!thing) {
            thing = make();
            const std::lock_guard lock(shelf_->mutex);
            shelf_->things.reserve(++shelf_->made);  // so that returning an object allocates no memory
        }
        T* raw = thing.release();
        return std::shared_ptr<T>(raw, [shelf = shelf_](T* back) {
            std::unique_ptr<T> owned(back);
            const std::lock_guard lock(shelf->mutex);
            shelf->things.push_back(std::move(owned));
        });
    }

private:
    struct Shelf {
        std::mutex mutex;
        std::vector<std::unique_ptr<T>> things;
        std::size_t made = 0;
    };
    std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace tex::inline v1
