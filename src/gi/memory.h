// Memory for arrays that rays read at random.
#pragma once

#include <cstdlib>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace etendue {

/// Asks for the line of the cache at a place, to be there when it is read.
inline void prefetch(const void* place) {
    __builtin_prefetch(place);
    // Or else GCC takes functions that do no more than this for such without effect, and drops calls of them.
    asm volatile("");
}

inline void prefetch_lines(const void* place, size_t bytes) {
    constexpr size_t LINE = 64;
    for (size_t i = 0; i < bytes; i += LINE) prefetch(static_cast<const char*>(place) + i);
}

/// Large arrays in huge pages, as otherwise most reads of a ray miss the TLB; and what a vector grows by is left as it
/// is, to be written by many threads at once rather than zeroed by one.
template <class T>
struct BulkAllocator {
    using value_type = T;

    BulkAllocator() = default;
    template <class U>
    BulkAllocator(const BulkAllocator<U>&) {}  // NOLINT(google-explicit-constructor): as all allocators
    template <class U>
    bool operator==(const BulkAllocator<U>&) const {
        return true;
    }

    T* allocate(size_t count) {
        if (!is_large(count)) return std::allocator<T>().allocate(count);
        const size_t bytes = (count * sizeof(T) + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
        void* const place = std::aligned_alloc(HUGE_PAGE, bytes);
        if (!place) throw std::bad_alloc();
#if defined(__linux__)
        madvise(place, bytes, MADV_HUGEPAGE);  // a wish: without it the pages are small
#endif
        return static_cast<T*>(place);
    }
    void deallocate(T* place, size_t count) {
        if (is_large(count)) {
            std::free(place);
        } else {
            std::allocator<T>().deallocate(place, count);
        }
    }

    template <class U>
    void construct(U* place) {
        ::new (static_cast<void*>(place)) U;
    }
    template <class U, class... Args>
    void construct(U* place, Args&&... args) {
        ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
    }

  private:
    static constexpr size_t HUGE_PAGE = size_t{2} << 20;
    // At most as much again is left over of pages that are not full.
    static bool is_large(size_t count) { return count * sizeof(T) >= HUGE_PAGE / 2; }
};

}  // namespace etendue
