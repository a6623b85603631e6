#include "driver/film_error.h"

#include <cmath>

#include "driver/pixel_groups.h"

namespace etendue {

namespace {

// A tile darker than this part of the image's mean counts as if it were as bright, or else the last photons of
// the deepest shadow would get all samples.
constexpr double DARK = 0.01;

/// Of a pixel: the squared standard error of its mean, summed over the channels.
///
/// Two means m_a and m_b of a and b independent samples differ by var (1/a + 1/b) in the expected square, and the
/// mean of all has var / (a + b), so (m_a - m_b)^2 ab / (a + b)^2 estimates its error without bias. Halves that
/// are stratified against each other, as Sobol's are, differ more: then it is too large, never too small.
double squared_error(const Pixel& pixel) {
    const double n = static_cast<double>(pixel.count - pixel.invalid);
    const double a = static_cast<double>(pixel.half_count), b = n - a;
    if (n == 0) return pixel.count > 0 ? 0 : INFINITE;
    if (a > 0 && b > 0) {
        const glm::dvec3 difference = pixel.half_sum / a - (pixel.sum - pixel.half_sum) / b;
        return dot(difference, difference) * a * b / (n * n);
    }
    // A range of samples that lies in one half: as if its samples were independent.
    if (n == 1) return INFINITE;
    const glm::dvec3 squares = pixel.sum_squares - pixel.sum * pixel.sum / n;
    return std::max(squares.x + squares.y + squares.z, 0.0) / (n * (n - 1));
}

struct TileSums {
    double radiance = 0, squared_error = 0, fourth_power = 0, pixels = 0;
    uint64_t fewest = UINT64_MAX, most = 0;
};

TileSums sums_of(const Film& film, const Tile& tile) {
    TileSums sums;
    for (uint32_t y = tile.y0; y < tile.y1; ++y) {
        for (uint32_t x = tile.x0; x < tile.x1; ++x) {
            const Pixel& pixel = film.at(x, y);
            const double squared = squared_error(pixel);
            const vec3 mean = pixel.mean();
            sums.radiance += double{mean.x} + mean.y + mean.z;
            sums.squared_error += squared;
            sums.fourth_power += squared * squared;
            sums.pixels += 1;
            sums.fewest = std::min(sums.fewest, pixel.count);
            sums.most = std::max(sums.most, pixel.count);
        }
    }
    return sums;
}

/// With S the sum of n pixels' squared errors s: error^2 = S / 3n / mean^2. Where the s are independent, the variance of each
/// is at most the expectation of s^2, so that of S is at most their sum, and an error's is that of its square over
/// (2 error)^2.
///
/// Pixels that share paths have correlated errors. They do for one block of samples out of b, which makes their
/// correlation 1 / b at most, and 1 / b^2 that of the squares; each pixel has b (sharing - 1) such partners.
TileError error_of(const TileSums& sums, double darkest, uint32_t sharing) {
    const double radiance = std::max(sums.radiance / (3 * sums.pixels), darkest);
    TileError tile{0, 0, sums.fewest, sums.most};
    if (sums.squared_error > 0) {
        tile.error = std::sqrt(sums.squared_error / (3 * sums.pixels)) / radiance;
        const double blocks = std::max(static_cast<double>(sums.fewest) / PixelGroups::BLOCK, 1.0);
        const double correlated = 1 + (sharing - 1) / blocks;
        tile.spread = tile.error * std::sqrt(correlated * sums.fourth_power) / (2 * sums.squared_error);
    }
    if (!std::isfinite(tile.error)) tile.spread = 0;
    return tile;
}

}  // namespace

std::vector<TileError> tile_errors(const Film& film, TileWorkers& workers, uint32_t sharing) {
    const Tiles tiles(film.width(), film.height());
    std::vector<TileSums> sums(tiles.count());
    workers.for_each(tiles, [&](uint32_t index, const Tile& tile) { sums[index] = sums_of(film, tile); });
    double radiance = 0;
    for (const TileSums& tile : sums) radiance += tile.radiance;
    const double darkest = DARK * radiance / (3.0 * film.width() * film.height());
    // In powers of two it hardly ever changes, so that samples elsewhere do not move a tile's error.
    const double steady = darkest > 0 ? std::exp2(std::floor(std::log2(darkest))) : 1;
    std::vector<TileError> errors;
    errors.reserve(sums.size());
    for (const TileSums& tile : sums) errors.push_back(error_of(tile, steady, sharing));
    return errors;
}

FilmError film_error(std::span<const TileError> tiles) {
    std::vector<double> values(tiles.size());
    const auto bound_of = [&](double spreads) {
        std::ranges::transform(tiles, values.begin(), [&](const TileError& t) {
            return std::max(t.error + spreads * t.spread, 0.0);
        });
        const auto last_within = values.begin() + static_cast<ptrdiff_t>(tiles_within(values.size())) - 1;
        std::ranges::nth_element(values, last_within);
        return *last_within;
    };
    return {bound_of(0), bound_of(-1.96), bound_of(1.96)};
}

}  // namespace etendue
