#include "gi/hit.h"

#include "gi/light.h"

namespace etendue {

// The tangent follows the texture's u.
vec3 mapped_normal(const Material& material, const Mesh& mesh, uint32_t triangle, const vec2& barycentrics,
                   const vec3& normal) {
    if (mesh.uvs.empty()) return normal;
    const auto& [p0, p1, p2] = mesh.facets[triangle].corners;
    const auto& [uv0, uv1, uv2] = mesh.shading[triangle].uvs;
    const vec2 duv1 = uv1 - uv0, duv2 = uv2 - uv0;
    const float determinant = duv1.x * duv2.y - duv1.y * duv2.x;
    if (determinant == 0) return normal;
    const vec3 dpdu = ((p1 - p0) * duv2.y - (p2 - p0) * duv1.y) / determinant;
    const vec3 dpdv = ((p2 - p0) * duv1.x - (p1 - p0) * duv2.x) / determinant;
    const vec3 tangent = dpdu - glm::dot(dpdu, normal) * normal;
    if (length2(tangent) == 0) return normal;
    const vec3 s = glm::normalize(tangent);
    vec3 t = glm::cross(normal, s);
    if (glm::dot(t, dpdv) < 0) t = -t;
    const vec3 local = material.normal_texture->normal(mesh.uv(triangle, barycentrics));
    return glm::normalize(local.x * s + local.y * t + local.z * normal);
}

SurfaceHit::SurfaceHit(const Ray& ray, float distance, const Mesh& mesh, uint32_t triangle, const vec2& b,
                       const Material& material, const Light* light)
    : valid(true),
      wo(-ray.direction),
      distance(distance),
      point(mesh.facets[triangle].point(b)),
      material(&material),
      light(light),
      mesh(&mesh),
      triangle(triangle),
      barycentrics(b) {
    if (material.albedo_texture) {
        colour_texture_ = material.albedo_texture;
        colour_texture_->prefetch(uv());
    }
    front = glm::dot(point.normal, wo) > 0;
    if (!front) point.normal = -point.normal;
    const bool is_flat = mesh.facets[triangle].smooth == 0 && !material.normal_texture;
    if (is_flat) {
        frame = Frame(point.normal);
    } else {
        const ClearNormal<vec3> normal = shading_normal();
        frame = Frame(normal.n);
        is_bent = normal.is_bent;
    }
    wo_local = frame.to_local(wo);
    surface_.albedo = material.albedo;
    surface_.ior = material.ior;
    surface_.roughness = material.roughness;
    surface_.absorb = material.absorb;
    surface_.coated = material.coated;
    surface_.front = front;
}

void SurfaceHit::read_colour() const {
    surface_.albedo = colour_texture_->colour(uv());
    colour_texture_ = nullptr;
}

ClearNormal<vec3> SurfaceHit::shading_normal() const {
    const vec2& b = barycentrics;
    // As the mesh has it, on the front.
    const vec3 geometric = front ? point.normal : -point.normal;
    vec3 n = geometric;
    if (mesh->facets[triangle].smooth > 0) {
        const auto& [n0, n1, n2] = mesh->shading[triangle].normals;
        const vec3 smooth = (1 - b.x - b.y) * n0 + b.x * n1 + b.y * n2;
        if (length2(smooth) > 0) n = glm::normalize(smooth);
        if (glm::dot(n, geometric) < 0) n = -n;
    }
    if (material->normal_texture) n = mapped_normal(*material, *mesh, triangle, b, n);
    return {front ? n : -n, wo, point.normal};
}

vec3 SurfaceHit::Le() const {
    if (!light) return vec3(0);
    return valid ? light->Le(*this) : light->Le(-wo);
}

vec3 SurfaceHit::f(const vec3& wi) const {
    const vec3 local = frame.to_local(wi);
    if ((local.z > 0) != (glm::dot(wi, point.normal) > 0)) return vec3(0);
    return bsdf_f(material->bsdf, surface(), wo_local, local);
}

float SurfaceHit::pdf(const vec3& wi) const {
    const vec3 local = frame.to_local(wi);
    if ((local.z > 0) != (glm::dot(wi, point.normal) > 0)) return 0;
    return bsdf_pdf(material->bsdf, surface(), wo_local, local);
}

BsdfSample SurfaceHit::sample(float lobe, const vec2& u) const {
    BsdfSample sample = bsdf_sample(material->bsdf, surface(), wo_local, lobe, u);
    const bool above = sample.wi.z > 0;
    sample.wi = frame.to_world(sample.wi);
    if (above != (glm::dot(sample.wi, point.normal) > 0)) sample.exists = false;
    return sample;
}

}  // namespace etendue
