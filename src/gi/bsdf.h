// The contract of a BSDF.  Each lives in a file of its own in bsdfs/, is found there by the build, and is
// listed with its material types wherever materials are named.
//
// Everything is in the local frame of the hit: z is the shading normal on the side of `wo`, so wo.z > 0; both
// directions point away from the surface; wi.z < 0 is transmission.  `f` excludes the cosine.  For one
// `Surface`,
//     sample().weight == f(wo, wi) |wi.z| / pdf(wo, wi)    and    sample() has the density pdf,
// but for delta lobes, whose f and pdf are 0 and whose weight is the whole truth.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "gi/material.h"
#include "gi/sampling.h"

namespace etendue {

enum BrdfType : uint8_t {
    BRDF_DIFFUSE = 1,
    BRDF_GLOSSY = 2,
    BRDF_SPECULAR = 4,  // a Dirac delta
    BRDF_TRANSMISSION = 8,
};

/// The parameters of a BSDF at a point: the material with its textures looked up.
struct Surface {
    vec3 albedo{0.8f};
    float ior = 1.5f;
    float roughness = 0.1f;
    float absorb = 0;
    bool coated = false;
    bool front = true;  // wo is on the side that the geometric normal points to

    /// The colour of a lobe of the coat: the albedo tints it unless the material is `coated`.
    vec3 tint() const { return coated ? vec3(1) : albedo; }
    /// Index of refraction of the far side over that of wo's side.
    float eta() const { return front ? ior : 1 / ior; }
};

struct BsdfSample {
    vec3 wi;
    vec3 weight;     // f |cos| / pdf
    float pdf;       // solid angle; for a delta lobe the probability of choosing it
    uint8_t type;    // of the lobe that was chosen
    float eta2 = 1;  // squared relative index crossed by refraction, which `weight` divided radiance by

    bool is_delta() const { return type & BRDF_SPECULAR; }
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

    /// What of the light that arrives leaves again, about, and from nowhere in particular: for pictures of
    /// materials and for denoising, never for transport.
    static vec3 albedo(const Surface& surface) { return surface.albedo; }
    static vec3 f(const Surface&, const vec3& /*wo*/, const vec3& /*wi*/) { return vec3(0); }
    static float pdf(const Surface&, const vec3& /*wo*/, const vec3& /*wi*/) { return 0; }
    /// `lobe` and `u` are uniform in [0, 1). Empty: nothing goes on from here.
    static std::optional<BsdfSample> sample(const Surface&, const vec3& /*wo*/, float /*lobe*/,
                                            const vec2& /*u*/) {
        return std::nullopt;
    }
};

// The same for a BSDF chosen at run time.
vec3 bsdf_albedo(BsdfKind kind, const Surface& surface);
vec3 bsdf_f(BsdfKind kind, const Surface& surface, const vec3& wo, const vec3& wi);
float bsdf_pdf(BsdfKind kind, const Surface& surface, const vec3& wo, const vec3& wi);
std::optional<BsdfSample> bsdf_sample(BsdfKind kind, const Surface& surface, const vec3& wo, float lobe,
                                      const vec2& u);
bool bsdf_is_delta(BsdfKind kind);

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
