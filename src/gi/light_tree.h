// Which of many emitters to sample from a point: a tree in which every node bounds how much of its light could
// arrive there (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting";
// pbrt 4th ed., 12.6.3).
//
// An emitter shines into the half space in front of it. What may arrive at a point from a node is taken for
//     power x cos(least angle between a normal of the node and the way to the point) / distance^2,
// and each step down the tree chooses a child by that. Visibility and the surface at the point are not asked for.
#pragma once

#include <array>
#include <bit>
#include <optional>
#include <span>
#include <vector>

#include "gi/math.h"
#include "gi/memory.h"

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
    static constexpr uint32_t WIDTH = 16;
    struct Choice {
        uint32_t emitter;
        float pmf;
        double remapped;  // `u`, uniform in [0, 1) again
    };
    /// A factor for each slot of a node, of which only the ratios count: relative to the largest, down to 2^-8 of it,
    /// in 32 steps an octave. In a byte each, so that the factors of many regions stay in the caches.
    class alignas(16) SlotFactors {
      public:
        SlotFactors() = default;
        /// All > 0.
        explicit SlotFactors(const std::array<float, WIDTH>& factors);

        float operator[](uint32_t slot) const {
            return std::bit_cast<float>(ONE - (uint32_t{codes_[slot]} << SHIFT));
        }

      private:
        // Codes count down from the bits of 1, in the exponent and the first five digits.
        static constexpr uint32_t ONE = 0x3f800000, SHIFT = 23 - 5;
        std::array<uint8_t, WIDTH> codes_{};
    };
    /// What the importances of the first two levels are multiplied by, where more is known than the tree knows: at
    /// the root, and below each of its slots.
    struct Factors {
        SlotFactors root;
        std::array<SlotFactors, WIDTH> below;
    };
    /// The slots on the way to an emitter at these two levels.
    struct Slots {
        uint32_t root;
        std::optional<uint32_t> below;  // empty where the root leads to the emitter
    };

    LightTree() = default;
    explicit LightTree(std::span<const EmitterBounds> emitters);

    /// Empty where no light of the emitters can arrive, or where the choice led to some of which none can. `u` is in
    /// [0, 1 - 2^-52].
    std::optional<Choice> sample(const vec3& reference, double u, const Factors* factors = nullptr) const;
    /// The same for references in lanes, level by level, so that the nodes that they lead to come from memory meanwhile.
    PerLane<std::optional<Choice>> sample(const LaneMask& on, const LaneVec3& references,
                                          const PerLane<double>& u,
                                          const PerLane<const Factors*>& factors) const;
    /// Probability with which `sample` chooses this emitter.
    float pmf(const vec3& reference, uint32_t emitter, const Factors* factors = nullptr) const;

    bool empty() const { return nodes_.empty(); }
    /// Of an emitter with power.
    Slots slots(uint32_t emitter) const;
    /// What is taken for arriving at a point from all emitters together.
    float importance(const vec3& reference) const;

  private:
    static constexpr uint32_t BITS = 4;
    static constexpr uint32_t LEAF = 1u << 31;
    /// The nodes or emitters below a node, side by side, so that vector instructions look at all of them at once.
    struct alignas(64) Node {
        std::array<float, WIDTH> x{}, y{}, z{}, radius{};  // bounding spheres
        std::array<float, WIDTH> axis_x{}, axis_y{}, axis_z{}, cos_angle{}, sin_angle{};
        std::array<float, WIDTH> power{};
        std::array<uint32_t, WIDTH> child{};  // index of a node, or LEAF | index of an emitter

        void set(uint32_t slot, const EmitterBounds& bounds);
    };
    /// A choice on its way down.
    struct Descent {
        double u = 0;
        uint32_t node = 0, depth = 0, root_slot = 0;
        float pmf = 1;
        std::optional<uint32_t> emitter;  // once it has arrived
        bool ended = false;               // where there was nothing to choose
    };
    /// One step down.
    void step(Descent& descent, const vec3& reference, const Factors* factors) const;

    using Importances = std::array<float, WIDTH>;
    // In double, as what is chosen rarely must be so as often as it says.
    using Sums = std::array<double, WIDTH + 1>;

    static Importances importances(const Node& node, const vec3& reference);
    /// With the factors of a node at this depth, below this slot of the root.
    static Importances importances(const Node& node, const vec3& reference, const Factors* factors,
                                   uint32_t depth, uint32_t root_slot);
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
