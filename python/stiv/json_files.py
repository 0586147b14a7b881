# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of JSON files that may have been made to harm."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from stiv import InputError


def read_json(path: Path, max_bytes: int) -> Any:
    """The data of a JSON file in UTF-8. Raises InputError naming the file for all that is not, or is too large."""
    try:
        if path.stat().st_size > max_bytes:
            raise InputError(f"{path}: larger than {max_bytes // 2**20} MiB, which no such file needs")
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except RecursionError as error:
        raise InputError(f"{path}: nested too deeply") from error
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"{path}: not JSON in UTF-8: {error}") from error
