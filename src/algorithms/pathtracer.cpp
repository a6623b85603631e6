// Path tracing with next event estimation (assignment 2) and multiple importance sampling (assignment 4).
//
// Every vertex samples a light on purpose and connects to it over a shadow ray; the path goes on by the BSDF
// and may find a light by chance.  Light that both can find is shared by weights that add up to 1 ("mis":
// power or balance heuristic), or left to light sampling ("mis": none).  Light that only chance can find,
// straight from the camera or after a delta bounce, counts in full.
#include "algorithms/direct_light.h"
#include "algorithms/russian_roulette.h"

namespace etendue {

namespace {

class Pathtracer : public Algorithm {
  public:
    explicit Pathtracer(const Parameters& parameters)
        : MAX_CAM_PATH_LENGTH(parameters.get<int>("max_cam_path_length")),
          light_choice_(parameters),
          mis_(mis_of(parameters)),
          roulette_(parameters) {}

    bool learns(const Scene& scene) const override { return light_choice_.learns(scene); }
    bool prepare(const Preparation& preparation) override {
        return light_choice_.prepare(preparation, MAX_CAM_PATH_LENGTH, mis_);
    }

    vec3 radiance(Context& context, Ray ray) const override {
        vec3 radiance(0), throughput(1);
        float eta_scale = 1;
        // Where the ray comes from, and how it was chosen: its solid-angle pdf, or by no density at all.
        vec3 prev_position(0);
        const LightFactors* prev_learned = nullptr;
        float prev_pdf = 0;
        bool prev_delta = true;
        // To a light from there, whose shadow ray is traced only when the next surface is being fetched from memory.
        Connection connection;
        for (int depth = 1;; ++depth) {
            context.sampler.start_vertex(depth);
            const SurfaceHit hit =
                context.intersect(ray, [&] { radiance += light_over(context, connection); });
            connection.exists = false;
            // Light found by chance, against the pdf of having sampled it on purpose from the vertex before.
            if (hit.is_light()) {
                Contribution found{Technique::bsdf_sampling, depth, throughput * hit.Le()};
                if (!prev_delta) {
                    found.pdf = prev_pdf;
                    found.other_pdf = light_pdf(context, prev_position, prev_learned, hit);
                    found.weight = bsdf_sampling_weight(mis_, found.pdf, found.other_pdf);
                }
                radiance += context.light(found);
            }
            if (!hit.valid || depth == MAX_CAM_PATH_LENGTH) break;

            // Light sampled on purpose, one edge further.
            const LightFactors* const learned = light_choice_.learned(hit);
            connection =
                connect_to_light(context, hit, throughput, depth + 1, light_choice_.kind(), learned, mis_);

            // Continue by the BSDF; on a lamp, which absorbs, there is nothing to continue with.
            const auto bounce = context.bounce(hit);
            if (!bounce) break;
            throughput *= bounce->weight;
            eta_scale *= bounce->eta2;
            if (is_black(throughput)) break;

            if (!roulette_.survives(context, throughput, eta_scale, depth)) break;
            prev_position = hit.point.position;
            prev_learned = learned;
            prev_pdf = bounce->pdf;
            prev_delta = bounce->is_delta();
            ray = hit.ray_towards(bounce->wi);
        }
        return radiance + light_over(context, connection);
    }

    static std::vector<Parameter> parameters() {
        auto all = RussianRoulette::parameters();
        all.push_back(max_path_length_parameter());
        all.push_back(LightChoice::parameter());
        all.push_back(mis_parameter());
        return all;
    }

  private:
    float light_pdf(const Context& context, const vec3& reference, const LightFactors* learned,
                    const SurfaceHit& hit) const {
        const auto kind = light_choice_.kind();
        return context.scene.light_source_pdf(kind, reference, hit.light, hit.triangle, learned) *
               hit.light->pdf_Li(hit, mis_ != Mis::none);
    }

    const int MAX_CAM_PATH_LENGTH;
    LightChoice light_choice_;
    const Mis mis_;
    const RussianRoulette roulette_;
};

const Register<Pathtracer> registered{
    "Pathtracer",
    "path tracing with next event estimation and multiple importance sampling (assignments 2 to 4)",
    Pathtracer::parameters()};

}  // namespace

}  // namespace etendue
