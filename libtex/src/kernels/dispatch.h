// SPDX-License-Identifier: Apache-2.0
// dispatch.h: calls a kernel as it was compiled for the processor. Include it after Highway.

#pragma once

// Defines a function that calls `Kernel` of HWY_NAMESPACE.
#define TEX_KERNEL(Result, function, Kernel, parameters, arguments) \
    HWY_EXPORT(Kernel);                                             \
    Result function parameters { return HWY_DYNAMIC_DISPATCH(Kernel) arguments; }
