// How far a film still is from the picture that more samples would make of it, tile by tile.
#pragma once

#include <span>
#include <vector>

#include "driver/tiles.h"
#include "gi/film.h"

namespace etendue {

struct TileError {
    /// Relative standard error: the root mean square, over pixels and channels, of the standard error of the
    /// mean, over the mean radiance. Infinite where a pixel has too few samples to tell.
    double error;
    double spread;          // standard error of `error`
    uint64_t fewest, most;  // samples of its pixels
};

/// One for each tile of `film`, whose samples no thread may add to meanwhile. `sharing`: how many pixels shared their paths,
/// see Algorithm.
std::vector<TileError> tile_errors(const Film& film, TileWorkers& workers, uint32_t sharing);

/// How many of so many tiles must keep a bound for the film to keep it: 95%.
constexpr size_t tiles_within(size_t tiles) { return (95 * tiles + 99) / 100; }

struct FilmError {
    double error;      // the least bound that the film keeps
    double low, high;  // 95% confidence interval
};
FilmError film_error(std::span<const TileError> tiles);

}  // namespace etendue
