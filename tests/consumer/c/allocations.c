// SPDX-License-Identifier: Apache-2.0
// allocations.c: counts what a program and its libraries take from the heap. The whole process calls these functions in
// place of glibc's; so does operator new, which calls malloc().

#include <errno.h>
#include <stdatomic.h>
#include <stddef.h>

long allocations_here(void);      // of this thread, so far
size_t largest_allocation(void);  // of all threads, in bytes, since the last call

// glibc's own names.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size);
void* calloc(size_t count, size_t size);
void* realloc(void* memory, size_t size);
void* aligned_alloc(size_t alignment, size_t size);
void* memalign(size_t alignment, size_t size);
int posix_memalign(void** memory, size_t alignment, size_t size);

static _Thread_local long here;
static atomic_size_t largest;

static void count_one(size_t size) {
    ++here;
    size_t seen = atomic_load(&largest);
    while (seen < size && !atomic_compare_exchange_weak(&largest, &seen, size)) {
    }
}

long allocations_here(void) { return here; }
size_t largest_allocation(void) { return atomic_exchange(&largest, 0); }

void* malloc(size_t size) { return count_one(size), __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return count_one(count * size), __libc_calloc(count, size); }
void* realloc(void* memory, size_t size) { return count_one(size), __libc_realloc(memory, size); }
void* memalign(size_t alignment, size_t size) { return count_one(size), __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, size_t alignment, size_t size) {
    *memory = memalign(alignment, size);
    return *memory == NULL ? ENOMEM : 0;
}
