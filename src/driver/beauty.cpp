#include "driver/beauty.h"

#include <cmath>

namespace etendue {

namespace {

/// The first stage beyond `samples`: 16, 24, 32, 48, 64, 96 ..., whole blocks of Sobol's sequence.
uint64_t stage_beyond(uint64_t samples) {
    if (samples < BEAUTY_MINIMUM) return BEAUTY_MINIMUM;
    const uint64_t octave = std::bit_floor(samples), middle = octave + octave / 2;
    return samples < middle ? middle : 2 * octave;
}

/// Tiles that an interruption has left within a stage.
std::vector<TileGoal> begun(std::span<const TileError> tiles) {
    std::vector<TileGoal> goals;
    for (uint32_t i = 0; i < tiles.size(); ++i) {
        const uint64_t stage = stage_beyond(tiles[i].most - 1);
        if (tiles[i].fewest < stage) goals.push_back({i, stage});
    }
    return goals;
}

/// The tiles above the level that may go on: first those with fewer samples than others have, and when there are
/// none but the film does not keep the level, all.
std::vector<TileGoal> above(std::span<const TileError> tiles, double level) {
    uint64_t most = 0;
    for (const TileError& tile : tiles) most = std::max(most, tile.most);
    std::vector<TileGoal> behind, all;
    for (uint32_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].error <= level) continue;
        all.push_back({i, stage_beyond(tiles[i].most)});
        if (tiles[i].most < most) behind.push_back({i, std::min(all.back().samples, most)});
    }
    if (!behind.empty()) return behind;
    return tiles.size() - all.size() < tiles_within(tiles.size()) ? all : std::vector<TileGoal>();
}

}  // namespace

std::vector<TileGoal> next_goals(std::span<const TileError> tiles, double bound) {
    std::vector<TileGoal> goals = begun(tiles);
    if (!goals.empty()) return goals;
    // The bound is approached in steps of what one stage gains at most, so that all tiles have about the same error
    // at any time.
    double level = bound;
    for (const TileError& tile : tiles) {
        if (std::isfinite(tile.error)) level = std::max(level, tile.error);
    }
    const int steps = static_cast<int>(std::ceil(2 * std::log2(level / bound)));
    for (int step = steps; step >= 0 && goals.empty(); --step) {
        goals = above(tiles, bound * std::exp2(0.5 * step));
    }
    std::ranges::stable_sort(goals, std::greater(),
                             [&](const TileGoal& goal) { return tiles[goal.tile].error; });
    return goals;
}

double samples_at(std::span<const TileError> tiles, const Tiles& shape, double bound) {
    std::vector<double> needs(tiles.size());
    std::ranges::transform(tiles, needs.begin(), [&](const TileError& tile) {
        const double excess = std::isfinite(tile.error) ? tile.error / bound : 1;
        if (excess <= 1) return static_cast<double>(tile.most);
        const double need = std::min(static_cast<double>(tile.most) * excess * excess, 0x1p62);
        return static_cast<double>(stage_beyond(static_cast<uint64_t>(std::ceil(need)) - 1));
    });
    std::vector<double> sorted = needs;
    const auto last_within = sorted.begin() + static_cast<ptrdiff_t>(tiles_within(sorted.size())) - 1;
    std::ranges::nth_element(sorted, last_within);
    double samples = 0;
    for (uint32_t i = 0; i < needs.size(); ++i) {
        const double need = std::max(std::min(needs[i], *last_within), static_cast<double>(tiles[i].most));
        samples += need * shape[i].pixels();
    }
    return samples;
}

}  // namespace etendue
