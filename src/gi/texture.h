// Images on surfaces: bilinear, repeating; 8-bit sRGB stays 8-bit in memory.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "gi/math.h"
#include "gi/memory.h"

namespace etendue {

class Texture {
  public:
    /// Rows from the top, `channels` values a pixel (1, 3 or 4). 8-bit values are sRGB where `srgb`, else
    /// linear / 255; floats are linear.
    Texture(uint32_t width, uint32_t height, uint32_t channels,
            std::variant<const uint8_t*, const float*> pixels, bool srgb);

    /// Linear colour at uv, v = 0 at the bottom.
    vec3 colour(const vec2& uv) const;

    /// Asks for the pixels that a lookup at uv reads.
    void prefetch(const vec2& uv) const;

    /// Opacity at uv: the alpha channel where there is one, else the first channel, undecoded.
    float opacity(const vec2& uv) const;

    /// Tangent-space normal at uv, unit, from values in [0, 1].
    vec3 normal(const vec2& uv) const;

    /// The mean over the whole image of the linear colour.
    vec3 mean_colour() const;

    size_t memory_bytes() const;

  private:
    /// The linear value of each of the 256 codes of a byte.
    using Codes = std::array<float, 256>;

    /// Pixels in square tiles that fill a line of the cache each: the four of a lookup mostly lie in one. Three
    /// channels take the room of four.
    template <class Value, uint32_t CHANNELS>
    struct Tiles {
        using Pixel = std::array<Value, CHANNELS>;
        static constexpr uint32_t LINE = 64, SIDE = sizeof(Pixel) == 1 ? 8 : sizeof(Pixel) == 4 ? 4 : 2;
        static_assert(size_t{SIDE} * SIDE * sizeof(Pixel) == LINE);
        struct alignas(LINE) Tile {
            std::array<Pixel, size_t{SIDE} * SIDE> pixels;
        };

        uint32_t across;  // tiles side by side
        std::vector<Tile, BulkAllocator<Tile>> tiles;

        Tiles(uint32_t width, uint32_t height, uint32_t channels, const Value* pixels);
        const Pixel& at(uint32_t x, uint32_t y) const {
            return tiles[size_t{y / SIDE} * across + x / SIDE].pixels[y % SIDE * SIDE + x % SIDE];
        }
    };
    using Image = std::variant<Tiles<uint8_t, 1>, Tiles<uint8_t, 4>, Tiles<float, 1>, Tiles<float, 4>>;

    static Image tiled(uint32_t width, uint32_t height, uint32_t channels,
                       std::variant<const uint8_t*, const float*> pixels);
    template <class Fetch>
    auto filtered(const vec2& uv, const Fetch& fetch) const;

    uint32_t width_, height_, opacity_channel_;
    Image image_;
    const Codes* codes_;  // of colours
};

}  // namespace etendue
