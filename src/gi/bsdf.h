// The contract of a BSDF.  Each lives in a file of its own in bsdfs/, is found there by the build, and is
// listed with its material types wherever materials are named.
//
// Everything is in the local frame of the hit: z is the shading normal on the side of `wo`, so wo.z > 0; both
// directions point away from the surface; wi.z < 0 is transmission.  `f` excludes the cosine.  For one
// `Surface`,
//     sample().weight == f(wo, wi) |wi.z| / pdf(wo, wi)    and    sample() has the density pdf,
// but for delta lobes, whose f and pdf are 0 and whose weight is the whole truth.
//
// Everything is for one surface and pair of directions, or for as many as Lanes hold, see gi/lanes.h.
#pragma once

#include <span>
#include <string_view>

#include "gi/material.h"
#include "gi/sampling.h"

namespace etendue {

enum BrdfType : uint8_t {
    BRDF_TRANSMISSION = 1,
    BRDF_DIFFUSE = 2,
    BRDF_GLOSSY = 4,
    BRDF_SPECULAR = 8,  // a Dirac delta
};

/// The parameters of a BSDF at a point: the material with its textures looked up.
template <class F>
struct SurfaceOf {
    Vec3<F> albedo{0.8f};
    F ior = 1.5f;
    F roughness = 0.1f;
    F absorb = 0;
    Mask<F> coated{false};
    Mask<F> front{true};  // wo is on the side that the geometric normal points to

    /// The colour of a lobe of the coat: the albedo tints it unless the material is `coated`.
    Vec3<F> tint() const { return select(coated, Vec3<F>(1), albedo); }
    /// Index of refraction of the far side over that of wo's side.
    F eta() const { return select(front, ior, 1 / ior); }
};
using Surface = SurfaceOf<float>;

template <class F>
struct BsdfSampleOf {
    Mask<F> exists{false};  // else nothing goes on from here, and the rest means nothing
    Vec3<F> wi{0};
    Vec3<F> weight{0};  // f |cos| / pdf
    F pdf = 0;          // solid angle; for a delta lobe the probability of choosing it
    F type = 0;         // of the lobe that was chosen: BRDF_ bits, as a number
    F eta2 = 1;         // squared relative index crossed by refraction, which `weight` divided radiance by

    Mask<F> is_delta() const { return type >= BRDF_SPECULAR; }
};
using BsdfSample = BsdfSampleOf<float>;

/// For one pair of directions.
template <class F>
struct BsdfValueOf {
    Vec3<F> f{0};
    F pdf = 0;
};

/// A material type of the scene file: text that its name may contain, and what it sets where a patch does
/// not.
struct MaterialType {
    static constexpr float KEEP = -1;

    std::string_view name;
    std::string_view summary;
    int order;                             // types are tried in this order; the first match decides
    std::string_view match[2] = {"", ""};  // lower case; none: matches everything
    float ior = KEEP;
    float absorb = KEEP;
    float roughness = KEEP;
    float emissive_strength = KEEP;  // where the mesh gives none
    float albedo[3] = {KEEP, KEEP, KEEP};
};

/// The roughness of a highlight that the scene file's authors gave as a Phong exponent.
constexpr float roughness_of_exponent(float n) {
    // sqrt(2 / (n + 2)) by Newton's iteration, as std::sqrt is no constant expression.
    const float x = 2 / (n + 2);
    float root = 1;
    for (int i = 0; i < 30; ++i) root = (root + x / root) / 2;
    return root;
}

/// What a BSDF's file declares: `struct Name : Bsdf` with the members below, hiding these defaults where they
/// do not fit.
struct Bsdf {
    // static constexpr std::string_view name, summary;
    // static constexpr MaterialType types[];
    static constexpr bool is_delta = false;       // all of its lobes are
    static constexpr bool is_reciprocal = false;  // f(wo, wi) == f(wi, wo)

    /// The diffuse part: f(wo, wi) = diffuse_share(ior, wo.z) albedo / pi + the rest, which is nowhere negative, for wi on
    /// wo's side of the surface.
    template <class F>
    static F diffuse_share(const F& /*ior*/, const F& /*cos_o*/) {
        return 0;
    }
    /// What of the light that arrives leaves again, about, and from nowhere in particular: for pictures of
    /// materials and for denoising, never for transport.
    static vec3 albedo(const Surface& surface) { return surface.albedo; }
    template <class F>
    static Vec3<F> f(const SurfaceOf<F>&, const Vec3<F>& /*wo*/, const Vec3<F>& /*wi*/) {
        return Vec3<F>(0);
    }
    template <class F>
    static F pdf(const SurfaceOf<F>&, const Vec3<F>& /*wo*/, const Vec3<F>& /*wi*/) {
        return 0;
    }
    /// `lobe` and `u` are uniform in [0, 1).
    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>&, const Vec3<F>& /*wo*/, const F& /*lobe*/,
                                  const Vec2<F>& /*u*/) {
        return {};
    }
};

// The same for a BSDF chosen at run time.
vec3 bsdf_albedo(BsdfKind kind, const Surface& surface);
vec3 bsdf_f(BsdfKind kind, const Surface& surface, const vec3& wo, const vec3& wi);
float bsdf_pdf(BsdfKind kind, const Surface& surface, const vec3& wo, const vec3& wi);
BsdfSample bsdf_sample(BsdfKind kind, const Surface& surface, const vec3& wo, float lobe, const vec2& u);
float bsdf_diffuse_share(BsdfKind kind, float ior, float cos_o);
bool bsdf_is_delta(BsdfKind kind);

// And for as many surfaces as there are lanes, each of a kind of its own, given as a number; 0 where a lane is off.
BsdfValueOf<Lanes> bsdf_values(const LaneMask& on, const Lanes& kinds, const SurfaceOf<Lanes>& surfaces,
                               const LaneVec3& wo, const LaneVec3& wi);
BsdfSampleOf<Lanes> bsdf_samples(const LaneMask& on, const Lanes& kinds, const SurfaceOf<Lanes>& surfaces,
                                 const LaneVec3& wo, const Lanes& lobe, const LaneVec2& u);
Lanes bsdf_diffuse_shares(const LaneMask& on, const Lanes& kinds, const Lanes& iors, const Lanes& cos_o);

/// The registry: every BSDF, its kind being its index here, and every material type in matching order.
struct BsdfInfo {
    std::string_view name, summary;
    bool is_delta, is_reciprocal;
};
std::span<const BsdfInfo> bsdfs();
struct NamedMaterialType {
    MaterialType type;
    BsdfKind bsdf;
};
std::span<const NamedMaterialType> material_types();

/// The kind of a material type or BSDF by name. Throws std::invalid_argument where there is none.
BsdfKind bsdf_of(std::string_view name);

}  // namespace etendue
