// The random numbers of several samples at once, each the same as its own Sampler's.
#pragma once

#include "gi/sampler.h"

namespace etendue {

class LaneSampler {
  public:
    /// A lane goes on with another sample. All are of one kind.
    void start(int lane, const Sampler::Stream& stream) {
        kind_ = stream.kind;
        keys_[lane] = stream.key;
        low_[lane] = Sampler::low(stream.key), high_[lane] = Sampler::high(stream.key);
        reversed_index_[lane] = stream.reversed_index;
    }

    /// Jumps to the dimensions of each lane's own vertex, see Sampler.
    void start_vertex(const Lanes& depth) {
        dimension_ = simd::static_simd_cast<LaneBits>(depth) * Sampler::DRAWS_AT_ONCE;
        used_ = 0;
        if (kind_ == Sampler::Kind::independent) {
            for (int i = 0; i < LANES; ++i) states_[i] = mix_bits(keys_[i] + dimension_[i]);
        }
    }

    /// So many draws, for the lanes that are `on`, are left out.
    void skip(const LaneMask& on, uint32_t draws) {
        if (kind_ == Sampler::Kind::independent) return;
        used_ += simd::static_simd_cast<LaneBits>(select(on, Lanes(static_cast<float>(draws)), Lanes(0)));
    }

    /// For the lanes that are `on`; the others draw nothing.
    Lanes next_1d(const LaneMask& on) {
        if (kind_ == Sampler::Kind::independent) return next_independent(on);
        return to_unit_interval(next_point(on).first());
    }
    LaneVec2 next_2d(const LaneMask& on) {
        if (kind_ == Sampler::Kind::independent) {
            const Lanes x = next_independent(on);
            return {x, next_independent(on)};
        }
        const SobolPoint<LaneBits> point = next_point(on);
        return {to_unit_interval(point.first()), to_unit_interval(point.second())};
    }

  private:
    SobolPoint<LaneBits> next_point(const LaneMask& on) {
        const LaneBits dimension = dimension_ + used_ % Sampler::DRAWS_AT_ONCE +
                                   used_ / Sampler::DRAWS_AT_ONCE * Sampler::FURTHER_DRAWS;
        used_ += simd::static_simd_cast<LaneBits>(select(on, Lanes(1), Lanes(0)));
        const auto words = [](const PerLane<uint32_t>& all) {
            return LaneBits(all.data(), simd::element_aligned);
        };
        return {{words(low_), words(high_), dimension}, words(reversed_index_)};
    }

    Lanes next_independent(const LaneMask& on) {
        PerLane<float> out{};
        for_lanes(on, [&](int i) { out[i] = to_unit_interval(next_pcg(states_[i])); });
        return lanes_of(out);
    }

    Sampler::Kind kind_ = Sampler::Kind::sobol;
    PerLane<uint64_t> keys_{}, states_{};
    PerLane<uint32_t> low_{}, high_{}, reversed_index_{};
    LaneBits dimension_ = 0, used_ = 0;
};

}  // namespace etendue
