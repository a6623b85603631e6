#include "gi/lights/sky_light.h"

namespace etendue {

namespace {

/// Image coordinates of a direction, u and v in [0, 1].
template <class V, class F = NumberOf<V>>
Vec2<F> uv_of(const V& direction) {
    const F turns = fast_atan2(direction.z, direction.x) * (INV_PI / 2);
    // acos loses its digits at the poles.
    const F theta = fast_atan2(sqrt(sqr(direction.x) + sqr(direction.z)), direction.y);
    return {select(turns < 0, turns + 1, turns), theta * INV_PI};
}

/// A direction by the cosine of its angle from +Y, and turns around it.
template <class F>
Vec3<F> direction_of(const F& cos_theta, const F& sin_theta, const F& turns) {
    F sin_phi = 0, cos_phi = 0;
    sin_cos_of_turns(turns, sin_phi, cos_phi);
    return {sin_theta * cos_phi, cos_theta, sin_theta * sin_phi};
}

}  // namespace

std::vector<SkyLight> SkyLight::find(const LightContext& context) {
    if (!context.sky) return {};
    return {SkyLight(*context.sky, context.scene_radius)};
}

SkyLight::SkyLight(const Sky& sky, float scene_radius) : sky_(&sky) {
    const uint32_t w = sky.width, h = sky.height;
    row_cosines_.resize(h + 1);
    for (uint32_t y = 0; y <= h; ++y)
        row_cosines_[y] = static_cast<float>(std::cos(M_PI * y / std::max(h, 1u)));
    double mean_luminance = 1;
    if (w > 0) {
        // Radiance is interpolated between pixels, so a cell's mean gathers from its neighbours: 1/8, 3/4,
        // 1/8 along each axis is the exact integral, and leaves no cell dark that shows light.
        std::vector<float> weights(size_t{w} * h);
        double total = 0;
        for (int32_t y = 0; y < static_cast<int32_t>(h); ++y) {
            // The sin theta of the mapping, integrated over the row.
            const float solid_angle =
                2 * PI / static_cast<float>(w) * (row_cosines_[y] - row_cosines_[y + 1]);
            for (int32_t x = 0; x < static_cast<int32_t>(w); ++x) {
                float sum = 0;
                for (int32_t dy = -1; dy <= 1; ++dy) {
                    for (int32_t dx = -1; dx <= 1; ++dx) {
                        const float share = (dx == 0 ? 0.75f : 0.125f) * (dy == 0 ? 0.75f : 0.125f);
                        sum += share * luminance(pixel(x + dx, y + dy));
                    }
                }
                weights[size_t(y) * w + x] = sum * solid_angle;
                total += sum * solid_angle;
            }
        }
        cells_ = Distribution2D(weights, w, h);
        double above_mean = 0;
        for (uint32_t y = 0; y < h; ++y) {
            const auto mean = static_cast<float>(total * (row_cosines_[y] - row_cosines_[y + 1]) / (2 * w));
            for (uint32_t x = 0; x < w; ++x) {
                float& weight = weights[size_t{y} * w + x];
                weight = std::max(weight - mean, 0.f);
                above_mean += weight;
            }
        }
        constexpr double ROUNDING = 1e-3;
        if (above_mean > ROUNDING * total) bright_ = Distribution2D(weights, w, h);
        mean_luminance = total / (4 * M_PI);
    }
    // Radiance from the whole sphere of directions through the cross-section of the scene's bounding sphere.
    power_ = static_cast<float>(mean_luminance * sky.intensity * 4 * M_PI * M_PI) *
             sqr(sky.radius.value_or(scene_radius));
}

const vec3& SkyLight::pixel(int32_t x, int32_t y) const {
    const auto w = static_cast<int32_t>(sky_->width), h = static_cast<int32_t>(sky_->height);
    const int32_t around = x < 0 ? w - 1 : x >= w ? 0 : x;
    return sky_->pixels[size_t(std::clamp(y, 0, h - 1)) * w + around];
}

vec3 SkyLight::Le(const vec3& direction) const {
    return sky_->width == 0 ? vec3(sky_->intensity) : radiance_at(uv_of(direction));
}

vec3 SkyLight::radiance_at(const vec2& uv) const {
    const float x = uv.x * static_cast<float>(sky_->width) - 0.5f,
                y = uv.y * static_cast<float>(sky_->height) - 0.5f;
    const float x_floor = std::floor(x), y_floor = std::floor(y);
    const auto ix = static_cast<int32_t>(x_floor), iy = static_cast<int32_t>(y_floor);
    const vec3 top = mixed(pixel(ix, iy), pixel(ix + 1, iy), x - x_floor);
    const vec3 bottom = mixed(pixel(ix, iy + 1), pixel(ix + 1, iy + 1), x - x_floor);
    return mixed(top, bottom, y - y_floor) * sky_->intensity;
}

LaneVec3 SkyLight::radiance_at(const LaneMask& on, const LaneVec2& uv) const {
    const Lanes x = uv.x * static_cast<float>(sky_->width) - 0.5f,
                y = uv.y * static_cast<float>(sky_->height) - 0.5f;
    const Lanes x_floor = floor(x), y_floor = floor(y);
    const PerLane<float> all_x = to_array(x_floor), all_y = to_array(y_floor);
    VectorArrays top_left, top_right, bottom_left, bottom_right;
    for_lanes(on, [&](int i) {
        const auto ix = static_cast<int32_t>(all_x[i]), iy = static_cast<int32_t>(all_y[i]);
        top_left.set(i, pixel(ix, iy)), top_right.set(i, pixel(ix + 1, iy));
        bottom_left.set(i, pixel(ix, iy + 1)), bottom_right.set(i, pixel(ix + 1, iy + 1));
    });
    const LaneVec3 top = mixed(top_left.lanes(), top_right.lanes(), x - x_floor);
    const LaneVec3 bottom = mixed(bottom_left.lanes(), bottom_right.lanes(), x - x_floor);
    return mixed(top, bottom, y - y_floor) * sky_->intensity;
}

void SkyLight::prefetch_around(uint32_t x, uint32_t y) const {
    for (int32_t dy = -1; dy <= 1; ++dy)
        prefetch(&pixel(static_cast<int32_t>(x), static_cast<int32_t>(y) + dy));
}

std::pair<uint32_t, uint32_t> SkyLight::cell_at(const vec2& uv) const {
    const uint32_t w = sky_->width, h = sky_->height;
    return {std::min(static_cast<uint32_t>(uv.x * static_cast<float>(w)), w - 1),
            std::min(static_cast<uint32_t>(uv.y * static_cast<float>(h)), h - 1)};
}

LightSample SkyLight::sample_Li(const vec3&, uint32_t, const vec2& u, bool with_mis) const {
    if (sky_->width == 0) {
        return {true, vec3(sky_->intensity), uniform_sphere(u), UNIFORM_SPHERE_PDF, {}, true};
    }
    if (cells_.total() <= 0) return {};
    // A cell by its power, then uniformly in solid angle within it.
    const Distribution2D::Choice cell = cells(with_mis).sample(u);
    prefetch_around(cell.x, cell.y);
    const float cos_theta = mixed(row_cosines_[cell.y], row_cosines_[cell.y + 1], cell.remapped.y);
    const float sin_theta = safe_sqrt(1 - cos_theta * cos_theta);
    const float turns = (static_cast<float>(cell.x) + cell.remapped.x) / static_cast<float>(sky_->width);
    const vec3 radiance = radiance_at({turns, fast_atan2(sin_theta, cos_theta) * INV_PI});
    return {true, radiance, direction_of(cos_theta, sin_theta, turns), pdf_in_row(cell.y, cell.pmf),
            {},   true};
}

ETENDUE_LANES_FLATTEN LightSampleOf<Lanes> SkyLight::sample_Li(const LaneMask& on, const LaneVec3&,
                                                               const PerLane<const SkyLight*>& skies,
                                                               const PerLane<uint32_t>&, const LaneVec2& u,
                                                               bool with_mis) {
    const SkyLight& sky = *skies[find_first_set(on)];
    LightSampleOf<Lanes> out;
    out.infinite = LaneMask(true);
    if (sky.sky_->width == 0) {
        out.exists = on;
        out.radiance = LaneVec3(sky.sky_->intensity);
        out.wi = uniform_sphere(u);
        out.pdf = UNIFORM_SPHERE_PDF;
        return out;
    }
    if (sky.cells_.total() <= 0) return out;
    out.exists = on;
    PerLane<float> low{}, high{}, along_x{}, along_y{}, pdf{};
    const Distribution2D& cells = sky.cells(with_mis);
    PerLane<Distribution2D::Search> searches;
    for_lanes(on, [&](int i) { searches[i] = cells.begin({u.x[i], u.y[i]}); });
    for_lanes(on, [&](int i) { cells.find_start(searches[i]); });
    for_lanes(on, [&](int i) {
        const Distribution2D::Choice cell = cells.finish(searches[i]);
        sky.prefetch_around(cell.x, cell.y);
        low[i] = sky.row_cosines_[cell.y], high[i] = sky.row_cosines_[cell.y + 1];
        along_y[i] = cell.remapped.y;
        along_x[i] = (static_cast<float>(cell.x) + cell.remapped.x) / static_cast<float>(sky.sky_->width);
        pdf[i] = sky.pdf_in_row(cell.y, cell.pmf);
    });
    const Lanes cos_theta = mixed(lanes_of(low), lanes_of(high), lanes_of(along_y));
    const Lanes sin_theta = safe_sqrt(1 - cos_theta * cos_theta), turns = lanes_of(along_x);
    out.wi = direction_of(cos_theta, sin_theta, turns);
    out.radiance = sky.radiance_at(on, {turns, fast_atan2(sin_theta, cos_theta) * INV_PI});
    out.pdf = lanes_of(pdf);
    return out;
}

ETENDUE_LANES_FLATTEN FoundLightOf<Lanes> SkyLight::found(const LaneMask& on, const SurfaceHits& misses,
                                                          const PerLane<const SkyLight*>& skies,
                                                          bool with_mis) {
    const SkyLight& sky = *skies[find_first_set(on)];
    if (sky.sky_->width == 0) return {LaneVec3(sky.sky_->intensity), UNIFORM_SPHERE_PDF};
    const LaneVec2 uv = uv_of(-misses.wo);
    const PerLane<float> u = to_array(uv.x), v = to_array(uv.y);
    for_lanes(on, [&](int i) {
        const auto [x, y] = sky.cell_at({u[i], v[i]});
        sky.prefetch_around(x, y);
        if (sky.cells_.total() > 0) sky.cells(with_mis).prefetch_pmf(x, y);
    });
    PerLane<float> pdf{};
    if (sky.cells_.total() > 0) {
        for_lanes(on, [&](int i) {
            const auto [x, y] = sky.cell_at({u[i], v[i]});
            pdf[i] = sky.pdf_in_row(y, sky.cells(with_mis).pmf(x, y));
        });
    }
    return {sky.radiance_at(on, uv), lanes_of(pdf)};
}

float SkyLight::pdf(const vec3& direction, bool with_mis) const {
    if (sky_->width == 0) return UNIFORM_SPHERE_PDF;
    if (cells_.total() <= 0) return 0;
    const auto [x, y] = cell_at(uv_of(direction));
    return pdf_in_row(y, cells(with_mis).pmf(x, y));
}

float SkyLight::pdf_in_row(uint32_t y, float pmf) const {
    const float solid_angle =
        2 * PI / static_cast<float>(sky_->width) * (row_cosines_[y] - row_cosines_[y + 1]);
    return pmf / solid_angle;
}

}  // namespace etendue
