#include "gi/camera.h"

#include <oneapi/tbb/parallel_for.h>

#include <stdexcept>
#include <vector>

#include "gi/scene.h"

namespace etendue {

Camera::Camera(const CameraSettings& settings, uint32_t width, uint32_t height)
    : settings_(settings), width_(width), height_(height), tan_half_fov_(std::tan(settings.fov * PI / 360)) {
    const vec3 right = glm::cross(settings.dir, settings.up);
    if (!(length2(right) > 0))
        throw std::invalid_argument("the camera's dir and up must not be zero or parallel");
    forward_ = glm::normalize(settings.dir);
    right_ = glm::normalize(right);
    up_ = glm::cross(right_, forward_);
}

std::optional<vec2> Camera::film_of(const vec3& point) const {
    const vec2 size(width_, height_);
    const vec3 to_point = point - settings_.pos;
    const float ahead = glm::dot(to_point, forward_);
    const vec2 aside(glm::dot(to_point, right_), glm::dot(to_point, up_));
    if (settings_.perspective) {
        if (!(ahead > 0)) return std::nullopt;
        return 0.5f * (size + size.y / (tan_half_fov_ * ahead) * vec2(aside.x, -aside.y));
    }
    const float phi = std::atan2(aside.x, ahead), theta = std::atan2(std::hypot(aside.x, ahead), aside.y);
    return vec2(size.x * (phi / (2 * PI) + 0.5f), size.y * theta / PI);
}

std::optional<Camera::View> Camera::view_of(const vec3& point, const vec2& u_lens) const {
    View view{{}, settings_.pos, {}, 0};
    std::optional<vec2> film;
    if (settings_.lens_radius > 0 && settings_.perspective) {
        view.origin += lens_offset(u_lens);
        const float ahead = glm::dot(point - view.origin, forward_);
        if (!(ahead > 0)) return std::nullopt;
        // Where the pinhole sees the point in focus on the way.
        film = film_of(view.origin + settings_.focal_depth / ahead * (point - view.origin));
    } else {
        film = film_of(point);
    }
    if (!film) return std::nullopt;
    view.film = *film;
    view.distance = glm::length(point - view.origin);
    view.direction = (point - view.origin) / view.distance;
    return view;
}

float Camera::depth(const vec3& point) const {
    const vec3 away = point - settings_.pos;
    return settings_.perspective ? glm::dot(away, forward_) : glm::length(away);
}

float auto_focus(const Scene& scene, const Camera& camera) {
    const uint32_t w = camera.width(), h = camera.height();
    // By rows on all cores, added up in their order, so that the sum is the same on any number of them.
    struct Row {
        double log_sum = 0;
        size_t hits = 0;
    };
    std::vector<Row> rows(std::max(h / 4, 1u));
    oneapi::tbb::parallel_for(size_t{0}, rows.size(), [&](size_t row) {
        const uint32_t y = h * 3 / 8 + static_cast<uint32_t>(row);
        for (uint32_t x = w * 3 / 8; x < w * 3 / 8 + std::max(w / 4, 1u); ++x) {
            const SurfaceHit hit = scene.intersect(camera.pinhole_ray(vec2(x, y) + 0.5f));
            if (!hit.valid || !(hit.distance > 0)) continue;
            rows[row].log_sum += std::log(hit.distance);
            ++rows[row].hits;
        }
    });
    double log_sum = 0;
    size_t hits = 0;
    for (const Row& row : rows) log_sum += row.log_sum, hits += row.hits;
    return hits > 0 ? static_cast<float>(std::exp(log_sum / static_cast<double>(hits)))
                    : camera.settings().focal_depth;
}

}  // namespace etendue
