"""ConfigManager: modes of methods, by class name, from a YAML file or a dict.

    ClassName:
      method: publish                    # or one for each instance: [publish, null, disable]

Rules: the first one that is made counts for the whole program.
"""

from __future__ import annotations

import os
from typing import Any

from wrapyfi.utils.core_utils import SingletonOptimized


class ConfigManager(metaclass=SingletonOptimized):
    """The modes; `config` is a dict of dicts."""

    def __init__(
        self, config: str | os.PathLike[str] | dict[str, Any] | None, **kwargs: Any
    ) -> None:
        self.config: dict[str, Any] = {}
        if isinstance(config, dict):
            self.config = config
        elif config is not None:
            import yaml

            with open(config, encoding="utf-8") as file:
                self.config = yaml.safe_load(file) or {}
