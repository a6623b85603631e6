// The schedule of a beauty render: which tiles get how many samples next.
//
// Tiles get samples in stages until their error is within the bound, and all end when 95% of them are. The result
// does not depend on the order: with need the first stage at which a tile's error is within the bound, it ends
// with min(need, K) samples, K being the first stage that is enough for 95% of the tiles. Hence a tile never gets
// more samples than uniform sampling to the same bound would give all of them, and a render that was interrupted
// anywhere ends as if it had not been. The order decides what there is if time runs out: the worst come first.
#pragma once

#include "driver/film_error.h"

namespace etendue {

/// What every pixel gets before its error is asked for.
constexpr uint64_t BEAUTY_MINIMUM = 16;

struct TileGoal {
    uint32_t tile;
    uint64_t samples;  // of each of its pixels
};

/// What is to be rendered next, the worst tiles first, each one stage; nothing once the film keeps the bound.
/// Every pixel has BEAUTY_MINIMUM samples.
std::vector<TileGoal> next_goals(std::span<const TileError> tiles, double bound);

/// How many samples the film will have once it keeps the bound, if errors fall with the root of the samples.
double samples_at(std::span<const TileError> tiles, const Tiles& shape, double bound);

}  // namespace etendue
