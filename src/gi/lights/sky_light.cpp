#include "gi/lights/sky_light.h"

namespace etendue {

namespace {

/// Image coordinates of a direction, u and v in [0, 1].
vec2 uv_of(const vec3& direction) {
    const float turns = fast_atan2(direction.z, direction.x) * (INV_PI / 2);
    // acos loses its digits at the poles.
    const float theta = fast_atan2(std::sqrt(sqr(direction.x) + sqr(direction.z)), direction.y);
    return {turns < 0 ? turns + 1 : turns, theta * INV_PI};
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
    const vec3 top = glm::mix(pixel(ix, iy), pixel(ix + 1, iy), x - x_floor);
    const vec3 bottom = glm::mix(pixel(ix, iy + 1), pixel(ix + 1, iy + 1), x - x_floor);
    return glm::mix(top, bottom, y - y_floor) * sky_->intensity;
}

std::optional<LightSample> SkyLight::sample_Li(const vec3&, uint32_t, const vec2& u, bool with_mis) const {
    if (sky_->width == 0) {
        return LightSample{vec3(sky_->intensity), uniform_sphere(u), UNIFORM_SPHERE_PDF, {}, true};
    }
    if (cells_.total() <= 0) return std::nullopt;
    // A cell by its power, then uniformly in solid angle within it.
    const Distribution2D::Choice cell = cells(with_mis).sample(u);
    for (int32_t dy = -1; dy <= 1; ++dy)
        prefetch(&pixel(static_cast<int32_t>(cell.x), static_cast<int32_t>(cell.y) + dy));
    const float cos_theta = glm::mix(row_cosines_[cell.y], row_cosines_[cell.y + 1], cell.remapped.y);
    const float sin_theta = safe_sqrt(1 - cos_theta * cos_theta);
    const float turns = (static_cast<float>(cell.x) + cell.remapped.x) / static_cast<float>(sky_->width);
    const float phi = 2 * PI * turns;
    const vec3 wi(sin_theta * std::cos(phi), cos_theta, sin_theta * std::sin(phi));
    const vec3 radiance = radiance_at({turns, fast_atan2(sin_theta, cos_theta) * INV_PI});
    return LightSample{radiance, wi, pdf_in_row(cell.y, cell.pmf), {}, true};
}

float SkyLight::pdf(const vec3& direction, bool with_mis) const {
    if (sky_->width == 0) return UNIFORM_SPHERE_PDF;
    if (cells_.total() <= 0) return 0;
    const uint32_t w = cells_.width(), h = cells_.height();
    const vec2 uv = uv_of(direction);
    const uint32_t x = std::min(static_cast<uint32_t>(uv.x * static_cast<float>(w)), w - 1);
    const uint32_t y = std::min(static_cast<uint32_t>(uv.y * static_cast<float>(h)), h - 1);
    return pdf_in_row(y, cells(with_mis).pmf(x, y));
}

float SkyLight::pdf_in_row(uint32_t y, float pmf) const {
    const float solid_angle =
        2 * PI / static_cast<float>(sky_->width) * (row_cosines_[y] - row_cosines_[y + 1]);
    return pmf / solid_angle;
}

}  // namespace etendue
