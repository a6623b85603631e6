"""
The compiled core of Étendue: scenes, estimators and the renderer. It opens no file and prints nothing.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray


class ParameterInfo:
    """A setting of an estimator: a top-level key of the scene file."""

    @property
    def name(self) -> str: ...

    @property
    def summary(self) -> str: ...

    @property
    def kind(self) -> str:
        """"bool", "int", "float" or "choice"."""

    @property
    def default(self) -> bool | int | float | str: ...

    @property
    def choices(self) -> list[str]:
        """The values of a choice."""

    @property
    def minimum(self) -> float:
        """Of a number."""

    @property
    def maximum(self) -> float:
        """Of a number."""

class AlgorithmInfo:
    """An estimator."""

    @property
    def name(self) -> str: ...

    @property
    def summary(self) -> str: ...

    @property
    def parameters(self) -> list[ParameterInfo]: ...

    @property
    def longest_path(self) -> int | None:
        """
        Edges of the longest path it takes in, whatever max_cam_path_length says: None for no limit, 2 for direct
        light, 0 where it pictures something else than light transport.
        """

def algorithms() -> list[AlgorithmInfo]:
    """All estimators, by name."""

class MaterialType:
    """What the name of a material makes of it."""

    @property
    def name(self) -> str: ...

    @property
    def summary(self) -> str: ...

    @property
    def bsdf(self) -> str:
        """Name of the BSDF."""

    @property
    def matches(self) -> list[str]:
        """
        Lower-case texts, any of which the name may contain; none: every name matches.
        """

    @property
    def ior(self) -> float | None:
        """None: the mesh's own."""

    @property
    def absorb(self) -> float | None: ...

    @property
    def roughness(self) -> float | None: ...

    @property
    def emissive_strength(self) -> float | None:
        """Where the mesh gives none."""

    @property
    def albedo(self) -> list[float] | None: ...

def material_types() -> list[MaterialType]:
    """
    All material types, in the order in which names are tried against them; the first match decides.
    """

def samplers() -> list[str]:
    """Names of the samplers, the default first."""

def filters() -> list[str]:
    """Names of the pixel filters, the default first."""

def versions() -> list[tuple[str, str]]:
    """What the core was built with and runs on, as (name, version)."""

class Texture:
    """An image on a surface: bilinear, repeating."""

    def __init__(self, pixels: Annotated[NDArray, dict(order='C', device='cpu', writable=False)], srgb: bool) -> None:
        """
        pixels: uint8 or float32 (height, width, channels) with 1, 3 or 4 channels, row 0 at the top.
        srgb: whether uint8 colours are sRGB-encoded. Raises ValueError for other shapes and types.
        """

class Material:
    """What a surface is made of."""

    def __init__(self, name: str, type: str, albedo: Sequence[float] = ..., ior: float = 1.5, roughness: float = 0.10000000149011612, absorb: float = 0.0, coated: bool = False, emissive_strength: float = 0.0, albedo_texture: int = -1, emission_texture: int = -1, normal_texture: int = -1, cutout_texture: int = -1) -> None:
        """
        type: the name of a material type or BSDF. albedo: linear RGB. roughness: GGX alpha. absorb: imaginary part of a
        conductor's index. Textures: indices into the scene's, -1 for none. Raises ValueError for an unknown type.
        """

    @property
    def name(self) -> str: ...

    @property
    def bsdf(self) -> str: ...

class Mesh:
    """Triangles of one material."""

    def __init__(self, vertices: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.uint32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], normals: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None = None, uvs: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)] | None = None, material: int = 0) -> None:
        """
        vertices: float32 (n, 3). triangles: uint32 (m, 3), counter-clockwise seen from the front. normals: float32 (n, 3),
        or None for flat shading. uvs: float32 (n, 2), v = 0 at the bottom of an image. material: index into the
        scene's. Raises ValueError for points that are not finite and indices out of range.
        """

class Sky:
    """Light from infinitely far away."""

    def __init__(self, pixels: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)] | None = None, intensity: float = 1.0, radius: float | None = None) -> None:
        """
        pixels: float32 (height, width, 3), equirectangular linear radiance, or None for white. intensity: factor on it.
        radius: of the sphere that stands for the scene when lights are chosen by power; None: the scene's own.
        """

class Scene:
    """Geometry, materials and lights."""

    def __init__(self, meshes: Sequence[Mesh], materials: Sequence[Material], textures: Sequence[Texture] = [], sky: Sky | None = None) -> None:
        """
        Copies the meshes and builds the acceleration structure on all cores. Raises ValueError for an index out of range.
        """

    @staticmethod
    def build_alone(meshes: Sequence[Mesh]) -> tuple[float, float]:
        """
        Builds the acceleration structure over meshes and nothing else, and drops it. Returns the seconds that it took by
        the clock, and of the processor.
        """

    def with_materials(self, materials: Sequence[Material], sky: Sky | None = None) -> Scene:
        """
        The same geometry, textures and cut-outs, which the two scenes share, under other materials and another sky. Quick,
        as no acceleration structure is built. Raises ValueError for an index out of range.
        """

    @property
    def triangle_count(self) -> int: ...

    @property
    def memory_bytes(self) -> int:
        """Bytes of arrays, textures and the acceleration structure."""

    @property
    def bounds(self) -> tuple[list[float], list[float]] | None:
        """
        Lower and upper corner of the axis-aligned bounding box, or None without geometry.
        """

    @property
    def lights(self) -> list[Light]:
        """All lights, area lights in the order of their meshes."""

    def sample_light_source(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], light_choice: str = 'tree', learned: LightFactors | None = None) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.float32], dict(shape=(None,))]]:
        """
        reference: float32 (n, 3). u: float32 (n,) in [0, 1) -> index of the light chosen there and of the triangle of its
        mesh, int32 (n,), -1 where there is none to choose, and the probability of that choice (n,).
        """

    def sample_light(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], light_choice: str = 'tree', with_mis: bool = True, learned: LightFactors | None = None) -> dict:
        """
        reference: float32 (n, 3). u: float32 (n, 2) in [0, 1). One light sample each, as next event estimation draws it:
        a dict of index (n,) int32 of the light, -1 where it failed, wi (n, 3), radiance (n, 3), position (n, 3) on the light and
        pdf (n,), the choice of the light included. Occlusion is not looked at.
        """

    def sample_light_in_lanes(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], light_choice: str = 'tree', with_mis: bool = True, learned: LightFactors | None = None) -> dict:
        """As `sample_light`, of many at once, as the path tracers do."""

    def light_pdf(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], wi: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], light_choice: str = 'tree', with_mis: bool = True, learned: LightFactors | None = None) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.float32], dict(shape=(None,))]]:
        """
        float32 (n, 3), (n, 3) -> index (n,) int32 of the light that each ray finds, -1 for none, and (n,): density of
        `sample_light` at wi.
        """

    def light_source_pdf(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], index: int, triangle: int = 0, light_choice: str = 'tree', learned: LightFactors | None = None) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
        """
        float32 (n, 3) -> (n,): probability with which sample_light_source chooses this triangle of this light there.
        """

    def intersect(self, origin: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], direction: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> dict:
        """
        float32 (n, 3), unit (n, 3). Returns a dict of distance (n,) (inf: miss), position (n, 3), normal and shading_normal
        (n, 3) on the ray's side, uv (n, 2) and material (n,) int32 (-1: miss).
        """

    def intersect_in_lanes(self, origin: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], direction: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> dict:
        """
        position, normal and shading_normal of `intersect`, of many at once, as the path tracers do.
        """

    def occluded(self, origin: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], target: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.bool_], dict(shape=(None,))]:
        """
        float32 (n, 3), (n, 3) -> bool (n,): whether anything is between, ends included.
        """

class Bsdf:
    """
    A BSDF in its local frame: z is the shading normal, wo.z > 0, both directions unit and away from the
    surface, wi.z < 0 for transmission. f excludes the cosine; pdfs are in solid angle.
    """

    def __init__(self, type: str, albedo: Sequence[float] = ..., ior: float = 1.5, roughness: float = 0.10000000149011612, absorb: float = 0.0, coated: bool = False, front: bool = True) -> None:
        """
        type: a BSDF or material type. front: whether wo is on the outside. Raises ValueError for an unknown type.
        """

    @property
    def name(self) -> str: ...

    @property
    def is_delta(self) -> bool:
        """Whether f and pdf are 0 everywhere."""

    @property
    def is_reciprocal(self) -> bool:
        """Whether f(wo, wi) == f(wi, wo) is claimed."""

    def f(self, wo: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], wi: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None, 3))]:
        """float32 (n, 3), (n, 3) -> (n, 3): the BSDF, cosine excluded."""

    def pdf(self, wo: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], wi: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
        """float32 (n, 3), (n, 3) -> (n,): density of `sample` at wi."""

    def sample(self, wo: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> dict:
        """
        wo: float32 (n, 3). u: float32 (n, 3) in [0, 1): lobe choice and two for the direction.
        Returns a dict of wi (n, 3), weight (n, 3) = f |cos| / pdf, pdf (n,), eta2 (n,) and type (n,) uint8 of BRDF_ bits;
        type is 0 where sampling failed.
        """

    def diffuse_share(self, cosines: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
        """
        float32 (n,) -> (n,): what of f is albedo / pi for wo of these cosines, where paths may be shared.
        """

    def diffuse_share_in_lanes(self, cosines: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
        """Of many at once."""

    def values_in_lanes(self, wo: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], wi: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> tuple:
        """(f, pdf) of many at once, as the path tracers ask for them."""

    def sample_in_lanes(self, wo: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> dict:
        """As `sample`, of many at once, as the path tracers do."""

LANES: int = 16

def bsdfs() -> list[str]:
    """Names of all BSDFs."""

BRDF_DIFFUSE: int = 2

BRDF_GLOSSY: int = 4

BRDF_SPECULAR: int = 8

BRDF_TRANSMISSION: int = 1

class Light:
    """
    A light of a scene. World frame; pdfs in solid angle at the reference point.
    """

    @property
    def kind(self) -> str:
        """"AreaLight" or "SkyLight", ..."""

    @property
    def power(self) -> float:
        """What lights are chosen by."""

    @property
    def material(self) -> str | None:
        """Name of the material of its mesh; None for the sky."""

    @property
    def triangle_count(self) -> int:
        """Of its mesh; 1 for the sky."""

    def sample_Li(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], with_mis: bool = False) -> dict:
        """
        reference: float32 (n, 3). u: float32 (n, 2) in [0, 1). Chooses a triangle by its power. Returns a dict of wi (n, 3), radiance (n, 3), pdf (n,), triangle (n,) int32 and
        position (n, 3) on the light; pdf is 0 where the point drawn cannot shine there. Occlusion is not looked at.
        """

    def pdf_Li(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], wi: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], with_mis: bool = False) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
        """
        float32 (n, 3), (n, 3) -> (n,): density of `sample_Li` at wi, 0 where the ray finds something else first.
        """

    def Le(self, reference: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], wi: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None, 3))]:
        """
        float32 (n, 3), (n, 3) -> (n, 3): radiance of this light seen from there, 0 where something else is in front.
        """

class LightFactors:
    """
    What was learned about the lights of a region of a scene: what the importances of the light tree's first two levels
    are multiplied by.
    """

    def __init__(self, triangles_share: float, root: Sequence[float], below: Sequence[Sequence[float]]) -> None:
        """
        triangles_share: probability of choosing a triangle rather than another light, 1 without others. root: 16 numbers,
        for the slots of the root. below: 16 of 16, for the slots of what is below each. Raises ValueError unless all are > 0.
        """

    @property
    def triangles_share(self) -> float: ...

    @property
    def root(self) -> list[float]: ...

    @property
    def below(self) -> list[list[float]]: ...

class LightGuide:
    """
    Where light does arrive from, region by region (`light_choice`: learned).
    """

    def __init__(self, scene: Scene, camera: Camera, max_edges: int = 10, threads: int = 0) -> None:
        """
        Learns from paths of that camera, as a render by Pathtracer does before its first sample.
        """

    @staticmethod
    def paths(camera: Camera) -> int:
        """How many paths it traces for that."""

    def at(self, position: Sequence[float], normal: Sequence[float]) -> LightFactors:
        """
        The LightFactors for a point and its unit normal; None where nothing is known.
        """

def light_sampling_weight(mis: str, light_pdf: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], bsdf_pdf: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
    """
    mis: "power", "balance" or "none". float32 (n,), (n,) -> (n,): weight of a light sample, light_pdf > 0.
    """

def bsdf_sampling_weight(mis: str, bsdf_pdf: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], light_pdf: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
    """
    The counterpart: weight of a light that a BSDF sample's ray found, bsdf_pdf > 0.
    """

class Sampler:
    """
    Random numbers as a function of (seed, pixel, sample index, dimension).
    """

    def __init__(self, kind: str = 'sobol', seed: int = 0) -> None:
        """Raises ValueError for an unknown kind."""

    def points(self, pixel: int, first: int, count: int, vertex: int = 0, pairs: int = 1, part: tuple[int, int] | None = None) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None))]:
        """
        Samples first .. first + count of a pixel: the first `pairs` two-dimensional draws at a vertex of the path, float32
        (count, 2 pairs). part: (k, n), the draws of part k of n of each sample, n a power of two.
        """

    def points_in_lanes(self, pixel: int, first: int, count: int, vertex: int = 0, pairs: int = 1) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None))]:
        """As `points`, of many samples at once, as the path tracers do."""

    def numbers(self, pixel: int, first: int, count: int, vertex: int = 0, draws: int = 1) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None))]:
        """The same for one-dimensional draws: float32 (count, draws)."""

class Camera:
    """A thin-lens or panorama camera."""

    def __init__(self, pos: Sequence[float], dir: Sequence[float], up: Sequence[float], fov: float, lens_radius: float, focal_depth: float, perspective: bool, width: int, height: int) -> None:
        """
        dir and up need be neither unit nor orthogonal; fov is vertical, in degrees. Raises ValueError where dir and up are
        zero or parallel.
        """

    @property
    def width(self) -> int: ...

    @property
    def height(self) -> int: ...

    @property
    def focal_depth(self) -> float: ...

    def film_of(self, point: Sequence[float]) -> list[float] | None:
        """
        (2,): where the middle of the lens sees a point, in pixels from the top left corner, maybe outside of the image;
        None behind a perspective camera.
        """

    def rays(self, film: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], lens: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float32], dict(shape=(None, 3))], Annotated[NDArray[numpy.float32], dict(shape=(None, 3))]]:
        """
        film: float32 (n, 2), pixels from the top left corner. lens: float32 (n, 2) in [0, 1). Returns origins and unit
        directions, (n, 3) each.
        """

    def films_of(self, points: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], lens: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float32], dict(shape=(None, 2))], Annotated[NDArray[numpy.float32], dict(shape=(None,))]]:
        """
        The inverse of `rays`. points: float32 (n, 3). lens: float32 (n, 2) in [0, 1). Returns where rays from there that meet the
        points come from the film, (n, 2), in pixels and maybe outside of the image, and how many pixels of film see a steradian
        there, (n,). NaN behind a perspective camera.
        """

def auto_focus(scene: Scene, camera: Camera) -> float:
    """
    Geometric mean of the hit distances of pixel-centre rays over the middle quarter (w/4 x h/4) of the image; the camera's
    own focal depth where none hits.
    """

def filter_offsets(filter: str, u: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None, 2))]:
    """
    u: float32 (n, 2) in [0, 1) -> offsets from the pixel's centre drawn from the filter, (n, 2).
    """

def filter_density(filter: str, offsets: Annotated[NDArray[numpy.float32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float32], dict(shape=(None,))]:
    """
    offsets: float32 (n, 2) from the pixel's centre, in pixels -> their density per pixel of area, (n,).
    """

class Films:
    """
    Memory for renderers that follow each other: what one had, the next clears and takes.
    """

    def __init__(self) -> None: ...

    def settle(self, width: int, height: int) -> None:
        """Has the memory of one film ready, and no more."""

class Renderer:
    """
    Renders a scene into its film, as far as it is asked to, again and again.
    """

    def __init__(self, scene: Scene, camera: Camera, algorithm: str, parameters: Mapping[str, bool | int | float | str] = {}, sampler: str = 'sobol', filter: str = 'blackman_harris', seed: int = 0, threads: int = 0, first_sample: int = 0, films: Films | None = None, prepares: bool = True) -> None:
        """
        parameters: values of the algorithm's parameters by name. threads: 0 for all cores. first_sample: the
        index of each pixel's first sample. films: whose memory its film takes, and gives back with the last reference to the
        renderer. prepares: whether the estimator may learn something before the first sample (see `prepare`). Raises
        ValueError for names and values that do not fit.
        """

    def render(self, samples: int, progress: object | None = None, time_limit: float | None = None) -> bool:
        """
        Brings every pixel to `samples` samples, going on from those it has, with the interpreter free for other threads.
        progress(fraction, samples_per_pixel) is called about 20 times a second; an exception in it, or from a signal, cancels
        the render within 100 ms and is raised. time_limit: seconds, after the first sample of each pixel.
        Returns whether all samples were taken.
        """

    def render_until(self, error_bound: float, progress: object | None = None, time_limit: float | None = None) -> bool:
        """
        A beauty render: gives every pixel 16 samples, then more to the worst tiles, until `error` is within the bound.
        The other arguments are those of `render`, but that the fraction of progress is a guess. Returns whether the bound
        is kept. How many samples a pixel has in the end depends on the samples alone.
        """

    def prepare(self) -> bool:
        """
        Lets the estimator learn what it wants to know before its first sample, as a render would: a fraction of a second.
        Returns False where `cancel` ended it.
        """

    @property
    def learns(self) -> bool:
        """
        Whether the estimator has anything to learn in this scene, where it may.
        """

    def cancel(self) -> None:
        """Makes a running render return, from another thread."""

    def mean(self) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3))]:
        """
        float32 (height, width, 3): linear radiance, row 0 at the top; 0 where there is no sample.
        """

    def sum(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))]:
        """float64 (height, width, 3): sum of the valid samples."""

    def sum_squares(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))]:
        """float64 (height, width, 3): sum of their squares."""

    def half_sum(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))]:
        """
        float64 (height, width, 3): sum of the valid samples of one half, of those whose index is in the first half of an
        octave [2^k, 2^(k + 1)), or of the first 16.
        """

    def sample_count(self) -> Annotated[NDArray[numpy.uint64], dict(shape=(None, None))]:
        """uint64 (height, width): samples taken."""

    def invalid_per_pixel(self) -> Annotated[NDArray[numpy.uint64], dict(shape=(None, None))]:
        """uint64 (height, width): of those, how many are not in the sums."""

    def half_count(self) -> Annotated[NDArray[numpy.uint64], dict(shape=(None, None))]:
        """uint64 (height, width): samples in half_sum."""

    def resume(self, sum: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)], sum_squares: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)], half_sum: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)], sample_count: Annotated[NDArray[numpy.uint64], dict(shape=(None, None), order='C', device='cpu', writable=False)], invalid_per_pixel: Annotated[NDArray[numpy.uint64], dict(shape=(None, None), order='C', device='cpu', writable=False)], half_count: Annotated[NDArray[numpy.uint64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> None:
        """
        Goes on from these, as another renderer of the same scene, settings and first sample gave them. Raises
        ValueError for another size.
        """

    def split(self, sums: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 2, 2, 3), order='C', device='cpu', writable=False)] | None = None) -> None:
        """
        From now on keeps contributions apart. sums: as another renderer gave them, to go on from, or None for zeros.
        Raises ValueError for another size.
        """

    def contributions(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None, 2, 2, 3))] | None:
        """
        float64 (height, width, 2, 2, 3), or None without `split`: sums of what BSDF sampling and light sampling found,
        of each over at most two edges and over more, weighted by MIS. Together they are `sum`.
        """

    @property
    def rays(self) -> int:
        """Rays traced, shadow rays included, without those of `prepare`."""

    @property
    def seconds(self) -> float:
        """Time spent in `render`."""

    @property
    def threads(self) -> int: ...

    @property
    def sharing(self) -> int:
        """
        How many pixels share what their paths find, see the function `sharing`.
        """

    @property
    def light_samples(self) -> int:
        """
        How many lights are sampled at the first surface of each path, by estimators that sample lights.
        """

    @property
    def by_portals(self) -> bool:
        """Whether directions to smooth glass and mirrors are sampled there too."""

    @property
    def light_paths(self) -> int:
        """How many paths from lights belong to a sample of every pixel; 0: none."""

    @property
    def error(self) -> float:
        """
        Error of the film as the running or last render last saw it (see film_error); infinite where it cannot
        be told.
        """

    @property
    def invalid_count(self) -> int:
        """Samples that were no finite numbers >= 0; not in the sums."""

    @property
    def invalid(self) -> list[tuple[int, int, int]]:
        """The first thousand of them: (x, y, sample)."""

    def render_coarse(self, stride: int) -> bool:
        """
        Gives the pixels whose x and y are multiples of stride (1, 2, 4, 8 or 16) their first sample, which `render` then
        need not take. Returns False where `cancel` ended it. Raises ValueError for another stride.
        """

    def picture(self, stride: int = 1) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3))]:
        """
        float32 (ceil(height / stride), ceil(width / stride), 3): mean radiance of every stride-th pixel. A pixel without
        samples is as the nearest to its left and above that `render_coarse` gave one. May be called while another thread
        renders. Raises ValueError for a stride that is not 1, 2, 4, 8 or 16.
        """

    def pixel(self, x: int, y: int) -> tuple[list[float], list[float], int, int] | None:
        """
        (mean, variance of one sample, samples, invalid samples) of a pixel, also while another thread renders; mean and
        variance have three channels. None outside of the image.
        """

    @property
    def samples_done(self) -> int:
        """
        Pixels x samples, of those that the running or last `render` was asked for, that are there.
        """

    def snapshot(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3))], Annotated[NDArray[numpy.uint64], dict(shape=(None, None))], Annotated[NDArray[numpy.uint64], dict(shape=(None, None))], Annotated[NDArray[numpy.uint64], dict(shape=(None, None))]]:
        """
        What `sum`, `sum_squares`, `half_sum`, `sample_count`, `invalid_per_pixel` and `half_count` give, of the same moment
        in each pixel, also while another thread renders.
        """

def film_error(sum: NDArray[numpy.float64], sum_squares: NDArray[numpy.float64], half_sum: NDArray[numpy.float64], sample_count: NDArray[numpy.uint64], invalid_per_pixel: NDArray[numpy.uint64], half_count: NDArray[numpy.uint64], sharing: int = 1) -> tuple[float, float, float, NDArray[numpy.float64]]:
    """
    The error of a film, the lower and the upper end of its 95% confidence interval, and the errors of its tiles of
    16 x 16 pixels, (rows, columns). A tile's is relative: the root mean square of its pixels' and channels' standard
    errors, estimated from the halves, over its mean radiance; the film's is what 95% of the tiles do not exceed.
    sharing: how many pixels shared their paths, see `sharing`.
    """

def sharing(algorithm: str, parameters: Mapping[str, bool | int | float | str]) -> int:
    """
    How many pixels at most, all in one tile of 16 x 16, an estimator lets share what their paths find: their estimates are not
    independent of each other. 1: none. Raises ValueError for names and values that do not fit.
    """

class Contribution:
    """Light that a path brought to the camera."""

    @property
    def technique(self) -> str:
        """bsdf_sampling or light_sampling."""

    @property
    def edges(self) -> int:
        """Length of the path in rays."""

    @property
    def unweighted(self) -> list[float]:
        """(3,): radiance, as the technique alone would have it."""

    @property
    def weight(self) -> float:
        """Of the technique, by multiple importance sampling."""

    @property
    def borrowed(self) -> bool:
        """It was found by another pixel's path, and shared."""

    @property
    def from_light(self) -> bool:
        """It was found by a path from a light."""

    @property
    def by_portal(self) -> bool:
        """It was found beside the path, through glass or over mirrors."""

    @property
    def pdf(self) -> float:
        """
        Of the last direction by this technique, in solid angle; 0 where it has no density. Of light that could be traced
        from its other end too: per pixel of film and solid angle.
        """

    @property
    def other_pdf(self) -> float:
        """Of the same direction by the other technique."""

class ShadowRay:
    """A look at a light."""

    @property
    def origin(self) -> list[float]: ...

    @property
    def direction(self) -> list[float]:
        """(3,): to the light; not of unit length."""

    @property
    def visible(self) -> bool: ...

class PathVertex:
    """The end of a path's edge, and what the estimator did there."""

    @property
    def origin(self) -> list[float]: ...

    @property
    def direction(self) -> list[float]:
        """(3,): unit, of the ray that led here."""

    @property
    def hit(self) -> bool:
        """False: the ray left the scene."""

    @property
    def position(self) -> list[float]: ...

    @property
    def normal(self) -> list[float]:
        """(3,): unit, for shading, on the side that the ray came from."""

    @property
    def front(self) -> bool: ...

    @property
    def distance(self) -> float: ...

    @property
    def material(self) -> str:
        """Its name; empty where the ray left the scene."""

    @property
    def bsdf(self) -> str: ...

    @property
    def albedo(self) -> list[float]: ...

    @property
    def emitted(self) -> list[float]:
        """(3,): radiance that shines from here along the ray."""

    @property
    def throughput(self) -> list[float]:
        """(3,): of the path when it came here."""

    @property
    def bounce_lobe(self) -> str | None:
        """Of the direction that the path went on in; None: it did not."""

    @property
    def bounce_pdf(self) -> float | None:
        """In solid angle; of a specular lobe the probability of choosing it."""

    @property
    def bounce_weight(self) -> list[float] | None:
        """(3,): f |cos| / pdf."""

    @property
    def roulette_q(self) -> float | None:
        """
        Probability with which Russian roulette ended the path here; None: it was not played.
        """

    @property
    def roulette_survived(self) -> bool | None: ...

    @property
    def shadow_rays(self) -> list[ShadowRay]: ...

    @property
    def contributions(self) -> list[Contribution]: ...

class PathRecord:
    """A sample's path, vertex by vertex."""

    @property
    def vertices(self) -> list[PathVertex]: ...

    @property
    def from_lights(self) -> list[Contribution]:
        """Contributions that paths from lights brought to this sample."""

    @property
    def by_portals(self) -> list[Contribution]:
        """
        Contributions that were found beside the path, from its first surface through glass and over mirrors.
        """

    @property
    def borrowed(self) -> list[Contribution]:
        """Contributions that other pixels' paths found and shared with this one."""

    @property
    def radiance(self) -> list[float]:
        """(3,): the estimate."""

def replay(renderer: Renderer, x: int, y: int, sample: int, with_lights: bool = True) -> PathRecord:
    """
    The path of one sample of a pixel, as `renderer` takes it. with_lights: and what paths from lights bring to it, for
    which those of the whole image are traced; else its radiance is without. Raises ValueError where there is no such pixel.
    """

class TechniqueFilm:
    """
    The picture split by how its light was found: by technique and path length.
    """

    def __init__(self, renderer: Renderer, max_edges: int = 10) -> None:
        """
        For the scene, camera, estimator and samples of `renderer`, from its seed and sample 0. Paths of more than
        max_edges rays are counted there. Needs 192 bytes x max_edges a pixel.
        """

    def render(self, samples: int, progress: object | None = None) -> bool:
        """
        Takes so many samples more of every pixel. progress(fraction) is called about 20 times a second; an exception in it,
        or from a signal, ends the render and is raised: the film is of no use then.
        """

    def mean(self) -> Annotated[NDArray[numpy.float32], dict(shape=(2, 2, None, None, None, 3))]:
        """
        float32 (2, 2, max_edges, height, width, 3): mean radiance, [0] with MIS weights, [1] without; [:, 0] found by
        BSDF sampling, [:, 1] by light sampling; [:, :, n - 1] over paths of n rays. The sum over mean()[0] is the
        picture.
        """

    def variance(self) -> Annotated[NDArray[numpy.float32], dict(shape=(2, 2, None, None, None, 3))]:
        """
        Of the same shape: variance of one sample, estimated without bias; 0 below two samples.
        """

    @property
    def samples(self) -> int:
        """Taken of every pixel."""

class RayRecord:
    """
    The rays that a render traces, to be traced again with nothing around them.
    """

    def __init__(self, renderer: Renderer, samples: int) -> None:
        """
        Of the first `samples` samples of every pixel, as this renderer takes them; 32 bytes a ray.
        """

    def replay(self, threads: int = 0) -> int:
        """
        Traces them all by Embree, tile by tile in their order. Returns how many hit something.
        """

    @property
    def rays(self) -> int:
        """How many there are."""

class AovPass:
    """What the camera rays of a picture's samples hit first, averaged."""

    def __init__(self, scene: Scene, camera: Camera, sampler: str = 'sobol', filter: str = 'blackman_harris', seed: int = 0, threads: int = 0) -> None:
        """As of the Renderer whose samples are meant."""

    def render(self, first: int, samples: int, progress: object | None = None) -> bool:
        """
        Adds the samples of the indices [first, first + samples). progress(fraction) is called about 20 times a second;
        an exception in it, or from a signal, ends the pass within 100 ms and is raised.
        """

    def albedo(self) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3))]:
        """
        float32 (height, width, 3), 0..1: of what is seen first; 0 where nothing is.
        """

    def normal(self) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3))]:
        """
        float32 (height, width, 3): mean shading normal in the world, on the viewer's side.
        """

    def position(self) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3))]:
        """
        float32 (height, width, 3): mean over the rays that hit; 0 where none does.
        """

    def depth(self) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None))]:
        """
        float32 (height, width): mean distance along the view over the rays that hit; infinite where none does.
        """

    def object_id(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, None))]:
        """int32 (height, width): index of the mesh that most rays hit; -1: none."""

    def material_id(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, None))]:
        """
        int32 (height, width): index of the material that most rays hit; -1: none.
        """

    def denoising_albedo(self) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3))]:
        """
        float32 (height, width, 3), 0..1: behind mirrors and glass, with what shines.
        """

    def denoising_normal(self) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3))]:
        """float32 (height, width, 3): behind mirrors and glass."""
