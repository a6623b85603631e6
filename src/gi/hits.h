// What the rays of several paths found, in lanes: as SurfaceHit, which is for a ray alone.
#pragma once

#include "gi/hit.h"

namespace etendue {

using LaneRays = RayOf<Lanes>;

inline Ray ray_of(const LaneRays& rays, int lane) {
    return {rays.origin.lane(lane), rays.direction.lane(lane), rays.t_max[lane]};
}

/// A mesh with what belongs to it, and what a hit wants to know of its material, in a line of the cache.
struct alignas(64) ScenePart {
    ScenePart(const Mesh& mesh, const Material& material);

    struct Line {
        vec3 albedo;
        float ior, roughness, absorb;
        float bsdf;                                     // a BsdfKind
        float coated, delta, has_colours, has_normals;  // 1 or 0; the latter two of textures
        float unused[5];
    } line;
    static_assert(sizeof(Line) == LINE_FLOATS * sizeof(float));
    const Mesh* mesh;
    const Material* material;
    const Light* light = nullptr;  // null where it does not emit
};

/// What of the hits of rays the library tells, and whose they are.
struct FoundHits {
    PerLane<float> distance{};
    PerLane<float> b1{}, b2{};  // barycentrics of the hit in the triangle
    PerLane<uint32_t> triangle{};
    PerLane<const ScenePart*> part{};  // null where a ray left the scene
    // The part's, or there the sky; null where nothing shines.
    PerLane<const Light*> light{};

    vec2 barycentrics(int lane) const { return {b1[lane], b2[lane]}; }
    vec2 uv(int lane) const { return part[lane]->mesh->uv(triangle[lane], barycentrics(lane)); }
};

struct SurfaceHits {
    /// Of the lanes `on`. Whatever else is in a lane that is not, or in one that hit nothing, means nothing.
    SurfaceHits(const LaneRays& rays, const LaneMask& on, const FoundHits& found);

    LaneMask valid;
    LaneMask is_light;  // light may come from here, as of SurfaceHit
    LaneMask is_delta;  // the BSDF is a pure Dirac delta
    LaneMask front;
    LaneVec3 wo;
    SurfacePointOf<Lanes> point;  // its normal is geometric and on the side of wo
    FrameOf<Lanes> frame;         // around the shading normal, on the side of wo
    LaneMask is_bent{false};      // that normal, see ClearNormal
    LaneVec3 wo_local;
    FoundHits found;

    // The BSDF in world directions, as of SurfaceHit.
    BsdfValueOf<Lanes> values(const LaneMask& on, const LaneVec3& wi) const;
    BsdfSampleOf<Lanes> sample(const LaneMask& on, const Lanes& lobe, const LaneVec2& u) const;

    /// The BSDF's diffuse part for the direction that the rays came from, see Bsdf, and its kind.
    Lanes diffuse_shares(const LaneMask& on) const {
        return bsdf_diffuse_shares(on, bsdf_, surface_.ior, wo_local.z);
    }
    const SurfaceOf<Lanes>& surfaces() const { return surface_; }
    const Lanes& bsdfs() const { return bsdf_; }

    /// The rays that leave these points in unit directions.
    LaneRays rays_towards(const LaneVec3& wi) const { return {point.offset_towards(wi), wi}; }

    /// Reads the colours of textures, which were asked for when the hits were made. To be called before the BSDF.
    void read_colours();

    /// What a light wants to know of one of the hits.
    SurfaceHit seen_by_light(int lane) const;

  private:
    LaneVec3 shading_normals(const LaneMask& smooth, const LaneMask& mapped);

    SurfaceOf<Lanes> surface_;
    Lanes bsdf_;  // kinds
    LaneMask textured_;
};

}  // namespace etendue
