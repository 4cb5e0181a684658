// SPDX-License-Identifier: Apache-2.0

#include "memory/lent_memory.h"

#include <cstdint>

namespace tex::inline v1 {
namespace {

thread_local LentMemory* lent = nullptr;

}  // namespace

LentMemory* lent_memory() noexcept { return lent; }

Lend::Lend(LentMemory& memory) noexcept : before_(lent) { lent = &memory; }
Lend::~Lend() { lent = before_; }

LentMemory::LentMemory(void* bytes, std::size_t size) noexcept {
    const std::size_t lost = (kStep - reinterpret_cast<std::uintptr_t>(bytes) % kStep) % kStep;
    if (bytes == nullptr || size < lost + 2 * kStep) return;
    free_ = ::new (static_cast<char*>(bytes) + lost) Piece{(size - lost) / kStep * kStep, nullptr};
}

void* LentMemory::allocate(std::size_t bytes) noexcept {
    if (bytes > SIZE_MAX - 2 * kStep) return nullptr;
    const std::size_t wanted = taken_by(bytes);
    for (Piece** link = &free_; *link != nullptr; link = &(*link)->next) {
        Piece* const piece = *link;
        if (piece->size < wanted) continue;
        if (piece->size - wanted < 2 * kStep) {
            *link = piece->next;
        } else {
            *link = ::new (reinterpret_cast<char*>(piece) + wanted) Piece{piece->size - wanted, piece->next};
            piece->size = wanted;
        }
        return reinterpret_cast<char*>(piece) + kStep;
    }
    return nullptr;
}

void LentMemory::release(void* bytes) noexcept {
    if (bytes == nullptr) return;
    auto* const piece = reinterpret_cast<Piece*>(static_cast<char*>(bytes) - kStep);
    const auto end_of = [](Piece* of) { return reinterpret_cast<char*>(of) + of->size; };
    Piece* before = nullptr;
    Piece* after = free_;
    while (after != nullptr && after < piece) {
        before = after;
        after = after->next;
    }
    // Neighbours become one piece.
    piece->next = after;
    if (after != nullptr && end_of(piece) == reinterpret_cast<char*>(after)) {
        piece->size += after->size;
        piece->next = after->next;
    }
    if (before == nullptr) {
        free_ = piece;
    } else if (end_of(before) == reinterpret_cast<char*>(piece)) {
        before->size += piece->size;
        before->next = piece->next;
    } else {
        before->next = piece;
    }
}

namespace {

thread_local const RowAllocation::Allocate* current_allocation = nullptr;

}  // namespace

RowAllocation::RowAllocation(const Allocate& allocate) noexcept : before_(current_allocation) {
    current_allocation = allocate ? &allocate : nullptr;
}

RowAllocation::~RowAllocation() { current_allocation = before_; }

const RowAllocation::Allocate* RowAllocation::current() noexcept { return current_allocation; }

}  // namespace tex::inline v1
