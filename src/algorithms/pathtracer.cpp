// Path tracing with next event estimation (assignment 2) and multiple importance sampling (assignment 4).
//
// Every vertex samples a light on purpose and connects to it over a shadow ray; the path goes on by the BSDF
// and may find a light by chance.  Light that both can find is shared by weights that add up to 1 ("mis":
// power or balance heuristic), or left to light sampling ("mis": none).  Light that only chance can find,
// straight from the camera or after a delta bounce, counts in full; but where light is traced from the other end as
// well ("light_tracing"), through glass and over mirrors to what the camera sees, see light_tracing.h.
//
// What paths find from their second surface on may be shared between pixels ("path_reuse"), see path_reuse.h. And at the
// first surface several lights may be sampled for each path ("light_splitting"), see pilot.h, and directions to smooth
// glass ("portals"), see portals.h.
#include "algorithms/direct_light.h"
#include "algorithms/lane_paths.h"
#include "algorithms/light_tracing.h"
#include "algorithms/pilot.h"
#include "algorithms/portals.h"
#include "algorithms/russian_roulette.h"

namespace etendue {

namespace {

class Pathtracer : public Algorithm {
  public:
    explicit Pathtracer(const Parameters& parameters)
        : MAX_CAM_PATH_LENGTH(static_cast<float>(parameters.get<int>("max_cam_path_length"))),
          light_choice_(parameters),
          mis_(mis_of(parameters)),
          reuses_paths_(parameters.get<bool>("path_reuse")),
          may_trace_light_(parameters.get<bool>("light_tracing")),
          splits_light_(parameters.get<bool>("light_splitting")),
          may_use_portals_(parameters.get<bool>("portals") && mis_of(parameters) != Mis::none),
          roulette_(parameters) {}

    bool learns(const Scene& scene) const override { return flies(scene) || light_choice_.learns(scene); }
    bool prepare(const Preparation& preparation) override {
        const Scene& scene = preparation.scene;
        light_tracing_ = {};
        if (light_choice_.learns(scene) &&
            !light_choice_.prepare(preparation, static_cast<int>(MAX_CAM_PATH_LENGTH), mis_))
            return false;
        by_portals_ = false;
        if (!flies(scene)) return true;
        if (may_use_portals(scene)) portals_ = Portals(scene);
        const auto attempt = [&](SampleQueue& queue, const Together& together) {
            return estimate_together(scene, queue, together);
        };
        const auto pilots = fly(preparation, {reuses_paths_, splits_light_, may_use_portals(scene)}, attempt);
        if (!pilots) return false;
        if (traces_light(scene) &&
            !light_tracing_.prepare(preparation, *pilots, MAX_CAM_PATH_LENGTH, light_choice_.kind(), mis_))
            return false;
        // Paths from lights and portals find the same light.
        const Pilot& pilot = light_tracing_.paths() > 0 ? pilots->without_portals : pilots->best;
        sharing_ = pilot.sharing, light_samples_ = pilot.light_samples, by_portals_ = pilot.by_portals;
        if (!by_portals_) portals_ = {};
        return true;
    }

    uint32_t sharing() const override { return sharing_; }
    uint32_t sharing_at_most() const override { return reuses_paths_ ? PathReuse::MOST_PIXELS : 1; }

    uint32_t light_samples() const override { return light_samples_; }
    bool by_portals() const override { return by_portals_; }
    uint32_t light_paths() const override { return light_tracing_.paths(); }
    std::optional<Splat> light_path(Context& context, uint32_t number) const override {
        return light_tracing_.path(context, number);
    }

    uint64_t estimate(const Scene& scene, SampleQueue& queue) const override {
        if (sharing_ == 1 && light_samples_ == 1 && !by_portals_) {
            return follow<Paths>(
                scene, queue, [&](LaneContext& context, Paths& paths) { extend(context, paths, nullptr); });
        }
        const Trial trial = estimate_together(scene, queue, {sharing_ > 1, light_samples_, by_portals_});
        for (size_t i = 0; i < trial.estimates.size(); ++i) queue.estimated(i, trial.estimates[i].shared);
        return trial.rays + trial.rays_of_sharing;
    }

    static std::vector<Parameter> parameters() {
        auto all = RussianRoulette::parameters();
        all.push_back(max_path_length_parameter());
        all.push_back(LightChoice::parameter());
        all.push_back(mis_parameter());
        all.push_back(PathReuse::parameter());
        all.push_back(LightTracing::parameter());
        all.push_back(light_splitting_parameter());
        all.push_back(Portals::parameter());
        return all;
    }

  private:
    bool flies(const Scene& scene) const {
        return reuses_paths_ || splits_light_ || traces_light(scene) || may_use_portals(scene);
    }
    bool may_use_portals(const Scene& scene) const {
        return may_use_portals_ && LightTracing::may_pay(scene);
    }
    bool traces_light(const Scene& scene) const { return may_trace_light_ && LightTracing::may_pay(scene); }

    struct Paths : LanePaths {
        // Where each came from last, and how that direction was chosen: its solid-angle pdf, or by no density at all.
        LaneVec3 prev_position;
        PerLane<const LightFactors*> prev_learned{};
        Lanes prev_pdf = 0;
        LaneMask prev_delta{true};
        // To a light from there, whose shadow ray is traced only when the next surface is being fetched from memory.
        ConnectionOf<Lanes> connection;
        // Of paths that are shared, from where on throughput and radiance begin anew: the largest component of what the
        // throughput was by then, and 1 / (1 - q) of a roulette before.
        Lanes scale = 1, survival = 1;
        // Of those that light may be traced along, see LightTracing::CameraPath.
        Lanes film_density = 0, cos_g = 1, area_density = 1;
        // Of those that have gone over delta surfaces since their first: how they left that, by the BSDF and by portals; 0: these
        // could not.
        Lanes first_pdf = 0, portal_pdf = 0;
    };

    /// The paths of a queue, of which something is left to do once all have ended.
    struct Queued {
        Together together;
        FirstSurfaces firsts;
        PathReuse reuse;
    };

    Trial estimate_together(const Scene& scene, SampleQueue& queue, const Together& together) const {
        LaneContext context(scene);
        Queued queued{together, {}, {}};
        FirstSurfaces& firsts = queued.firsts;
        PathReuse& reuse = queued.reuse;
        follow<Paths>(
            context, queue, [&](const CameraSample& sample) { firsts.begin(sample), reuse.begin(sample); },
            [&](Paths& paths) { extend(context, paths, &queued); },
            [&](size_t sample, const vec3& radiance) { reuse.end(sample, radiance); });
        Trial trial;
        if (together.by_portals) trial.portal_gains.resize(firsts.count());
        firsts.for_each([&](size_t first, const LaneMask& on, const SurfaceHits& hits) {
            if (together.light_samples > 1) light_first(context, queued, first, on, hits);
            if (together.by_portals) light_by_portals(context, queued, first, on, hits, trial.portal_gains);
            const uint64_t before = context.rays;
            if (together.shares) reuse.connect(context, first, on, hits);
            trial.rays_of_sharing += context.rays - before;
        });
        trial.rays = context.rays - trial.rays_of_sharing;
        trial.estimates = reuse.estimates();
        return trial;
    }

    /// Light sampled on purpose at what the paths from `first` on see first, several times for each.
    void light_first(LaneContext& context, Queued& queued, size_t first, const LaneMask& on,
                     const SurfaceHits& hits) const {
        const PerLane<const LightFactors*> learned = light_choice_.learned(hits, on);
        const uint32_t samples = queued.together.light_samples;
        LaneVec3 radiance(0);
        for (uint32_t k = 0; k < samples; ++k) {
            for_lanes(on, [&](int i) {
                const CameraSample& sample = queued.firsts.sample(first + i);
                context.start_at_first(i, sample, Sampler::part(sample.numbers, k, samples));
            });
            context.sampler.start_vertex(1);
            const auto connection = connect_to_lights(context, hits, on, LaneVec3(1), 2, light_choice_.kind(),
                                                      learned, mis_, static_cast<float>(samples));
            radiance += light_over(context, connection, on);
        }
        for_lanes(on, [&](int i) { queued.reuse.add_own(first + i, radiance.lane(i)); });
    }

    /// The same through glass and over mirrors.
    void light_by_portals(LaneContext& context, Queued& queued, size_t first, const LaneMask& on,
                          const SurfaceHits& hits, std::vector<vec3>& gains) const {
        for_lanes(on, [&](int i) {
            const CameraSample& sample = queued.firsts.sample(first + i);
            context.start_at_first(i, sample, Sampler::part(sample.numbers, 0, 1));
        });
        const Portals::Light light = portals_.light(context, hits, on, MAX_CAM_PATH_LENGTH, mis_);
        for_lanes(on, [&](int i) {
            queued.reuse.add_own(first + i, light.radiance.lane(i));
            gains[first + i] = light.gain.lane(i);
        });
    }

    /// By an edge. `queued`: null where nothing is left to do once they have ended.
    void extend(LaneContext& context, Paths& paths, Queued* queued) const {
        PathReuse* const reuse = queued && queued->together.shares ? &queued->reuse : nullptr;
        const bool splits_light = queued && queued->together.light_samples > 1;
        const LaneMask on = paths.alive, is_first = paths.edges == 1;
        context.sampler.start_vertex(paths.edges);
        SurfaceHits hits = context.intersect(paths.rays, on, [&] {
            paths.radiance += light_over(context, paths.connection, on && !is_first);
        });

        // Light found by chance, against the pdf of having sampled it on purpose from the vertex before.
        if (any(hits.is_light)) {
            const FoundLightOf<Lanes> light = Light::found(hits.is_light, hits, mis_ != Mis::none);
            ContributionOf<Lanes> found{Technique::bsdf_sampling, paths.edges,
                                        paths.throughput * light.radiance};
            const LaneMask could_be_sampled = hits.is_light && !is_first && !paths.prev_delta;
            if (any(could_be_sampled)) {
                found.pdf = select(could_be_sampled, paths.prev_pdf, Lanes(0));
                found.other_pdf = choice_pmfs(context, paths, hits, could_be_sampled) * light.pdf;
                if (splits_light) {
                    const auto samples = static_cast<float>(queued->together.light_samples);
                    found.other_pdf *= select(paths.edges == 2, Lanes(samples), Lanes(1));
                }
                found.weight = select(could_be_sampled,
                                      bsdf_sampling_weight(mis_, found.pdf, found.other_pdf), Lanes(1));
            }
            const LaneMask could_be_traced = hits.is_light && !is_first && paths.prev_delta &&
                                             paths.film_density > 0 &&
                                             paths.edges <= light_tracing_.longest();
            if (any(could_be_traced)) {
                const Lanes light_density = choice_pmfs(context, paths, hits, could_be_traced) * light.pdf;
                const Lanes density = light_tracing_.density(
                    {paths.film_density, paths.cos_g, paths.area_density, light_density});
                found.pdf = select(could_be_traced, paths.film_density, found.pdf);
                found.other_pdf = select(could_be_traced, density, found.other_pdf);
                const Lanes weight = balance_heuristic(paths.film_density, density);
                found.weight = select(could_be_traced, weight, found.weight);
            }
            const LaneMask could_be_by_portal = hits.is_light && !is_first && paths.portal_pdf > 0;
            if (any(could_be_by_portal)) {
                found.pdf = select(could_be_by_portal, paths.first_pdf, found.pdf);
                found.other_pdf = select(could_be_by_portal, paths.portal_pdf, found.other_pdf);
                const Lanes weight = bsdf_sampling_weight(mis_, paths.first_pdf, paths.portal_pdf);
                found.weight = select(could_be_by_portal, weight, found.weight);
            }
            paths.radiance += context.light(found, hits.is_light);
        }
        LaneMask goes_on = hits.valid && paths.edges < MAX_CAM_PATH_LENGTH;

        // Light sampled on purpose, one edge further.
        hits.read_colours();
        PerLane<const LightFactors*> learned = light_choice_.learned(hits, goes_on && !hits.is_delta);
        if (queued) queued->firsts.add(goes_on && is_first && !hits.is_delta, paths.sample, hits);
        const LaneMask is_later = is_first && LaneMask(splits_light);
        if (splits_light) context.sampler.skip(is_later && goes_on && !hits.is_delta, 2);
        paths.connection = connect_to_lights(context, hits, goes_on && !is_later, paths.throughput,
                                             paths.edges + 1, light_choice_.kind(), learned, mis_);

        // Continue by the BSDF; on a lamp, which absorbs, there is nothing to continue with.
        const BsdfSampleOf<Lanes> bounce = context.bounce(hits, goes_on);
        const LaneMask is_shared =
            reuse ? share(context, paths, hits, goes_on, bounce, *reuse) : LaneMask(false);
        goes_on = goes_on && bounce.exists;
        paths.throughput = select(is_shared, LaneVec3(1), paths.throughput * bounce.weight);
        paths.eta_scale *= bounce.eta2;
        goes_on = goes_on && !is_black(select(is_shared, bounce.weight, paths.throughput));
        const LaneVec3 before = paths.throughput;
        goes_on = roulette_.survives(context, paths.throughput, paths.eta_scale * paths.scale, paths.edges,
                                     goes_on);
        if (light_tracing_.paths() > 0) mark_traceable(paths, hits, is_first, bounce, learned);
        if (queued && queued->together.by_portals) mark_portals(paths, hits, on);
        if (reuse) {
            const Lanes survival = max_component(paths.throughput) / max_component(before);
            paths.survival = select(is_first, survival, paths.survival);
        }

        paths.prev_position = hits.point.position;
        paths.prev_learned = learned;
        paths.prev_pdf = bounce.pdf;
        paths.prev_delta = bounce.is_delta();
        paths.rays = hits.rays_towards(bounce.wi);
        paths.alive = goes_on;
        paths.edges += 1;
        // Of those that end here nothing will be traced meanwhile.
        paths.radiance += light_over(context, paths.connection, on && !goes_on);
    }

    /// At the second surfaces of paths, where their light is known for other directions too: hands over what they have found,
    /// and begins anew with what they will find. Says which paths are shared from there on.
    LaneMask share(LaneContext& context, Paths& paths, const SurfaceHits& hits, const LaneMask& goes_on,
                   const BsdfSampleOf<Lanes>& bounce, PathReuse& reuse) const {
        const LaneMask is_first = paths.edges == 1;
        paths.scale = select(is_first, Lanes(1), paths.scale);
        LaneMask shared = goes_on && paths.edges == 2 && !paths.prev_delta;
        if (!any(shared)) return shared;
        const Lanes share = hits.diffuse_shares(shared);
        shared = shared && share > 0;
        if (!any(shared)) return shared;
        reuse.observe_beyond(context, shared, paths.sample);
        // The light that was sampled here belongs to what is handed over: its shadow ray cannot wait for the next one.
        ConnectionOf<Lanes> connection = paths.connection;
        connection.found.unweighted = connection.irradiance;
        const LaneVec3 irradiance = light_over(context, connection, shared);
        paths.connection.exists = paths.connection.exists && !shared;
        reuse.add_second(shared, paths.sample,
                         {hits, share, paths.radiance, paths.throughput, paths.survival, irradiance,
                          connection.f, bounce});
        paths.radiance = select(shared, LaneVec3(0), paths.radiance);
        paths.scale =
            select(shared, max_component(paths.throughput) * max_component(bounce.weight), paths.scale);
        return shared;
    }

    /// Which paths go from their first surface over delta surfaces alone, so that light may have been traced along them.
    void mark_traceable(Paths& paths, const SurfaceHits& hits, const LaneMask& is_first,
                        const BsdfSampleOf<Lanes>& bounce, PerLane<const LightFactors*>& learned) const {
        const Lanes begins =
            bounce.pdf * light_tracing_.film_per_etendue(hits.point.normal, paths.rays.direction,
                                                         lanes_of(hits.found.distance), bounce.wi);
        const LaneMask goes_on =
            hits.is_delta && is_reversible(hits.is_bent, hits.frame.n, hits.point.normal, bounce.wi);
        paths.film_density = select(is_first, select(hits.is_delta, Lanes(0), begins),
                                    select(goes_on, paths.film_density, Lanes(0)));
        const LaneMask traceable = paths.film_density > 0 && !is_first;
        if (!any(traceable)) return;
        paths.cos_g = abs(dot(bounce.wi, hits.point.normal));
        PerLane<float> area_densities{};
        for_lanes(traceable, [&](int i) {
            area_densities[i] = light_tracing_.area_density(hits.found.part[i]->mesh, hits.found.triangle[i]);
            learned[i] = light_tracing_.light_factors();
        });
        paths.area_density = lanes_of(area_densities);
    }

    /// Which paths have gone from their first surface over delta surfaces alone, so that portals may have led there.
    void mark_portals(Paths& paths, const SurfaceHits& hits, const LaneMask& on) const {
        const LaneMask is_second = paths.edges == 2, is_delta = hits.valid && hits.is_delta;
        const Lanes pdfs =
            portals_.pdfs(on && is_second && is_delta && !paths.prev_delta, paths.prev_position, hits);
        paths.first_pdf = select(is_second, paths.prev_pdf, paths.first_pdf);
        paths.portal_pdf =
            select(is_second, pdfs, select(is_delta && paths.edges > 2, paths.portal_pdf, Lanes(0)));
    }

    /// Probabilities with which the lights that were found, and what of them, would have been chosen on purpose; 0 for the
    /// other lanes.
    Lanes choice_pmfs(const LaneContext& context, const Paths& paths, const SurfaceHits& hits,
                      const LaneMask& on) const {
        PerLane<float> pmfs{};
        for_lanes(on, [&](int i) {
            pmfs[i] = context.scene.light_source_pdf(light_choice_.kind(), paths.prev_position.lane(i),
                                                     hits.found.light[i], hits.found.triangle[i],
                                                     paths.prev_learned[i]);
        });
        return lanes_of(pmfs);
    }

    const float MAX_CAM_PATH_LENGTH;
    LightChoice light_choice_;
    const Mis mis_;
    const bool reuses_paths_, may_trace_light_, splits_light_, may_use_portals_;
    LightTracing light_tracing_;
    Portals portals_;
    uint32_t sharing_ = 1, light_samples_ = 1;
    bool by_portals_ = false;
    const RussianRoulette roulette_;
};

const Register<Pathtracer> registered{
    "Pathtracer",
    "path tracing with next event estimation and multiple importance sampling (assignments 2 to 4)",
    Pathtracer::parameters()};

}  // namespace

}  // namespace etendue
