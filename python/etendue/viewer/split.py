"""A second estimator of the same scene, beside the first."""

from __future__ import annotations

import copy
from typing import Any

from .. import _core
from ..config import Config
from .scenes import Scenes
from .session import Session


class Split:
    """What is right of the line: the scene with another algorithm, or the same with other parameters."""

    def __init__(self, scenes: Scenes, threads: int) -> None:
        self.session = Session(scenes, threads)
        self.position = 0.5
        self.algorithm: str | None = None
        self.parameters: dict[str, Any] = {}

    def config(self, config: Config) -> Config:
        """What is rendered right of the line while `config` is left of it."""
        data = copy.deepcopy(config.data)
        data["algorithm"] = self.algorithm or other_than(config.algorithm)
        known = {
            parameter.name
            for info in _core.algorithms()
            if info.name == data["algorithm"]
            for parameter in info.parameters
        }
        data.update({name: value for name, value in self.parameters.items() if name in known})
        return Config.from_data(data, config.path)


def other_than(algorithm: str) -> str:
    """An estimator to compare one with: the naive one, or else the best."""
    return "Pathtracer" if algorithm == "NaivePathtracer" else "NaivePathtracer"
