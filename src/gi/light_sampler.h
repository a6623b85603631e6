// Which light to sample, and which of its triangles.
#pragma once

#include <array>
#include <string_view>

#include "gi/distribution.h"
#include "gi/light.h"
#include "gi/light_tree.h"

namespace etendue {

/// What was learned about the lights of a region of the scene.
struct alignas(64) LightFactors {
    float triangles_share;  // probability of choosing a triangle rather than another light; in (0, 1]
    LightTree::Factors tree;

    /// Of triangles no more than what the tree knows.
    static LightFactors even(float triangles_share) {
        std::array<float, LightTree::WIDTH> ones;
        ones.fill(1);
        LightFactors out{triangles_share, {LightTree::SlotFactors(ones), {}}};
        out.tree.below.fill(out.tree.root);
        return out;
    }
};

class LightSampler {
  public:
    /// `power`: by what triangles emit, from everywhere alike. `tree`: by how much of it could arrive at the reference
    /// point. The sky, infinitely far away, is chosen by its power in both.
    enum class Kind : uint8_t { tree, power };
    static constexpr std::array<std::string_view, 2> names{"tree", "power"};

    struct Choice {
        const Light* light;
        uint32_t triangle;  // of the light's mesh; 0 for the sky
        float pmf;
        float remapped;  // `u`, uniform in [0, 1) again
    };

    LightSampler() = default;
    explicit LightSampler(std::span<const Light> lights);

    /// Empty in a scene without light, or where the tree knows of none that could arrive. `u` in [0, 1) has more digits
    /// than a float, as many as both the choice and `remapped` need. `learned` counts for the tree alone.
    std::optional<Choice> sample(Kind kind, const vec3& reference, double u,
                                 const LightFactors* learned = nullptr) const;
    /// The same for references in lanes.
    PerLane<std::optional<Choice>> sample(Kind kind, const LaneMask& on, const LaneVec3& references,
                                          const PerLane<double>& u,
                                          const PerLane<const LightFactors*>& learned) const;
    float pmf(Kind kind, const vec3& reference, const Light* light, uint32_t triangle,
              const LightFactors* learned = nullptr) const;

    /// The tree over all triangles; empty where there are so few that their power decides.
    const LightTree& tree() const { return tree_; }
    /// Whether there are lights beside the tree's triangles that may be chosen.
    bool has_others() const { return others_.total() > 0; }
    /// Number of a triangle of a light among the tree's emitters.
    uint32_t emitter(const Light* light, uint32_t triangle) const {
        return first_[light - lights_.data()] + triangle;
    }

  private:
    double share_of_tree(const LightFactors* learned) const {
        return !has_others() ? 1 : learned ? learned->triangles_share : triangles_share_;
    }

    struct Emitter {
        const Light* light;
        uint32_t triangle;
    };

    Choice of_all(double u) const;
    Choice of_others(double u, double share) const;
    Choice of_tree(const LightTree::Choice& choice, double share) const;
    /// What is left of `u` for the tree, which has this share.
    static double within(double u, double share) { return std::min(u / share, 1 - 0x1p-52); }

    std::span<const Light> lights_;
    // All triangles of all lights, then the sky.
    std::vector<Emitter> emitters_;
    std::vector<uint32_t> first_;  // emitter of each light
    Distribution1D by_power_;
    LightTree tree_;
    Distribution1D others_;       // by power, of what is no triangle
    double triangles_share_ = 0;  // of the power, with which the tree is asked where nothing is learned
    // Of the two halves of a rectangle neither is nearer than the other.
    static constexpr size_t WORTH_A_TREE = 3;
};

}  // namespace etendue
