#include "gi/texture.h"

#include <array>

namespace etendue {

namespace {

// The transfer function of IEC 61966-2-1, decoded once for each of the 256 codes.
const std::array<float, 256> SRGB_TO_LINEAR = [] {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) {
        const double c = i / 255.0;
        table[i] = static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return table;
}();

// Into [0, 1); a coordinate that is not a number reads the corner rather than memory outside.
float wrapped(float t) {
    const float fraction = t - std::floor(t);
    return fraction >= 0 && fraction < 1 ? fraction : 0.f;
}

}  // namespace

Texture::Texture(uint32_t width, uint32_t height, uint32_t channels,
                 std::variant<std::vector<uint8_t>, std::vector<float>> data, bool srgb)
    : width_(width),
      height_(height),
      channels_(channels),
      opacity_channel_(channels == 4 ? 3 : 0),
      data_(std::move(data)),
      srgb_(srgb) {}

template <class Value, class Fetch>
Value Texture::filtered(const vec2& uv, Fetch&& fetch) const {
    const float x = wrapped(uv.x) * static_cast<float>(width_) - 0.5f;
    const float y = wrapped(1 - uv.y) * static_cast<float>(height_) - 0.5f;
    const float x_floor = std::floor(x), y_floor = std::floor(y);
    const float fx = x - x_floor, fy = y - y_floor;
    const uint32_t x0 = (static_cast<int32_t>(x_floor) + width_) % width_, x1 = x0 + 1 == width_ ? 0 : x0 + 1;
    const uint32_t y0 = (static_cast<int32_t>(y_floor) + height_) % height_,
                   y1 = y0 + 1 == height_ ? 0 : y0 + 1;
    const size_t row0 = size_t{y0} * width_, row1 = size_t{y1} * width_;
    const Value top = (1 - fx) * fetch(row0 + x0) + fx * fetch(row0 + x1);
    const Value bottom = (1 - fx) * fetch(row1 + x0) + fx * fetch(row1 + x1);
    return (1 - fy) * top + fy * bottom;
}

vec3 Texture::colour(const vec2& uv) const {
    return filtered<vec3>(uv, [this](size_t i) { return colour_texel(i); });
}

float Texture::opacity(const vec2& uv) const {
    return filtered<float>(uv, [this](size_t i) { return raw_texel(i, opacity_channel_); });
}

float Texture::raw_texel(size_t pixel, uint32_t channel) const {
    const size_t i = pixel * channels_ + channel;
    if (const auto* bytes = std::get_if<0>(&data_)) return static_cast<float>((*bytes)[i]) / 255;
    return std::get<1>(data_)[i];
}

vec3 Texture::colour_texel(size_t pixel) const {
    const size_t r = pixel * channels_, g = channels_ < 3 ? r : r + 1, b = channels_ < 3 ? r : r + 2;
    if (const auto* bytes = std::get_if<0>(&data_)) {
        const uint8_t* const c = bytes->data();
        if (srgb_) return {SRGB_TO_LINEAR[c[r]], SRGB_TO_LINEAR[c[g]], SRGB_TO_LINEAR[c[b]]};
        return vec3(c[r], c[g], c[b]) / 255.f;
    }
    const float* const c = std::get<1>(data_).data();
    return {c[r], c[g], c[b]};
}

vec3 Texture::normal(const vec2& uv) const {
    const vec3 raw = filtered<vec3>(uv, [this](size_t i) {
        return vec3(raw_texel(i, 0), raw_texel(i, channels_ < 3 ? 0 : 1),
                    raw_texel(i, channels_ < 3 ? 0 : 2));
    });
    const vec3 n = 2.f * raw - 1.f;
    // A map that points into the surface, or nowhere, says nothing about it.
    return n.z > 0 ? glm::normalize(n) : vec3(0, 0, 1);
}

vec3 Texture::mean_colour() const {
    glm::dvec3 sum(0);
    const size_t pixels = size_t{width_} * height_;
    for (size_t i = 0; i < pixels; ++i) sum += glm::dvec3(colour_texel(i));
    return vec3(sum / static_cast<double>(pixels));
}

size_t Texture::memory_bytes() const {
    return size_t{width_} * height_ * channels_ * (data_.index() == 0 ? sizeof(uint8_t) : sizeof(float));
}

}  // namespace etendue
