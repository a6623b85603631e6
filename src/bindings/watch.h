// Long work of the core, watched from Python: with progress and Ctrl-C.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace etendue {

/// Runs work(), which returns a bool, on another thread, while this one, which holds the interpreter, looks 20
/// times a second for signals and calls tick(). An exception from either calls cancel(), which makes work()
/// return soon, and is raised once it has.
template <class Work, class Cancel, class Tick>
bool watched(const Work& work, const Cancel& cancel, const Tick& tick) {
    using namespace std::chrono_literals;
    std::mutex mutex;
    std::condition_variable finished;
    bool is_finished = false, result = false;
    std::exception_ptr failure;
    std::thread worker([&] {
        try {
            result = work();
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        is_finished = true;
        finished.notify_one();
    });
    const auto join = [&] {
        const nanobind::gil_scoped_release release;
        worker.join();
    };
    try {
        for (bool last = false; !last;) {
            {
                const nanobind::gil_scoped_release release;
                std::unique_lock lock(mutex);
                last = finished.wait_for(lock, 50ms, [&] { return is_finished; });
            }
            if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
            tick();
        }
    } catch (...) {
        cancel();
        join();
        throw;
    }
    join();
    if (failure) std::rethrow_exception(failure);
    return result;
}

}  // namespace etendue
