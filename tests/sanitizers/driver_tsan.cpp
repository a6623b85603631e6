// The driver under ThreadSanitizer: what other threads may do while a render runs, and several renders of one scene.
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "driver/renderer.h"

namespace {

using namespace etendue;

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "failed: %s\n", what);
    std::exit(1);
}

Mesh quad(const vec3& a, const vec3& b, const vec3& c, const vec3& d, uint32_t material) {
    Mesh mesh;
    mesh.vertices = {a, b, c, d, vec3(0)};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = material;
    return mesh;
}

Material material(const char* type, float emission) {
    Material m;
    m.name = type;
    m.bsdf = bsdf_of(type);
    m.emissive_strength = emission;
    return m;
}

/// Ground, a lamp of this radiance, and glass with holes, under a sky.
Scene::Data world(float radiance) {
    Scene::Data data;
    const std::vector<uint8_t> opacity{0, 255, 255, 0};
    data.textures.push_back(std::make_shared<Texture>(2, 2, 1, opacity.data(), false));
    data.materials = {material("diffuse", 0), material("light", radiance), material("glass", 0),
                      material("light", 1e4f * radiance)};
    data.materials[2].cutout_texture = data.textures[0].get();
    data.meshes = {
        quad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}, 0),
        quad({-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}, 1),
        // So many triangles shine that there is something to learn about them.
        quad({-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}, 1),
        quad({-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 1, 0}, 2),
        // And so small a one that its light is traced through the glass.
        quad({-0.5f, 0.5f, -0.3f}, {-0.5f, 0.5f, -0.31f}, {-0.5f, 0.51f, -0.31f}, {-0.5f, 0.51f, -0.3f}, 3)};
    data.sky.emplace();
    return data;
}

std::unique_ptr<Renderer> renderer(const Scene& scene, int threads) {
    CameraSettings settings;
    settings.pos = vec3(0, 1, 3);
    Renderer::Settings options;
    options.threads = threads;
    return std::make_unique<Renderer>(scene, Camera(settings, 48, 48), make_algorithm("Pathtracer", {}),
                                      options);
}

bool same(const Renderer& a, const Renderer& b) {
    return std::ranges::equal(a.film().pixels(), b.film().pixels(), [](const Pixel& p, const Pixel& q) {
        return p.sum == q.sum && p.count == q.count;
    });
}

/// All that may be asked of a renderer while it renders.
void watch(const Renderer& renderer, const std::atomic<bool>& done) {
    uint64_t seen = 0;
    while (!done) {
        seen += renderer.samples_done() + renderer.rays() + renderer.invalid_count();
        seen += renderer.invalid_samples().size() + (renderer.seconds() > 0);
        seen += renderer.error() > 0 && renderer.samples_expected() >= 0;
        renderer.read([&](const Tile& tile, const Film& film) {
            seen += film.pixels()[size_t{tile.y0} * film.width() + tile.x0].count;
        });
    }
    require(seen > 0, "a watched render reports something");
}

template <class Render>
void watch_while(const Renderer& renderer, const Render& render) {
    std::atomic<bool> done = false;
    std::thread watcher([&] { watch(renderer, done); });
    require(render(), "an undisturbed render is complete");
    done = true;
    watcher.join();
}

void watched(Renderer& renderer, uint64_t samples) {
    watch_while(renderer, [&] { return renderer.render(samples); });
}

}  // namespace

int main() {
    const Scene scene(world(5));
    const auto one = renderer(scene, 1), three = renderer(scene, 3);
    require(one->render(12), "one thread renders");
    require(one->algorithm().light_paths() > 0, "light is traced through the glass");
    watched(*three, 12);
    require(same(*one, *three), "threads do not change the picture");

    const auto coarse = renderer(scene, 3);
    for (const uint32_t stride : {16, 8, 2})
        require(coarse->render_coarse(stride), "coarse passes are complete");
    watched(*coarse, 12);
    require(same(*one, *coarse), "coarse passes do not change the picture");

    const auto beauty = renderer(scene, 1), beauty_of_three = renderer(scene, 3);
    require(beauty->render_until(0.2), "a beauty render keeps its bound");
    watch_while(*beauty_of_three, [&] { return beauty_of_three->render_until(0.2); });
    require(same(*beauty, *beauty_of_three), "threads do not change a beauty render");

    const auto cancelled = renderer(scene, 3);
    std::thread stopper([&] {
        while (cancelled->samples_done() == 0) std::this_thread::yield();
        cancelled->cancel();
    });
    require(!cancelled->render(1'000'000), "a cancelled render is not complete");
    stopper.join();
    uint64_t most = 0;
    for (const Pixel& pixel : cancelled->film().pixels()) most = std::max(most, pixel.count);
    require(cancelled->render(most), "a cancelled render goes on");

    const auto left = renderer(scene, 2), right = renderer(scene, 2);
    std::thread beside([&] { watched(*left, 12); });
    watched(*right, 12);
    beside.join();
    require(same(*left, *one) && same(*right, *one), "renders side by side do not disturb each other");

    const Scene blinding(world(INFINITE));
    const auto invalid = renderer(blinding, 3);
    watched(*invalid, 4);
    require(invalid->invalid_count() > 0 && !invalid->invalid_samples().empty(),
            "invalid samples are listed");
    std::puts("driver: ok");
}
