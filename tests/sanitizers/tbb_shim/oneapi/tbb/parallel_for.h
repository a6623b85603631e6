// As much of oneTBB as the driver uses, on std::thread, for ThreadSanitizer: it cannot see how the library, which it
// did not compile, hands work and memory from one thread to another, and would take every tile for a race.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace oneapi::tbb {

inline thread_local int arena_threads = 1;

class task_arena {
  public:
    explicit task_arena(int threads) : threads_(threads) {}

    template <class F>
    void execute(F&& f) {
        const int before = arena_threads;
        arena_threads = threads_;
        f();
        arena_threads = before;
    }

  private:
    int threads_;
};

template <class Index, class F>
void parallel_for(Index first, Index last, const F& f) {
    std::atomic<Index> next = first;
    const auto work = [&] {
        for (Index i = next++; i < last; i = next++) f(i);
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < arena_threads; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
}

template <class F, class G>
void parallel_invoke(const F& f, const G& g) {
    std::thread other(f);
    g();
    other.join();
}

struct global_control {
    enum Parameter { max_allowed_parallelism };
    global_control(Parameter, size_t) {}
    static size_t active_value(Parameter) { return 1; }
};

namespace info {
inline int default_concurrency() { return 2; }
}  // namespace info

}  // namespace oneapi::tbb
