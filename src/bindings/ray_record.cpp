// Timing of nothing but the rays of a render.
#include "driver/ray_record.h"
#include "bindings/arrays.h"
#include "driver/renderer.h"

namespace etendue {

void bind_ray_record(nb::module_& m) {
    nb::class_<RayRecord>(m, "RayRecord",
                          "The rays that a render traces, to be traced again with nothing around them.")
        .def(
            "__init__",
            [](RayRecord* self, Renderer& renderer, uint64_t samples) {
                const nb::gil_scoped_release release;
                new (self) RayRecord(renderer.scene(), renderer.sensor(), renderer.algorithm(), samples,
                                     renderer.threads());
            },
            nb::keep_alive<1, 2>(), nb::arg("renderer"), nb::arg("samples"),
            "Of the first `samples` samples of every pixel, as this renderer takes them; 32 bytes a ray.")
        .def(
            "replay",
            [](const RayRecord& record, int threads) {
                const nb::gil_scoped_release release;
                return record.replay(threads);
            },
            nb::arg("threads") = 0,
            "Traces them all by Embree, tile by tile in their order. Returns how many hit something.")
        .def_prop_ro("rays", &RayRecord::rays, "How many there are.");
}

}  // namespace etendue
