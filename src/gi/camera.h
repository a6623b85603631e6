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
    Ray ray(const vec2& film, const vec2& u_lens) const;

    /// The same for the pinhole in the middle of the lens.
    Ray pinhole_ray(const vec2& film) const;

    /// Where that pinhole sees a point: the inverse of the above. Empty behind a perspective camera; may be
    /// outside of the film.
    std::optional<vec2> film_of(const vec3& point) const;
    /// How far away a point is: along dir, as focal_depth counts; of a panorama, straight from pos.
    float depth(const vec3& point) const;

    const CameraSettings& settings() const { return settings_; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

  private:
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
