"""What pickle makes objects of again."""

from __future__ import annotations

from typing import Any


def again(kind: type, values: tuple[Any, ...], words: dict[str, Any]) -> Any:
    return kind(*values, **words)
