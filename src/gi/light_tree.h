// Which of many emitters to sample from a point: a tree in which every node bounds how much of its light could
// arrive there (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting";
// pbrt 4th ed., 12.6.3).
//
// An emitter shines into the half space in front of it. What may arrive at a point from a node is taken for
//     power x cos(least angle between a normal of the node and the way to the point) / distance^2,
// and each step down the tree chooses a child by that. Visibility and the surface at the point are not asked for.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "gi/math.h"

namespace etendue {

/// Directions within an angle of an axis; by default none.
struct Cone {
    vec3 axis{0, 0, 1};  // unit
    float cos_angle = INFINITE;

    bool is_empty() const { return cos_angle == INFINITE; }
    float angle() const { return std::acos(std::clamp(cos_angle, -1.f, 1.f)); }
    /// The smallest one around both, whose axis lies between theirs.
    Cone united(const Cone& other) const;
};

/// Where some emitters are, where their fronts face, and how much they give.
struct EmitterBounds {
    vec3 lower{INFINITE}, upper{-INFINITE};
    Cone normals;
    float power = 0;

    vec3 centre() const { return (lower + upper) / 2.f; }
    EmitterBounds united(const EmitterBounds& other) const;
};

class LightTree {
  public:
    struct Choice {
        uint32_t emitter;
        float pmf;
        double remapped;  // `u`, uniform in [0, 1) again
    };

    LightTree() = default;
    explicit LightTree(std::span<const EmitterBounds> emitters);

    /// Empty where no light of the emitters can arrive, or where the choice led to some of which none can. `u` is in
    /// [0, 1 - 2^-52].
    std::optional<Choice> sample(const vec3& reference, double u) const;
    /// Probability with which `sample` chooses this emitter.
    float pmf(const vec3& reference, uint32_t emitter) const;

  private:
    static constexpr uint32_t WIDTH = 16, BITS = 4;
    static constexpr uint32_t LEAF = 1u << 31;
    /// The nodes or emitters below a node, side by side, so that vector instructions look at all of them at once.
    struct alignas(64) Node {
        std::array<float, WIDTH> x{}, y{}, z{}, radius{};  // bounding spheres
        std::array<float, WIDTH> axis_x{}, axis_y{}, axis_z{}, cos_angle{}, sin_angle{};
        std::array<float, WIDTH> power{};
        std::array<uint32_t, WIDTH> child{};  // index of a node, or LEAF | index of an emitter

        void set(uint32_t slot, const EmitterBounds& bounds);
    };
    using Importances = std::array<float, WIDTH>;
    // In double, as what is chosen rarely must be so as often as it says.
    using Sums = std::array<double, WIDTH + 1>;

    static Importances importances(const Node& node, const vec3& reference);
    /// Of all slots before each, and of all.
    static Sums sums_before(const Importances& importance);
    uint32_t build(std::span<const EmitterBounds> emitters, std::span<uint32_t> indices, uint64_t path,
                   uint32_t depth);

    std::vector<Node> nodes_;
    // By emitter: the slots on its way from the root, BITS each from the lowest on. Empty ways are of emitters without
    // power, which no node has.
    struct Way {
        uint64_t slots = 0;
        uint32_t length = 0;
    };
    std::vector<Way> ways_;
};

}  // namespace etendue
