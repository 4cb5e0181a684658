# SPDX-License-Identifier: Apache-2.0
"""Heights of files, in one step."""

from __future__ import annotations

import os as _os
from typing import TYPE_CHECKING, Any

from tex import _tex
from tex._errors import Error as _Error

if TYPE_CHECKING:
    from tex import HeightField


def read_heights(
    path: str | _os.PathLike[str], *, read: dict[str, Any] | None = None, **options: Any
) -> HeightField:
    """The HeightField of a picture: height_field(read_image(path)).

    Of a picture with colours, height_field() chooses or mixes the channels. `read` is a dict of the options of
    read_image(); the others are those of height_field(): read_heights("rock.exr", channel_name="height").
    numpy.asarray(field) is the array (height, width).
    """
    image = _tex.read_image(path, **(read or {}))
    try:
        return _tex.height_field(image, **options)
    except _Error as error:
        raise type(error)(_os.fsdecode(path), error.reason) from None
