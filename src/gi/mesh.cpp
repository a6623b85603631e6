#include "gi/mesh.h"

namespace etendue {

namespace {

/// Whether two unit vectors are the same but for rounding.
bool are_same(const vec3& a, const vec3& b) {
    return max_component(glm::abs(a - b)) <= 8 * std::numeric_limits<float>::epsilon();
}

}  // namespace

Facet::Facet(const std::array<vec3, 3>& corners) : corners(corners) {
    const auto& [v0, v1, v2] = corners;
    const vec3 edge1 = v1 - v0, edge2 = v2 - v0;
    const float size = std::max(max_component(glm::abs(edge1)), max_component(glm::abs(edge2)));
    // Scaled first: the square of a small triangle's area would underflow to a normal of NaN.
    normal = glm::normalize(glm::cross(edge1 / size, edge2 / size));
    // A point at barycentrics is off by the rounding of their sum (pbrt 4th ed., 6.8.4), a ray's origin beside it by
    // that of another, and by the intersection test's, which subtracts corners from the ray's origin and so rounds
    // at the size of the triangle.  The last is what keeps a ray off a wall that lies in a coordinate plane, where
    // the sums are exact.
    const vec3 farthest = glm::max(glm::abs(v0), glm::max(glm::abs(v1), glm::abs(v2)));
    const vec3 error = error_bound(9) * farthest + error_bound(4) * size;
    reach = glm::dot(glm::abs(normal), error);
}

void Mesh::pack() {
    facets.clear();
    shading.clear();
    facets.reserve(triangles.size());
    for (const auto& [i, j, k] : triangles) {
        facets.emplace_back(std::array{vertices[i], vertices[j], vertices[k]});
    }
    if (normals.empty() && uvs.empty()) return;
    shading.resize(triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = triangles[t][corner];
            if (!normals.empty()) {
                shading[t].normals[corner] = normals[vertex];
                facets[t].smooth |= !are_same(normals[vertex], facets[t].normal);
            }
            if (!uvs.empty()) shading[t].uvs[corner] = uvs[vertex];
        }
    }
}

}  // namespace etendue
