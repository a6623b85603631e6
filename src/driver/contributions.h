// A picture taken apart: what each technique found, over short paths and over long ones.
#pragma once

#include "algorithms/observer.h"
#include "gi/math.h"

namespace etendue {

/// Sums over the samples of a pixel, weighted by MIS, so that they add up to the film's.
struct ContributionSums {
    // Light over at most two edges, a lamp that is seen or lights what is seen, and all that is indirect.
    enum Part { direct, indirect };
    static constexpr int DIRECT_EDGES = 2;
    static constexpr size_t PARTS = 2;

    glm::dvec3 by[TECHNIQUES.size()][PARTS]{};
};

/// Keeps one sample's contributions, until it is known that the sample counts.
class ContributionObserver : public Observer {
  public:
    void contribution(const Contribution& found) override {
        const auto part = found.edges > ContributionSums::DIRECT_EDGES ? ContributionSums::indirect
                                                                       : ContributionSums::direct;
        sample_.by[static_cast<size_t>(found.technique)][part] += glm::dvec3(found.unweighted * found.weight);
    }
    void add_to(ContributionSums& sums) const {
        for (size_t technique = 0; technique < TECHNIQUES.size(); ++technique) {
            for (size_t part = 0; part < ContributionSums::PARTS; ++part) {
                sums.by[technique][part] += sample_.by[technique][part];
            }
        }
    }

  private:
    ContributionSums sample_;
};

}  // namespace etendue
