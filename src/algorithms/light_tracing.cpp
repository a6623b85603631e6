#include "algorithms/light_tracing.h"

#include <bit>
#include <map>
#include <numeric>
#include <unordered_map>

namespace etendue {

namespace {

constexpr uint32_t ROUNDS = 4;  // of trials

bool is_delta(const Scene& scene, const Mesh& mesh) {
    return bsdf_is_delta(scene.materials()[mesh.material].bsdf);
}

using Corners = std::array<float, 9>;
struct CornersHash {
    size_t operator()(const Corners& corners) const {
        uint64_t bits = 0;
        for (const float x : corners) bits = mix_bits(bits + std::bit_cast<uint32_t>(x));
        return bits;
    }
};
Corners corners_in_order(const Facet& facet) {
    std::array<std::array<float, 3>, 3> corners;
    for (int i = 0; i < 3; ++i) corners[i] = {facet.corners[i].x, facet.corners[i].y, facet.corners[i].z};
    std::ranges::sort(corners);
    Corners out;
    for (size_t i = 0; i < 9; ++i) out[i] = corners[i / 3][i % 3];
    return out;
}

}  // namespace

bool LightTracing::may_pay(const Scene& scene) {
    return !scene.lights().empty() &&
           std::ranges::any_of(scene.meshes(), [&](const Mesh& mesh) { return is_delta(scene, mesh); });
}

LightTracing::Trial LightTracing::trace(Context& context, uint32_t number, uint32_t paths) const {
    // A point g of a delta surface. Neighbours are near each other, so that what they read is in the cache.
    const double stratum = number + double{context.sampler.next_1d()};
    const Distribution1D::Choice choice = choice_.sample(std::min(stratum / paths, 1 - 0x1p-52));
    const auto [mesh_index, triangle, place] = triangles_[choice.index];
    Trial trial{place, area_densities_[place]};
    const Mesh& mesh = scene_->meshes()[mesh_index];
    const Material& material = scene_->materials()[mesh.material];
    const vec2 barycentrics = uniform_triangle(context.sampler.next_2d());
    const SurfacePoint g = mesh.facets[triangle].point(barycentrics);
    const vec2 u_lens = context.sampler.next_2d();
    if (material.cutout_texture && material.is_cut_out(mesh.uv(triangle, barycentrics))) return trial;

    // A light from there.
    context.sampler.start_vertex(1);
    const float finer_digits = context.sampler.next_1d();
    const vec2 u = context.sampler.next_2d();
    const auto light =
        scene_->sample_light_source(kind_, g.position, light_number(u.x, finer_digits), &light_factors_);
    if (!light) return trial;
    trial.of_triangles = light->light->mesh() != nullptr;
    const float triangles_share = light_factors_.triangles_share;
    trial.kind_share = trial.of_triangles ? triangles_share : 1 - triangles_share;
    const LightSample sample =
        light->light->sample_Li(g.position, light->triangle, {light->remapped, u.y}, mis_ != Mis::none);
    if (!sample.exists || is_black(sample.radiance) || !context.visible(shadow_ray(g, sample))) return trial;
    SurfaceHit hit({g.position + sample.wi, -sample.wi}, 1, mesh, triangle, barycentrics, material, nullptr);

    // The light's way to a surface that is none.
    const float cos_g = std::abs(dot(sample.wi, g.normal));
    trial.density = light->pmf * sample.pdf * area_densities_[place] / cos_g;
    trial.radiance = sample.radiance / trial.density;
    trial.edges = 2;
    Ray ray;
    do {
        context.sampler.start_vertex(static_cast<uint32_t>(trial.edges));
        const BsdfSample bounce = context.bounce(hit);
        if (!bounce.exists || !is_reversible(hit.is_bent, hit.frame.n, hit.point.normal, bounce.wi))
            return trial;
        const auto cos_ratio = [&](const vec3& direction) {
            return std::abs(dot(direction, hit.point.normal) / dot(direction, hit.frame.n));
        };
        // Without what refraction does to radiance, as it undoes that to the solid angle.
        const vec3 tint = bounce.weight * bounce.eta2;
        trial.radiance *= tint * (cos_ratio(bounce.wi) / cos_ratio(hit.wo));
        ray = hit.ray_towards(bounce.wi);
        if (++trial.edges > max_edges_ || is_black(trial.radiance)) return trial;
        hit = context.intersect(ray);
        if (!hit.valid) return trial;
    } while (hit.is_type(BRDF_SPECULAR));

    // To the camera, which sees that surface in its own way.
    const auto view = camera_->view_of(hit.point.position, u_lens);
    if (!view) return trial;
    const SurfaceHit x({view->origin, view->direction}, view->distance, *hit.mesh, hit.triangle,
                       hit.barycentrics, *hit.material, hit.light);
    const vec3 wi = -ray.direction;
    const vec3 f = x.f(wi);
    if (is_black(f)) return trial;
    const vec3 origin = x.point.offset_towards(-view->direction);
    constexpr float SHORT_OF_LENS = 1 - 4 * std::numeric_limits<float>::epsilon();
    if (!context.visible({origin, view->origin - origin, SHORT_OF_LENS})) return trial;
    const float film_per_etendue =
        this->film_per_etendue(x.point.normal, view->direction, view->distance, wi);
    trial.radiance *= f * std::abs(dot(wi, x.frame.n)) * film_per_etendue;
    trial.film_density = film_per_etendue * x.pdf(wi);
    trial.film = view->film;
    trial.arrived = true;
    return trial;
}

std::optional<Splat> LightTracing::path(Context& context, uint32_t number) const {
    const Trial found = trace(context, number, paths_);
    if (!found.arrived) return std::nullopt;
    const float paths = static_cast<float>(paths_);
    Contribution contribution{Technique::light_sampling, found.edges, found.radiance / paths};
    contribution.pdf = found.density * paths;
    contribution.other_pdf = found.film_density;
    contribution.weight = balance_heuristic(contribution.pdf, contribution.other_pdf);
    contribution.from_light = true;
    return Splat{found.film, contribution};
}

bool LightTracing::prepare(const Preparation& preparation, const Pilots& pilots, float max_edges,
                           LightSampler::Kind kind, Mis mis) {
    scene_ = &preparation.scene, camera_ = &preparation.camera;
    constexpr float LONGEST = 20;
    max_edges_ = std::min(max_edges, LONGEST), kind_ = kind, mis_ = mis;
    light_factors_ = LightFactors::even(may_choose_kind() ? 0.5f : 1.f);
    find_triangles();
    if (!(choice_.total() > 0)) return true;

    std::vector<Trial> all, last;
    float rays = 0;
    for (uint32_t round = 0; round < ROUNDS; ++round) {
        last = trials(preparation, round, rays);
        if (last.empty()) return false;
        all.insert(all.end(), last.begin(), last.end());
        if (round + 1 < ROUNDS) learn(all);
    }

    const Pilot& pilot = pilots.without_portals;
    // Measured on `pots`: the time of a light path's ray over that of a camera path's, of which many are followed at once.
    constexpr float RAY = 1.5f;
    // The variance of a sample of a pixel, relative to the image's, with M paths: of what both can find it is
    // integral of F^2 / (p_camera + M p_light), as of the balance heuristic.
    const float pixels = static_cast<float>(camera_->width()) * static_cast<float>(camera_->height());
    // Where light arrives in this way alone, paths from the camera may have seen none of it.
    double arrived = 0;
    for (const Trial& trial : last) arrived += luminance(trial.radiance) * (trial.arrived ? 1.f : 0.f);
    const double image =
        std::max(double{pilot.luminance}, arrived / static_cast<double>(last.size()) / pixels);
    const auto effort = [&](float m) {
        double sum = 0;
        for (const Trial& trial : last) {
            if (!trial.arrived) continue;
            sum += sqr(double{luminance(trial.radiance)}) / (trial.film_density / trial.density + m);
        }
        const double variance = sum / static_cast<double>(last.size()) / (pixels * sqr(image));
        return (pilot.relative_variance + variance) * (pilot.rays + RAY * rays * m / pixels);
    };
    // Trials are few, so a small gain is as good as none, and the fewest paths with nearly the least effort are best: the
    // pilot leaves the noisiest pixels out.
    constexpr double NEARLY = 1.1;
    // On `sibenik`, where portals are better, paths from lights gain less than this, on `pots`, where portals are worse, more.
    const double worthwhile = pilots.best.by_portals ? 1.5 : NEARLY;
    constexpr uint32_t MOST = 64;  // in 64ths of the pixels
    const auto paths = [&](uint32_t share) {
        return std::max(std::floor(static_cast<float>(share) / 64 * pixels), 1.f);
    };
    double least = effort(0);
    for (uint32_t share = 1; share <= MOST; share *= 2) least = std::min(least, effort(paths(share)));
    if (effort(0) <= worthwhile * least) return true;
    uint32_t share = 1;
    while (effort(paths(share)) > NEARLY * least) share *= 2;
    paths_ = static_cast<uint32_t>(paths(share));
    return true;
}

std::vector<LightTracing::Trial> LightTracing::trials(const Preparation& preparation, uint32_t round,
                                                      float& rays) const {
    constexpr uint32_t PARTS = 64, PATHS_A_PART = 128;
    // Random numbers that no render uses.
    constexpr uint64_t SEED = 0xca0571c5ull << 24;
    std::vector<std::vector<Trial>> parts(PARTS);
    std::vector<uint64_t> rays_of(PARTS);
    const vec2 size(camera_->width(), camera_->height());
    const bool is_complete = preparation.for_each(PARTS, [&](uint32_t part) {
        Context context(*scene_, Sampler(Sampler::Kind::sobol, SEED));
        for (uint32_t i = part * PATHS_A_PART; i < (part + 1) * PATHS_A_PART; ++i) {
            context.sampler.start(round, i);
            Trial trial = trace(context, i, PARTS * PATHS_A_PART);
            trial.arrived = trial.arrived && trial.film.x >= 0 && trial.film.y >= 0 &&
                            trial.film.x < size.x && trial.film.y < size.y;
            parts[part].push_back(trial);
        }
        rays_of[part] = context.rays;
    });
    std::vector<Trial> all;
    if (!is_complete) return all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    rays = static_cast<float>(std::accumulate(rays_of.begin(), rays_of.end(), uint64_t{0})) /
           static_cast<float>(all.size());
    return all;
}

void LightTracing::find_triangles() {
    constexpr float ACROSS = 8;  // places along the longest side
    triangles_.clear();
    places_.assign(scene_->meshes().size(), {});
    vec3 lower(INFINITE), upper(-INFINITE);
    const auto for_each = [&](const auto& visit) {
        for (uint32_t i = 0; i < scene_->meshes().size(); ++i) {
            const Mesh& mesh = scene_->meshes()[i];
            if (!is_delta(*scene_, mesh)) continue;
            for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
                visit(i, triangle, mesh.facets[triangle]);
            }
        }
    };
    for_each([&](uint32_t, uint32_t, const Facet& facet) {
        for (const vec3& corner : facet.corners) lower = min(lower, corner), upper = max(upper, corner);
    });
    const float per_length = ACROSS / std::max(max_component(upper - lower), 1e-30f);
    std::map<std::array<int, 4>, Place> numbers;
    std::unordered_map<Corners, Place, CornersHash> known;
    for_each([&](uint32_t mesh, uint32_t triangle, const Facet& facet) {
        const vec3 cell =
            floor((facet.corners[0] + facet.corners[1] + facet.corners[2] - 3.f * lower) * (per_length / 3));
        const vec3 size = abs(facet.normal);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::array<int, 4> key{static_cast<int>(cell.x), static_cast<int>(cell.y),
                                     static_cast<int>(cell.z), 2 * axis + (facet.normal[axis] < 0)};
        Place place = numbers.try_emplace(key, static_cast<Place>(numbers.size())).first->second;
        // Of triangles in the same place, such as the two faces of a mirror, rays meet one: so must paths that begin there.
        const auto [first, is_new] = known.try_emplace(corners_in_order(facet), place);
        place = first->second;
        if (is_new) triangles_.push_back({mesh, triangle, place});
        places_[mesh].push_back(place);
    });
    std::ranges::stable_sort(triangles_, {}, &DeltaTriangle::place);
    choose_by(std::vector<float>(numbers.size(), 1));
}

void LightTracing::choose_by(const std::vector<float>& place_factors) {
    std::vector<double> weights;
    weights.reserve(triangles_.size());
    for (const auto& [mesh, triangle, place] : triangles_) {
        weights.push_back(scene_->meshes()[mesh].facets[triangle].area * place_factors[place]);
    }
    choice_ = Distribution1D(weights);
    area_densities_.clear();
    for (const float factor : place_factors)
        area_densities_.push_back(static_cast<float>(factor / choice_.total()));
}

void LightTracing::learn(std::span<const Trial> trials) {
    // Of choices by fixed probabilities, those in proportion to the root of the mean square of what each brings, over those
    // probabilities, have the least variance. Light may come where no trial has met any, so none is left out.
    constexpr float LEAST = 0.05f;
    constexpr double PRIOR_TRIALS = 4;
    struct Sum {
        double count = 0, squares = 0;
        void add(double value) { count += 1, squares += value * value; }
    };
    Sum of_all;
    std::vector<Sum> of_places(area_densities_.size());
    std::array<Sum, 2> of_kinds;
    const float pixels = static_cast<float>(camera_->width()) * static_cast<float>(camera_->height());
    for (const Trial& trial : trials) {
        double value = 0;
        if (trial.arrived) {
            // Of what paths from the camera do not find themselves, were there about as many as may pay.
            const float weight = balance_heuristic(trial.density * pixels / 8, trial.film_density);
            value = double{luminance(trial.radiance)} * weight;
        }
        of_all.add(value * trial.place_density);
        of_places[trial.place].add(value * trial.place_density);
        of_kinds[trial.of_triangles].add(value * trial.kind_share);
    }
    if (of_all.squares == 0) return;
    const double mean = of_all.squares / of_all.count;
    std::vector<float> factors;
    for (const Sum& sum : of_places) {
        const double square = (sum.squares + PRIOR_TRIALS * mean) / (sum.count + PRIOR_TRIALS);
        factors.push_back(static_cast<float>(std::sqrt(square / mean)));
    }
    const float most = *std::ranges::max_element(factors);
    for (float& factor : factors) factor = std::max(factor, LEAST * most);
    choose_by(factors);
    if (may_choose_kind()) {
        const auto root = [](const Sum& sum) { return std::sqrt(sum.squares / std::max(sum.count, 1.0)); };
        const double share = root(of_kinds[1]) / (root(of_kinds[0]) + root(of_kinds[1]));
        light_factors_ = LightFactors::even(std::clamp(static_cast<float>(share), LEAST, 1 - LEAST));
    }
}

}  // namespace etendue
