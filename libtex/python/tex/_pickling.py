# SPDX-License-Identifier: Apache-2.0
"""What pickle calls to make an object again."""

from tex import _tex


def restore(name, parts):
    """The object of the class `name` that has these parts."""
    return getattr(_tex, f"_restore_{name}")(parts)
