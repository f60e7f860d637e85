"""Libraries that some calls need, and the package does not."""

from __future__ import annotations

import importlib
from typing import Any


def extra(module: str, name: str) -> Any:
    """The module, or an ImportError that says how it is installed: as the extra ``name``."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        said = f"this needs {package}: pip install {package}, or install condyle with [{name}]"
        raise ImportError(said) from error
