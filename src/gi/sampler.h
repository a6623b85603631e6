// Random numbers as a function of (seed, pixel, sample index, dimension): never of the thread or the time.
#pragma once

#include <array>
#include <string_view>

#include "gi/math.h"

namespace etendue {

/// Bijections of words in which every input bit moves every output bit.
inline uint64_t mix_bits(uint64_t v) {
    v = (v ^ (v >> 31)) * 0x7fb5d329728ea185ull;
    v = (v ^ (v >> 27)) * 0x81dadef4bc2dd44dull;
    return v ^ (v >> 33);
}
template <class Word>
Word mix_bits32(Word v) {
    v = (v ^ (v >> 16)) * 0x7feb352du;
    v = (v ^ (v >> 15)) * 0x846ca68bu;
    return v ^ (v >> 16);
}

/// Owen-scrambled points of Sobol's first two dimensions (Burley 2020, "Practical Hash-based Owen Scrambling"), for
/// words, or lanes of them.
template <class Word>
struct SobolPoint {
    /// Seeds of a pair of dimensions, which shuffle the points and scramble each coordinate.
    struct Seeds {
        Word points, first, second;
        Seeds(const Word& key, const Word& key_high, const Word& dimension)
            : points(mix_bits32(Word(key + dimension * 0x9e3779b9u))),
              first(mix_bits32(Word(points ^ key_high))),
              second(mix_bits32(Word(first + 0x9e3779b9u))) {}
    };

    /// The point of an index whose bits are reversed. Sobol's first coordinate is the index with its bits reversed, so the
    /// index is that coordinate reversed.
    SobolPoint(const Seeds& seeds, const Word& reversed_index)
        : seeds_(seeds), index_(reverse_bits(scramble(reversed_index, seeds.points))) {}

    Word first() const { return reverse_bits(scramble(index_, seeds_.first)); }
    Word second() const { return reverse_bits(scramble(second_coordinate_reversed(index_), seeds_.second)); }

    static Word reverse_bits(Word x) {
        x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
        x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
        x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
        x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
        return (x >> 16) | (x << 16);
    }

    /// Owen's scrambling of a coordinate whose bits are reversed: a hash in which every bit depends on the
    /// bits below it alone (Laine and Karras 2011; constants of Vegdahl 2021, "Building a Better LK Hash").
    static Word scramble(Word x, const Word& seed) {
        x ^= x * 0x3d20adeau;
        x += seed;
        x *= (seed >> 16) | 1u;
        x ^= x * 0x05526c56u;
        x ^= x * 0x53a22864u;
        return x;
    }

    /// Sobol's second coordinate with its bits reversed.  Its generator matrix is Pascal's triangle modulo 2:
    /// bit j is the parity of those index bits k whose binary digits cover j's (Lucas), a sum over supersets
    /// that takes five steps.
    static Word second_coordinate_reversed(Word x) {
        x ^= (x >> 1) & 0x55555555u;
        x ^= (x >> 2) & 0x33333333u;
        x ^= (x >> 4) & 0x0f0f0f0fu;
        x ^= (x >> 8) & 0x00ff00ffu;
        x ^= (x >> 16) & 0x0000ffffu;
        return x;
    }

  private:
    Seeds seeds_;
    Word index_;
};

inline float signed_to_float(uint32_t x) { return static_cast<float>(static_cast<int32_t>(x)); }
inline Lanes signed_to_float(const LaneBits& x) {
    using Signed = simd::rebind_simd_t<int32_t, Lanes>;
    return simd::static_simd_cast<Lanes>(simd::static_simd_cast<Signed>(x));
}
/// A word as a number in [0, 1). Cut to the 24 digits of a float, not rounded: a point stays in its stratum, and below
/// one.
template <class Word>
auto to_unit_interval(Word x) {
    // As many of the last bits as the first eight have digits, without the count of leading zeros that vector
    // instructions lack; then by halves, as they convert signed numbers alone.
    Word excess = x >> 24;
    excess |= excess >> 1;
    excess |= excess >> 2;
    excess |= excess >> 4;
    x &= ~excess;
    return signed_to_float(x >> 16) * 0x1p-16f + signed_to_float(x & 0xffffu) * 0x1p-32f;
}

/// A generator's next number, whose state it moves on (PCG, O'Neill 2014, XSH-RR).
inline uint32_t next_pcg(uint64_t& state) {
    const uint64_t old = state;
    state = old * 6364136223846793005ull + 1442695040888963407ull;
    const uint32_t word = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const uint32_t turn = static_cast<uint32_t>(old >> 59);
    return (word >> turn) | (word << (-turn & 31));
}

/// One sample's stream of numbers in [0, 1).
///
/// `sobol`: the first two dimensions of Sobol's sequence, its points shuffled and its values scrambled in
/// Owen's way by hashing, afresh for every pair of dimensions and every pixel. Any power of two of consecutive
/// samples is stratified in every such pair. `independent`: PCG, reseeded at every vertex so that it is indexed by
/// dimension too.
class Sampler {
  public:
    enum class Kind : uint8_t { sobol, independent };
    static constexpr std::array<std::string_view, 2> names{"sobol", "independent"};

    /// What the numbers of a sample are made of.
    struct Stream {
        Kind kind;
        uint32_t reversed_index;
        uint64_t key;
    };

    explicit Sampler(const Stream& stream) { start(stream); }
    Sampler(Kind kind, uint64_t seed) : kind_(kind), seed_(mix_bits(seed + 0x9e3779b97f4a7c15ull)) {}

    /// Of sample `index` of a pixel.
    Stream stream(uint32_t pixel, uint64_t index) const {
        // A Sobol index has 32 bits; what is above selects another scrambling, an independent replicate.
        const uint64_t replicate = kind_ == Kind::sobol ? index >> 32 : index;
        return {kind_, SobolPoint<uint32_t>::reverse_bits(static_cast<uint32_t>(index)),
                mix_bits(mix_bits(seed_ ^ pixel) + replicate)};
    }

    /// The numbers of part `part` of so many of a sample, a power of two; others than the sample's own. Parts are stratified
    /// like samples: those of any power of two of consecutive samples, all together.
    static Stream part(const Stream& sample, uint32_t part, uint32_t parts) {
        if (sample.kind == Kind::independent) return {sample.kind, 0, mix_bits(~sample.key + part)};
        // What no longer fits into the index selects another scrambling, see `stream`.
        const uint32_t replicate = sample.reversed_index & (parts - 1);
        return {sample.kind, sample.reversed_index / parts | SobolPoint<uint32_t>::reverse_bits(part),
                mix_bits(~sample.key + replicate)};
    }

    /// Begins a sample at dimension 0.
    void start(const Stream& stream) {
        kind_ = stream.kind, key_ = stream.key, reversed_index_ = stream.reversed_index;
        start_vertex(0);
    }
    void start(uint32_t pixel, uint64_t index) { start(stream(pixel, index)); }

    /// Jumps to the dimensions of the path's vertex `depth` (0: the camera), so that what one vertex draws
    /// does not shift the dimensions of the next, whatever branches it took.
    void start_vertex(uint32_t depth) {
        dimension_ = depth * DRAWS_AT_ONCE;
        used_ = DRAWS_AT_ONCE;
        if (kind_ == Kind::independent) state_ = mix_bits(key_ + dimension_);
    }

    /// Makes the vertex's first numbers, which takes a while, before they are asked for.
    void prepare() {
        if (kind_ == Kind::sobol && used_ == DRAWS_AT_ONCE) draw();
    }

    float next_1d() { return kind_ == Kind::independent ? to_unit_interval(next_pcg(state_)) : x_[next()]; }

    vec2 next_2d() {
        if (kind_ == Kind::independent) {
            const float x = to_unit_interval(next_pcg(state_));
            return {x, to_unit_interval(next_pcg(state_))};
        }
        const uint32_t i = next();
        return {x_[i], y_[i]};
    }

  private:
    // Sobol draws of a vertex are made together, in the lanes of vector instructions: eight cost little more than one.
    static constexpr uint32_t DRAWS_AT_ONCE = 8;
    // Between the dimensions of a vertex's first eight draws and those of the eight after them: beyond all vertices.
    static constexpr uint32_t FURTHER_DRAWS = 1u << 24;

    static uint32_t low(uint64_t h) { return static_cast<uint32_t>(h); }
    static uint32_t high(uint64_t h) { return static_cast<uint32_t>(h >> 32); }

    uint32_t next() {
        if (used_ == DRAWS_AT_ONCE) [[unlikely]]
            draw_more();
        return used_++;
    }

    /// Rare, so in one place.
    [[gnu::noinline]] void draw_more() { draw(); }

    void draw() {
        for (uint32_t i = 0; i < DRAWS_AT_ONCE; ++i) {
            const SobolPoint<uint32_t> point({low(key_), high(key_), dimension_ + i}, reversed_index_);
            x_[i] = to_unit_interval(point.first());
            y_[i] = to_unit_interval(point.second());
        }
        dimension_ += FURTHER_DRAWS;
        used_ = 0;
    }

    friend class LaneSampler;

    Kind kind_ = Kind::sobol;
    uint32_t dimension_ = 0;
    uint32_t reversed_index_ = 0;
    uint32_t used_ = DRAWS_AT_ONCE;
    uint64_t seed_ = 0, key_ = 0, state_ = 0;
    // The first and the second coordinate of the draws that have been made.
    float x_[DRAWS_AT_ONCE] = {}, y_[DRAWS_AT_ONCE] = {};
};

}  // namespace etendue
