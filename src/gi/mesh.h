// A triangle mesh of one material, as arrays.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "gi/memory.h"
#include "gi/ray.h"

namespace etendue {

template <class F>
struct TriangleOf {
    std::array<Vec3<F>, 3> corners;
    Vec3<F> normal;  // of the front, unit
    F reach;         // see SurfacePoint
    F area;

    SurfacePointOf<F> point(const Vec2<F>& b) const {
        return {(1 - b.x - b.y) * corners[0] + b.x * corners[1] + b.y * corners[2], normal, reach};
    }
};

/// What every hit wants to know of its triangle, in one line of the cache.
struct alignas(64) Facet : TriangleOf<float> {
    float smooth;  // 1 where the normals at its corners are others, else 0

    Facet() = default;
    Facet(const vec3& v0, const vec3& v1, const vec3& v2);
};

/// For lanes that have no triangle.
inline const Facet NO_FACET({0, 0, 0}, {1, 0, 0}, {0, 1, 0});

/// A facet for each lane.
struct FacetLanes : TriangleOf<Lanes> {
    Lanes smooth;

    ETENDUE_LANES_INLINE explicit FacetLanes(const PerLane<const Facet*>& facets) {
        PerLane<const float*> lines;
        for (int i = 0; i < LANES; ++i) lines[i] = &facets[i]->corners[0].x;
        const LineColumns columns = columns_of(lines);
        corners = {vector_at(columns, 0), vector_at(columns, 3), vector_at(columns, 6)};
        normal = vector_at(columns, 9);
        reach = columns[12], area = columns[13], smooth = columns[14];
    }
};

/// What a smooth or textured one needs besides, in another.
struct alignas(64) FacetShading {
    std::array<vec3, 3> normals;
    std::array<vec2, 3> uvs;
};

struct Mesh {
    // One vertex more than there are: Embree reads 16 bytes at the last one.
    std::vector<vec3> vertices;
    std::vector<vec3> normals;  // unit, one a vertex, or empty: flat
    std::vector<vec2> uvs;      // one a vertex, or empty; v = 0 is the bottom of an image
    std::vector<std::array<uint32_t, 3>> triangles;
    uint32_t material = 0;

    // Made of these by `pack`, one a triangle. They lie with those of the other meshes, as small arrays would not have
    // huge pages.
    std::span<Facet> facets;
    std::span<FacetShading> shading;  // empty where there are neither normals nor uvs

    /// Coordinates beyond this are refused: the square of a triangle's area must fit single precision.
    static constexpr float FARTHEST = 1e9f;

    size_t vertex_count() const { return vertices.size() - 1; }

    bool has_shading() const { return !normals.empty() || !uvs.empty(); }

    /// Fills memory for as many as there are triangles, or none where the mesh has no shading. Must be called before
    /// anything of the below. Works on all cores.
    void pack(std::span<Facet> facet_memory, std::span<FacetShading> shading_memory);

    /// Asks for what a hit of the triangle will want to know.
    void prefetch(uint32_t triangle) const {
        etendue::prefetch(&facets[triangle]);
        if (!shading.empty()) etendue::prefetch(&shading[triangle]);
    }

    /// The texture coordinates at barycentrics (b1, b2); the barycentrics themselves where the mesh has none.
    vec2 uv(uint32_t triangle, const vec2& b) const {
        if (uvs.empty()) return b;
        const auto& [uv0, uv1, uv2] = shading[triangle].uvs;
        return (1 - b.x - b.y) * uv0 + b.x * uv1 + b.y * uv2;
    }
};

}  // namespace etendue
