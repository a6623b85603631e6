// Images on surfaces: bilinear, repeating; 8-bit sRGB stays 8-bit in memory.
#pragma once

#include <variant>
#include <vector>

#include "gi/math.h"

namespace etendue {

class Texture {
  public:
    /// Rows from the top, `channels` values a pixel (1, 3 or 4). 8-bit values are sRGB where `srgb`, else
    /// linear / 255; floats are linear.
    Texture(uint32_t width, uint32_t height, uint32_t channels,
            std::variant<std::vector<uint8_t>, std::vector<float>> data, bool srgb);

    /// Linear colour at uv, v = 0 at the bottom.
    vec3 colour(const vec2& uv) const;

    /// Opacity at uv: the alpha channel where there is one, else the first channel, undecoded.
    float opacity(const vec2& uv) const;

    /// Tangent-space normal at uv, unit, from values in [0, 1].
    vec3 normal(const vec2& uv) const;

    /// The mean over the whole image of the linear colour.
    vec3 mean_colour() const;

    size_t memory_bytes() const;

  private:
    template <class Value, class Fetch>
    Value filtered(const vec2& uv, Fetch&& fetch) const;
    float raw_texel(size_t pixel, uint32_t channel) const;
    vec3 colour_texel(size_t pixel) const;

    uint32_t width_, height_, channels_, opacity_channel_;
    std::variant<std::vector<uint8_t>, std::vector<float>> data_;
    bool srgb_;
};

}  // namespace etendue
