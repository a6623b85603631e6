#include "gi/mesh.h"

#include <oneapi/tbb/parallel_for.h>

namespace etendue {

namespace {

/// glm's takes a branch for each number, by signs that nothing foretells.
vec3 absolute(const vec3& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

/// Whether two unit vectors are the same but for rounding.
bool are_same(const vec3& a, const vec3& b) {
    return max_component(absolute(a - b)) <= 8 * std::numeric_limits<float>::epsilon();
}

}  // namespace

Facet::Facet(const vec3& v0, const vec3& v1, const vec3& v2) : smooth(0) {
    corners = {v0, v1, v2};
    const vec3 edge1 = v1 - v0, edge2 = v2 - v0;
    const float size = std::max(max_component(absolute(edge1)), max_component(absolute(edge2)));
    // Scaled first: the square of a small triangle's area would underflow to a normal of NaN.
    normal = glm::normalize(glm::cross(edge1 / size, edge2 / size));
    // A point at barycentrics is off by the rounding of their sum (pbrt 4th ed., 6.8.4), a ray's origin beside it by
    // that of another, and by the intersection test's, which subtracts corners from the ray's origin and so rounds
    // at the size of the triangle.  The last is what keeps a ray off a wall that lies in a coordinate plane, where
    // the sums are exact.
    const vec3 farthest = glm::max(absolute(v0), glm::max(absolute(v1), absolute(v2)));
    const vec3 error = error_bound(9) * farthest + error_bound(4) * size;
    reach = glm::dot(absolute(normal), error);
    area = glm::length(glm::cross(edge1, edge2)) / 2;
}

void Mesh::pack(std::span<Facet> facet_memory, std::span<FacetShading> shading_memory) {
    facets = facet_memory;
    shading = shading_memory;
    const auto pack_one = [&](size_t t) {
        const auto& [i, j, k] = triangles[t];
        // In place: copies would wait for what was just written.
        Facet& facet = *std::construct_at(&facets[t], vertices[i], vertices[j], vertices[k]);
        if (shading.empty()) return;
        const vec3 normal = facet.normal;
        bool smooth = false;
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = triangles[t][corner];
            if (!normals.empty()) {
                shading[t].normals[corner] = normals[vertex];
                smooth |= !are_same(normals[vertex], normal);
            }
            if (!uvs.empty()) shading[t].uvs[corner] = uvs[vertex];
        }
        facet.smooth = smooth ? 1.f : 0.f;
    };
    constexpr size_t BLOCK = 4096;
    oneapi::tbb::parallel_for(size_t{0}, (triangles.size() + BLOCK - 1) / BLOCK, [&](size_t block) {
        const size_t end = std::min(triangles.size(), (block + 1) * BLOCK);
        for (size_t t = block * BLOCK; t < end; ++t) pack_one(t);
    });
}

}  // namespace etendue
