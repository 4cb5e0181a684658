# SPDX-License-Identifier: Apache-2.0
"""The exceptions of tex: one class for each code of ErrorCode (tex/types.h)."""


class Error(Exception):
    """A verb failed.

    code    a word: 'io', 'bad-data', 'unsupported', 'bad-option', 'out-of-memory' or 'cancelled'
    file    the path concerned, as the caller gave it; empty if no file is involved
    reason  one clause without a full stop
    """

    code = ""

    def __init__(self, file, reason):
        super().__init__(f"{file}: {reason}" if file else reason)
        self.file = file
        self.reason = reason

    def __reduce__(self):
        return type(self), (self.file, self.reason)


class IoError(Error, OSError):
    """A file cannot be opened, read, written or renamed; the disk is full. Also an OSError.

    errno     errno.ENOSPC if the disk or the quota is full. Otherwise None: libtex does not tell the other failures
              apart, so there is no FileNotFoundError and no PermissionError
    strerror  the reason
    filename  the file; None if no file is involved
    """

    code = "io"

    def __init__(self, file, reason, errno=None):
        super().__init__(file, reason)
        self.errno = errno
        self.strerror = reason
        self.filename = file or None

    def __reduce__(self):
        return type(self), (self.file, self.reason, self.errno)

    def __str__(self):
        return self.args[0]


class BadDataError(Error, ValueError):
    """A file is damaged, or holds values that cannot be used. Also a ValueError."""

    code = "bad-data"


class UnsupportedError(Error, ValueError):
    """A file is sound but of a type that libtex does not handle. Also a ValueError."""

    code = "unsupported"


class BadOptionError(Error, ValueError):
    """The options contradict each other or the data. Also a ValueError."""

    code = "bad-option"


class OutOfMemoryError(Error, MemoryError):
    """Memory, threads or another resource of the system ran out. Also a MemoryError."""

    code = "out-of-memory"


class CancelledError(Error):
    """The progress callback returned False."""

    code = "cancelled"


_CLASSES = {each.code: each for each in Error.__subclasses__()}


def error_of(code, file, reason, errno=None):
    """The exception of this code. `errno`: only of IoError."""
    return _CLASSES[code](file, reason) if errno is None else _CLASSES[code](file, reason, errno)
