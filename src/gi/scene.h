// All there is to light: geometry for rays to find, materials, and lights to choose from.
#pragma once

#include <memory>
#include <span>

#include "gi/light.h"
#include "gi/light_sampler.h"

namespace etendue {

/// A ray and the question that it asked: what is first, or whether there is anything.
struct TracedRay {
    Ray ray;
    bool is_shadow_ray;
};

class Scene {
  public:
    struct Data {
        std::vector<Mesh> meshes;
        std::vector<Material> materials;
        std::vector<std::shared_ptr<const Texture>> textures;  // referred to by the materials
        std::optional<Sky> sky;
    };

    /// Builds the acceleration structure on all cores. Throws std::runtime_error where Embree cannot.
    explicit Scene(Data data);
    /// Another scene's geometry, textures and cut-outs, which the two share, under other materials and another
    /// sky: only the lights are found anew. Throws std::invalid_argument where a mesh's material is missing.
    Scene(const Scene& other, std::vector<Material> materials, std::optional<Sky> sky);

    struct BuildTime {
        double seconds, processor_seconds;
    };
    /// How long Embree takes over these meshes when nothing else is done: what a scene's making is held against.
    static BuildTime build_alone(const std::vector<Mesh>& meshes);

    // Lights point into the scene.
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// What the ray finds first. `meanwhile` is called while what is known of a surface comes from memory.
    template <class Work>
    SurfaceHit intersect(const Ray& ray, const Work& meanwhile) const {
        const Found found = first(ray);
        if (found.mesh == NONE) return {ray, sky_};
        const ScenePart& part = parts_[found.mesh];
        part.mesh->prefetch(found.triangle);
        meanwhile();
        return {ray,       found.distance, *part.mesh, found.triangle, found.barycentrics, *part.material,
                part.light};
    }
    SurfaceHit intersect(const Ray& ray) const {
        return intersect(ray, [] {});
    }
    /// The same for the rays of the lanes that are `on`.
    template <class Work>
    SurfaceHits intersect(const LaneRays& rays, const LaneMask& on, const Work& meanwhile) const {
        const FoundHits found = first(rays, on);
        meanwhile();
        return {rays, on, found};
    }
    /// Whether anything is between two points, or along the ray before t_max.
    bool occluded(const Ray& ray) const;
    LaneMask occluded(const LaneRays& rays, const LaneMask& on) const;
    /// Traces all of these and does nothing else, as fast as the library does. Returns how many hit something.
    uint64_t trace(std::span<const TracedRay> rays) const;

    /// A light, and a triangle of it, for a reference point; empty where there is none to choose. `learned`: for the
    /// region of that point, or null.
    std::optional<LightSampler::Choice> sample_light_source(LightSampler::Kind kind, const vec3& reference,
                                                            double u, const LightFactors* learned) const {
        return light_sampler_.sample(kind, reference, u, learned);
    }
    /// Probability with which sample_light_source chooses this triangle of the light; the sky's is number 0.
    float light_source_pdf(LightSampler::Kind kind, const vec3& reference, const Light* light,
                           uint32_t triangle, const LightFactors* learned) const {
        return light_sampler_.pmf(kind, reference, light, triangle, learned);
    }
    const LightSampler& light_sampler() const { return light_sampler_; }

    const std::vector<Light>& lights() const { return lights_; }
    const std::vector<Mesh>& meshes() const;
    const std::vector<Material>& materials() const { return materials_; }
    const std::vector<std::shared_ptr<const Texture>>& textures() const;
    size_t triangle_count() const;
    /// Bytes of arrays, textures and the acceleration structure.
    size_t memory_bytes() const;

    /// Axis-aligned bounds of all vertices; lower > upper in an empty scene.
    const vec3& lower() const;
    const vec3& upper() const;

  private:
    struct Geometry;
    /// What of a hit the library tells.
    struct Found {
        uint32_t mesh, triangle;
        float distance;
        vec2 barycentrics;
    };
    static constexpr uint32_t NONE = ~0u;
    Found first(const Ray& ray) const;
    /// What is known of the triangles is asked for, to come from memory.
    FoundHits first(const LaneRays& rays, const LaneMask& on) const;

    Scene(std::shared_ptr<const Geometry> geometry, std::vector<Material> materials, std::optional<Sky> sky);

    std::shared_ptr<const Geometry> geometry_;
    std::vector<Material> materials_;
    std::optional<Sky> sky_image_;
    std::vector<Light> lights_;
    std::vector<ScenePart> parts_;  // by the index of a mesh
    const Light* sky_ = nullptr;
    LightSampler light_sampler_;
};

/// Version of the library that traces rays.
std::string embree_version();

}  // namespace etendue
