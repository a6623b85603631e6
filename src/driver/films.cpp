#include "driver/films.h"

#include <optional>

#include "driver/tiles.h"

namespace etendue {

Film Films::take(uint32_t width, uint32_t height, int threads) {
    std::optional<Film> film;
    {
        const std::lock_guard lock(mutex_);
        if (!films_.empty() && (films_[0].width() != width || films_[0].height() != height)) films_.clear();
        if (films_.empty()) return Film(width, height);
        film = std::move(films_.back());
        films_.pop_back();
    }
    TileWorkers(threads).for_each(Tiles(width, height), [&](uint32_t, const Tile& tile) {
        for (uint32_t y = tile.y0; y < tile.y1; ++y) {
            for (uint32_t x = tile.x0; x < tile.x1; ++x) film->at(x, y) = Pixel{};
        }
    });
    return *std::move(film);
}

void Films::settle(uint32_t width, uint32_t height) {
    Film ready = take(width, height, 1);
    const std::lock_guard lock(mutex_);
    films_.clear();
    films_.push_back(std::move(ready));
}

void Films::give_back(Film film) {
    const std::lock_guard lock(mutex_);
    const bool fits =
        films_.empty() || (films_[0].width() == film.width() && films_[0].height() == film.height());
    if (fits && films_.size() < MOST) films_.push_back(std::move(film));
}

}  // namespace etendue
