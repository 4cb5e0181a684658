// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <tbb/task_group.h>
