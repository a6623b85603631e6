#include "gi/hit.h"

#include "gi/light.h"

namespace etendue {

namespace {

/// The normal mapped by a tangent-space texture; the tangent follows the texture's u.
vec3 mapped_normal(const Texture& texture, const Mesh& mesh, uint32_t triangle, const vec2& uv,
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
    const vec3 local = texture.normal(uv);
    return glm::normalize(local.x * s + local.y * t + local.z * normal);
}

}  // namespace

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
    const bool is_flat = !mesh.facets[triangle].smooth && !material.normal_texture;
    frame = Frame(is_flat ? point.normal : shading_normal());
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

vec3 SurfaceHit::shading_normal() const {
    const vec2& b = barycentrics;
    // As the mesh has it, on the front.
    const vec3 geometric = front ? point.normal : -point.normal;
    vec3 n = geometric;
    if (mesh->facets[triangle].smooth) {
        const auto& [n0, n1, n2] = mesh->shading[triangle].normals;
        const vec3 smooth = (1 - b.x - b.y) * n0 + b.x * n1 + b.y * n2;
        if (length2(smooth) > 0) n = glm::normalize(smooth);
        if (glm::dot(n, geometric) < 0) n = -n;
    }
    if (material->normal_texture) n = mapped_normal(*material->normal_texture, *mesh, triangle, uv(), n);
    if (!front) n = -n;
    // Seen at a grazing angle a shading normal would mirror the view into the surface, or even face away from
    // it.  It is bent just so far that the mirrored direction clears the surface: no black rims, and wo.z >
    // 0.
    const vec3 mirrored = 2 * glm::dot(n, wo) * n - wo;
    const float above = glm::dot(mirrored, point.normal);
    const float least = std::min(0.01f, 0.9f * glm::dot(wo, point.normal));
    if (above >= least) return n;
    return glm::normalize(wo + glm::normalize(mirrored + (least - above) * point.normal));
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

std::optional<BsdfSample> SurfaceHit::sample(float lobe, const vec2& u) const {
    // One variable is what every path returns, so that it is never copied.
    auto sample = bsdf_sample(material->bsdf, surface(), wo_local, lobe, u);
    if (!sample) return sample;
    const bool above = sample->wi.z > 0;
    sample->wi = frame.to_world(sample->wi);
    if (above != (glm::dot(sample->wi, point.normal) > 0)) sample.reset();
    return sample;
}

}  // namespace etendue
