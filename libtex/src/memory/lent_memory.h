// SPDX-License-Identifier: Apache-2.0
// lent_memory.h: memory that a caller lends to what one thread does, and containers that take theirs from it.
//
// The folder memory/ knows no map and no thread but its own. Planes (allocate_rows() in types.h) and WorkingVectors
// come from the heap, unless the thread that makes them has been lent memory. Verbs need not know which of the two it
// is: so the functions of tex_c.h run the same rows as those of C++ and allocate nothing.

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <new>
#include <vector>

namespace tex::inline v1 {

// Hands out pieces of a caller's memory and takes them back: the first piece that is large enough. For one thread.
class LentMemory {
public:
    // Pieces start at multiples of this, and take as many bytes besides.
    static constexpr std::size_t kStep = 64;

    // `bytes` may start anywhere.
    LentMemory(void* bytes, std::size_t size) noexcept;

    // Null if no piece is large enough.
    [[nodiscard]] void* allocate(std::size_t bytes) noexcept;
    void release(void* piece) noexcept;

    // The bytes that allocate(bytes) takes away, and those that the start of the memory may lose.
    static constexpr std::size_t taken_by(std::size_t bytes) { return (bytes + kStep - 1) / kStep * kStep + kStep; }
    static constexpr std::size_t lost_at_start() { return kStep; }

private:
    struct Piece {
        std::size_t size;  // with this head
        Piece* next;       // of the free pieces, by address
    };
    Piece* free_ = nullptr;
};

// What this thread has been lent; null: nothing.
[[nodiscard]] LentMemory* lent_memory() noexcept;

// Lends `memory` to this thread as long as it lives.
class Lend {
public:
    explicit Lend(LentMemory& memory) noexcept;
    ~Lend();
    Lend(const Lend&) = delete;
    Lend& operator=(const Lend&) = delete;

private:
    LentMemory* before_;
};

// Execution::allocate of the verb that this thread runs. While it lives, planes that the thread makes come from it, if
// it is not empty.
class RowAllocation {
public:
    using Allocate = std::function<std::shared_ptr<void>(std::size_t bytes)>;

    explicit RowAllocation(const Allocate& allocate) noexcept;
    ~RowAllocation();
    RowAllocation(const RowAllocation&) = delete;
    RowAllocation& operator=(const RowAllocation&) = delete;

    // The allocator of this thread; null: the heap.
    static const Allocate* current() noexcept;

private:
    const Allocate* before_;
};

// Allocates from what the thread that made it had been lent, or from the heap. Throws std::bad_alloc.
template <class T>
class WorkingAllocator {
public:
    using value_type = T;
    using propagate_on_container_move_assignment = std::true_type;
    using propagate_on_container_swap = std::true_type;

    WorkingAllocator() noexcept : lent_(lent_memory()) {}
    template <class U>
    WorkingAllocator(const WorkingAllocator<U>& other) noexcept : lent_(other.lent()) {}

    T* allocate(std::size_t count) {
        if (lent_ == nullptr) return std::allocator<T>().allocate(count);
        void* const piece = lent_->allocate(count * sizeof(T));
        if (piece == nullptr) throw std::bad_alloc();
        return static_cast<T*>(piece);
    }
    void deallocate(T* memory, std::size_t count) noexcept {
        if (lent_ == nullptr) return std::allocator<T>().deallocate(memory, count);
        lent_->release(memory);
    }

    [[nodiscard]] LentMemory* lent() const noexcept { return lent_; }
    friend bool operator==(const WorkingAllocator& a, const WorkingAllocator& b) { return a.lent_ == b.lent_; }

private:
    LentMemory* lent_;
};

template <class T>
using WorkingVector = std::vector<T, WorkingAllocator<T>>;

}  // namespace tex::inline v1
