#include "gi/texture.h"

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

const std::array<float, 256> UNDECODED = [] {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(i) / 255;
    return table;
}();

float value(uint8_t code, const std::array<float, 256>& codes) { return codes[code]; }
float value(float linear, const std::array<float, 256>&) { return linear; }

vec3 colour_of(const auto& pixel, const std::array<float, 256>& codes) {
    if constexpr (std::tuple_size_v<std::decay_t<decltype(pixel)>> == 1)
        return vec3(value(pixel[0], codes));
    else
        return {value(pixel[0], codes), value(pixel[1], codes), value(pixel[2], codes)};
}

// Into [0, 1); a coordinate that is not a number reads the corner rather than memory outside.
float wrapped(float t) {
    const float fraction = t - std::floor(t);
    return fraction >= 0 && fraction < 1 ? fraction : 0.f;
}

/// Two pixels side by side, or one above the other, and the share of the second.
struct Neighbours {
    uint32_t first, second;
    float share;

    /// At a coordinate in [0, 1) of `size` pixels that repeat.
    Neighbours(float t, uint32_t size) {
        const float place = t * static_cast<float>(size) - 0.5f, floor = std::floor(place);
        // As unsigned, -1 is beyond the last as well.
        first = std::min(static_cast<uint32_t>(static_cast<int32_t>(floor)), size - 1);
        second = first + 1 == size ? 0 : first + 1;
        share = place - floor;
    }
};

}  // namespace

template <class Value, uint32_t CHANNELS>
Texture::Tiles<Value, CHANNELS>::Tiles(uint32_t width, uint32_t height, uint32_t channels,
                                       const Value* pixels)
    : across((width + SIDE - 1) / SIDE) {
    tiles.resize(size_t{across} * ((height + SIDE - 1) / SIDE));
    for (uint32_t y = 0; y < height; ++y) {
        Tile* const row = &tiles[size_t{y / SIDE} * across];
        for (uint32_t x = 0; x < width; ++x, pixels += channels) {
            Pixel& pixel = row[x / SIDE].pixels[y % SIDE * SIDE + x % SIDE];
            if constexpr (CHANNELS == 1)
                pixel = {pixels[0]};
            else
                pixel = {pixels[0], pixels[1], pixels[2], pixels[channels - 1]};
        }
    }
}

Texture::Image Texture::tiled(uint32_t width, uint32_t height, uint32_t channels,
                              std::variant<const uint8_t*, const float*> pixels) {
    return std::visit(
        [&]<class Value>(const Value* values) -> Image {
            if (channels == 1) return Tiles<Value, 1>(width, height, channels, values);
            return Tiles<Value, 4>(width, height, channels, values);
        },
        pixels);
}

Texture::Texture(uint32_t width, uint32_t height, uint32_t channels,
                 std::variant<const uint8_t*, const float*> pixels, bool srgb)
    : width_(width),
      height_(height),
      opacity_channel_(channels == 4 ? 3 : 0),
      image_(tiled(width, height, channels, pixels)),
      codes_(srgb ? &SRGB_TO_LINEAR : &UNDECODED) {}

template <class Fetch>
auto Texture::filtered(const vec2& uv, const Fetch& fetch) const {
    const Neighbours x(wrapped(uv.x), width_), y(wrapped(1 - uv.y), height_);
    return std::visit(
        [&](const auto& image) {
            const auto row = [&](uint32_t line) {
                return (1 - x.share) * fetch(image.at(x.first, line)) +
                       x.share * fetch(image.at(x.second, line));
            };
            return (1 - y.share) * row(y.first) + y.share * row(y.second);
        },
        image_);
}

vec3 Texture::colour(const vec2& uv) const {
    return filtered(uv, [&codes = *codes_](const auto& pixel) { return colour_of(pixel, codes); });
}

void Texture::prefetch(const vec2& uv) const {
    const Neighbours x(wrapped(uv.x), width_), y(wrapped(1 - uv.y), height_);
    std::visit(
        [&](const auto& image) {
            for (const uint32_t line : {y.first, y.second})
                for (const uint32_t column : {x.first, x.second}) etendue::prefetch(&image.at(column, line));
        },
        image_);
}

float Texture::opacity(const vec2& uv) const {
    return filtered(uv, [this](const auto& pixel) { return value(pixel[opacity_channel_], UNDECODED); });
}

vec3 Texture::normal(const vec2& uv) const {
    const vec3 raw = filtered(uv, [](const auto& pixel) { return colour_of(pixel, UNDECODED); });
    const vec3 n = 2.f * raw - 1.f;
    // A map that points into the surface, or nowhere, says nothing about it.
    return n.z > 0 ? glm::normalize(n) : vec3(0, 0, 1);
}

vec3 Texture::mean_colour() const {
    glm::dvec3 sum(0);
    std::visit(
        [&](const auto& image) {
            for (uint32_t y = 0; y < height_; ++y)
                for (uint32_t x = 0; x < width_; ++x) sum += glm::dvec3(colour_of(image.at(x, y), *codes_));
        },
        image_);
    return vec3(sum / (static_cast<double>(width_) * height_));
}

size_t Texture::memory_bytes() const {
    return std::visit([](const auto& image) { return image.tiles.size() * sizeof(image.tiles[0]); }, image_);
}

}  // namespace etendue
