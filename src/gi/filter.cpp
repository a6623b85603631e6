#include "gi/filter.h"

namespace etendue {

namespace {

constexpr double RADIUS = 1.5;  // of the Blackman-Harris window, in pixels

/// Integral of the window from -RADIUS to x, of its whole (Harris 1978, minimum 4-term window).
double blackman_harris_cdf(double x) {
    const double t = (x + RADIUS) / (2 * RADIUS);
    const double p = 2 * M_PI;
    const double integral = 0.35875 * t - 0.48829 * std::sin(p * t) / p +
                            0.14128 * std::sin(2 * p * t) / (2 * p) - 0.01168 * std::sin(3 * p * t) / (3 * p);
    return integral / 0.35875;
}

}  // namespace

Filter::Filter(Kind kind) : kind_(kind) {
    for (int i = 0; i <= CELLS; ++i) {
        const double root = double(i) / CELLS, left = root * root * root * root / 2;
        double low = 0, high = RADIUS;
        for (int step = 0; step < 60; ++step) {
            const double middle = (low + high) / 2;
            (blackman_harris_cdf(-middle) > left ? low : high) = middle;
        }
        distances_[i] = static_cast<float>((low + high) / 2);
    }
}

float Filter::density_1d(float offset) const {
    if (kind_ == Kind::box) return offset >= -0.5f && offset < 0.5f ? 1.f : 0.f;
    const float distance = std::abs(offset);
    if (distance >= radius()) return 0;
    // The cell that reaches from distances_[i] inwards to distances_[i + 1].
    const auto next = std::ranges::lower_bound(distances_, distance, std::greater_equal());
    const auto i = std::clamp<ptrdiff_t>(next - distances_.begin(), 1, CELLS) - 1;
    const float width = distances_[i] - distances_[i + 1];
    const float cell = static_cast<float>(i) + (distances_[i] - distance) / width;
    // The derivative of the share that is left beyond, (cell / CELLS)^4 / 2.
    const float x = cell / CELLS;
    return 2 * x * x * x / (CELLS * width);
}

}  // namespace etendue
