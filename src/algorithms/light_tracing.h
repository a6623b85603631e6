// Caustics: light that mirrors and glass throw onto a surface which the camera sees, traced from the light (Arvo 1986,
// "Backward Ray Tracing"; Dutre, Lafortune and Willems 1993, "Monte Carlo Light Tracing with Direct Computation of
// Pixel Intensities").
//
// A path from the camera finds such light by chance alone, and where the lamp is small never, or as a firefly: at a
// delta surface no light can be sampled. From the other end the same path
//
//     light - g - ... - e - x - camera
//
// is easy: choose a point g on the scene's delta surfaces, of density p_A per area, and a light from there as next event
// estimation does; follow the light through further delta surfaces to the first x that is none, and connect x to the lens.
//
// The measure. A path tracer integrates over film and direction at x, ds d omega_x; here area and direction at g are
// sampled, dA_g d omega_g. Light keeps its etendue: from g to x, cos_g dA_g d omega_g = cos_x dA_x d omega_x, times n^2
// where it is refracted, which the radiance of refracted light makes up for. The film sees x from the direction v at the
// distance D, ds = film per solid angle * cos_v dA_x / D^2. So the estimate of a pixel of area 1 by one of M paths is
//
//     Le  prod(tint)  f_x |cos_x'|  W  cos_g / (M p_A p_omega),      W = film per solid angle * cos_v / (D^2 cos_x),
//
// cos' being at the shading normal. Where that is not the geometric one, a delta vertex does not keep etendue: it is off by
// (cos_out cos'_in) / (cos_in cos'_out) (Veach 1997, 5.3.2).
//
// Both ends find the same paths, so they are combined by the balance heuristic: W p_bsdf for the camera's, M p_A p_omega /
// cos_g for the light's. That takes refraction and shading normals for none: weights need to add up to 1, no more. Paths
// over a bent shading normal (ClearNormal) look different from the other end, and are left to the camera's, in full.
#pragma once

#include "algorithms/direct_light.h"
#include "algorithms/pilot.h"
#include "gi/camera.h"
#include "gi/distribution.h"

namespace etendue {

class LightTracing {
  public:
    static Parameter parameter() {
        return {"light_tracing",
                "whether light that mirrors and glass throw onto what the camera sees is traced from the "
                "lights too, "
                "where that pays: clean caustics",
                true};
    }

    /// Whether a scene has what light can be traced through.
    static bool may_pay(const Scene& scene);

    /// Finds out how many paths pay, if any; until then none is traced. False where it was cut short. Where portals pay, which
    /// find the same light, paths must pay much more than a little.
    bool prepare(const Preparation& preparation, const Pilots& pilots, float max_edges,
                 LightSampler::Kind kind, Mis mis);

    uint32_t paths() const { return paths_; }
    std::optional<Splat> path(Context& context, uint32_t number) const;

    /// A path from the camera, of up to `longest` edges, as one from the light might have found it.
    struct CameraPath {
        Lanes film_density;  // W p_bsdf, see above; 0 where it could not be
        Lanes cos_g;
        Lanes area_density;   // p_A
        Lanes light_density;  // p_omega
    };
    float longest() const { return max_edges_; }
    /// With which all paths from lights would have, as `film_density` is that of the camera's.
    Lanes density(const CameraPath& found) const {
        return static_cast<float>(paths_) * (found.area_density * found.light_density / found.cos_g);
    }
    /// W, for what a ray of the camera found and a direction of light there.
    template <class F>
    F film_per_etendue(const Vec3<F>& normal, const Vec3<F>& ray_direction, const F& distance,
                       const Vec3<F>& wi) const {
        return camera_->film_per_solid_angle(ray_direction) *
               abs(dot(ray_direction, normal) / dot(wi, normal)) / (distance * distance);
    }
    /// p_A, of a triangle of a delta surface.
    float area_density(const Mesh* mesh, uint32_t triangle) const {
        return area_densities_[places_[mesh - scene_->meshes().data()][triangle]];
    }
    /// How light is sampled at a delta surface.
    const LightFactors* light_factors() const { return &light_factors_; }

  private:
    /// Triangles of delta surfaces near each other, which face to the same side.
    using Place = uint32_t;
    /// What a light path found, and how it began.
    struct Trial {
        Place place;
        float place_density;        // per area
        bool of_triangles = false;  // or from another light, as the sky
        float kind_share = 1;       // with which such a light was chosen
        bool arrived = false;       // else the rest means nothing
        vec2 film{0};
        float edges = 0;
        vec3 radiance{0};        // over the density by which one path finds it
        float density = 0;       // that density, cos_g included
        float film_density = 0;  // of the camera's path
    };
    /// Path `number` of so many.
    Trial trace(Context& context, uint32_t number, uint32_t paths) const;
    /// Trials of a round; empty where it was cut short. Adds the rays of a path.
    std::vector<Trial> trials(const Preparation& preparation, uint32_t round, float& rays) const;
    void find_triangles();
    /// From now on begins where, by all trials, something arrives that paths from the camera find badly.
    void learn(std::span<const Trial> trials);
    void choose_by(const std::vector<float>& place_factors);
    bool may_choose_kind() const {
        return scene_->light_sampler().has_others() && !scene_->light_sampler().tree().empty();
    }

    const Scene* scene_ = nullptr;
    const Camera* camera_ = nullptr;
    float max_edges_ = 0;  // no more than light that is caught in glass may go on for
    LightSampler::Kind kind_{};
    Mis mis_{};
    struct DeltaTriangle {
        uint32_t mesh, triangle;
        Place place;
    };
    std::vector<DeltaTriangle> triangles_;
    Distribution1D choice_;
    std::vector<std::vector<Place>> places_;  // by mesh and triangle; empty where a mesh is no delta surface
    std::vector<float> area_densities_;       // by place
    LightFactors light_factors_ = LightFactors::even(1);
    uint32_t paths_ = 0;
};

}  // namespace etendue
