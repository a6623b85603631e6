// Which pixels of a tile share what their paths find, see Algorithm::sharing.
//
// They are dealt into groups at random: neighbours that share noise would show as blotches. For a block of Sobol's sequence
// the groups stay, so that each of its pixels gets all of another's stratified samples; then they are dealt anew.
#pragma once

#include <span>
#include <vector>

#include "driver/tiles.h"
#include "gi/sampler.h"

namespace etendue {

class PixelGroups {
  public:
    struct Place {
        uint32_t x, y;
    };
    /// Samples for which the groups stay.
    static constexpr uint64_t BLOCK = 16;

    /// Of a tile, for the samples of a block, in groups of `sharing`, the last of which may be smaller.
    PixelGroups(const Tile& tile, uint32_t sharing, uint64_t block) : sharing_(sharing) {
        places_.reserve(tile.pixels());
        for (uint32_t stride = COARSEST; stride > 0; stride /= 2) {
            // A coarse picture is of pixels of a stride: they come first, so that few of others are in their groups.
            const size_t first = places_.size();
            for (uint32_t y = tile.y0; y < tile.y1; y += stride) {
                for (uint32_t x = tile.x0; x < tile.x1; x += stride) {
                    const bool is_coarser = (x | y) % (2 * stride) == 0;
                    if (stride == COARSEST || !is_coarser) places_.push_back({x, y});
                }
            }
            if (sharing > 1) shuffle(std::span(places_).subspan(first), mix_bits(block) ^ place_bits(tile));
        }
    }

    /// Calls visit(places) for each group.
    void for_each(const auto& visit) const {
        for (size_t first = 0; first < places_.size(); first += sharing_) visit(group(first));
    }
    /// The group of one pixel.
    std::span<const Place> of(uint32_t x, uint32_t y) const {
        const auto is_here = [&](const Place& place) { return place.x == x && place.y == y; };
        const auto number = static_cast<size_t>(std::ranges::find_if(places_, is_here) - places_.begin());
        return group(number - number % sharing_);
    }

  private:
    static constexpr uint32_t COARSEST = Tiles::SIDE;

    static uint64_t place_bits(const Tile& tile) { return mix_bits(uint64_t{tile.y0} << 32 | tile.x0); }
    static void shuffle(std::span<Place> places, uint64_t state) {
        for (size_t left = places.size(); left > 1; --left) {
            state = mix_bits(state + 0x9e3779b97f4a7c15ull);
            std::swap(places[left - 1], places[(state >> 32) * left >> 32]);
        }
    }
    std::span<const Place> group(size_t first) const {
        return std::span(places_).subspan(first, std::min<size_t>(sharing_, places_.size() - first));
    }

    uint32_t sharing_;
    std::vector<Place> places_;
};

}  // namespace etendue
