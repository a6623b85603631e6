"""Wrong estimators and pdfs, each one line away from the right ones, and the tests that must catch them.

All of them are built into one module: a copy of the sources in which every mutated expression reads
`(mutant(k) ? wrong : right)`, with k chosen by the environment variable ETENDUE_MUTANT.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from .. import builds
from ..builds import ROOT


@dataclass(frozen=True)
class Mutant:
    """One mistake: the expression `right` in a file under src/ becomes `wrong`.

    `tests` are pytest's arguments that select tests which fail on it and pass without it.
    """

    name: str
    file: str
    right: str
    wrong: str
    tests: tuple[str, ...]


ANALYTIC = "tests/estimators/test_analytic.py"
BSDF = "tests/statistics/test_bsdf_sampling.py"
LIGHTS = "tests/statistics/test_light_sampling.py"
CHOICE = "tests/statistics/test_light_choice.py"
GUIDE = "tests/estimators/test_light_guide.py"
REUSE = ("tests/estimators/test_path_reuse.py", "-k", "mean")
TRACING = ("tests/estimators/test_light_tracing.py", "-k", "mean or spreads")
SPLITTING = ("tests/estimators/test_light_splitting.py", "-k", "mean or noise")
PORTALS = ("tests/estimators/test_portals.py", "-k", "mean or clean")
SAMPLER = "tests/statistics/test_sampler.py"


def furnace(file: str = ANALYTIC) -> tuple[str, ...]:
    return (file, "-k", "furnace")


MUTANTS = (
    Mutant(
        "roulette without reweighting",
        "algorithms/russian_roulette.h",
        "throughput / (1 - q)",
        "throughput",
        furnace(),
    ),
    Mutant(
        "light-selection probability missing",
        "algorithms/direct_light.h",
        "pmf * light.pdf",
        "light.pdf",
        (ANALYTIC, "-k", "two_lamps"),
    ),
    Mutant(
        "light-selection probability missing in the weight of light found by chance",
        "algorithms/pathtracer.cpp",
        "choice_pmfs(context, paths, hits, could_be_sampled) * light.pdf",
        "light.pdf",
        (ANALYTIC, "-k", "two_lamps"),
    ),
    Mutant(
        "light traced without the angle at which the film sees it",
        "algorithms/light_tracing.h",
        "abs(dot(ray_direction, normal) / dot(wi, normal))",
        "abs(dot(wi, normal) / dot(wi, normal))",
        TRACING,
    ),
    Mutant(
        "light traced as if shading normals kept its etendue",
        "algorithms/light_tracing.cpp",
        "cos_ratio(bounce.wi) / cos_ratio(hit.wo)",
        "1.f",
        TRACING,
    ),
    Mutant(
        "light traced as if refraction changed its power",
        "algorithms/light_tracing.cpp",
        "bounce.weight * bounce.eta2",
        "bounce.weight",
        TRACING,
    ),
    Mutant(
        "bent shading normals taken for the same from both ends",
        "gi/hit.h",
        "!is_bent && !ClearNormal<V>(side * normal, wi, side * geometric).is_bent",
        "Mask<F>(true)",
        TRACING,
    ),
    Mutant(
        "light traced in addition to what paths from the camera find",
        "algorithms/pathtracer.cpp",
        "select(could_be_traced, weight, found.weight)",
        "found.weight",
        TRACING,
    ),
    Mutant(
        "light traced through some places more often than weights know",
        "algorithms/light_tracing.cpp",
        "light->pmf * sample.pdf * area_densities_[place] / cos_g",
        "light->pmf * sample.pdf / static_cast<float>(choice_.total()) / cos_g",
        TRACING,
    ),
    Mutant(
        "light spread over pixels by another density than the filter's",
        "gi/filter.cpp",
        "2 * x * x * x / (CELLS * width)",
        "3 * x * x * x / (CELLS * width)",
        ("tests/statistics/test_filter.py", "-k", "density"),
    ),
    Mutant(
        "light sampled several times as if it were once",
        "algorithms/direct_light.cpp",
        "light_samples * lanes_of(pmfs)",
        "lanes_of(pmfs)",
        SPLITTING,
    ),
    Mutant(
        "light found by chance weighted as if one had been sampled",
        "algorithms/pathtracer.cpp",
        "select(paths.edges == 2, Lanes(samples), Lanes(1))",
        "Lanes(1)",
        SPLITTING,
    ),
    Mutant(
        "the same light sampled several times",
        "algorithms/pathtracer.cpp",
        "Sampler::part(sample.numbers, k, samples)",
        "Sampler::part(sample.numbers, 0, samples)",
        SPLITTING,
    ),
    Mutant(
        "light through windows found twice",
        "algorithms/portals.cpp",
        "light_sampling_weight(mis, found.pdf, found.other_pdf)",
        "Lanes(1)",
        PORTALS,
    ),
    Mutant(
        "windows weighted by another density than they are sampled by",
        "algorithms/portals.cpp",
        "sqr(hits.found.distance[i]) / cos_g[i]",
        "sqr(hits.found.distance[i])",
        PORTALS,
    ),
    Mutant(
        "light through windows found behind what hides them",
        "algorithms/portals.cpp",
        "mask_of(is_meant)",
        "at.valid",
        PORTALS,
    ),
    Mutant(
        "windows chosen by area without asking how likely",
        "algorithms/portals.cpp",
        "lanes_of(pmfs) / facet.area",
        "1 / facet.area",
        PORTALS,
    ),
    Mutant(
        "paths shared with pixels that do not see them",
        "algorithms/path_reuse.cpp",
        "sees_each_other(context, first, hits.point, point, wi, valid)",
        "valid",
        REUSE,
    ),
    Mutant(
        "paths shared by weights that forget who else could have found them",
        "algorithms/path_reuse.cpp",
        "at(path - of.place + place, (of.place + of.size - place) % of.size).density",
        "at(path, 0).density",
        REUSE,
    ),
    Mutant(
        "black surfaces taken for finders of paths",
        "algorithms/path_reuse.cpp",
        "bsdf.pdf > 0 && !is_black(bsdf.f)",
        "bsdf.pdf > 0",
        REUSE,
    ),
    Mutant(
        "roulette before sharing forgotten",
        "algorithms/path_reuse.cpp",
        "path.survival * (y.radiance + path.shared_bounce * radiance)",
        "(y.radiance + path.shared_bounce * radiance)",
        REUSE,
    ),
    Mutant(
        "light over a coat's mirror kept from its own pixel",
        "algorithms/path_reuse.cpp",
        "path.own_bounce * radiance",
        "vec3(0)",
        REUSE,
    ),
    Mutant(
        "a coat that lets as much through in all directions",
        "algorithms/path_reuse.cpp",
        "per_area * share",
        "per_area",
        REUSE,
    ),
    Mutant(
        "distance to what is shared forgotten",
        "algorithms/path_reuse.cpp",
        "bsdf.pdf * per_area",
        "bsdf.pdf * cos_y",
        REUSE,
    ),
    Mutant(
        "cosine twice",
        "algorithms/direct_light.h",
        "abs(dot(light.wi, shading_normal))",
        "sqr(dot(light.wi, shading_normal))",
        (ANALYTIC, "-k", "disc_over or uniform_sky"),
    ),
    Mutant(
        "area pdf not converted to solid angle",
        "gi/lights/area_light.cpp",
        "distance2 / (cos_light * triangle.area)",
        "1 / triangle.area",
        (ANALYTIC, "-k", "disc_over"),
    ),
    Mutant(
        "back side of a light shining",
        "gi/lights/area_light.h",
        "hit.front ? material_->emission_at(hit.uv()) : vec3(0)",
        "material_->emission_at(hit.uv())",
        (ANALYTIC, "-k", "back_of_a_lamp"),
    ),
    Mutant(
        "triangles of a light taken for equally large",
        "gi/lights/area_light.cpp",
        "mesh_->facets[hit.triangle].area",
        "mesh_->facets[0].area",
        (LIGHTS, "-k", "unequal_triangles"),
    ),
    Mutant(
        "light tree that forgets half of a child in its probabilities",
        "gi/light_tree.cpp",
        "pmf *= importance[slot] / total",
        "pmf *= importance[slot] / (total - 0.5f * importance[0])",
        (CHOICE,),
    ),
    Mutant(
        "what was learned of lights forgotten in the weight of light found by chance",
        "algorithms/pathtracer.cpp",
        "paths.prev_learned[i]",
        "nullptr",
        (GUIDE, "-k", "same_picture"),
    ),
    Mutant(
        "lights left out that no path has seen shine",
        "algorithms/light_guide.cpp",
        "std::max(std::sqrt(squares[i] / most), LEAST)",
        "squares[i] / most > 0.1",
        (GUIDE,),
    ),
    Mutant(
        "points crowd in a corner of a triangle",
        "gi/sampling.h",
        "u.y - half",
        "u.y * (u.y - half)",
        (LIGHTS, "-k", "triangle or quad"),
    ),
    Mutant(
        "MIS weight of the wrong pair",
        "algorithms/pathtracer.cpp",
        "bsdf_sampling_weight(mis_, found.pdf, found.other_pdf)",
        "light_sampling_weight(mis_, found.pdf, found.other_pdf / 2)",
        furnace(),
    ),
    Mutant(
        "light found by chance counted beside light sampling",
        "algorithms/direct_light.h",
        "select(light_pdf > 0, F(0), F(1))",
        "F(1)",
        furnace(),
    ),
    Mutant(
        "power heuristic that is none",
        "gi/sampling.h",
        "1 / (1 + sqr(pdf_b / pdf_a))",
        "1 / (1 + pdf_b / pdf_a * sqrt(pdf_b / pdf_a) / 2)",
        furnace(),
    ),
    Mutant(
        "every bounce taken for a delta bounce",
        "algorithms/pathtracer.cpp",
        "bounce.is_delta()",
        "LaneMask(true)",
        furnace(),
    ),
    Mutant(
        "sky without sin theta",
        "gi/lights/sky_light.cpp",
        "pmf / solid_angle",
        "pmf / (4 * PI / static_cast<float>(sky_->width * sky_->height))",
        (ANALYTIC, "-k", "uniform_sky"),
    ),
    Mutant(
        "sky sampled where it is not seen",
        "gi/lights/sky_light.cpp",
        "sin_cos_of_turns(turns,",
        "sin_cos_of_turns(-turns,",
        (LIGHTS,),
    ),
    Mutant(
        "sky sampled by one density and weighted by another",
        "algorithms/pathtracer.cpp",
        "mis_ != Mis::none",
        "false",
        (ANALYTIC, "-k", "uneven_sky"),
    ),
    Mutant(
        "Jacobian of the half vector missing",
        "gi/microfacet.h",
        "D(wo + wi) / (2 * (wo.z + root(wo)))",
        "D(wo + wi) * 4 * dot(wo, normalize(wo + wi)) / (2 * (wo.z + root(wo)))",
        (BSDF,),
    ),
    Mutant(
        "masking counted without shadowing",
        "gi/ggx_reflection.h",
        "ggx.G2(wo, wi) / ggx.G1(wo)",
        "ggx.G1(wo)",
        (BSDF,),
    ),
    Mutant(
        "layered pdf of one lobe alone",
        "gi/bsdfs/layered_ggx.h",
        "(1 - coat) * cosine_hemisphere_pdf(wi.z)",
        "cosine_hemisphere_pdf(wi.z)",
        (BSDF,),
    ),
    Mutant(
        "a path that begins with what the one before it in its lane carried",
        "algorithms/lane_paths.h",
        "select(on, LaneVec3(1), throughput)",
        "throughput",
        furnace(),
    ),
    Mutant(
        "light of one lane counted for all",
        "algorithms/lane_context.h",
        "select(on, found.unweighted * found.weight, LaneVec3(0))",
        "found.unweighted * found.weight",
        (ANALYTIC, "-k", "two_lamps"),
    ),
    Mutant(
        "last vertex looks for light beyond the path length",
        "algorithms/pathtracer.cpp",
        "paths.edges < MAX_CAM_PATH_LENGTH",
        "paths.edges <= MAX_CAM_PATH_LENGTH",
        furnace(),
    ),
    Mutant(
        "shadows forgotten",
        "algorithms/direct_light.h",
        "context.visible(connection.shadow_ray, asked)",
        "asked",
        (ANALYTIC, "-k", "two_lamps"),
    ),
    Mutant(
        "radiance not compressed by refraction",
        "gi/bsdfs/glass.h",
        "surface.albedo / eta2",
        "surface.albedo",
        (ANALYTIC, "-k", "lamp_inside_glass"),
    ),
    Mutant(
        "Fresnel as weight and as probability",
        "gi/bsdfs/glass.h",
        "select(reflects, F(1), sqr(eta))",
        "select(reflects, 1 / reflectance, sqr(eta))",
        (ANALYTIC, "-k", "glass_slabs"),
    ),
    Mutant(
        "refraction always into the glass",
        "gi/bsdf.h",
        "select(front, ior, 1 / ior)",
        "ior",
        (ANALYTIC, "-k", "glass_slabs"),
    ),
    Mutant(
        "rays that start on the surface itself",
        "gi/mesh.cpp",
        "glm::dot(absolute(normal), error)",
        "0.f",
        furnace(),
    ),
    Mutant(
        "one random sequence for all pixels",
        "gi/sampler.h",
        "mix_bits(seed_ ^ pixel)",
        "mix_bits(seed_)",
        (SAMPLER,),
    ),
    Mutant(
        "Sobol's second coordinate is its first",
        "gi/sampler.h",
        "second_coordinate_reversed(index_)",
        "index_",
        (SAMPLER,),
    ),
)

# Statements cannot stand in `? :`; these mutants differ in an operand instead.
_OPERANDS = {
    "sin_cos_of_turns(turns,": ("sin_cos_of_turns(", "turns", "-turns"),
}

SWITCH = """#pragma once
#include <cstdlib>
inline bool mutant(int k) {
    static const int chosen = [] {
        const char* const text = std::getenv("ETENDUE_MUTANT");
        return text ? std::atoi(text) : 0;
    }();
    return chosen == k;
}
"""


def mutate(source: str, mutant: Mutant, number: int) -> str:
    """The source with a switch at the mutant's place."""
    if source.count(mutant.right) != 1:
        raise ValueError(
            f"{mutant.file}: {mutant.right!r} stands there {source.count(mutant.right)} times, not once"
        )
    before, right, wrong = _OPERANDS.get(mutant.right, ("", mutant.right, mutant.wrong))
    after = mutant.right[len(before) + len(right) :]
    if right.startswith("{"):  # a braced list needs its type to stand in an expression
        right, wrong = f"vec2{right}", f"vec2{wrong}"
    return source.replace(mutant.right, f"{before}(mutant({number}) ? ({wrong}) : ({right})){after}")


def build(folder: Path) -> Path:
    """Builds the module with all mutants below `folder` and gives back its path."""
    sources = folder / "source"
    shutil.rmtree(sources / "src", ignore_errors=True)
    shutil.copytree(ROOT / "src", sources / "src")
    shutil.copy(ROOT / "CMakeLists.txt", sources)
    (sources / "python" / "etendue").mkdir(parents=True, exist_ok=True)
    (sources / "mutant.h").write_text(SWITCH)
    for number, mutant in enumerate(MUTANTS, 1):
        path = sources / "src" / mutant.file
        path.write_text(mutate(path.read_text(), mutant, number))
    switch = f"-DCMAKE_CXX_FLAGS=-include {sources / 'mutant.h'}"
    return builds.core_in(builds.build(folder / "build", "_core", switch, sources=sources))


def failing(core: Path, number: int, tests: tuple[str, ...]) -> bool:
    """Whether the tests fail on mutant `number`; 0 is the right one."""
    environment = {**os.environ, "ETENDUE_TEST_CORE": str(core), "ETENDUE_MUTANT": str(number)}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *tests],
        cwd=ROOT,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if done.returncode not in (0, 1):
        raise RuntimeError(f"pytest ended with {done.returncode}:\n{done.stdout[-4000:]}")
    return done.returncode == 1
