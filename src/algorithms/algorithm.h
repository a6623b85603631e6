// The contract of an estimator, and the registry that makes one file in this folder enough to add another.
//
// An estimator answers one question: how much light arrives along a camera ray, on average over many calls.
// Path length counts edges: max_cam_path_length = n takes in light that came over at most n rays, for every
// estimator.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "algorithms/observer.h"
#include "gi/camera.h"
#include "gi/sampler.h"
#include "gi/scene.h"

namespace etendue {

using ParameterValue = std::variant<bool, int, double, std::string>;

/// A setting of an estimator: a key of the scene file, checked there, and a control in the viewer.
struct Parameter {
    std::string name, summary;
    ParameterValue default_value;
    double minimum = 0, maximum = 0;   // of numbers
    std::vector<std::string> choices;  // of strings
};

/// Values by name; what is not given has the default of its declaration.
class Parameters {
  public:
    Parameters(const std::vector<Parameter>& declared, const std::map<std::string, ParameterValue>& given);

    template <class T>
    T get(const std::string& name) const {
        return std::get<T>(values_.at(name));
    }

  private:
    std::map<std::string, ParameterValue> values_;
};

/// What an estimator works with that follows one path after the other: the scene, the sample's random numbers, and
/// counters. One a thread. LaneContext is its like for several paths at once.
class Context {
  public:
    Context(const Scene& scene, Sampler sampler, Observer* observer = nullptr)
        : scene(scene), sampler(sampler), observer_(observer) {}

    /// What the path's next edge ends at. The next random numbers are made while what is known of it comes from memory.
    SurfaceHit intersect(const Ray& ray) {
        ++rays;
        const SurfaceHit hit = scene.intersect(ray, [&] { sampler.prepare(); });
        if (observer_) observer_->edge(ray, hit);
        return hit;
    }
    bool visible(const Ray& ray) {
        ++rays;
        const bool visible = !scene.occluded(ray);
        if (observer_) observer_->shadow_ray(ray, visible);
        return visible;
    }
    /// A direction to go on in, by the BSDF; there is none on a lamp, which absorbs.
    BsdfSample bounce(const SurfaceHit& hit) {
        const float lobe = sampler.next_1d();
        const BsdfSample sample = hit.sample(lobe, sampler.next_2d());
        if (observer_) observer_->bounce(sample);
        return sample;
    }
    /// Ends a path that plays with probability q; the caller divides the throughput of survivors by 1 - q.
    bool roulette(float q, bool plays) {
        if (!plays) return true;
        const bool survives = sampler.next_1d() >= q;
        if (observer_) observer_->roulette(q, survives);
        return survives;
    }
    /// The radiance that light which was found adds to the estimate.
    vec3 light(const Contribution& found) {
        if (observer_) observer_->contribution(found);
        return found.unweighted * found.weight;
    }

    const Scene& scene;
    Sampler sampler;
    uint64_t rays = 0;

  private:
    Observer* observer_;
};

/// A sample to be estimated: its camera ray, its random numbers, and who listens, if anyone.
struct CameraSample {
    Ray ray;
    Sampler::Stream numbers;
    Observer* observer = nullptr;
    bool shares = false;  // its path with that of the sample before it, see Algorithm::sharing
};

/// Samples of a queue, about: enough for lanes to be full most of the time.
inline constexpr size_t QUEUE_SAMPLES = 4096;

/// Samples to be estimated, in any order.
class SampleQueue {
  public:
    virtual ~SampleQueue() = default;
    /// The next one; empty: there are no more.
    virtual std::optional<CameraSample> next() = 0;
    /// What became of one of them, counted from 0 in the order of `next`.
    virtual void estimated(size_t sample, const vec3& radiance) = 0;
};

/// What an estimator may look at before it is asked for anything.
struct Preparation {
    const Scene& scene;
    const Camera& camera;
    /// Calls work(i) for i from 0 to before `count` on all threads. False where it was cut short.
    std::function<bool(uint32_t count, const std::function<void(uint32_t)>& work)> for_each;
};

/// Light that a path from a light brought to the film.
struct Splat {
    vec2 film;           // in pixels, (0, 0) the top left corner
    Contribution found;  // of a pixel that sees this place; for a filter of area 1
};

class Algorithm {
  public:
    virtual ~Algorithm() = default;
    /// Whether `prepare` has anything to do for a scene.
    virtual bool learns(const Scene&) const { return false; }
    /// Called once where it `learns`, before all that is below; again where it returned false, which it does where it was
    /// cut short. Learned from random numbers that an estimate uses, anything would bias that estimate; learned from
    /// anything but the scene, the camera and the parameters, a render would not come out the same again.
    virtual bool prepare(const Preparation&) { return true; }
    /// How many samples, of neighbouring pixels, are best estimated together, as what is found for one is used for the
    /// others; 1: none. The second can be told before it has learned anything.
    virtual uint32_t sharing() const { return 1; }
    virtual uint32_t sharing_at_most() const { return 1; }
    /// How many lights it samples at the first surface of each path, if it samples any.
    virtual uint32_t light_samples() const { return 1; }
    /// Whether it samples directions to smooth glass and mirrors there too.
    virtual bool by_portals() const { return false; }
    /// How many paths from lights belong to a sample of every pixel. What they bring is added to what `estimate` finds, which
    /// leaves it out.
    virtual uint32_t light_paths() const { return 0; }
    /// One of them by its number, whose random numbers have begun; for the scene and the camera that it has prepared for. What
    /// neighbours in number read is near each other in memory.
    virtual std::optional<Splat> light_path(Context&, uint32_t /*number*/) const { return std::nullopt; }
    /// Unbiased estimates of the radiance along the camera rays of a queue, until there are no more. Returns how many rays
    /// it traced. Called by many threads at once.
    virtual uint64_t estimate(const Scene& scene, SampleQueue& queue) const = 0;
};

/// An estimator that follows one path after the other.
class PathByPath : public Algorithm {
  public:
    uint64_t estimate(const Scene& scene, SampleQueue& queue) const final;

  protected:
    /// One unbiased estimate of the radiance along a camera ray.
    virtual vec3 radiance(Context& context, Ray ray) const = 0;
};

struct AlgorithmInfo {
    // Longest path that an estimator takes in, whatever max_cam_path_length says.
    static constexpr int UNLIMITED = std::numeric_limits<int>::max(), DIRECT = 2, NO_TRANSPORT = 0;

    std::string name, summary;
    std::vector<Parameter> parameters;
    int longest_path;
    std::function<std::unique_ptr<Algorithm>(const Parameters&)> make;
};

/// All estimators by name, in alphabetical order.
const std::map<std::string, AlgorithmInfo>& algorithms();

/// Throws std::invalid_argument where there is no such estimator or parameter, or a value does not fit.
std::unique_ptr<Algorithm> make_algorithm(const std::string& name,
                                          const std::map<std::string, ParameterValue>& given);

/// A global of this type in an estimator's file registers it:
///     const Register<Pathtracer> registered{"Pathtracer", "what it is", {max_path_length_parameter()}};
void register_algorithm(AlgorithmInfo info);
template <class T>
struct Register {
    Register(std::string name, std::string summary, std::vector<Parameter> parameters,
             int longest_path = AlgorithmInfo::UNLIMITED) {
        const auto make = [](const Parameters& p) -> std::unique_ptr<Algorithm> {
            return std::make_unique<T>(p);
        };
        register_algorithm({std::move(name), std::move(summary), std::move(parameters), longest_path, make});
    }
};

// Settings that several estimators share.
Parameter max_path_length_parameter();

}  // namespace etendue
