#include "driver/aovs.h"

#include "algorithms/algorithm.h"

namespace etendue {

namespace {

// Mirrors and glass that a path is followed through for the denoiser's guides.
constexpr int MAX_DELTA_BOUNCES = 16;

}  // namespace

AovPass::AovPass(const Scene& scene, const Sensor& sensor, int threads)
    : scene_(scene),
      sensor_(sensor),
      threads_(thread_count(threads)),
      pixels_(size_t{sensor.camera.width()} * sensor.camera.height()) {}

bool AovPass::render(uint64_t first, uint64_t samples) {
    TileWorkers workers(threads_);
    const Tiles tiles(width(), height());
    tiles_done_ = 0;
    workers.for_each(tiles, [&](uint32_t, const Tile& tile) {
        Context context(scene_, sensor_.make_sampler());
        for (uint32_t y = tile.y0; y < tile.y1; ++y) {
            for (uint32_t x = tile.x0; x < tile.x1; ++x) {
                AovPixel& pixel = pixels_[size_t{y} * width() + x];
                for (uint64_t i = first; i < first + samples && !stop_; ++i) {
                    add(context, pixel, sensor_.start(context.sampler, x, y, i));
                }
            }
        }
        ++tiles_done_;
    });
    return !stop_.exchange(false);
}

void AovPass::add(Context& context, AovPixel& pixel, const Ray& ray) const {
    const SurfaceHit hit = context.intersect(ray);
    ++pixel.count;
    if (hit.valid) {
        ++pixel.hits;
        pixel.albedo += hit.albedo();
        pixel.normal += hit.frame.n;
        pixel.position += hit.point.position;
        pixel.depth += sensor_.camera.depth(hit.point.position);
        pixel.object.add(static_cast<int32_t>(hit.mesh - scene_.meshes().data()));
        pixel.material.add(static_cast<int32_t>(hit.material - scene_.materials().data()));
    } else {
        pixel.object.add(-1);
        pixel.material.add(-1);
    }
    add_guides(context, pixel, hit);
}

/// What Open Image Denoise asks for: the surface behind perfect mirrors and glass, its albedo dimmed on the way,
/// and where something shines, that. By the random numbers of the estimators, so it is what they find there.
void AovPass::add_guides(Context& context, AovPixel& pixel, SurfaceHit hit) const {
    vec3 throughput(1);
    for (int depth = 1; hit.valid && hit.is_type(BRDF_SPECULAR) && depth <= MAX_DELTA_BOUNCES; ++depth) {
        context.sampler.start_vertex(depth);
        const BsdfSample bounce = context.bounce(hit);
        if (!bounce.exists) break;
        // Without the compression of radiance in glass, a share of light.
        throughput *= bounce.weight * bounce.eta2;
        hit = context.intersect(hit.ray_towards(bounce.wi));
    }
    const vec3 seen = (hit.valid ? hit.albedo() : vec3(0)) + hit.Le();
    pixel.denoising_albedo += glm::min(throughput * seen, vec3(1));
    if (hit.valid) pixel.denoising_normal += hit.frame.n;
}

}  // namespace etendue
