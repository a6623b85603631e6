#include "gi/hit.h"

#include "gi/light.h"

namespace etendue {

namespace {

/// The normal mapped by a tangent-space texture; the tangent follows the texture's u.
vec3 mapped_normal(const Texture& texture, const Mesh& mesh, uint32_t triangle, const vec2& uv,
                   const vec3& normal) {
    if (mesh.uvs.empty()) return normal;
    const auto [p0, p1, p2] = mesh.corners(triangle);
    const auto& [i, j, k] = mesh.triangles[triangle];
    const vec2 duv1 = mesh.uvs[j] - mesh.uvs[i], duv2 = mesh.uvs[k] - mesh.uvs[i];
    const float determinant = duv1.x * duv2.y - duv1.y * duv2.x;
    if (determinant == 0) return normal;
    const vec3 dpdu = ((p1 - p0) * duv2.y - (p2 - p0) * duv1.y) / determinant;
    const vec3 dpdv = ((p2 - p0) * duv1.x - (p1 - p0) * duv2.x) / determinant;
    const vec3 tangent = dpdu - glm::dot(dpdu, normal) * normal;
    if (length2(tangent) == 0) return normal;
    const vec3 s = glm::normalize(tangent);
    vec3 t = glm::cross(normal, s);
    if (glm::dot(t, dpdv) < 0) t = -t;
    const vec3 local = texture.normal(uv);
    return glm::normalize(local.x * s + local.y * t + local.z * normal);
}

}  // namespace

SurfaceHit::SurfaceHit(const Ray& ray, float distance, const Mesh& mesh, uint32_t triangle, const vec2& b,
                       const Material& material, const Light* light)
    : valid(true),
      wo(-ray.direction),
      distance(distance),
      point(mesh.point(triangle, b)),
      uv(mesh.uv(triangle, b)),
      mesh(&mesh),
      material(&material),
      light(light) {
    front = glm::dot(point.normal, wo) > 0;
    set_shading_frame(mesh, triangle, b);
    surface = {material.albedo_at(uv), material.ior,    material.roughness,
               material.absorb,        material.coated, front};
}

void SurfaceHit::set_shading_frame(const Mesh& mesh, uint32_t triangle, const vec2& b) {
    vec3 n = point.normal;
    if (!mesh.normals.empty()) {
        const auto& [i, j, k] = mesh.triangles[triangle];
        const vec3 smooth = (1 - b.x - b.y) * mesh.normals[i] + b.x * mesh.normals[j] + b.y * mesh.normals[k];
        if (length2(smooth) > 0) n = glm::normalize(smooth);
        if (glm::dot(n, point.normal) < 0) n = -n;
    }
    if (material->normal_texture) n = mapped_normal(*material->normal_texture, mesh, triangle, uv, n);
    if (!front) {
        point.normal = -point.normal;
        n = -n;
    }
    // Seen at a grazing angle a shading normal would mirror the view into the surface, or even face away from
    // it.  It is bent just so far that the mirrored direction clears the surface: no black rims, and wo.z >
    // 0.
    const vec3 mirrored = 2 * glm::dot(n, wo) * n - wo;
    const float above = glm::dot(mirrored, point.normal);
    const float least = std::min(0.01f, 0.9f * glm::dot(wo, point.normal));
    if (above < least) n = glm::normalize(wo + glm::normalize(mirrored + (least - above) * point.normal));
    frame = Frame(n);
}

vec3 SurfaceHit::Le() const {
    if (!light) return vec3(0);
    return valid ? light->Le(*this) : light->Le(-wo);
}

vec3 SurfaceHit::f(const vec3& wi) const {
    const vec3 local = frame.to_local(wi);
    if ((local.z > 0) != (glm::dot(wi, point.normal) > 0)) return vec3(0);
    return bsdf_f(material->bsdf, surface, frame.to_local(wo), local);
}

float SurfaceHit::pdf(const vec3& wi) const {
    const vec3 local = frame.to_local(wi);
    if ((local.z > 0) != (glm::dot(wi, point.normal) > 0)) return 0;
    return bsdf_pdf(material->bsdf, surface, frame.to_local(wo), local);
}

std::optional<BsdfSample> SurfaceHit::sample(float lobe, const vec2& u) const {
    auto sample = bsdf_sample(material->bsdf, surface, frame.to_local(wo), lobe, u);
    if (!sample) return std::nullopt;
    const bool above = sample->wi.z > 0;
    sample->wi = frame.to_world(sample->wi);
    if (above != (glm::dot(sample->wi, point.normal) > 0)) return std::nullopt;
    return sample;
}

}  // namespace etendue
