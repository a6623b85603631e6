// A triangle mesh of one material, as arrays.
#pragma once

#include <array>
#include <vector>

#include "gi/ray.h"

namespace etendue {

struct Mesh {
    // One vertex more than there are: Embree reads 16 bytes at the last one.
    std::vector<vec3> vertices;
    std::vector<vec3> normals;  // unit, one a vertex, or empty: flat
    std::vector<vec2> uvs;      // one a vertex, or empty; v = 0 is the bottom of an image
    std::vector<std::array<uint32_t, 3>> triangles;
    uint32_t material = 0;

    /// Coordinates beyond this are refused: the square of a triangle's area must fit single precision.
    static constexpr float FARTHEST = 1e9f;

    size_t vertex_count() const { return vertices.size() - 1; }

    std::array<vec3, 3> corners(uint32_t triangle) const {
        const auto& [a, b, c] = triangles[triangle];
        return {vertices[a], vertices[b], vertices[c]};
    }

    float area(uint32_t triangle) const {
        const auto [a, b, c] = corners(triangle);
        return glm::length(glm::cross(b - a, c - a)) / 2;
    }

    /// The texture coordinates at barycentrics (b1, b2); the barycentrics themselves where the mesh has none.
    vec2 uv(uint32_t triangle, const vec2& b) const {
        if (uvs.empty()) return b;
        const auto& [i, j, k] = triangles[triangle];
        return (1 - b.x - b.y) * uvs[i] + b.x * uvs[j] + b.y * uvs[k];
    }

    /// The point at barycentrics (b1, b2), its geometric normal, and a bound on its error: that of the sum
    /// below (pbrt 4th ed., 6.8.4), and that of the intersection test, which subtracts corners from the ray's
    /// origin and so rounds at the size of the triangle.  The second is what keeps a ray off a wall that lies
    /// in a coordinate plane, where the sum is exact.
    SurfacePoint point(uint32_t triangle, const vec2& b) const {
        const auto [v0, v1, v2] = corners(triangle);
        const vec3 p0 = (1 - b.x - b.y) * v0, p1 = b.x * v1, p2 = b.y * v2;
        const vec3 edge1 = v1 - v0, edge2 = v2 - v0;
        const float size = std::max(max_component(glm::abs(edge1)), max_component(glm::abs(edge2)));
        return {p0 + p1 + p2,
                error_bound(7) * (glm::abs(p0) + glm::abs(p1) + glm::abs(p2)) + error_bound(4) * size,
                // Scaled first: the square of a small triangle's area would underflow to a normal of NaN.
                glm::normalize(glm::cross(edge1 / size, edge2 / size))};
    }
};

}  // namespace etendue
