# SPDX-License-Identifier: GPL-3.0-or-later
"""Validation of outputs against the schemas of the package."""

import importlib.resources
import json
from pathlib import Path
from typing import Any

import jsonschema


def read_valid(path: Path, schema: str) -> Any:
    """The JSON in a file, valid by the schema of this name."""
    data = json.loads(path.read_text(encoding="utf-8"))
    jsonschema.validate(data, schema_of(schema))
    return data


def schema_of(name: str) -> Any:
    text = importlib.resources.files("stiv.schemas").joinpath(f"{name}.schema.json").read_text(encoding="utf-8")
    jsonschema.Draft202012Validator.check_schema(json.loads(text))
    return json.loads(text)
