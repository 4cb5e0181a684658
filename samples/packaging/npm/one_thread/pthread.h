// SPDX-License-Identifier: Apache-2.0
// pthread.h: no thread can be started.

#pragma once

#include <errno.h>
#include <stddef.h>

#define __NEED_pthread_t
#define __NEED_pthread_attr_t
#include <bits/alltypes.h>

inline int pthread_attr_init(pthread_attr_t*) { return 0; }
inline int pthread_attr_setstacksize(pthread_attr_t*, size_t) { return 0; }
inline int pthread_attr_destroy(pthread_attr_t*) { return 0; }
inline int pthread_create(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*) { return EAGAIN; }
inline int pthread_join(pthread_t, void**) { return EINVAL; }
