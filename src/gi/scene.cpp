#include "gi/scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <oneapi/tbb/parallel_invoke.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <stdexcept>

namespace etendue {

namespace {

/// A hit of a surface that is cut out there is no hit.
void cutout_filter(const RTCFilterFunctionNArguments* args) {
    const auto* const mesh_and_material =
        static_cast<const std::pair<const Mesh*, Material>*>(args->geometryUserPtr);
    const auto& [mesh, material] = *mesh_and_material;
    for (uint32_t i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const vec2 b(RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i));
        const uint32_t triangle = RTCHitN_primID(args->hit, args->N, i);
        if (material.is_cut_out(mesh->uv(triangle, b))) args->valid[i] = 0;
    }
}

/// Fills in what the library reads.
void set_ray(RTCRay& r, const Ray& ray) {
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = 0;
    r.time = 0;
    r.tfar = ray.t_max;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
}

/// Rays in lanes, one after the other.
class RayArrays {
  public:
    explicit RayArrays(const LaneRays& rays)
        : origin_{to_array(rays.origin.x), to_array(rays.origin.y), to_array(rays.origin.z)},
          direction_{to_array(rays.direction.x), to_array(rays.direction.y), to_array(rays.direction.z)},
          t_max_(to_array(rays.t_max)) {}

    Ray operator[](int i) const {
        return {{origin_[0][i], origin_[1][i], origin_[2][i]},
                {direction_[0][i], direction_[1][i], direction_[2][i]},
                t_max_[i]};
    }

  private:
    std::array<PerLane<float>, 3> origin_, direction_;
    PerLane<float> t_max_;
};

}  // namespace

struct Scene::Geometry {
    std::vector<Mesh> meshes;
    // Of all of them.
    std::vector<Facet, BulkAllocator<Facet>> facets;
    std::vector<FacetShading, BulkAllocator<FacetShading>> shading;
    std::vector<std::shared_ptr<const Texture>> textures;
    vec3 lower{INFINITE}, upper{-INFINITE};
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::atomic<ssize_t> bytes = 0;
    std::vector<std::pair<const Mesh*, Material>> cut_outs;  // what the filters see

    Geometry() : device(rtcNewDevice(nullptr)) {
        if (!device) throw std::runtime_error("Embree found no way to run on this processor");
        rtcSetDeviceMemoryMonitorFunction(device, &count_bytes, this);
        scene = rtcNewScene(device);
        // Robust: no ray slips between two triangles that share an edge.
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    }

    Geometry(std::vector<Mesh> all_meshes, std::vector<std::shared_ptr<const Texture>> all_textures,
             const std::vector<Material>& materials)
        : Geometry() {
        meshes = std::move(all_meshes);
        textures = std::move(all_textures);
        cut_outs.reserve(meshes.size());
        for (const Mesh& mesh : meshes) add(mesh, &materials[mesh.material]);
        // Embree leaves cores idle at times, and looks at none of what is packed.
        oneapi::tbb::parallel_invoke([this] { pack(); }, [this] { build(); });
    }

    Geometry(const Geometry&) = delete;
    Geometry& operator=(const Geometry&) = delete;
    ~Geometry() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void pack() {
        size_t triangles = 0, shaded = 0;
        for (const Mesh& mesh : meshes) {
            triangles += mesh.triangles.size();
            if (mesh.has_shading()) shaded += mesh.triangles.size();
        }
        facets.resize(triangles);
        shading.resize(shaded);
        const auto take = [](auto& free, size_t count) {
            const auto part = free.first(count);
            free = free.subspan(count);
            return part;
        };
        std::span<Facet> free_facets(facets);
        std::span<FacetShading> free_shading(shading);
        for (Mesh& mesh : meshes) {
            const size_t count = mesh.triangles.size();
            mesh.pack(take(free_facets, count), take(free_shading, mesh.has_shading() ? count : 0));
            for (size_t i = 0; i < mesh.vertex_count(); ++i) {
                lower = glm::min(lower, mesh.vertices[i]);
                upper = glm::max(upper, mesh.vertices[i]);
            }
        }
    }

    void build() {
        rtcCommitScene(scene);
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
            throw std::runtime_error("Embree could not build its hierarchy over the scene: out of memory?");
    }

    /// One geometry a mesh, its id the mesh's index, over the mesh's own arrays.
    void add(const Mesh& mesh, const Material* material) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh.vertices.data(), 0, sizeof(vec3), mesh.vertex_count());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles.data(), 0, sizeof(mesh.triangles[0]),
                                   mesh.triangles.size());
        if (material && material->cutout_texture) {
            rtcSetGeometryUserData(geometry, &cut_outs.emplace_back(&mesh, *material));
            rtcSetGeometryIntersectFilterFunction(geometry, &cutout_filter);
            rtcSetGeometryOccludedFilterFunction(geometry, &cutout_filter);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }

    RTCRayHit first_hit(const Ray& ray) const {
        RTCRayHit query;
        set_ray(query.ray, ray);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(scene, &query);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &query);
#endif
        return query;
    }

    static bool count_bytes(void* self, ssize_t bytes, bool) {
        static_cast<Geometry*>(self)->bytes += bytes;
        return true;
    }
};

// In braces, as the materials are looked at before they are moved.
Scene::Scene(Data data)
    : Scene{std::make_shared<Geometry>(std::move(data.meshes), std::move(data.textures), data.materials),
            std::move(data.materials), std::move(data.sky)} {}

Scene::Scene(const Scene& other, std::vector<Material> materials, std::optional<Sky> sky)
    : Scene(other.geometry_, std::move(materials), std::move(sky)) {}

Scene::Scene(std::shared_ptr<const Geometry> geometry, std::vector<Material> materials,
             std::optional<Sky> sky)
    : geometry_(std::move(geometry)), materials_(std::move(materials)), sky_image_(std::move(sky)) {
    parts_.reserve(meshes().size());
    for (const Mesh& mesh : meshes()) {
        if (mesh.material >= materials_.size())
            throw std::invalid_argument("a mesh names a material that is not there");
        parts_.emplace_back(mesh, materials_[mesh.material]);
    }
    const float radius = lower().x <= upper().x ? glm::length(upper() - lower()) / 2 : 1.f;
    lights_ = Light::find_all({meshes(), materials_, sky_image_ ? &*sky_image_ : nullptr, radius});
    for (const Light& light : lights_) {
        if (light.mesh()) {
            parts_[light.mesh() - meshes().data()].light = &light;
        } else {
            sky_ = &light;
        }
    }
    light_sampler_ = LightSampler(lights_);
}

Scene::BuildTime Scene::build_alone(const std::vector<Mesh>& meshes) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    Geometry bare;
    for (const Mesh& mesh : meshes) bare.add(mesh, nullptr);
    bare.build();
    const std::clock_t processor = std::clock() - processor_start;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return {seconds.count(), static_cast<double>(processor) / CLOCKS_PER_SEC};
}

const std::vector<Mesh>& Scene::meshes() const { return geometry_->meshes; }
const std::vector<std::shared_ptr<const Texture>>& Scene::textures() const { return geometry_->textures; }
const vec3& Scene::lower() const { return geometry_->lower; }
const vec3& Scene::upper() const { return geometry_->upper; }

Scene::Found Scene::first(const Ray& ray) const {
    static_assert(NONE == RTC_INVALID_GEOMETRY_ID);
    const RTCRayHit found = geometry_->first_hit(ray);
    return {found.hit.geomID, found.hit.primID, found.ray.tfar, {found.hit.u, found.hit.v}};
}

FoundHits Scene::first(const LaneRays& rays, const LaneMask& on) const {
    FoundHits hits;
    const RayArrays arrays(rays);
    for_lanes(on, [&](int i) {
        const Found found = first(arrays[i]);
        if (found.mesh == NONE) {
            hits.light[i] = sky_;
            return;
        }
        const ScenePart& part = parts_[found.mesh];
        part.mesh->prefetch(found.triangle);
        hits.distance[i] = found.distance;
        hits.b1[i] = found.barycentrics.x, hits.b2[i] = found.barycentrics.y;
        hits.triangle[i] = found.triangle;
        hits.part[i] = &part;
        hits.light[i] = part.light;
    });
    return hits;
}

LaneMask Scene::occluded(const LaneRays& rays, const LaneMask& on) const {
    PerLane<bool> is_occluded{};
    const RayArrays arrays(rays);
    for_lanes(on, [&](int i) { is_occluded[i] = occluded(arrays[i]); });
    return mask_of(is_occluded);
}

bool Scene::occluded(const Ray& ray) const {
    RTCRay query;
    set_ray(query, ray);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(geometry_->scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(geometry_->scene, &context, &query);
#endif
    return query.tfar < 0;
}

uint64_t Scene::trace(std::span<const TracedRay> rays) const {
    uint64_t hits = 0;
    for (const TracedRay& traced : rays) {
        if (traced.is_shadow_ray) {
            hits += occluded(traced.ray);
        } else {
            hits += geometry_->first_hit(traced.ray).hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return hits;
}

size_t Scene::triangle_count() const {
    size_t count = 0;
    for (const Mesh& mesh : meshes()) count += mesh.triangles.size();
    return count;
}

size_t Scene::memory_bytes() const {
    size_t bytes = static_cast<size_t>(geometry_->bytes.load());
    for (const Mesh& mesh : meshes()) {
        bytes += (mesh.vertices.size() + mesh.normals.size()) * sizeof(vec3) +
                 mesh.uvs.size() * sizeof(vec2) + mesh.triangles.size() * sizeof(mesh.triangles[0]) +
                 mesh.facets.size() * sizeof(Facet) + mesh.shading.size() * sizeof(FacetShading);
    }
    for (const auto& texture : textures()) bytes += texture->memory_bytes();
    if (sky_image_)
        bytes += sky_image_->pixels.size() * (sizeof(vec3) + 2 * (sizeof(float) + sizeof(uint32_t)));
    return bytes;
}

std::string embree_version() { return RTC_VERSION_STRING; }

}  // namespace etendue
