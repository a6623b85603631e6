"""The atrium's light: the sun as a disc of `light.001`, and a sky that closes the view above the roofs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from etendue.models._spz_noise import cloud, grid, mix, save, step
from etendue.models.mesh import Floats, Mesh, disc, merged, surface
from etendue.models.model import Model

SUN = np.array([-0.34, 0.86, 0.40])  # towards the sun
TARGET, DISTANCE, RADIUS = np.array([2.0, 4.0, -3.0]), 46.0, 2.6
SKY_RADIUS, SKY_STRENGTH = 72.0, 0.56

EYE = 6.7  # height of the sky's horizon
LOWEST, ROOFS = -4.0, 8.0  # degrees above it: where the sky ends, and what the roofs hide


def light(folder: Path) -> Model:
    """The lamps' model; its sky's picture is written into `folder`."""
    model = Model()
    sun = model.material("light.001", kd=(1.0, 0.9, 0.8), ke=(300, 300, 300))
    model.add(sun, _sun())
    picture = "textures/" + _paint_sky(folder / "textures" / "sky.png")
    sky = model.material("sky_light.001", kd=(0.5, 0.65, 0.9), ke=(SKY_STRENGTH,) * 3, map_ke=picture)
    model.add(sky, _dome())
    return model


def _sun() -> Mesh:
    y = -SUN / np.linalg.norm(SUN)
    x = np.cross(y, [0, 0, 1.0])
    x /= np.linalg.norm(x)
    face = disc(RADIUS, 64).transformed(np.stack([x, y, np.cross(x, y)], 1))
    at = TARGET - DISTANCE * y
    return face.moved(*at)


def _dome() -> Mesh:
    """The sky, shining inwards: above the roofs, and below the horizon where the east windows show it.

    What nobody can see is left out, as it would take its share of the samples.
    """

    def patch(around: tuple[float, float], up: tuple[float, float], nu: int, nv: int) -> Mesh:
        def f(u: Floats, v: Floats) -> Floats:
            phi = np.radians(around[0] + (around[1] - around[0]) * u)
            theta = np.radians(up[0] + (up[1] - up[0]) * v)
            y = EYE / SKY_RADIUS + np.sin(theta)
            return SKY_RADIUS * np.stack([np.cos(theta) * np.cos(phi), y, np.cos(theta) * np.sin(phi)], 1)

        mesh = surface(f, nu, nv)
        assert mesh.uvs is not None
        u = (around[0] + (around[1] - around[0]) * mesh.uvs[:, 0]) / 360
        v = (up[0] + (up[1] - up[0]) * mesh.uvs[:, 1] - LOWEST) / (90 - LOWEST)
        mesh = Mesh(mesh.vertices, mesh.faces, mesh.normals, np.stack([u, v], 1))
        assert mesh.normals is not None
        inwards = float(((mesh.vertices - [0, EYE, 0]) * mesh.normals).sum()) < 0
        corners = mesh.vertices[mesh.faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        mesh = Mesh(mesh.vertices, mesh.faces[area > 1e-3], mesh.normals, mesh.uvs)  # none at the zenith
        return mesh if inwards else mesh.flipped()

    return merged([patch((0, 360), (ROOFS, 90), 60, 13), patch((-36, 36), (LOWEST, ROOFS), 12, 3)])


def _paint_sky(path: Path, shape: tuple[int, int] = (512, 1024)) -> str:
    """A clear sky, deeper towards the zenith, with a few thin clouds, over a line of hills."""
    _, v = grid(shape)
    elevation = LOWEST + (90 - LOWEST) * v
    colour = mix((0.66, 0.79, 0.95), (0.16, 0.34, 0.78), step(-0.15, 0.85, v))
    thick = cloud(shape, 101, 1.75, 2, 200, stretch=(2.2, 1)) + 0.25 * cloud(shape, 102, 1.2, 10, 200)
    # Clouds thin out towards the seam of the field at the zenith.
    white = step(0.35, 2.2, thick) * step(1.0, 0.55, v)
    colour = mix(colour, (1.0, 0.98, 0.95), 0.85 * white)
    for seed, height, hill in (
        (103, 1.6, (0.30, 0.40, 0.50)),
        (104, 0.3, (0.13, 0.19, 0.17)),
        (105, -1.3, (0.09, 0.12, 0.05)),
    ):
        ridge = height + 0.5 * cloud((8, shape[1]), seed, 1.4, 2, 120)[0]
        colour = mix(colour, hill, step(0.1, -0.1, elevation - ridge))
    return save(path, colour)
