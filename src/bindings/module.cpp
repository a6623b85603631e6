#include "bindings/arrays.h"

NB_MODULE(_core, m) {
    m.doc() =
        "The compiled core of Étendue: scenes, estimators and the renderer. It opens no file and prints "
        "nothing.";
    // Arrays may outlive the interpreter's last look at them (progress callbacks hold the renderer); that is
    // no leak of ours.
    nb::set_leak_warnings(false);
    etendue::bind_registry(m);
    etendue::bind_scene(m);
    etendue::bind_bsdf(m);
    etendue::bind_lights(m);
    etendue::bind_study(m);
    etendue::bind_renderer(m);
    etendue::bind_paths(m);
    etendue::bind_live(m);
    etendue::bind_ray_record(m);
    etendue::bind_aovs(m);
}
