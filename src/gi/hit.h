// What a ray found: the point, its surface ready to be shaded, and the light that shines from there.
#pragma once

#include "gi/bsdf.h"
#include "gi/material.h"
#include "gi/mesh.h"
#include "gi/microfacet.h"
#include "gi/ray.h"

namespace etendue {

class Light;

/// Seen at a grazing angle a shading normal would mirror the view into the surface, or even face away from it. It is bent
/// just so far that the mirrored direction clears the surface: no black rims, and wo.z > 0. All unit, and `geometric` on
/// the side of wo.
template <class V, class F = NumberOf<V>>
struct ClearNormal {
    ClearNormal(const V& normal, const V& wo, const V& geometric) : n(normal) {
        const V mirror = mirrored(wo, normal);
        const F above = dot(mirror, geometric);
        const F least = min(F(0.01f), 0.9f * dot(wo, geometric));
        is_bent = above < least;
        if (!any(is_bent)) return;
        n = select(is_bent, normalize(wo + normalize(mirror + (least - above) * geometric)), normal);
    }

    V n;
    Mask<F> is_bent;
};

/// Whether light that a delta BSDF sends from wi to wo would take the same way back: the shading normal is bent for neither
/// of them, neither for wo, where it `is_bent` or not, nor for wi. `normal` and `geometric` on the side of wo.
template <class V, class F = NumberOf<V>>
Mask<F> is_reversible(const Mask<F>& is_bent, const V& normal, const V& geometric, const V& wi) {
    const F side = select(dot(wi, geometric) > 0, F(1), F(-1));
    return !is_bent && !ClearNormal<V>(side * normal, wi, side * geometric).is_bent;
}

/// The normal mapped by a material's texture around the unit normal `normal` of a triangle's front.
vec3 mapped_normal(const Material& material, const Mesh& mesh, uint32_t triangle, const vec2& barycentrics,
                   const vec3& normal);

/// The exercise's SurfaceInteraction. Where the ray left the scene `valid` is false, and `light` is the sky,
/// if there is one.
struct SurfaceHit {
    bool valid = false;
    bool front = false;         // wo is on the side that the geometric normal points to
    vec3 wo{0, 0, 1};           // unit, world: back along the ray
    float distance = INFINITE;  // from the ray's origin
    SurfacePoint point;         // its normal is geometric and on the side of wo
    Frame frame;                // around the shading normal, on the side of wo
    const Material* material = nullptr;
    const Light* light = nullptr;
    vec3 wo_local{0, 0, 1};  // wo in `frame`
    bool is_bent = false;    // the shading normal, see ClearNormal
    const Mesh* mesh = nullptr;
    uint32_t triangle = 0;
    vec2 barycentrics{0};  // (b1, b2) of the hit in the triangle

    SurfaceHit() = default;
    /// A ray's miss; `sky` may be null.
    SurfaceHit(const Ray& ray, const Light* sky) : wo(-ray.direction), light(sky) {}
    /// A ray's hit of a triangle at barycentrics (b1, b2); `light` is the mesh's, or null.
    SurfaceHit(const Ray& ray, float distance, const Mesh& mesh, uint32_t triangle, const vec2& b,
               const Material& material, const Light* light);

    /// Whether light may come from here. `Le` tells how much.
    bool is_light() const { return light != nullptr; }
    /// Whether the BSDF is of this type, e.g. BRDF_SPECULAR: a pure Dirac delta, which no light can be
    /// sampled for.
    bool is_type(BrdfType type) const { return type == BRDF_SPECULAR && bsdf_is_delta(material->bsdf); }
    /// Texture coordinates; not of a miss.
    vec2 uv() const { return mesh->uv(triangle, barycentrics); }
    /// Radiance emitted towards wo.
    vec3 Le() const;

    /// What the BSDF sees, the texel of its colour included.
    const Surface& surface() const {
        if (colour_texture_) read_colour();
        return surface_;
    }

    /// The BSDF's, see there.
    vec3 albedo() const { return bsdf_albedo(material->bsdf, surface()); }

    // The BSDF in world directions.  A direction that is above the surface for one of the shading and the
    // geometric normal, and below for the other, carries no light: f, pdf and sample agree on that.
    vec3 f(const vec3& wi) const;
    float pdf(const vec3& wi) const;
    BsdfSample sample(float lobe, const vec2& u) const;

    /// The ray that leaves this point in a unit direction.
    Ray ray_towards(const vec3& wi) const { return {point.offset_towards(wi), wi}; }

  private:
    /// On the side of wo.
    ClearNormal<vec3> shading_normal() const;
    void read_colour() const;

    // The texture is asked for the colour when the hit is made, and read when the BSDF is first needed: by then, after
    // a light has been chosen, it has come from memory.
    mutable Surface surface_;
    mutable const Texture* colour_texture_ = nullptr;  // null: the colour is known
};

}  // namespace etendue
