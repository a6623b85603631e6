// Films that nobody needs any more, kept for their memory: to get so much anew from the system takes longer than
// the first picture of a change.
#pragma once

#include <mutex>
#include <vector>

#include "gi/film.h"

namespace etendue {

/// May be used by several threads.
class Films {
  public:
    /// A film without samples. threads: that clear one which was used.
    Film take(uint32_t width, uint32_t height, int threads);
    void give_back(Film film);
    /// Has one ready, and no more: for when no flight goes on, and the next change may come.
    void settle(uint32_t width, uint32_t height);

  private:
    // One for what is shown, one for what follows, and for each the hurried picture before it.
    static constexpr size_t MOST = 4;

    std::mutex mutex_;
    std::vector<Film> films_;  // all of one size
};

}  // namespace etendue
