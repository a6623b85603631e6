// Memory for arrays that rays read at random.
#pragma once

#include <cstdlib>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace etendue {

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
        const size_t page = count * sizeof(T) >= 2 * HUGE_PAGE ? HUGE_PAGE : alignof(T);
        if (page == alignof(T)) return std::allocator<T>().allocate(count);
        const size_t bytes = (count * sizeof(T) + page - 1) / page * page;
        void* const place = std::aligned_alloc(page, bytes);
        if (!place) throw std::bad_alloc();
#if defined(__linux__)
        madvise(place, bytes, MADV_HUGEPAGE);  // a wish: without it the pages are small
#endif
        return static_cast<T*>(place);
    }
    void deallocate(T* place, size_t count) {
        if (count * sizeof(T) >= 2 * HUGE_PAGE) {
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
};

}  // namespace etendue
