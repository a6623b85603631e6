// The sensor: from a point on the film and a point on the lens to a ray.
#pragma once

#include <optional>

#include "gi/ray.h"
#include "gi/sampling.h"

namespace etendue {

class Scene;

struct CameraSettings {
    vec3 pos{0}, dir{0, 0, -1}, up{0, 1, 0};  // need be neither unit nor orthogonal
    float fov = 70;                           // vertical, degrees
    float lens_radius = 0, focal_depth = 1;
    bool perspective = true;  // false: an equirectangular panorama whose centre looks along dir
};

class Camera {
  public:
    /// Throws std::invalid_argument where dir or up is zero or the two are parallel.
    Camera(const CameraSettings& settings, uint32_t width, uint32_t height);

    /// The ray through a film position in pixels, (0, 0) the top left corner, and a uniform point of the
    /// lens.
    template <class V2, class F = NumberOf<V2>>
    RayOf<F> ray(const V2& film, const V2& u_lens) const {
        const RayOf<F> through_centre = pinhole_ray(film);
        if (settings_.lens_radius <= 0 || !settings_.perspective) return through_centre;
        // All rays of a film point meet in the plane in focus, at focal_depth along dir.
        const Vec3<F> offset = lens_offset(u_lens);
        const F depth = settings_.focal_depth / dot(through_centre.direction, Vec3<F>(forward_));
        return {through_centre.origin + offset, normalize(through_centre.direction * depth - offset)};
    }

    /// The same for the pinhole in the middle of the lens.
    template <class V2, class F = NumberOf<V2>>
    RayOf<F> pinhole_ray(const V2& film) const {
        const Vec3<F> forward(forward_), right(right_), up(up_);
        const float w = static_cast<float>(width_), h = static_cast<float>(height_);
        if (!settings_.perspective) {
            F sin_theta, cos_theta, sin_phi, cos_phi;
            sin_cos_of_turns(film.y * (0.5f / h), sin_theta, cos_theta);
            sin_cos_of_turns(film.x * (1 / w) - 0.5f, sin_phi, cos_phi);
            const Vec3<F> level = cos_phi * forward + sin_phi * right;
            return {Vec3<F>(settings_.pos), sin_theta * level + cos_theta * up};
        }
        // Pixels are square: one scale for both axes, set by the height.
        const F x = (2 * film.x - w) / h, y = (h - 2 * film.y) / h;
        return {Vec3<F>(settings_.pos), normalize(forward + tan_half_fov_ * (x * right + y * up))};
    }

    /// Where that pinhole sees a point: the inverse of the above. Empty behind a perspective camera; may be
    /// outside of the film.
    std::optional<vec2> film_of(const vec3& point) const;
    /// A ray of the camera that meets a point.
    struct View {
        vec2 film;  // which may be outside of it
        vec3 origin;
        vec3 direction;  // unit
        float distance;
    };
    /// That from a uniform point of the lens; empty behind a perspective camera.
    std::optional<View> view_of(const vec3& point, const vec2& u_lens) const;
    /// Calls visit(film) for a place on the film and those beyond its edges that see the same: a panorama goes on there.
    void for_each_image(const vec2& film, const auto& visit) const {
        visit(film);
        if (settings_.perspective) return;
        const float w = static_cast<float>(width_), h = static_cast<float>(height_);
        for (const float turn : {-1.f, 1.f}) {
            visit(vec2(film.x + turn * w, film.y));
            for (const float half_turns : {-1.5f, -0.5f, 0.5f, 1.5f}) {
                visit(vec2(film.x + half_turns * w, turn < 0 ? -film.y : 2 * h - film.y));
            }
        }
    }
    /// How much film, in pixels, sees a solid angle around the direction of a ray from one point of the lens.
    template <class V, class F = NumberOf<V>>
    F film_per_solid_angle(const V& direction) const {
        const float w = static_cast<float>(width_), h = static_cast<float>(height_);
        if (!settings_.perspective) {
            // d omega = sin theta d theta d phi.
            const F cos_theta = dot(direction, V(up_));
            return w * h / (2 * PI * PI) / max(safe_sqrt(1 - cos_theta * cos_theta), F(1e-6f));
        }
        // d omega = cos dA / distance^2 in the plane at distance 1 along dir, where a pixel has the side 2 tan(fov / 2) / h.
        const F cos = dot(direction, V(forward_));
        return sqr(h / (2 * tan_half_fov_)) / (cos * cos * cos);
    }
    /// How far away a point is: along dir, as focal_depth counts; of a panorama, straight from pos.
    float depth(const vec3& point) const;

    const CameraSettings& settings() const { return settings_; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

  private:
    template <class V2, class F = NumberOf<V2>>
    Vec3<F> lens_offset(const V2& u_lens) const {
        const V2 lens = uniform_disc(u_lens);
        return settings_.lens_radius * lens.x * Vec3<F>(right_) +
               settings_.lens_radius * lens.y * Vec3<F>(up_);
    }

    CameraSettings settings_;
    uint32_t width_, height_;
    vec3 forward_, right_, up_;
    float tan_half_fov_;
};

/// The distance along `dir` to focus on: the geometric mean of the hit distances of rays through the centres
/// of the pixels in the middle quarter (w/4 x h/4) of the image. The camera's own focal depth where none of
/// them hits.
float auto_focus(const Scene& scene, const Camera& camera);

}  // namespace etendue
