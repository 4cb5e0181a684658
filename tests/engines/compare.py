#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""compare.py OURS THEIRS: fails unless two pictures of the sphere agree within 3 codes of 255 on 99 % of its pixels.

The sphere has the radius 1 in a square picture of 2.12. Its outline, where programs average in different ways, is left
out: a ring of a pixel and a half.
"""

import sys

import numpy
import tex

CODES = 3


def picture(path):
    return numpy.rint(numpy.stack(tex.read_image(path).planes[:3], axis=2) * 255)


def main():
    ours, theirs = picture(sys.argv[1]), picture(sys.argv[2])
    assert ours.shape == theirs.shape, f"{sys.argv[2]}: {theirs.shape} instead of {ours.shape}"
    side = ours.shape[0]
    row, column = numpy.indices((side, side)) + 0.5 - side / 2
    inside = numpy.hypot(row, column) < side / 2.12 - 1.5
    apart = numpy.abs(ours - theirs).max(axis=2)[inside]
    agree = 100 * numpy.mean(apart <= CODES)
    print(f"{sys.argv[2]}: {agree:.2f} % of {inside.sum()} pixels within {CODES} codes, at most {apart.max():.0f} apart,"
          f" values {theirs[inside].min():.0f} to {theirs[inside].max():.0f}")
    sys.exit(int(agree < 99 or theirs[inside].max() < 150))


if __name__ == "__main__":
    main()
