"""The sections of a scene file: their keys, defaults and ranges, and what each means.

These models are the single source of the JSON Schema, of what error messages call allowed and of the
tables in docs/scene-format.md. All are immutable.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
)
from pydantic_core import PydanticCustomError

Vec3 = tuple[float, float, float]

# Two directions closer than this (sine of the angle) leave the camera's roll to rounding errors.
_PARALLEL = 1e-6
_LARGEST, _SMALLEST = 3.4e38, 1.2e-38


def _three(value: Any) -> Any:
    if isinstance(value, list) and len(value) == 3:
        return tuple(value)
    if isinstance(value, (list, tuple)) and len(value) != 3:
        raise PydanticCustomError(
            "number_of_values", "three numbers are needed here, not {n}", {"n": len(value)}
        )
    return value


def _whole(value: Any) -> Any:
    # Configs saved by other programs write 32.0 where they mean 32.
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _single(value: float) -> float:
    # Rendering is done in single precision, where these would be infinite or zero.
    if abs(value) > _LARGEST or 0 < abs(value) < _SMALLEST:
        size = "large" if abs(value) > 1 else "small"
        raise PydanticCustomError("single_precision", "too {size} for single precision", {"size": size})
    return value


def _nonzero(value: Vec3) -> Vec3:
    if math.hypot(*value) < 1e-12:
        raise PydanticCustomError("zero_vector", "a direction cannot be zero")
    return value


# Constraints go before it in an annotation, or the JSON Schema loses them.
WHOLE = BeforeValidator(_whole)

SINGLE = AfterValidator(_single)

Number = Annotated[float, Field(allow_inf_nan=False), SINGLE]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False), SINGLE]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False), SINGLE]
Fraction = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Point = Annotated[tuple[Number, Number, Number], BeforeValidator(_three)]
# As far as a mesh may reach: farther away, directions and distances leave single precision.
Coordinate = Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False), SINGLE]
Position = Annotated[tuple[Coordinate, Coordinate, Coordinate], BeforeValidator(_three)]
Length = Annotated[float, Field(ge=0, le=1e9, allow_inf_nan=False), SINGLE]
Direction = Annotated[Point, AfterValidator(_nonzero)]
Colour = Annotated[tuple[Fraction, Fraction, Fraction], BeforeValidator(_three)]
FileName = Annotated[str, Field(min_length=1)]

MOST_PIXELS = 65_536
MOST_SAMPLES = 2**31 - 1
LONGEST_PATH = 1_000_000


class Section(BaseModel):
    """What all sections share: no key that is not known, no conversion between types, no change later."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, protected_namespaces=())


class Framebuffer(Section):
    """The image."""

    res_w: Annotated[int, Field(ge=1, le=MOST_PIXELS), WHOLE] = Field(
        default=1280, title="Width", description="Width in pixels."
    )
    res_h: Annotated[int, Field(ge=1, le=MOST_PIXELS), WHOLE] = Field(
        default=720, title="Height", description="Height in pixels."
    )
    sppx: Annotated[int, Field(ge=1, le=MOST_SAMPLES), WHOLE] = Field(
        default=10, title="Samples per pixel", description="Samples taken in every pixel."
    )
    exposure: Positive = Field(
        default=1.0,
        title="Exposure",
        description="Factor on the linear radiance for display, PNG and JPEG; never for EXR.",
    )
    hdr: bool = Field(
        default=True, title="HDR", description="Accepted, without effect: films always hold linear radiance."
    )


class Camera(Section):
    """The camera, in a right-handed frame with +Y up."""

    pos: Position = Field(default=(0.0, 0.0, 0.0), title="Position", description="Where the camera stands.")
    dir: Direction = Field(
        default=(0.0, 0.0, -1.0),
        title="Direction",
        description="Where it looks; of any length but zero.",
        validate_default=True,
    )
    up: Direction = Field(
        default=(0.0, 1.0, 0.0),
        title="Up",
        description="What is up in the image; of any length, at any angle to the direction but not along it.",
        validate_default=True,
    )
    fov: Annotated[float, Field(gt=0, lt=180, allow_inf_nan=False), SINGLE] = Field(
        default=70.0, title="Field of view", description="Vertical field of view, in degrees."
    )
    lens_radius: Length = Field(
        default=0.0,
        title="Lens radius",
        description="Radius of the aperture, in scene units; 0 is a pinhole: all is sharp.",
    )
    focal_depth: Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False), SINGLE] = Field(
        default=1.0,
        title="Focal depth",
        description="Distance of the plane in focus, along the direction; auto_focus replaces it.",
    )
    perspective: bool = Field(
        default=True,
        title="Perspective",
        description="false renders an equirectangular panorama of everything around.",
    )

    @field_validator("up")
    @classmethod
    def _not_along_direction(cls, up: Vec3, info: ValidationInfo) -> Vec3:
        direction = info.data.get("dir")
        if direction is None:
            return up
        u, d = ([part / math.hypot(*vector) for part in vector] for vector in (up, direction))
        sine = math.hypot(u[1] * d[2] - u[2] * d[1], u[2] * d[0] - u[0] * d[2], u[0] * d[1] - u[1] * d[0])
        if sine < _PARALLEL:
            raise PydanticCustomError("parallel", "parallel to dir, so nothing says what is up")
        return up


class Sky(Section):
    """Light from all around, infinitely far away."""

    envmap: FileName | None = Field(
        default=None,
        title="Environment map",
        description="Equirectangular image, HDR or not; without it the sky is white.",
    )
    intensity: NotNegative = Field(
        default=1.0, title="Intensity", description="Factor on the sky's radiance."
    )
    scene_center: Point | None = Field(
        default=None,
        title="Scene centre",
        description="Centre of the sphere around the scene; computed where missing.",
    )
    scene_radius: Positive | None = Field(
        default=None,
        title="Scene radius",
        description="Radius of the sphere around the scene; computed where missing.",
    )


class MaterialPatch(Section):
    """Changes to one material that the meshes bring; a key that is missing or null leaves it as it is."""

    name: FileName = Field(title="Name", description="Exact name of the material in the mesh files.")
    type: str | None = Field(
        default=None,
        title="Type",
        description="Kind of material: the first known type that this text contains. Without it the name "
        "decides in the same way.",
    )
    ior: Positive | None = Field(
        default=None, title="Index of refraction", description="Index of refraction; eta of a conductor."
    )
    roughness: Fraction | None = Field(
        default=None,
        title="Roughness",
        description="GGX alpha itself: 0 is a mirror, 1 is as rough as it gets. Else 0.1.",
    )
    absorb: NotNegative | None = Field(
        default=None, title="Absorption", description="k of a conductor. Else 0."
    )
    albedo_col: Colour | None = Field(
        default=None,
        title="Albedo",
        description="Colour: linear red, green and blue. A texture of the mesh file goes before it.",
    )
    emissive_strength: NotNegative | None = Field(
        default=None,
        title="Emissive strength",
        description="Emitted radiance is albedo or emission texture times this. Else 0; 10 for a light.",
    )
    coated: bool | None = Field(
        default=None,
        title="Coated",
        description="true: the albedo does not tint the specular lobe. Else false: it does.",
    )


class SceneSection(Section):
    """What is in the scene."""

    mesh_files: list[FileName] = Field(
        default=[],
        title="Mesh files",
        description="OBJ, PLY, STL or glTF files. A path is tried as given, beside the scene file, under "
        "each --data folder, under $ETENDUE_DATA, then among the bundled scenes.",
    )
    materials: list[MaterialPatch] = Field(
        default=[], title="Materials", description="Patches over the materials that the meshes bring."
    )
    sky: Sky | None = Field(
        default=None, title="Sky", description="Light from all around; null is a black sky."
    )
    volume_path: FileName | None = Field(
        default=None,
        title="Volume file",
        description="NanoVDB grid. Accepted; Étendue renders no volumes and says so.",
    )
    volume: dict[str, Any] | None = Field(
        default=None,
        title="Volume",
        description="Settings of the volume. Accepted; Étendue renders no volumes and says so.",
    )
