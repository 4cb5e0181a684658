// SPDX-License-Identifier: Apache-2.0
// math.h: elementary functions that return the same bits on every machine.
//
// The functions of <cmath> differ in the last bits between C libraries, and those of glibc differ between processors
// with and without fused multiply-add. The functions here use only + - * / in a fixed order, so filter weights and
// transfer curves are the same on every machine. (std::sqrt is exact everywhere and needs no replacement.)
//
// Method: the argument is reduced exactly (Cody, Waite: Software Manual for the Elementary Functions, 1980). Then a
// Taylor series is evaluated that is long enough for its remainder to lie below half a unit in the last place.
//
// Error in units in the last place of a double (ulp), measured against long double:
//
//     exp, log    below 1
//     sin, cos    below 1.5 for |x| <= 1e3, below 2.5 for |x| <= 1e6
//     atan        below 1.5
//     pow         below 2 + 3 |y log x|
//
// Special values are those of IEC 60559 (infinities, NaN, signed zeros). Beyond 1e6, sin and cos lose accuracy; they
// stay in [-1, 1] up to 1e9 and are NaN from there on.

#pragma once

namespace tex::inline v1::math {

inline constexpr double kPi = 0x1.921fb54442d18p+1;

double exp(double x);
double log(double x);
double sin(double x);  // radians
double cos(double x);
double atan(double x);

// x to the power of y, x >= 0 (NaN for x < 0).
double pow(double x, double y);

// sin(pi x) / (pi x), which is 1 at 0 and exactly 0 at the other integers.
double sinc(double x);

}  // namespace tex::inline v1::math
