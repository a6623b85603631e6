// Light from infinitely far away: an equirectangular image around the scene, or uniform white.
//
// Mapping: theta = pi v down from +Y, phi = 2 pi u, direction = (sin theta cos phi, cos theta, sin theta sin
// phi).
#pragma once

#include <optional>

#include "gi/distribution.h"
#include "gi/light_sample.h"

namespace etendue {

/// The sky of a scene file, as arrays.
struct Sky {
    uint32_t width = 0, height = 0;                 // 0: uniform white
    std::vector<vec3, BulkAllocator<vec3>> pixels;  // rows from the top, linear radiance
    float intensity = 1;
    std::optional<float>
        radius;  // of the sphere whose cross-section counts in `power`; the scene's where empty
};

class SkyLight {
  public:
    static constexpr std::string_view name = "SkyLight";

    /// The sky, where the scene has one.
    static std::vector<SkyLight> find(const LightContext& context);

    SkyLight(const Sky& sky, float scene_radius);

    LightSample sample_Li(const vec3& reference, uint32_t triangle, const vec2& u, bool with_mis) const;
    // The same for lanes. A scene has one sky.
    static LightSampleOf<Lanes> sample_Li(const LaneMask& on, const LaneVec3& reference,
                                          const PerLane<const SkyLight*>& skies,
                                          const PerLane<uint32_t>& triangles, const LaneVec2& u,
                                          bool with_mis);
    static FoundLightOf<Lanes> found(const LaneMask& on, const SurfaceHits& misses,
                                     const PerLane<const SkyLight*>& skies, bool with_mis);

    float pdf_Li(const SurfaceHit& miss, bool with_mis) const { return pdf(-miss.wo, with_mis); }
    vec3 Le(const SurfaceHit& miss) const { return Le(-miss.wo); }
    vec3 Le(const vec3& direction) const;
    float power() const { return power_; }
    const Mesh* mesh() const { return nullptr; }

    /// Solid-angle density of sample_Li in a unit direction.
    float pdf(const vec3& direction, bool with_mis) const;

  private:
    const vec3& pixel(int32_t x, int32_t y) const;
    vec3 radiance_at(const vec2& uv) const;
    LaneVec3 radiance_at(const LaneMask& on, const LaneVec2& uv) const;
    /// Asks for the pixels that `radiance_at` reads in a cell of the image.
    void prefetch_around(uint32_t x, uint32_t y) const;
    /// The cell of image coordinates.
    std::pair<uint32_t, uint32_t> cell_at(const vec2& uv) const;
    /// Solid-angle density in a cell of row y that is chosen with probability `pmf`.
    float pdf_in_row(uint32_t y, float pmf) const;

    const Sky* sky_;
    const Distribution2D& cells(bool with_mis) const {
        return with_mis && bright_.total() > 0 ? bright_ : cells_;
    }

    // One cell a pixel, weighted by luminance x solid angle.
    Distribution2D cells_;
    // The same by how much brighter than the mean they are, for MIS: BSDF sampling finds the even part of a sky better
    // (Karlik et al. 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling"). Empty
    // where the sky is even.
    Distribution2D bright_;
    std::vector<float> row_cosines_;  // cos theta at the edges of the rows
    float power_;
};

}  // namespace etendue
