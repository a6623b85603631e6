#include "gi/distribution.h"

namespace etendue {

Distribution1D::Distribution1D(std::span<const double> weights)
    : cumulative_(weights.size() + 1, 0.0), first_(weights.size()) {
    for (size_t i = 0; i < weights.size(); ++i) cumulative_[i + 1] = cumulative_[i] + weights[i];
    total_ = cumulative_.back();
    for (uint32_t step = 0, cell = 0; step < size(); ++step) {
        // A little early, as `sample` rounds.
        const double target = step / static_cast<double>(size()) * total_ * (1 - 1e-12);
        while (cell + 1 < size() && cumulative_[cell + 1] <= target) ++cell;
        first_[step] = cell;
    }
}

Distribution1D::Choice Distribution1D::sample(double u) const {
    const double target = u * total_;
    // The first cell that ends beyond the target; as that is below the total, where it is finite, the cell has a weight.
    uint32_t index = first_[static_cast<size_t>(u * static_cast<double>(size()))];
    while (index + 1 < size() && cumulative_[index + 1] <= target) ++index;
    const double from = cumulative_[index];
    const auto width = static_cast<float>(cumulative_[index + 1] - from);
    const float remapped = static_cast<float>(target - from) / width;
    return {index, width / static_cast<float>(total_), std::clamp(remapped, 0.f, ONE_MINUS_EPSILON)};
}

Distribution2D::Distribution2D(std::span<const float> weights, uint32_t width, uint32_t height)
    : cumulative_(weights.size()), first_cell_(weights.size()), width_(width), height_(height) {
    std::vector<double> row_sums(height);
    for (size_t y = 0; y < height; ++y) {
        double sum = 0;
        for (size_t x = y * width; x < (y + 1) * width; ++x) {
            sum += weights[x];
            cumulative_[x] = static_cast<float>(sum);
        }
        const float* const row = &cumulative_[y * width];
        row_sums[y] = row[width - 1];
        for (uint32_t step = 0, cell = 0; step < width; ++step) {
            // A little early, as `sample` rounds.
            const float target = step / static_cast<float>(width) * row[width - 1] * (1 - 1e-6f);
            while (cell + 1 < width && row[cell] <= target) ++cell;
            first_cell_[y * width + step] = cell;
        }
    }
    rows_ = Distribution1D(row_sums);
}

Distribution2D::Search Distribution2D::begin(const vec2& u) const {
    Search search{rows_.sample(u.y), u.x};
    const auto step = std::min(static_cast<uint32_t>(u.x * static_cast<float>(width_)), width_ - 1);
    search.first_cell = size_t{search.row.index} * width_ + step;
    prefetch(&first_cell_[search.first_cell]);
    prefetch(&cumulative_[size_t{search.row.index} * width_ + width_ - 1]);
    return search;
}

void Distribution2D::find_start(Search& search) const {
    search.start = &cumulative_[size_t{search.row.index} * width_] + first_cell_[search.first_cell];
    prefetch(search.start);
}

Distribution2D::Choice Distribution2D::finish(const Search& search) const {
    const float* const begin = &cumulative_[size_t{search.row.index} * width_];
    const float target = search.u * begin[width_ - 1];
    const float* end = search.start;
    while (end < begin + width_ && *end <= target) ++end;
    while (end == begin + width_ || *end == (end == begin ? 0.f : *(end - 1))) --end;
    const float from = end == begin ? 0.f : *(end - 1), width = *end - from;
    const float remapped = std::clamp((target - from) / width, 0.f, ONE_MINUS_EPSILON);
    return {static_cast<uint32_t>(end - begin),
            search.row.index,
            search.row.pmf * width / begin[width_ - 1],
            {remapped, search.row.remapped}};
}

Distribution2D::Choice Distribution2D::sample(const vec2& u) const {
    Search search = begin(u);
    find_start(search);
    return finish(search);
}

float Distribution2D::pmf(uint32_t x, uint32_t y) const {
    const float* const row = &cumulative_[size_t{y} * width_];
    if (row[width_ - 1] == 0) return 0;
    return rows_.pmf(y) * (row[x] - (x == 0 ? 0.f : row[x - 1])) / row[width_ - 1];
}

}  // namespace etendue
