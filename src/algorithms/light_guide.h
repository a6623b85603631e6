// Where light does arrive from, region by region, learned from paths of its own before a render.
//
// The light tree knows how much of each light could arrive at a point, but of no wall between the two, nor of the
// surface there. Here the scene is cut into cells, by position and by the side that surfaces face, and each learns by
// what to multiply the tree's importances, so that lights are chosen about in proportion to the root of the mean
// square of what they bring: of choices by fixed probabilities, those have the least variance (Vevoda, Kondapaneni and
// Krivanek 2018, "Bayesian online regression for adaptive direct illumination sampling"; Pantaleoni 2019, "Importance
// Sampling of Many Lights with Reinforcement Lightcuts Learning").
//
// No light is ever left out, so what is learned moves noise, never the picture.
#pragma once

#include <bit>
#include <vector>

#include "gi/camera.h"
#include "gi/light_sampler.h"

namespace etendue {

struct Preparation;
enum class Mis;

class LightGuide {
  public:
    /// Traces the beginnings of paths of up to `max_edges` edges, always the same ones. False, with nothing learned,
    /// where it was cut short. To be called once it has learned nothing yet.
    bool learn(const Preparation& preparation, int max_edges, Mis mis);

    /// For a point and its unit normal; null where nothing is known.
    const LightFactors* at(const vec3& position, const vec3& normal) const;
    /// The same for lanes. What is known of the first choice is asked for, to come from memory.
    PerLane<const LightFactors*> at(const LaneMask& on, const LaneVec3& positions,
                                    const LaneVec3& normals) const;

    /// How many paths are traced for a picture: about one for every two pixels, which takes a fraction of a sample a
    /// pixel but where there are few, and no more than what the viewer can wait for.
    static uint32_t paths(const Camera& camera) {
        const uint64_t pixels = uint64_t{camera.width()} * camera.height();
        return std::bit_floor(static_cast<uint32_t>(std::clamp(pixels / 2, FEWEST_PATHS, MOST_PATHS)));
    }

  private:
    static constexpr uint64_t FEWEST_PATHS = 1 << 15, MOST_PATHS = 1 << 17;

    /// Numbers of cells by position and normal: cubes of one size for each of the six sides that normals may face.
    class Cells {
      public:
        static constexpr uint32_t NONE = ~0u;

        Cells() = default;
        Cells(const vec3& origin, float side) : origin_(origin), per_length_(1 / side) {}

        uint32_t find(const vec3& position, const vec3& normal) const;
        // `find` in two steps, between which what it looks at comes from memory.
        uint64_t begin_find(const vec3& position, const vec3& normal) const;
        uint32_t find(uint64_t key) const { return slots_[slot_of(key)].cell; }
        uint32_t find_or_add(const vec3& position, const vec3& normal);
        uint32_t count() const { return count_; }

      private:
        struct Slot {
            uint64_t key;
            uint32_t cell = NONE;
        };
        uint64_t key_of(const vec3& position, const vec3& normal) const;
        /// The slot of a key, or the free one where it belongs.
        size_t slot_of(uint64_t key) const;

        vec3 origin_{0};
        float per_length_ = 0;
        uint32_t count_ = 0;
        std::vector<Slot> slots_;  // a hash table with linear probing, half empty; its size is a power of 2
    };

    const LightFactors* in_large(const vec3& position, const vec3& normal) const;

    // Few paths come to a small cell; what they leave open the large one around it tells.
    Cells small_, large_;
    std::vector<LightFactors> of_small_, of_large_;
};

}  // namespace etendue
