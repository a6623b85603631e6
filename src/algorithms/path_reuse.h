// Paths of neighbouring pixels share what they find (Bekaert, Sbert and Halton 2002, "Accelerating path tracing by
// re-using paths").
//
// Path k of a group sees a surface x_k, and finds y_k from there by the BSDF, with the density
//
//     p_k(y) = pdf_k(x_k -> y) |cos_y| / |x_k - y|^2    per area of y, 0 where x_k does not see y.
//
// The light that leaves y_k it estimates, by the rest of its path. All x_i of the group might have found the same y_k,
// so it is connected to each of them, and the n estimates of pixel i's light are combined by the balance heuristic:
//
//     sum over k of  f_i |cos_i| |cos_y| / |x_i - y_k|^2 V(x_i, y_k)  L(y_k -> x_i) / (p_1(y_k) + ... + p_n(y_k)).
//
// For a few shadow rays a pixel has n estimates of its indirect light, each of which cost a path. L(y -> x) must be known
// in other directions than that which the path came from: what the diffuse part of y's BSDF reflects, f = share albedo /
// pi + rest, where the share depends on the direction alone. The rest counts for the path's own pixel, in full.
//
// Each pixel's estimate is unbiased, as before, and its samples are independent of each other. Of different pixels, whose
// paths were shared, they no longer are.
#pragma once

#include <memory>
#include <vector>

#include "algorithms/first_surfaces.h"

namespace etendue {

/// The paths of a queue's samples, while they are traced and until they are shared.
class PathReuse {
  public:
    PathReuse() {
        paths_.reserve(QUEUE_SAMPLES), ys_.reserve(QUEUE_SAMPLES);
        connections_.reserve(QUEUE_SAMPLES * MOST_PIXELS);
    }

    /// How many pixels share their paths at most.
    static constexpr uint32_t MOST_PIXELS = 16;

    static Parameter parameter() {
        return {
            "path_reuse",
            "whether neighbouring pixels share the indirect light that their paths find: less noise for a "
            "few shadow rays, which is no longer independent from pixel to pixel",
            true};
    }

    /// A sample's path begins, the next of the queue.
    void begin(const CameraSample& sample);

    /// A path at its second surface y, where what is found from there on begins to be shared.
    struct Second {
        const SurfaceHits& hits;
        Lanes share;                 // of y's BSDF, see above
        LaneVec3 radiance;           // that the path has found before
        LaneVec3 throughput;         // when it came to y,
        Lanes survival;              // and of that 1 / (1 - q), where it played roulette at x
        LaneVec3 irradiance;         // that was found at y by sampling a light: |cos| radiance / pdf
        LaneVec3 f;                  // y's BSDF towards that light
        BsdfSampleOf<Lanes> bounce;  // how the path goes on from y, if it does
    };
    void add_second(const LaneMask& on, const PerLane<size_t>& samples, const Second& second);

    /// A path has ended. `radiance`: all that it found; or, if it came to a shared y, what came to y over its bounce.
    void end(size_t sample, const vec3& radiance);

    /// Of a sample, by its path alone, and by those of its group.
    struct Estimates {
        vec3 alone, shared;
    };
    /// Light that is of its pixel alone, found once it has ended.
    void add_own(size_t sample, const vec3& radiance) { paths_[sample].own += radiance; }
    /// Once all have ended: connects those from `first` on that are `on` with what others of their groups have found. `hits`: what
    /// they see first.
    void connect(LaneContext& context, size_t first, const LaneMask& on, const SurfaceHits& hits);
    /// Once all are connected: the estimates of each sample.
    std::vector<Estimates> estimates() const;

    /// Contributions found beyond y, kept until it is known what they are worth to whom.
    class Beyond : public Observer {
      public:
        explicit Beyond(Observer* own) : own_(own) {}
        void edge(const Ray& ray, const SurfaceHit& hit) override {
            if (own_) own_->edge(ray, hit);
        }
        void shadow_ray(const Ray& ray, bool visible) override {
            if (own_) own_->shadow_ray(ray, visible);
        }
        void bounce(const BsdfSample& sample) override {
            if (own_) own_->bounce(sample);
        }
        void roulette(float q, bool survived) override {
            if (own_) own_->roulette(q, survived);
        }
        void contribution(const Contribution& found) override { found_.push_back(found); }
        /// What has been found was found at y.
        void leave() { at_y_ = found_.size(); }

        /// Tells about all, as it is worth to a pixel: found at y, and beyond.
        void tell(Observer& observer, const vec3& at_y, const vec3& beyond, bool borrowed) const;

      private:
        Observer* own_;
        std::vector<Contribution> found_;
        size_t at_y_ = 0;
    };
    /// From now on the observers of these lanes' paths, and of others in their groups, learn what is found later.
    void observe_beyond(LaneContext& context, const LaneMask& on, const PerLane<size_t>& samples);

  private:
    /// y, as all of its group want to know it: a line of the cache.
    struct alignas(64) Shared {
        vec3 position{0};
        float reach = 0;
        vec3 normal{0, 0, 1}, shading_normal{0, 0, 1};
        vec3 radiance{0};  // that leaves y by its diffuse part where its share is 1
        float ior = 1, bsdf = 0;
        float exists = 0;  // 1 or 0
    };
    static_assert(sizeof(Shared) == LINE_FLOATS * sizeof(float));

    struct Path {
        uint32_t place = 0, size = 1;  // in its group, which lies together
        float survival = 1;
        vec3 own{0};  // that is of its pixel alone
        // What radiance that comes to y over the path's bounce is worth, to the diffuse part and to the own pixel.
        vec3 shared_bounce{0}, own_bounce{0};
        // The same of irradiance from the light that was sampled at y.
        vec3 shared_light{0}, own_light{0};
        Observer* observer = nullptr;
        std::unique_ptr<Beyond> beyond;
    };
    /// Of a pixel and the path of a member of its group: what a radiance of 1 from y's diffuse part is worth to the pixel
    /// before it is divided by the sum of densities, and the pixel's own density of y.
    struct Connection {
        vec3 value{0};
        float density = 0;
    };

    LaneMask sees_each_other(LaneContext& context, size_t first, const SurfacePointOf<Lanes>& x,
                             const SurfacePointOf<Lanes>& y, const LaneVec3& wi, const LaneMask& on) const;
    /// A path's observer learns what another of its group, or itself, found beyond y. `worth`: of radiance from there.
    static void tell(const Path& path, const Path& found_by, const vec3& worth, bool borrowed);
    /// Partner number 0 of a path is itself.
    size_t partner_of(size_t path, uint32_t partner) const;
    /// The sum of the densities that the members of a path's group have of its y.
    float density(size_t path) const;
    Connection& at(size_t path, uint32_t partner) { return connections_[path * MOST_PIXELS + partner]; }
    const Connection& at(size_t path, uint32_t partner) const {
        return connections_[path * MOST_PIXELS + partner];
    }

    std::vector<Path> paths_;
    std::vector<Shared> ys_;  // of each path
    std::vector<Connection> connections_;
};

}  // namespace etendue
