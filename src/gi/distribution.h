// Piecewise-constant distributions, sampled by inverting their cumulative sums.
#pragma once

#include <span>
#include <vector>

#include "gi/math.h"
#include "gi/memory.h"

namespace etendue {

/// A choice among n things with given weights.
class Distribution1D {
  public:
    struct Choice {
        uint32_t index;
        float pmf;
        float remapped;  // `u` stretched over the chosen cell: uniform in [0, 1) again
    };

    Distribution1D() = default;
    explicit Distribution1D(std::span<const double> weights);

    /// Inverts the cumulative sum at u in [0, 1). Needs total() > 0; never chooses a weight of zero.
    Choice sample(double u) const;

    float pmf(uint32_t index) const {
        return static_cast<float>((cumulative_[index + 1] - cumulative_[index]) / total_);
    }
    double total() const { return total_; }
    size_t size() const { return cumulative_.empty() ? 0 : cumulative_.size() - 1; }

  private:
    // In double: a mesh of a million triangles keeps the area of each.
    std::vector<double> cumulative_;
    // For u in each of size() equal steps: the cell at which the search begins, which then is near its end (Chen and Asau
    // 1974, "On Generating Random Variates from an Empirical Distribution").
    std::vector<uint32_t> first_;
    double total_ = 0;
};

/// A choice among the cells of a grid, row by its sum, then column within the row.
class Distribution2D {
  public:
    struct Choice {
        uint32_t x, y;
        float pmf;
        vec2 remapped;
    };

    Distribution2D() = default;
    /// Weights of `height` rows of `width` cells.
    Distribution2D(std::span<const float> weights, uint32_t width, uint32_t height);

    Choice sample(const vec2& u) const;
    /// The same in three steps, `begin`, `find_start` and `finish`, between which what the next one reads comes from memory:
    /// several choices can so wait at once.
    struct Search {
        Distribution1D::Choice row{};
        float u = 0;
        size_t first_cell = 0;         // the place of the search's beginning in its table
        const float* start = nullptr;  // and that beginning
    };
    Search begin(const vec2& u) const;
    void find_start(Search& search) const;
    Choice finish(const Search& search) const;

    float pmf(uint32_t x, uint32_t y) const;
    /// Asks for what `pmf` reads.
    void prefetch_pmf(uint32_t x, uint32_t y) const {
        prefetch(&cumulative_[size_t{y} * width_ + x]);
        prefetch(&cumulative_[size_t{y} * width_ + width_ - 1]);
    }
    double total() const { return rows_.total(); }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

  private:
    // Single precision within a row: at 16 million cells the table is what counts.
    std::vector<float, BulkAllocator<float>> cumulative_;
    // By row, for u in each of `width` equal steps: the cell at which the search begins, as above.
    std::vector<uint32_t, BulkAllocator<uint32_t>> first_cell_;
    Distribution1D rows_;
    uint32_t width_ = 0, height_ = 0;
};

}  // namespace etendue
