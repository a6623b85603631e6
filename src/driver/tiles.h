// All threads over the tiles of an image.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace etendue {

/// Pixels from (x0, y0) to before (x1, y1).
struct Tile {
    uint32_t x0, y0, x1, y1;
    uint32_t pixels() const { return (x1 - x0) * (y1 - y0); }
};

/// An image cut into squares, by rows from the top.
class Tiles {
  public:
    static constexpr uint32_t SIDE = 16;

    Tiles(uint32_t width, uint32_t height)
        : width_(width), height_(height), columns_((width + SIDE - 1) / SIDE) {}

    uint32_t count() const { return columns_ * ((height_ + SIDE - 1) / SIDE); }
    uint32_t index_of(uint32_t x, uint32_t y) const { return y / SIDE * columns_ + x / SIDE; }
    Tile operator[](uint32_t index) const {
        const uint32_t x = index % columns_ * SIDE, y = index / columns_ * SIDE;
        return {x, y, std::min(x + SIDE, width_), std::min(y + SIDE, height_)};
    }

  private:
    uint32_t width_, height_, columns_;
};

inline int thread_count(int wanted) { return wanted > 0 ? wanted : oneapi::tbb::info::default_concurrency(); }

/// Denormals as zero while in scope: Embree asks for it, and a dim path would otherwise cost a hundred bright
/// ones.
class FlushDenormals {
  public:
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO); }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
    static constexpr unsigned FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040;
    unsigned saved_;
};

/// Threads that take one tile after the other.
class TileWorkers {
  public:
    explicit TileWorkers(int threads) : allow_(limit(threads)), arena_(threads) {}

    /// Calls work(index, tile) for all tiles, each on one thread.
    template <class Work>
    void for_each(const Tiles& tiles, const Work& work) {
        for_each(tiles.count(), [&](uint32_t index) { work(index, tiles[index]); });
    }

    /// Calls work(index) for 0 to before `count`, begun in this order.
    template <class Work>
    void in_order(uint32_t count, const Work& work) {
        std::atomic<uint32_t> next = 0;
        for_each(count, [&](uint32_t) { work(next++); });
    }

  private:
    template <class Work>
    void for_each(uint32_t count, const Work& work) {
        arena_.execute([&] {
            oneapi::tbb::parallel_for(0u, count, [&](uint32_t index) {
                const FlushDenormals flush;
                work(index);
            });
        });
    }

    using Control = oneapi::tbb::global_control;
    // oneTBB itself would start no more threads than there are cores.
    static Control limit(int threads) {
        const auto parameter = Control::max_allowed_parallelism;
        return {parameter, std::max<size_t>(threads, Control::active_value(parameter))};
    }

    Control allow_;
    oneapi::tbb::task_arena arena_;
};

}  // namespace etendue
