// Arrays to a scene.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>

#include "bindings/arrays.h"
#include "gi/scene.h"

namespace etendue {

namespace {

using Colour = std::array<float, 3>;
using Indices = In<uint32_t, nb::shape<-1, 3>>;

std::shared_ptr<Texture> make_texture(const nb::ndarray<nb::c_contig, nb::device::cpu, nb::ro>& pixels,
                                      bool srgb) {
    if (pixels.ndim() != 3 || pixels.shape(0) == 0 || pixels.shape(1) == 0) {
        throw std::invalid_argument("a texture has the shape (height, width, channels)");
    }
    const size_t height = pixels.shape(0), width = pixels.shape(1), channels = pixels.shape(2);
    if (channels != 1 && channels != 3 && channels != 4)
        throw std::invalid_argument("a texture has 1, 3 or 4 channels");
    std::variant<const uint8_t*, const float*> data;
    if (pixels.dtype() == nb::dtype<uint8_t>()) {
        data = static_cast<const uint8_t*>(pixels.data());
    } else if (pixels.dtype() == nb::dtype<float>()) {
        data = static_cast<const float*>(pixels.data());
    } else {
        throw std::invalid_argument("a texture is of uint8 or float32");
    }
    return std::make_shared<Texture>(width, height, channels, data, srgb);
}

/// A material whose textures are still indices.
struct PythonMaterial {
    Material material;
    int albedo_texture, emission_texture, normal_texture, cutout_texture;
};

PythonMaterial make_material(const std::string& name, const std::string& type, const Colour& albedo,
                             float ior, float roughness, float absorb, bool coated, float emissive_strength,
                             int albedo_texture, int emission_texture, int normal_texture,
                             int cutout_texture) {
    PythonMaterial python{{}, albedo_texture, emission_texture, normal_texture, cutout_texture};
    Material& material = python.material;
    material.name = name;
    material.bsdf = bsdf_of(type);
    material.albedo = to_vec3(albedo);
    material.ior = ior;
    material.roughness = roughness;
    material.absorb = absorb;
    material.coated = coated;
    material.emissive_strength = emissive_strength;
    return python;
}

/// The arrays of a mesh as Python has them, which are copied once: into the scene.
struct PythonMesh {
    Vectors3 vertices;
    Indices triangles;
    std::optional<Vectors3> normals;
    std::optional<Vectors2> uvs;
    uint32_t material;

    void require_valid() const {
        const size_t n = vertices.shape(0);
        for (size_t i = 0; i < 3 * n; ++i) {
            // Written so that NaN counts as too far.
            if (!(std::abs(vertices.data()[i]) <= Mesh::FARTHEST)) {
                throw std::invalid_argument("vertex " + std::to_string(i / 3) +
                                            " is not finite, or too far away");
            }
        }
        for (size_t i = 0; i < 3 * triangles.shape(0); ++i) {
            if (triangles.data()[i] >= n) {
                throw std::invalid_argument("triangle " + std::to_string(i / 3) +
                                            " names a vertex that is not there");
            }
        }
    }

    Mesh copy() const {
        // Again, as others may have written to the arrays since.
        require_valid();
        Mesh mesh;
        mesh.vertices.reserve(vertices.shape(0) + 1);
        assign(mesh.vertices, vertices);
        mesh.vertices.emplace_back(0);
        assign(mesh.triangles, triangles);
        if (normals) assign(mesh.normals, *normals);
        if (uvs) assign(mesh.uvs, *uvs);
        mesh.material = material;
        return mesh;
    }

  private:
    template <class Row, class Array>
    static void assign(std::vector<Row>& rows, const Array& array) {
        const auto* const begin = reinterpret_cast<const Row*>(array.data());
        rows.assign(begin, begin + array.shape(0));
    }
};

using Meshes = std::vector<const PythonMesh*>;

std::vector<Mesh> copies_of(const Meshes& meshes) {
    std::vector<Mesh> copies;
    copies.reserve(meshes.size());
    for (const PythonMesh* mesh : meshes) copies.push_back(mesh->copy());
    return copies;
}

PythonMesh make_mesh(Vectors3 vertices, Indices triangles, std::optional<Vectors3> normals,
                     std::optional<Vectors2> uvs, uint32_t material) {
    if (normals) require_same_length(normals->shape(0), vertices.shape(0), "vertices and normals");
    if (uvs) require_same_length(uvs->shape(0), vertices.shape(0), "vertices and uvs");
    PythonMesh mesh{std::move(vertices), std::move(triangles), std::move(normals), std::move(uvs), material};
    mesh.require_valid();
    return mesh;
}

Sky make_sky(std::optional<In<float, nb::shape<-1, -1, 3>>> pixels, float intensity,
             std::optional<float> radius) {
    Sky sky;
    sky.intensity = intensity;
    sky.radius = radius;
    if (pixels) {
        sky.height = pixels->shape(0);
        sky.width = pixels->shape(1);
        if (sky.width == 0 || sky.height == 0) throw std::invalid_argument("the sky's image is empty");
        const auto* const begin = reinterpret_cast<const vec3*>(pixels->data());
        sky.pixels.assign(begin, begin + size_t{sky.width} * sky.height);
        for (const vec3& p : sky.pixels) {
            if (!(p.x >= 0 && p.y >= 0 && p.z >= 0 && max_component(p) < INFINITE)) {
                throw std::invalid_argument("the sky's image has a pixel that is negative or not finite");
            }
        }
    }
    return sky;
}

using Textures = std::vector<std::shared_ptr<const Texture>>;

/// The materials with their textures looked up.
std::vector<Material> materials_of(const std::vector<PythonMaterial>& materials, const Textures& textures) {
    const auto texture = [&](int index) -> const Texture* {
        if (index == -1) return nullptr;
        if (index < 0 || static_cast<size_t>(index) >= textures.size())
            throw std::invalid_argument("no such texture");
        return textures[index].get();
    };
    std::vector<Material> found;
    for (const PythonMaterial& python : materials) {
        Material& material = found.emplace_back(python.material);
        material.albedo_texture = texture(python.albedo_texture);
        material.emission_texture = texture(python.emission_texture);
        material.normal_texture = texture(python.normal_texture);
        material.cutout_texture = texture(python.cutout_texture);
    }
    return found;
}

std::shared_ptr<Scene> make_scene(const Meshes& meshes, const std::vector<PythonMaterial>& materials,
                                  const std::vector<std::shared_ptr<Texture>>& textures,
                                  std::optional<Sky> sky) {
    Scene::Data data;
    data.textures.assign(textures.begin(), textures.end());
    data.materials = materials_of(materials, data.textures);
    for (const PythonMesh* mesh : meshes) {
        if (mesh->material >= materials.size())
            throw std::invalid_argument("a mesh names a material that is not there");
    }
    data.meshes = copies_of(meshes);
    data.sky = std::move(sky);
    const nb::gil_scoped_release release;
    return std::make_shared<Scene>(std::move(data));
}

std::shared_ptr<Scene> relit_scene(const Scene& scene, const std::vector<PythonMaterial>& materials,
                                   std::optional<Sky> sky) {
    std::vector<Material> changed = materials_of(materials, scene.textures());
    const nb::gil_scoped_release release;
    return std::make_shared<Scene>(scene, std::move(changed), std::move(sky));
}

}  // namespace

void bind_scene(nb::module_& m) {
    nb::class_<Texture>(m, "Texture", "An image on a surface: bilinear, repeating.")
        .def(nb::new_(&make_texture), nb::arg("pixels"), nb::arg("srgb"),
             "pixels: uint8 or float32 (height, width, channels) with 1, 3 or 4 channels, row 0 at the top.\n"
             "srgb: whether uint8 colours are sRGB-encoded. Raises ValueError for other shapes and types.");

    nb::class_<PythonMaterial>(m, "Material", "What a surface is made of.")
        .def(nb::new_(&make_material), nb::arg("name"), nb::arg("type"),
             nb::arg("albedo") = Colour{0.8f, 0.8f, 0.8f}, nb::arg("ior") = 1.5f, nb::arg("roughness") = 0.1f,
             nb::arg("absorb") = 0.f, nb::arg("coated") = false, nb::arg("emissive_strength") = 0.f,
             nb::arg("albedo_texture") = -1, nb::arg("emission_texture") = -1, nb::arg("normal_texture") = -1,
             nb::arg("cutout_texture") = -1,
             "type: the name of a material type or BSDF. albedo: linear RGB. roughness: GGX alpha. absorb: "
             "imaginary part of a\n"
             "conductor's index. Textures: indices into the scene's, -1 for none. Raises ValueError for an "
             "unknown type.")
        .def_prop_ro("name", [](const PythonMaterial& p) { return p.material.name; })
        .def_prop_ro("bsdf",
                     [](const PythonMaterial& p) { return std::string(bsdfs()[p.material.bsdf].name); });

    nb::class_<PythonMesh>(m, "Mesh", "Triangles of one material.")
        .def(nb::new_(&make_mesh), nb::arg("vertices"), nb::arg("triangles"), nb::arg("normals") = nb::none(),
             nb::arg("uvs") = nb::none(), nb::arg("material") = 0,
             "vertices: float32 (n, 3). triangles: uint32 (m, 3), counter-clockwise seen from the front. "
             "normals: float32 (n, 3),\n"
             "or None for flat shading. uvs: float32 (n, 2), v = 0 at the bottom of an image. material: "
             "index into the\n"
             "scene's. Raises ValueError for points that are not finite and indices out of range.");

    nb::class_<Sky>(m, "Sky", "Light from infinitely far away.")
        .def(nb::new_(&make_sky), nb::arg("pixels") = nb::none(), nb::arg("intensity") = 1.f,
             nb::arg("radius") = nb::none(),
             "pixels: float32 (height, width, 3), equirectangular linear radiance, or None for white. "
             "intensity: factor on it.\n"
             "radius: of the sphere that stands for the scene when lights are chosen by power; None: the "
             "scene's own.");

    nb::class_<Scene>(m, "Scene", "Geometry, materials and lights.")
        .def(nb::new_(&make_scene), nb::arg("meshes"), nb::arg("materials"),
             nb::arg("textures") = std::vector<std::shared_ptr<Texture>>{}, nb::arg("sky") = nb::none(),
             "Copies the meshes and builds the acceleration structure on all cores. Raises ValueError for an "
             "index out of range.")
        .def_static(
            "build_alone",
            [](const Meshes& meshes) {
                const std::vector<Mesh> copies = copies_of(meshes);
                const nb::gil_scoped_release release;
                const Scene::BuildTime time = Scene::build_alone(copies);
                return std::pair{time.seconds, time.processor_seconds};
            },
            nb::arg("meshes"),
            "Builds the acceleration structure over meshes and nothing else, and drops it. Returns the "
            "seconds "
            "that it took by\n"
            "the clock, and of the processor.")
        .def(
            "with_materials", &relit_scene, nb::arg("materials"), nb::arg("sky") = nb::none(),
            "The same geometry, textures and cut-outs, which the two scenes share, under other materials and "
            "another sky. Quick,\n"
            "as no acceleration structure is built. Raises ValueError for an index out of range.")
        .def_prop_ro("triangle_count", [](const Scene& s) { return s.triangle_count(); })
        .def_prop_ro(
            "memory_bytes", [](const Scene& s) { return s.memory_bytes(); },
            "Bytes of arrays, textures and the acceleration structure.")
        .def_prop_ro(
            "bounds",
            [](const Scene& s) -> std::optional<std::pair<Colour, Colour>> {
                if (s.lower().x > s.upper().x) return std::nullopt;
                return std::pair{from_vec3(s.lower()), from_vec3(s.upper())};
            },
            "Lower and upper corner of the axis-aligned bounding box, or None without geometry.");
}

}  // namespace etendue
