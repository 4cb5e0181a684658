// SPDX-License-Identifier: Apache-2.0
#include <tex/types.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#include "memory/lent_memory.h"
#include "threads/huge_pages.h"

#if defined(__SANITIZE_ADDRESS__)
#define TEX_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TEX_ADDRESS_SANITIZER
#endif
#endif

namespace tex::inline v1 {
namespace {

void free_rows(void* rows) noexcept {
    void* block = nullptr;
    std::memcpy(&block, static_cast<char*>(rows) - sizeof block, sizeof block);
    std::free(block);
}

}  // namespace

// Not aligned_alloc(): if aligned blocks are allocated and freed often, the heap of glibc before 2.38 grows without end
// (its bug 14581). The address of the block that contains the rows is stored before them. The address sanitizer watches
// the end of the rows, so its blocks end there.
std::shared_ptr<void> allocate_rows(std::size_t bytes) {
    if (LentMemory* const lent = lent_memory(); lent != nullptr) {
        void* const rows = lent->allocate(bytes);
        if (rows == nullptr) throw std::bad_alloc();
        return {rows, [lent](void* piece) { lent->release(piece); }, WorkingAllocator<char>()};
    }
    if (const RowAllocation::Allocate* const allocate = RowAllocation::current(); allocate != nullptr) {
        std::shared_ptr<void> rows = (*allocate)(bytes);
        if (rows == nullptr) throw std::bad_alloc();
        return rows;
    }
#ifdef TEX_ADDRESS_SANITIZER
    void* const block = std::aligned_alloc(kRowAlignment, bytes + kRowAlignment);
#else
    void* const block = std::malloc(bytes + kRowAlignment);
#endif
    if (block == nullptr) throw std::bad_alloc();
    prefer_huge_pages(block, bytes);
    char* const rows =
        static_cast<char*>(block) + (kRowAlignment - reinterpret_cast<std::uintptr_t>(block) % kRowAlignment);
    std::memcpy(rows - sizeof block, &block, sizeof block);
    return {static_cast<void*>(rows), free_rows};  // frees them, too, if its own memory cannot be had
}

}  // namespace tex::inline v1
